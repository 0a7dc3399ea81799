"""What a character should become."""

import ctypes as c

from . import abi
from .character import Character
from .library import Handle, call, text


class Style(Handle):
    """Numbers, not a model: it can be saved, mixed, and used with any character. Made by one of its class methods."""

    @property
    def _handle(self) -> abi.SdefStyle:
        return abi.SdefStyle(self._number)

    @classmethod
    def heads(cls, heads: float, like: "Style | None" = None) -> "Style":
        """A style of so many heads, 1.8 to 6; `like`: the style whose body it takes."""
        made = abi.SdefStyle()
        call("style_from_heads", heads, like._handle if like else abi.SdefStyle(), c.byref(made))
        return cls(made.id)

    @classmethod
    def text(cls, given: str) -> "Style":
        """A built-in style ("sd2", "sd2.5", "sd3", "sd4") or the JSON of a saved one."""
        made, bytes_ = abi.SdefStyle(), given.encode()
        call("style_from_text", bytes_, len(bytes_), c.byref(made))
        return cls(made.id)

    @classmethod
    def measure(cls, character: Character, name: str = "", options: abi.SdefOptions | None = None) -> "Style":
        """The proportions of a super-deformed character."""
        made = abi.SdefStyle()
        call("style_measure", character._handle, name.encode(), c.byref(options) if options else None, c.byref(made))
        return cls(made.id)

    @classmethod
    def file(cls, given: bytes, name: str = "the reference", options: abi.SdefOptions | None = None) -> "Style":
        """The proportions of a super-deformed character in a GLB or VRM file."""
        made = abi.SdefStyle()
        call("style_from_file", name.encode(), given, len(given), c.byref(options) if options else None, c.byref(made))
        return cls(made.id)

    @classmethod
    def blend(cls, first: "Style", second: "Style", amount: float) -> "Style":
        """A style between two: 0 is `first`, 1 `second`."""
        made = abi.SdefStyle()
        call("style_blend", first._handle, second._handle, amount, c.byref(made))
        return cls(made.id)

    def json(self) -> str:
        """The style as text, to be saved and given to `Style.text`."""
        return text("style_to_json", self._handle)


def chosen(heads: float | None, style: "Style | str | None", reference: bytes | None) -> Style:
    """The one style that is asked for; sd2.5 where nothing is."""
    if sum(given is not None for given in (heads, style, reference)) > 1:
        raise TypeError("give one of heads, style and reference")
    if heads is not None:
        return Style.heads(heads)
    if reference is not None:
        return Style.file(reference)
    return style if isinstance(style, Style) else Style.text(style or "sd2.5")
