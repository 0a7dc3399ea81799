"""Characters as files: the bytes of a GLB or VRM in, those of another out."""

import ctypes as c
import json
from collections.abc import Mapping
from typing import Any

from .library import Handle, Progress, call, reports
from .options import options
from .style import Style, chosen


class Conversion(Handle):
    """A file that stays open while styles and options change.

    - `given`: the bytes of a GLB, VRM 0.x or VRM 1.0 file.
    - `name`: for sentences.
    - `roles`: humanoid role to node name, where the file does not say: `{"hips": "Bone.001"}`.
    - `new_rig`: makes a rig whatever there is; else where there is none that has the roles that are needed.
    - `allow_prohibited`: takes what its licence forbids to change: the user is its author or may change it.
    - `progress`: called with what part is done; what it returns, if true, ends the call with an Error.
    - `rig`: options that begin with `rig_`, and `thread_count`.

    Raises Error: a file that cannot be read, a licence that forbids changes, a rig that cannot be made.
    """

    _closes = "conversion_close"

    def __init__(self, given: bytes, name: str = "the file", roles: Mapping[str, str] | None = None, new_rig: bool = False,
                 allow_prohibited: bool = False, progress: Progress | None = None, **rig: Any):
        made, asked, callback = c.c_uint64(), options(**rig), reports(progress)
        roles_text = json.dumps(dict(roles)).encode() if roles else None
        call("conversion_open", name.encode(), given, len(given), roles_text, new_rig, allow_prohibited, c.byref(asked),
             callback, None, c.byref(made))
        super().__init__(made.value)

    def set(self, heads: float | None = None, style: "Style | str | None" = None, reference: bytes | None = None,
            progress: Progress | None = None, **given: Any) -> None:
        """Gives the character a style, as often as something changes.

        - one of `heads` (1.8 to 6), `style` (a Style, or "sd2", "sd2.5", "sd3", "sd4" or saved JSON) and `reference` (the bytes
          of a super-deformed character's file); "sd2.5" where none is given.
        - `given`: as in `superdeform.options`.

        After an Error all is as it was.
        """
        # A style that only this call knows lives until its end.
        asked, callback, wanted = options(**given), reports(progress), chosen(heads, style, reference)
        call("conversion_set", self._number, wanted._handle, c.byref(asked), callback, None)

    def write(self) -> tuple[bytes, dict[str, Any]]:
        """The file, of the kind that came in, and its report: figures, groups, joints, warnings."""
        size, report_size = c.c_size_t(), c.c_size_t()
        call("conversion_write", self._number, None, 0, c.byref(size), None, 0, c.byref(report_size))
        file, report = bytearray(size.value), c.create_string_buffer(report_size.value)
        into = (c.c_char * len(file)).from_buffer(file)
        call("conversion_write", self._number, into, len(file), None, report, len(report), None)
        del into
        return bytes(file), json.loads(report.value)


def convert(given: bytes, heads: float | None = None, style: "Style | str | None" = None, reference: bytes | None = None, *,
            name: str = "the file", roles: Mapping[str, str] | None = None, new_rig: bool = False,
            allow_prohibited: bool = False, progress: Progress | None = None, **options: Any) -> bytes:
    """The super-deformed version of a GLB or VRM file.

    What the arguments mean is told by `Conversion` and its `set`: `convert(bytes, heads=2.5, amount=0.9)`.
    """
    rig = {key: value for key, value in options.items() if key.startswith("rig_") or key == "thread_count"}
    rest = {key: value for key, value in options.items() if not key.startswith("rig_")}
    wanted = chosen(heads, style, reference)
    with Conversion(given, name, roles, new_rig, allow_prohibited, progress, **rig) as conversion:
        conversion.set(style=wanted, progress=progress, **rest)
        return conversion.write()[0]
