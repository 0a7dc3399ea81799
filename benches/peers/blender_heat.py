"""Compares our heat weights with Blender's automatic weights on the same body and bones.

    pip install bpy numpy        (in an environment of the Python version that bpy is built for)
    cargo run --release -p superdeform-benches --example heat_weights -- 0 1 3 > weights.json
    python blender_heat.py weights.json [SCALE]

Prints, for each c, the mean over vertices of half the L1 distance of the two rows, its 95th percentile, and the share of
vertices with the same strongest bone. Blender's solve fails on some meshes in metres: SCALE (10) enlarges them for it.
"""

import json
import sys

import bpy
import numpy

# Blender drops bones shorter than this, so points become as long.
LEAST_LENGTH = 1e-3


def blender_weights(positions, triangles, bones, scale):
    """One row a vertex, one column a bone, and how many vertices have nothing."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("body")
    mesh.from_pydata((positions * scale).tolist(), [], triangles)
    mesh.update()
    body = bpy.data.objects.new("body", mesh)
    armature = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    for item in (body, armature):
        bpy.context.collection.objects.link(item)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for index, (head, tail) in enumerate(bones):
        head, tail = numpy.array(head), numpy.array(tail)
        if numpy.linalg.norm(tail - head) < LEAST_LENGTH:
            tail = head + [0.0, 0.0, LEAST_LENGTH]
        bone = armature.data.edit_bones.new(f"bone {index}")
        bone.head, bone.tail = head * scale, tail * scale
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.select_all(action="DESELECT")
    body.select_set(True)
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    weights = numpy.zeros((len(positions), len(bones)))
    columns = [int(group.name.split()[1]) for group in body.vertex_groups]
    for vertex in mesh.vertices:
        for entry in vertex.groups:
            weights[vertex.index, columns[entry.group]] = entry.weight
    return weights


def main():
    with open(sys.argv[1]) as file:
        data = json.load(file)
    scale = float(sys.argv[2]) if len(sys.argv) > 2 else 10.0
    positions = numpy.array(data["positions"])
    theirs = blender_weights(positions, data["triangles"], data["bones"], scale)
    sums = theirs.sum(axis=1)
    weighted = sums > 0
    print(f"{data['body']}: {len(positions)} vertices, {len(data['bones'])} bones, Blender {bpy.app.version_string}")
    print(f"vertices that Blender leaves without weights: {(~weighted).sum()}")
    if not weighted.any():
        sys.exit("Blender found no solution")
    theirs = theirs[weighted] / sums[weighted, None]
    for c, rows in data["weights"].items():
        ours = numpy.zeros((len(positions), len(data["bones"])))
        for vertex, row in enumerate(rows):
            for bone, weight in row:
                ours[vertex, bone] = weight
        ours = ours[weighted]
        half = 0.5 * numpy.abs(ours - theirs).sum(axis=1)
        same = (ours.argmax(axis=1) == theirs.argmax(axis=1)).mean()
        print(
            f"c = {c}: mean half L1 {half.mean():.4f}, 95th percentile {numpy.percentile(half, 95):.3f}, "
            f"same strongest bone {100 * same:.1f} %"
        )


if __name__ == "__main__":
    main()
