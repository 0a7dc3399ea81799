# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the VRM add-on keeps of springs: colliders (empties on bones), and radii, stiffness and gravity, of VRM 0.x and 1.0.

The add-on fills both sets when it imports a VRM 0.x file, so both are written.
"""

import math

from mathutils import Matrix, Vector
from superdeform import abi

from .read import rest_world, tail_of


def springs(armature, copy, figure, deformer):
    """Maps colliders, and what of springs has a length; nothing where the add-on is not there."""
    before = getattr(armature.data, "vrm_addon_extension", None)
    after = getattr(copy.data, "vrm_addon_extension", None)
    if before is None or after is None:
        return
    # What VRM 0.x and 1.0 have of the same file are two sets of empties.
    balls, of_group, chains = _balls_0(before, armature, figure)
    for group, chain in zip(after.vrm0.secondary_animation.bone_groups, chains):
        parents = [(armature.data.bones[name].parent, name) for name in chain]
        bones = [(parent.name, name, group.gravity_power, group.stiffiness, group.gravity_dir)
                 for parent, name in parents if parent is not None and parent.name in chain]
        group.gravity_power *= _gravity_kept(bones, armature, copy)
        _scaled(group, ("hit_radius", "stiffiness", "gravity_power"), chain, armature, figure, deformer)
    _colliders(_pairs_0(before, after, of_group), balls, armature, copy, figure, deformer)
    balls, of_spring = _balls_1(before, armature, figure)
    for spring in after.spring_bone1.springs:
        joints = list(spring.joints)
        bones = [(joint.node.bone_name, following.node.bone_name, joint.gravity_power, joint.stiffness, joint.gravity_dir)
                 for joint, following in zip(joints, joints[1:])]
        kept = _gravity_kept(bones, armature, copy)
        for joint in joints:
            joint.gravity_power *= kept
            _scaled(joint, ("hit_radius", "stiffness", "gravity_power"), [joint.node.bone_name], armature, figure, deformer)
    _colliders(_pairs_1(before, after, of_spring), balls, armature, copy, figure, deformer)


def _gravity_kept(bones, armature, copy):
    """The share of their gravity with which the bones of a chain bend at rest as far as they did, in the mean; at most 1.

    - `bones`: where each begins and ends, its gravity, its stiffness, and which way is down.

    Gravity and stiffness, r to 1 and at an angle a, balance where a bone is bent by atan(r sin a / (1 + r cos a)). At the angle b, r'
    bends it as far where r' (sin b + r sin(b - a)) = r sin a. What is not stiff hangs straight down anyway.
    """
    before = after = 0.0
    for start, end, gravity, stiffness, down in bones:
        if stiffness <= 0 or start not in armature.data.bones or end not in armature.data.bones:
            continue
        a, b = (_angle(owner, start, end, Vector(down)) for owner in (armature, copy))
        before += math.sin(a)
        after += math.sin(b) + gravity / stiffness * math.sin(b - a)
    return before / after if before < after else 1.0


def _angle(armature, start, end, down):
    bones = armature.data.bones
    return (armature.matrix_world.to_3x3() @ (bones[end].head_local - bones[start].head_local)).angle(down, 0.0)


def _scaled(owner, names, chain, armature, figure, deformer):
    """Numbers of a spring grow as the body does where its bones begin, on average: the step of a spring is in units of the model."""
    bones = [armature.data.bones[name] for name in chain if name in figure.joints.of_bone]
    if bones:
        joints = [figure.joints.of_bone[bone.name] for bone in bones]
        scale = float(deformer.map_points(joints, [tuple(armature.matrix_world @ bone.head_local) for bone in bones])[1].mean())
        for name in names:
            setattr(owner, name, getattr(owner, name) * scale)


def _ball(figure, bone, place, radius):
    return abi.SdefSpringBall(joint=figure.joints.of_bone[bone], x=place.x, y=place.y, z=place.z, radius=radius)


def _balls_0(extension, armature, figure):
    """A ball at the end of every bone of every chain; which are of which bone group; the bones of each group."""
    balls, of_group, chains, world = [], [], [], armature.matrix_world
    for group in extension.vrm0.secondary_animation.bone_groups:
        mine, chain, todo = [], {}, [armature.data.bones.get(bone.bone_name) for bone in group.bones]
        while todo:
            bone = todo.pop()
            if bone is None or bone.name not in figure.joints.of_bone:
                continue
            chain[bone.name] = True
            ends = [(child.name, child.head_local) for child in bone.children] or [(bone.name, bone.tail_local)]
            todo += bone.children
            for name, end in ends:
                if name in figure.joints.of_bone:
                    mine.append(len(balls))
                    balls.append(_ball(figure, name, world @ end, group.hit_radius))
        of_group.append(mine)
        chains.append(list(chain))
    return balls, of_group, chains


def _balls_1(extension, armature, figure):
    """A ball where each joint of a spring ends, which is where the next begins, and which are of which spring."""
    balls, of_spring = [], []
    for spring in extension.spring_bone1.springs:
        mine, joints = [], list(spring.joints)
        for joint, following in zip(joints, joints[1:]):
            bone = armature.data.bones.get(following.node.bone_name)
            if bone is not None and bone.name in figure.joints.of_bone:
                mine.append(len(balls))
                balls.append(_ball(figure, bone.name, armature.matrix_world @ bone.head_local, joint.hit_radius))
        of_spring.append(mine)
    return balls, of_spring


def _pairs_0(before, after, of_group):
    """Each collider with its copy and the balls that it is for."""
    old, new = before.vrm0.secondary_animation, after.vrm0.secondary_animation
    for group, group_of_copy in zip(old.collider_groups, new.collider_groups):
        mine = [ball for bone_group, balls in zip(old.bone_groups, of_group)
                if any(named.collider_group_uuid == group.uuid for named in bone_group.collider_groups) for ball in balls]
        for collider, made in zip(group.colliders, group_of_copy.colliders):
            yield collider.bpy_object, made.bpy_object, group.node.bone_name, mine


def _pairs_1(before, after, of_spring):
    old, new = before.spring_bone1, after.spring_bone1
    for collider, made in zip(old.colliders, new.colliders):
        groups = {group.uuid for group in old.collider_groups if any(named.collider_uuid == collider.uuid for named in group.colliders)}
        mine = [ball for spring, balls in zip(old.springs, of_spring)
                if any(named.collider_group_uuid in groups for named in spring.collider_groups) for ball in balls]
        yield collider.bpy_object, made.bpy_object, collider.node.bone_name, mine


def _colliders(pairs, balls, armature, copy, figure, deformer):
    rows, targets, kept = [], [], []
    for empty, made, bone, mine in pairs:
        if empty is None or made is None or empty is made or bone not in figure.joints.of_bone:
            continue
        tail = next(iter(empty.children), None)
        tail_made = next(iter(made.children), None)
        place = rest_world(armature, empty)
        start = place.translation
        end = (place @ tail.matrix_parent_inverse @ tail.matrix_basis).translation if tail and tail_made else Vector()
        springs = (abi.c.c_uint32 * len(mine))(*mine)
        kept.append(springs)
        kind = abi.SDEF_COLLIDER_CAPSULE if tail and tail_made else abi.SDEF_COLLIDER_SPHERE
        radius = empty.empty_display_size * sum(empty.matrix_basis.to_scale()) / 3
        rows.append(abi.SdefCollider(kind=kind, joint=figure.joints.of_bone[bone], spring_count=len(mine), x=start.x, y=start.y,
                                     z=start.z, end_x=end.x, end_y=end.y, end_z=end.z, radius=radius,
                                     springs=abi.c.addressof(springs) if mine else None))
        targets.append((made, tail_made if tail else None, radius))
    for row, (made, tail, radius) in zip(deformer.map_colliders(rows, balls), targets):
        _place(made, copy, Vector((row.x, row.y, row.z)))
        if radius > 0:
            made.empty_display_size *= row.radius / radius
        if tail is not None:
            place = rest_world(copy, made)
            inner = place.inverted() @ Vector((row.end_x, row.end_y, row.end_z))
            tail.matrix_parent_inverse = Matrix.Identity(4)
            tail.location = inner
            tail.empty_display_size = made.empty_display_size


def _place(empty, armature, place):
    """Moves an empty on a bone; the add-on reads its offset from its location, so that changes and not the parent's inverse."""
    wanted = rest_world(armature, empty)
    wanted.translation = place
    tail = tail_of(armature, empty.parent_bone)
    empty.matrix_basis = empty.matrix_parent_inverse.inverted() @ tail.inverted() @ wanted
