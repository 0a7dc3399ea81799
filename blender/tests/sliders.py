"""How long a step of a slider takes while a preview is shown: milliseconds, the least of so many frames.

    python sliders.py MODEL

The largest mesh of the character gets so many vertices and shape keys; a frame ends when Blender has evaluated what it would draw.
"""

import sys
import time

import bpy
import numpy as np
from start import fresh, imported, leave, rows

import bmesh  # There once bpy is.

VERTICES, KEYS, FRAMES = 50_000, 100, 20


def refined(mesh):
    """Cuts edges until the mesh has as many vertices as are asked for."""
    form = bmesh.new()
    form.from_mesh(mesh.data)
    bmesh.ops.triangulate(form, faces=form.faces)
    while len(form.verts) < VERTICES:
        edges = list(form.edges)[:VERTICES - len(form.verts)]
        bmesh.ops.subdivide_edges(form, edges=edges, cuts=1)
        bmesh.ops.triangulate(form, faces=form.faces)
    form.to_mesh(mesh.data)
    form.free()


def keyed(mesh):
    """Gives the mesh shape keys, each of which moves a tenth of its vertices."""
    mesh.shape_key_add(name="Basis")
    places = rows(mesh.data.vertices, "co")
    for number in range(KEYS):
        moved = places.copy()
        moved[number % 10::10, 2] += 1e-3
        mesh.shape_key_add(name=f"key {number}", from_mix=False).data.foreach_set("co", moved.reshape(-1))


def least(given, name, values):
    """The least milliseconds of a frame in which a setting changes."""
    found = []
    for value in values:
        begun = time.perf_counter()
        setattr(given, name, value)
        bpy.context.view_layer.update()
        found.append(1000 * (time.perf_counter() - begun))
    return min(found)


def main(model):
    fresh()
    things = imported(model)
    armature = next(thing for thing in things if thing.type == "ARMATURE")
    mesh = max((thing for thing in things if thing.type == "MESH"), key=lambda thing: len(thing.data.vertices))
    refined(mesh)
    keyed(mesh)
    bpy.context.view_layer.objects.active = armature
    given = bpy.context.scene.superdeform
    for weight in (0, 1):
        for key in mesh.data.shape_keys.key_blocks[1:]:
            key.value = weight
        given.preview = True
        assert not given.fault, given.fault
        amount = least(given, "amount", np.linspace(0.3, 0.9, FRAMES))
        heads = least(given, "heads", np.linspace(2, 3, FRAMES))
        given.preview = False
        print(f"Blender {bpy.app.version_string}, {len(mesh.data.vertices)} vertices, {KEYS} keys at {weight}: "
              f"Amount {amount:.0f}, Heads {heads:.0f} milliseconds", flush=True)


if __name__ == "__main__":
    leave(main(sys.argv[1]))
