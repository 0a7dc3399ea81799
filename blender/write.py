# SPDX-License-Identifier: MIT OR Apache-2.0
"""A deformation written into copies: bones, meshes with their keys and normals, what hangs from bones, actions."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import copies, skeleton, vrm
from .read import rest_world, tail_of, turned
from .refuse import Refused

# A bone shorter than this vanishes when edit mode ends.
_SHORTEST = 1e-5
# Bones begin at one place and point one way as far as they differ by less than this, over the length of one.
_ALIKE = 1e-4
# Bones that deform may lie this far from their rest, over the character's height, after the controls of a rig have moved.
_CARRIED_OFF = 0.02


def character(context, deformation, name):
    """Copies with the new shape in a collection `name`: it, and sentences about what a person should know.

    Needs object mode. Raises Refused, after which no copy is left.
    """
    figure = deformation.figure
    armature = bpy.data.objects[figure.armature]
    meshes = [bpy.data.objects[source.name] for source in figure.sources]
    things = copies.belonging(armature, meshes)
    places = {thing.name: rest_world(armature, thing) for thing in things}
    home, made = copies.copied(context, things, name)
    try:
        notes = _written(context, deformation, armature, made, places)
    except Exception:
        copies.removed(home)
        raise
    return home, made, notes


def _written(context, deformation, armature, made, places):
    figure, deformer = deformation.figure, deformation.deformer
    copy = made[armature.name]
    reshape(context, deformation, armature, made, places)
    vrm.springs(armature, copy, figure, deformer)
    notes = deformer.warnings()
    _scale_actions(copy, deformation.hip_ratio())
    if figure.controls:
        _reset_controls(context, copy, figure)
    return notes


def reshape(context, deformation, armature, made, places):
    """Gives copies the shape that a deformation has now: bones, what hangs from them, meshes. Needs object mode.

    - `places`: of the objects that the copies, by the same names, were made from, at rest.
    """
    figure, deformer = deformation.figure, deformation.deformer
    copy, joints = made[armature.name], deformer.joints()
    bones(context, copy, armature, figure, deformer, joints)
    _carry_roots(copy, armature)
    context.view_layer.update()
    for name, thing in made.items():
        _hang(thing, copy, armature, figure, deformer, joints, name, places[name])
    context.view_layer.update()
    shapes(deformation, {source.name: made[source.name] for source in figure.sources})


def bones(context, copy, armature, figure, deformer, joints):
    """Gives an armature its new rest: heads move, directions and rolls stay, lengths follow the body."""
    world = armature.matrix_world
    back = copy.matrix_world.inverted()
    names = [bone.name for bone in armature.data.bones]
    ends = [[world @ place for place in (bone.head_local, bone.tail_local)] for bone in armature.data.bones]
    new_ends = [_ends(armature, figure, deformer, joints, name, *places) for name, places in zip(names, ends)]
    turned = [(head, (tail - head).normalized(), new_tail - new_head) for (head, tail), (new_head, new_tail) in zip(ends, new_ends)
              if figure.controls and skeleton.joint_at(figure.joints, tail) is not None]
    context.view_layer.objects.active = copy
    bpy.ops.object.mode_set(mode="EDIT")
    edited = copy.data.edit_bones
    mirrored, copy.data.use_mirror_x = copy.data.use_mirror_x, False
    connected = {bone.name for bone in edited if bone.use_connect}
    for bone in edited:
        bone.use_connect = False
    for name, (head, tail), (new_head, new_tail) in zip(names, ends, new_ends):
        bone, before = edited[name], (tail - head).length
        axis, roll, across = bone.matrix.to_3x3() @ Vector((0, 1, 0)), bone.roll, bone.z_axis.copy()
        ratio = (new_tail - new_head).length / before if before > 0 else 1.0
        length = max(armature.data.bones[name].length * ratio, _SHORTEST)
        along = next((new for at, way, new in turned if (at - head).length < _ALIKE * before
                      and way.dot(tail - head) > (1 - _ALIKE) * before), None)
        bone.head = back @ new_head
        if figure.controls and skeleton.joint_at(figure.joints, tail) is not None:
            # Chains of controls must meet: a limb that is bent to reach a point begins where the one before ends. Others keep
            # their direction, which constraints may copy.
            bone.tail = back @ new_tail
            bone.align_roll(across)
        elif along is not None:
            # A control and a bone that copies it turn alike, though one of them is shorter and ends where no joint is.
            bone.tail = bone.head + (back.to_3x3() @ along).normalized() * length
            bone.align_roll(across)
        else:
            bone.tail = bone.head + axis * length
            bone.roll = roll
    for bone in edited:
        # Where a head has left its parent's tail, connecting would bend the parent.
        near = bone.parent and (bone.parent.tail - bone.head).length < _SHORTEST
        if bone.name in connected and near:
            bone.use_connect = True
    copy.data.use_mirror_x = mirrored
    bpy.ops.object.mode_set(mode="OBJECT")


def _carry_roots(copy, armature):
    """Poses bones without a parent so that they carry the copy where those of the source carry it: a scale or a turn of a pose is
    about the head of its bone, which is elsewhere now. Importers pose whole characters, from where a file stores them to where
    it shows them."""
    for bone in armature.pose.bones:
        if bone.parent is None and bone.matrix_basis != Matrix.Identity(4):
            rest, new = bone.bone.matrix_local, copy.data.bones[bone.name].matrix_local
            carried = rest @ bone.matrix_basis @ rest.inverted()
            copy.pose.bones[bone.name].matrix_basis = new.inverted() @ carried @ new


def _ends(armature, figure, deformer, joints, name, head, tail):
    """Where the ends of a bone are now. Of rigs with controls, ends where a joint is go with that joint."""
    own = figure.joints.of_bone.get(name)
    if not figure.controls:
        return Vector(joints[own]), Vector(deformer.map_points([own], [tail])[0][0])
    new = []
    for place in (head, tail):
        at, joint = skeleton.joint_at(figure.joints, place), own
        if at is not None:
            new.append(Vector(joints[at]))
            continue
        if joint is None:
            joint = skeleton.nearest(armature, figure.joints, place)
        new.append(Vector(deformer.map_points([joint], [place])[0][0]))
    return new


def _hang(thing, copy, armature, figure, deformer, joints, source_name, place):
    """Puts what hangs from a bone where that part of the body is now; its own location stays, its parent's inverse changes."""
    if thing.parent is not copy or thing.parent_type != "BONE" or thing.parent_bone not in copy.data.bones:
        return
    own = figure.joints.of_bone.get("\0" + source_name)
    if own is not None:
        to = Vector(joints[own])
    else:
        joint = figure.joints.of_bone.get(thing.parent_bone)
        if joint is None:
            joint = skeleton.nearest(armature, figure.joints, place.translation)
        to = Vector(deformer.map_points([joint], [place.translation])[0][0])
    wanted = Matrix.Translation(to - place.translation) @ place
    thing.matrix_parent_inverse = tail_of(copy, thing.parent_bone).inverted() @ wanted @ thing.matrix_basis.inverted()


def shapes(deformation, made):
    """Writes places, shape keys and normals into meshes, by the names of those that they were made from."""
    results = deformation.everything()
    for source in deformation.figure.sources:
        thing = made[source.name]
        _write_mesh(source, thing.data, back_of(source, thing), *results[source.name])


def back_of(source, thing):
    """What takes world space to that of a mesh made from `source`."""
    return np.linalg.inv(np.array(rest_world(thing.parent, thing) if source.rigid else source.world, np.float64))


def _write_mesh(source, data, back, places, keys, normals):
    local = put(data, places, back)
    if data.shape_keys:
        blocks = data.shape_keys.key_blocks
        written = {data.shape_keys.reference_key.name: local}
        waiting = [(name, onto, moved @ back[:3, :3].T) for (name, onto, _), moved in zip(source.keys, keys)]
        while waiting:
            ready = [entry for entry in waiting if entry[1] in written]
            if not ready:
                raise Refused(f"the shape keys of {source.name} are relative to each other in a circle: make one relative to the first")
            for name, onto, moved in ready:
                written[name] = (written[onto] + moved).astype(np.float32)
            waiting = [entry for entry in waiting if entry[0] not in written]
        for name, rows in written.items():
            blocks[name].data.foreach_set("co", np.ascontiguousarray(rows).reshape(-1))
    # Normals are kept relative to those that follow from the places.
    data.update()
    if data.has_custom_normals:
        data.normals_split_custom_set(turned(normals, back)[source.split].tolist())
        data.update()


def _mapped(places, matrix):
    """Places through a matrix, as floats. Not by `@`: BLAS lets its threads spin after a product, a fifth of a slider's frame."""
    made = np.empty_like(places)
    x, y, z = places.T
    for axis, row in enumerate(matrix[:3].astype(np.float32)):
        made[:, axis] = x * row[0] + y * row[1] + z * row[2] + row[3]
    return made


def put(data, places, back):
    """Writes the places of a mesh, a hundred times as fast as through its vertices, and those of its first key; gives them."""
    local = _mapped(places, back)
    data.attributes["position"].data.foreach_set("vector", local.reshape(-1))
    if data.shape_keys:
        data.shape_keys.reference_key.data.foreach_set("co", local.reshape(-1))
    return local


def _scale_actions(copy, ratio):
    """Locations that an action of the copy gives to bones shrink by `ratio`, on a copy of the action."""
    if not copy.animation_data:
        return
    done = {}

    def own(action):
        if action.name not in done:
            made = action.copy() if action.users > 1 or action.library else action
            for curve in _curves(made):
                if curve.data_path.startswith("pose.bones") and curve.data_path.endswith(".location"):
                    for key in curve.keyframe_points:
                        key.co.y *= ratio
                        key.handle_left.y *= ratio
                        key.handle_right.y *= ratio
            done[action.name] = made
        return done[action.name]

    data = copy.animation_data
    if data.action:
        data.action = own(data.action)
    for track in data.nla_tracks:
        for strip in track.strips:
            if strip.action:
                strip.action = own(strip.action)


def _curves(action):
    if hasattr(action, "layers") and len(action.layers):
        return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]
    return list(getattr(action, "fcurves", ()))


def _reset_controls(context, copy, figure):
    """Lets stretched bones take their new lengths; refuses a rig whose controls carry the body off."""
    for bone in copy.pose.bones:
        for constraint in bone.constraints:
            if constraint.type == "STRETCH_TO":
                constraint.rest_length = 0
    position, copy.data.pose_position = copy.data.pose_position, "POSE"
    basis = {bone.name: bone.matrix_basis.copy() for bone in copy.pose.bones}
    for bone in copy.pose.bones:
        bone.matrix_basis = Matrix.Identity(4)
    context.view_layer.update()
    height = max(np.ptp(source.to_world(source.local)[:, 2]) for source in figure.sources) or 1.0
    off, worst = 0.0, ""
    for name in figure.joints.of_bone:
        bone = copy.pose.bones.get(name)
        if bone is not None:
            away = (copy.matrix_world.to_3x3() @ (bone.matrix.translation - bone.bone.head_local)).length / height
            off, worst = max((off, worst), (away, name))
    for bone in copy.pose.bones:
        bone.matrix_basis = basis[bone.name]
    copy.data.pose_position = position
    context.view_layer.update()
    if off > _CARRIED_OFF:
        raise Refused(f"the controls of {figure.armature} pull its bone {worst} off by {off:.2f} of the height: convert a copy of "
                      "the character on a rig without controls (for Rigify, its metarig), then generate the rig anew")
