"""The shared library: found beside this file, checked once, called with errors as exceptions."""

import ctypes as c
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from . import abi

_NAMES = {"win32": "superdeform_files.dll", "darwin": "libsuperdeform_files.dylib"}

Progress = Callable[[float], Any]
"""Called now and then with what part of the work is done, 0 to 1; what it returns, if true, ends the call."""


class Error(Exception):
    """What went wrong: one sentence that names the array, the element, the value and the remedy.

    - `status`: one of `superdeform.abi.SDEF_STATUS_*`.
    - `mesh`, `element`: their indices, or None where none is concerned.
    """

    def __init__(self, message: str, status: int, mesh: int | None = None, element: int | None = None):
        super().__init__(message)
        self.status, self.mesh, self.element = status, mesh, element


# Beside superdeform.h: characters as files (python/library/lib.rs).
_FILES = {
    "sdef_conversion_open": [c.c_char_p, c.c_char_p, c.c_size_t, c.c_char_p, c.c_uint32, c.c_uint32, c.c_void_p, c.c_void_p, c.c_void_p, c.c_void_p],
    "sdef_conversion_set": [c.c_uint64, abi.SdefStyle, c.c_void_p, c.c_void_p, c.c_void_p],
    "sdef_conversion_write": [c.c_uint64, c.c_void_p, c.c_size_t, c.c_void_p, c.c_void_p, c.c_size_t, c.c_void_p],
    "sdef_conversion_close": [c.c_uint64],
    "sdef_style_from_file": [c.c_char_p, c.c_char_p, c.c_size_t, c.c_void_p, c.c_void_p],
}


def _load() -> c.CDLL:
    name = _NAMES.get(sys.platform, "libsuperdeform_files.so")
    path = os.environ.get("SUPERDEFORM_FILES_LIBRARY") or str(Path(__file__).with_name(name))
    try:
        loaded = c.CDLL(path)
    except OSError as fault:
        raise ImportError(f"{path} is not there or not for this system ({fault}): install the wheel for {sys.platform}") from None
    loaded.sdef_abi_version.restype = c.c_uint32
    found = loaded.sdef_abi_version()
    if found != abi.SDEF_ABI_VERSION:
        raise ImportError(f"{path} has version {found} of the ABI, this package needs {abi.SDEF_ABI_VERSION}: install the wheel anew")
    functions = dict(abi.FUNCTIONS)
    functions |= {name: (abi.SdefStatus, given + [c.c_void_p]) for name, given in _FILES.items()}
    for name, (returned, given) in functions.items():
        function = getattr(loaded, name)
        function.restype, function.argtypes = returned, given
    return loaded


_library = _load()


def version() -> str:
    """The library's release, such as "1.0.0-rc.1"."""
    return _library.sdef_version().decode()


def call(name: str, *given: Any) -> None:
    """Calls `sdef_NAME` with an error at the end.

    Raises Error where the status is not OK.
    """
    error = abi.SdefError(struct_size=c.sizeof(abi.SdefError))
    if getattr(_library, "sdef_" + name)(*given, c.byref(error)):
        mesh, element = (None if index == abi.SDEF_NONE else index for index in (error.mesh, error.element))
        raise Error(error.message.decode(), error.status, mesh, element)


def text(name: str, *given: Any) -> str:
    """The text that `sdef_NAME` writes: capacity and size are its last arguments."""
    size = c.c_size_t()
    call(name, *given, None, 0, c.byref(size))
    written = c.create_string_buffer(size.value)
    call(name, *given, written, size.value, None)
    return written.value.decode()


def reports(progress: Progress | None) -> Any:
    """`progress` as a callback for C, to be kept during the call."""
    if progress is None:
        return None
    return abi.SdefProgress(lambda _, fraction: int(bool(progress(fraction))))


def array(given: Any, kind: Any, *shape: int) -> np.ndarray:
    """`given` as a packed array of numbers of the kind, without a copy where it is one; -1 in the shape is any length."""
    made = np.ascontiguousarray(given, kind)
    if made.ndim != len(shape) or any(asked not in (-1, there) for asked, there in zip(shape, made.shape)):
        raise ValueError(f"an array has the shape {made.shape}: give {shape}, where -1 is any length")
    return made


def at(given: np.ndarray | None) -> int | None:
    """The address of an array's numbers."""
    return None if given is None else given.ctypes.data


class Handle:
    """What the library keeps for us, until it is closed or nobody uses it any more."""

    _closes = "destroy"

    def __init__(self, number: int):
        self._number = number

    def close(self) -> None:
        """Gives the memory back; afterwards nothing can be done with it."""
        number, self._number = self._number, 0
        if number:
            call(self._closes, number)

    def __del__(self) -> None:
        if getattr(self, "_number", 0):
            self.close()

    def __enter__(self):
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
