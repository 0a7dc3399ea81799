# SPDX-License-Identifier: MIT OR Apache-2.0
"""A rig for meshes without: an armature with the joints that the library finds, and their weights as vertex groups."""

import bpy
import numpy as np
import superdeform
from mathutils import Vector

from .character import UP, give
from .read import Source
from .refuse import Refused, check_meshes, makers

# How long a bone is at which no other begins, over the one before.
_LAST = 0.5


def rigged(context, meshes):
    """Gives meshes an armature, which comes back with sentences about what a person should know. Needs object mode.

    Raises Refused, after which nothing is changed.
    """
    check_meshes(meshes)
    for mesh in meshes:
        if mesh.data.users > 1:
            raise Refused(f"{mesh.name} shares its mesh with another object: give it one of its own first (Object > Relations > Make "
                          "Single User > Object & Data)")
        if makers(mesh):
            raise Refused(f"{mesh.name} has the modifier {makers(mesh)[0]}, which makes vertices: apply it first, so that all of the body is seen")
    sources = [Source(mesh, None, {}) for mesh in meshes]
    character = superdeform.Character(up=UP)
    parts = give(character, meshes, sources)
    character.rig()
    joints = character.joints()
    role_of = {number: role for role, number in superdeform.character.ROLES.items()}
    names = [role_of.get(int(role), f"joint {index}") for index, role in enumerate(joints.roles)]
    armature = _armature(context, f"{meshes[0].name} rig", names, joints)
    for mesh in meshes:
        _hang(mesh, armature)
    groups = {source.name: [bpy.data.objects[source.name].vertex_groups.new(name=name) for name in names] for source in sources}
    for number, (source, _, of) in enumerate(parts):
        for vertex, numbers, weights in zip(of.tolist(), *(each.tolist() for each in character.weights(number))):
            for joint, weight in zip(numbers, weights):
                if weight > 0:
                    groups[source.name][joint].add([vertex], weight, "REPLACE")
    return armature, character.warnings()


def _armature(context, name, names, joints):
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    context.scene.collection.objects.link(armature)
    heads = [Vector(matrix[:3, 3]) for matrix in joints.rest]
    context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = [armature.data.edit_bones.new(name) for name in names]
    for joint, bone in enumerate(bones):
        parent = int(joints.parents[joint])
        bone.head = heads[joint]
        bone.parent = bones[parent] if parent >= 0 else None
        bone.tail = _tail(joint, heads, joints)
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def _tail(joint, heads, joints):
    """A bone ends where the next one begins; of several, the one that goes on most straight ahead. The last of a chain goes on."""
    parent, children = int(joints.parents[joint]), np.flatnonzero(joints.parents == joint)
    ahead = heads[joint] - heads[parent] if parent >= 0 else Vector(UP)
    ways = [heads[child] - heads[joint] for child in children]
    ways = [way for way in ways if way.length > 0]
    if not ways:
        return heads[joint] + (ahead * _LAST if ahead.length > 0 else Vector(UP) * _LAST)
    return heads[joint] + max(ways, key=lambda way: way.normalized().dot(ahead))


def _hang(mesh, armature):
    place = mesh.matrix_world.copy()
    mesh.parent = armature
    mesh.matrix_world = place
    modifier = mesh.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    mesh.modifiers.move(len(mesh.modifiers) - 1, 0)
