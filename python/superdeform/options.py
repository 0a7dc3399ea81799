"""Options by keyword: the fields of SdefOptions, and `groups` by name."""

import ctypes as c
import math
from collections.abc import Mapping
from typing import Any

from . import abi
from .library import call

_MODES = {"product": abi.SDEF_MODE_PRODUCT, "paper": abi.SDEF_MODE_PAPER}
_REPAIRS = {"off": abi.SDEF_REPAIR_OFF, "on": abi.SDEF_REPAIR_ON, "kept": abi.SDEF_REPAIR_KEPT}
# Set by what is said of groups, roles and sizes, not by name.
_COUNTED = {"struct_size", "groups", "group_count", "bone_groups", "bone_group_count", "rig_joints", "rig_joint_count"}
_FIELDS = {name: kind for name, kind in abi.SdefOptions._fields_ if name not in _COUNTED}


def options(groups: Mapping[str, Mapping[str, float]] | None = None, **given: Any) -> abi.SdefOptions:
    """The library's options, with the defaults for what is not given.

    - `groups`: settings by bone group: `{"upper_leg": {"length_scale": 0.8}}`.
    - `given`: fields of SdefOptions by name, such as `amount=0.5`, `youth=1`, `mode="paper"`, `repair="off"`, `height=1.2`;
      None leaves the default. `OPTIONS` has their ranges and what they do.

    Raises TypeError for a name that is none; what a number may be is checked where the options are used.
    """
    made = abi.SdefOptions()
    call("options_init", c.byref(made), c.sizeof(made))
    for name, value in given.items():
        if name not in _FIELDS:
            raise TypeError(f"there is no option {name}: name one of {', '.join(sorted(_FIELDS))}")
        if value is None:
            continue
        words = {"mode": _MODES, "repair": _REPAIRS}.get(name, {})
        if isinstance(value, str):
            if value not in words:
                raise TypeError(f"{name} is {value!r}: give one of {', '.join(words) or 'its numbers'}")
            value = words[value]
        setattr(made, name, value if _FIELDS[name] is c.c_double else int(value))
    if groups:
        rows = (abi.SdefGroupSettings * len(groups))()
        for row, (name, settings) in zip(rows, groups.items()):
            row.struct_size, row.group = c.sizeof(row), name.encode()
            for field in ("length_scale", "thickness_scale", "length_transfer", "thickness_transfer"):
                value = settings.get(field)
                setattr(row, field, math.nan if value is None else value)
            unknown = set(settings) - {field for field, _ in abi.SdefGroupSettings._fields_}
            if unknown:
                raise TypeError(f"a group has no {unknown.pop()}: name length_scale, thickness_scale, length_transfer or thickness_transfer")
        made.group_count, made.groups = len(rows), c.addressof(rows)
        # Kept as long as the struct that points there.
        made._rows = rows
    return made
