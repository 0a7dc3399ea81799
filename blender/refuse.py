# SPDX-License-Identifier: MIT OR Apache-2.0
"""What cannot be converted: one sentence that names the object and the remedy, before anything is touched."""

import platform

import bpy

# Of the library, whose wheel another extension may have brought.
_VERSION = "1.0."


class Refused(Exception):
    """A sentence for the user."""


def library_fault():
    """Why the library cannot be used, as a sentence; empty where it can."""
    try:
        import superdeform
    except ModuleNotFoundError:
        return f"This extension has no library for {platform.system()} on {platform.machine()}: install the zip that is made for it"
    except ImportError as fault:
        return str(fault)
    found = superdeform.version()
    if found.startswith(_VERSION):
        return ""
    return f"Version {found} of the library is loaded and {_VERSION}x is needed: remove the other extension that has it, and restart Blender"


# Modifiers that give an armature modifier behind them other vertices than those of the mesh.
_MAKERS = set("ARRAY BEVEL BOOLEAN BUILD DECIMATE EDGE_SPLIT EXPLODE MASK MIRROR MULTIRES NODES REMESH SCREW SKIN SOLIDIFY "
              "SUBSURF TRIANGULATE VOLUME_TO_MESH WELD WIREFRAME".split())


def armatures_of(mesh):
    """The armatures that deform a mesh or carry it."""
    found = [modifier.object for modifier in mesh.modifiers if modifier.type == "ARMATURE" and modifier.object]
    if not found and mesh.parent and mesh.parent.type == "ARMATURE" and mesh.parent_type in {"ARMATURE", "BONE"}:
        found = [mesh.parent]
    return list(dict.fromkeys(found))


def armature_of(thing):
    """The armature that is meant where `thing` is the active object."""
    if thing is None:
        raise Refused("no object is active: select the armature of a character, or one of its meshes")
    if thing.type == "ARMATURE":
        return thing
    if thing.type != "MESH":
        raise Refused(f"{thing.name} is neither an armature nor a mesh: select the armature of a character")
    found = armatures_of(thing)
    if not found:
        raise Refused(f"{thing.name} has no armature: select all meshes of the character and let Make a Rig find one, or parent them "
                      "to one with weights")
    if len(found) > 1:
        raise Refused(f"{thing.name} is deformed by {found[0].name} and {found[1].name}: remove one of the Armature modifiers")
    return found[0]


def meshes_of(armature):
    """The meshes of a character: those that its armature deforms, and those that hang from its bones."""
    found = [thing for thing in bpy.data.objects if thing.type == "MESH" and armature in armatures_of(thing)]
    found = [mesh for mesh in found if mesh.data.polygons]
    if not found:
        raise Refused(f"no mesh belongs to {armature.name}: give its meshes an Armature modifier that names it")
    return found


def unrigged(context):
    """The selected meshes, or the active one, that no armature deforms or carries; none where the active object has an armature."""
    active = context.object
    if active is None or active.type != "MESH" or armatures_of(active):
        return []
    chosen = [active, *(thing for thing in context.selected_objects if thing is not active)]
    return [thing for thing in chosen if thing.type == "MESH" and thing.data.polygons and not armatures_of(thing)]


def check(armature, meshes):
    """Refuses what cannot be converted as a whole."""
    _check_local(armature)
    check_meshes(meshes)
    for mesh in meshes:
        armature_of(mesh)
        before = makers(mesh)
        if before and any(modifier.type == "ARMATURE" for modifier in mesh.modifiers):
            raise Refused(f"{mesh.name} has the modifier {before[0]} before its Armature: apply it, or move it below")


def check_meshes(meshes):
    """Refuses meshes that are not here to change, and keys that are no differences."""
    for mesh in meshes:
        _check_local(mesh)
        keys = mesh.data.shape_keys
        if keys and not keys.use_relative:
            raise Refused(f"{mesh.name} has absolute shape keys: switch Relative on in its Shape Keys panel")


def makers(mesh):
    """The modifiers that make vertices, as far as they come before an Armature."""
    before = []
    for modifier in mesh.modifiers:
        if modifier.type == "ARMATURE":
            break
        if modifier.show_viewport and modifier.type in _MAKERS:
            before.append(modifier.name)
    return before


def _check_local(thing):
    for part in (thing, thing.data):
        if part.library or part.override_library:
            kind = "linked from another file" if part.library else "a library override"
            raise Refused(f"{thing.name} is {kind}: make it local first (Object > Relations > Make Local > All)")
