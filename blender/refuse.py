# SPDX-License-Identifier: MIT OR Apache-2.0
"""What cannot be converted: one sentence that names the object and the remedy, before anything is touched."""

import bpy


class Refused(Exception):
    """A sentence for the user."""


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
        raise Refused(f"{thing.name} has no armature: parent it to one with weights, or export it as GLB and give that to the "
                      "command line, which finds a rig")
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


def check(armature, meshes):
    """Refuses what cannot be converted as a whole."""
    for thing in (armature, *meshes):
        for part in (thing, thing.data):
            if part.library or part.override_library:
                kind = "linked from another file" if part.library else "a library override"
                raise Refused(f"{thing.name} is {kind}: make it local first (Object > Relations > Make Local > All)")
    for mesh in meshes:
        armature_of(mesh)
        keys = mesh.data.shape_keys
        if keys and not keys.use_relative:
            raise Refused(f"{mesh.name} has absolute shape keys: switch Relative on in its Shape Keys panel")
        before = []
        for modifier in mesh.modifiers:
            if modifier.type == "ARMATURE":
                if before:
                    raise Refused(f"{mesh.name} has the modifier {before[0]} before its Armature: apply it, or move it below")
                break
            if modifier.show_viewport and modifier.type in _MAKERS:
                before.append(modifier.name)
