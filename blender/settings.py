# SPDX-License-Identifier: MIT OR Apache-2.0
"""What can be set, by the library's own table of ranges and defaults: the same for the panel and the operator."""

import bpy
from superdeform import OPTIONS

# What a panel shows of the options that are a share of the style or of the character: label, ends of the slider.
SHOWN = {
    "amount": ("Amount", 0, 1), "head_scale": ("Head Size", 0.5, 2.5), "youth": ("Youth", 0, 1), "smile": ("Smile", 0, 1),
    "hair_length": ("Hair Length", 0, 1), "hair_lay": ("Hair Lies", 0, 1), "seat": ("Head Sits", 0, 1), "profile": ("Profile", 0, 1),
}
GROUPS = ("head", "neck", "torso", "shoulder", "upper_arm", "lower_arm", "hand", "finger", "hip", "upper_leg", "lower_leg", "foot")


def _number(option, label, low, high, update):
    least, most, usual, text = OPTIONS[option]
    limits = {"min": least, "max": most, "soft_min": max(least, low), "soft_max": min(most, high)}
    subtype = "FACTOR" if (low, high) == (0, 1) else "NONE"
    return bpy.props.FloatProperty(name=label, description=text[:1].upper() + text[1:], default=usual, subtype=subtype, update=update, **limits)


def properties(update=None):
    """Properties by name; `update` is called when one changes."""
    least, most, _, text = OPTIONS["heads"]
    made = {
        "style": bpy.props.EnumProperty(
            name="Style", description="What the character should become", update=update,
            items=[("HEADS", "Heads", "So many heads tall"), ("FILE", "File", "Like a GLB or VRM file, or a saved style"),
                   ("ARMATURE", "Character", "Like another character of the scene")]),
        "heads": bpy.props.FloatProperty(name="Heads", description=text[:1].upper() + text[1:], default=2.5, min=least, max=most, update=update),
        "path": bpy.props.StringProperty(name="File", description="GLB, VRM or saved style", subtype="FILE_PATH", update=update),
        "like": bpy.props.StringProperty(name="Like", description="The armature of a super-deformed character", update=update),
    }
    for option, (label, low, high) in SHOWN.items():
        made[option] = _number(option, label, low, high, update)
    for group in GROUPS:
        for part in ("length", "thickness"):
            made[f"{group}_{part}"] = bpy.props.FloatProperty(
                name=part.capitalize(), default=1, min=0, max=1, subtype="FACTOR", update=update,
                description=f"How much of the style's {part} the {group.replace('_', ' ')} takes; 0 keeps the character's own")
    return made


def options(given):
    """The library's options of a property group or an operator; what stands at its default is left to the library."""
    groups = {}
    for group in GROUPS:
        shares = {f"{part}_transfer": getattr(given, f"{group}_{part}") for part in ("length", "thickness")}
        shares = {name: share for name, share in shares.items() if share < 1}
        if shares:
            groups[group] = shares
    return {name: getattr(given, name) for name in SHOWN} | {"groups": groups}


def draw(layout, given):
    """The settings as a column, groups aside."""
    layout.prop(given, "style", expand=False)
    if given.style == "HEADS":
        layout.prop(given, "heads", slider=True)
    elif given.style == "FILE":
        layout.prop(given, "path")
    else:
        layout.prop_search(given, "like", bpy.data, "objects", icon="ARMATURE_DATA")
    for name in SHOWN:
        layout.prop(given, name, slider=True)


def draw_groups(layout, given):
    """How much of the style each part of the body takes."""
    def line(label):
        made = layout.split(factor=0.4, align=True)
        made.label(text=label)
        return made

    heading = line("")
    for part in ("Length", "Girth"):
        heading.label(text=part)
    for group in GROUPS:
        numbers = line(group.replace("_", " ").title())
        for part in ("length", "thickness"):
            numbers.prop(given, f"{group}_{part}", text="", slider=True)
