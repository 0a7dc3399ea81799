# SPDX-License-Identifier: MIT OR Apache-2.0
"""The joints of a character: the bones of its armature and the objects that hang from them, at rest, in world space.

Of a rig with controls (Rigify, Auto-Rig Pro) the joints are the bones that deform; every other bone follows the joint that it
lies nearest to. Elsewhere every bone is a joint, as a glTF node is.
"""

from dataclasses import dataclass, field

import numpy as np
from .read import rest_world

# Constraints by which controls carry the bones that deform.
_CARRIES = {"COPY_TRANSFORMS", "COPY_LOCATION", "COPY_ROTATION", "STRETCH_TO", "IK", "ARMATURE"}

# Ends of bones this near to each other, over the size of the skeleton, are at one place.
_SAME_PLACE = 1e-5


@dataclass
class Joints:
    """Names, parents (-1: none) and rest matrices; `of_bone` has a joint for every bone that is one."""

    names: list = field(default_factory=list)
    parents: list = field(default_factory=list)
    rest: list = field(default_factory=list)
    of_bone: dict = field(default_factory=dict)

    def add(self, key, name, parent, rest):
        self.of_bone[key] = len(self.names)
        self.names.append(name)
        self.parents.append(parent)
        self.rest.append(np.array(rest, np.float64))


def deforming(armature, meshes):
    """The names of the bones that move vertices or carry objects."""
    bones = armature.data.bones
    found = {mesh.parent_bone for mesh in meshes if mesh.parent_type == "BONE" and mesh.parent is armature}
    for mesh in meshes:
        names = [group.name for group in mesh.vertex_groups]
        used = {entry.group for vertex in mesh.data.vertices for entry in vertex.groups if entry.weight > 0}
        found |= {names[group] for group in used if group < len(names)}
    return {name for name in found if name in bones and bones[name].use_deform}


def has_controls(armature, names):
    """Whether the bones that deform, `names`, are carried by bones that do not."""
    for name in names:
        for constraint in armature.pose.bones[name].constraints:
            carried = constraint.type in _CARRIES and not constraint.mute
            if carried and getattr(constraint, "target", armature) in (armature, None):
                targets = [constraint.subtarget] if hasattr(constraint, "subtarget") else [t.subtarget for t in constraint.targets]
                if any(target not in names for target in targets):
                    return True
    return False


def joints_of(armature, meshes):
    """The joints, and whether the rig has controls."""
    bones, world, made = armature.data.bones, armature.matrix_world, Joints()
    moving = deforming(armature, meshes)
    controls = has_controls(armature, moving)
    chosen = moving if controls else {bone.name for bone in bones}
    for bone in bones:
        if bone.name in chosen:
            made.add(bone.name, bone.name, -1, world @ bone.matrix_local)
    for bone in bones:
        if bone.name in chosen:
            made.parents[made.of_bone[bone.name]] = made.of_bone.get(_parent(bone, chosen, bones), -1)
    for mesh in meshes:
        if mesh.parent_type == "BONE" and mesh.parent is armature:
            made.add("\0" + mesh.name, mesh.name, made.of_bone.get(mesh.parent_bone, -1), rest_world(armature, mesh))
    return made, controls


def _parent(bone, chosen, bones):
    """The nearest ancestor that is a joint; a Rigify bone ORG-x above stands for DEF-x."""
    above = bone.parent
    while above is not None:
        twin = above.name.replace("ORG-", "DEF-", 1)
        for name in (above.name, twin):
            if name in chosen and name != bone.name:
                return name
        above = above.parent
    return None


def nearest(armature, joints, point):
    """The joint whose bone passes nearest to a point in world space."""
    best, at = np.inf, 0
    world = armature.matrix_world
    for bone in armature.data.bones:
        joint = joints.of_bone.get(bone.name)
        if joint is None:
            continue
        head, tail = world @ bone.head_local, world @ bone.tail_local
        along = tail - head
        share = max(0.0, min(1.0, (point - head).dot(along) / max(along.length_squared, 1e-20)))
        distance = (point - head - along * share).length
        if distance < best:
            best, at = distance, joint
    return at


def joint_at(joints, place):
    """The joint that is at a place, but for rounding; None where none is."""
    heads = np.array(joints.rest)[:, :3, 3]
    apart = np.linalg.norm(heads - np.array(place), axis=1)
    found = int(apart.argmin())
    return found if apart[found] <= _SAME_PLACE * max(np.ptp(heads, axis=0).max(), 1e-20) else None
