"""What the tests share: Blender with the extension, models imported without their clips, objects as arrays."""

import json
import logging
import os
import sys
import tempfile
from pathlib import Path

import bpy

import addon_utils  # There once bpy is.
import numpy as np

# The importer tells of every mesh.
logging.disable(logging.INFO)
NAME = "bl_ext.user_default.superdeform"


def fresh():
    """An empty scene with the extension."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("bl_pkg")
    addon_utils.enable(NAME)


def stripped(path, folder):
    """A copy of a GLB or VRM file as a GLB with what Blender's own importer reads: no roles and springs of a VRM, and no clips,
    of which Blender would show the first frame."""
    raw = Path(path).read_bytes()
    size = int.from_bytes(raw[12:16], "little")
    content = json.loads(raw[20:20 + size])
    content.pop("animations", None)
    for name in ("VRM", "VRMC_vrm", "VRMC_springBone"):
        content.get("extensions", {}).pop(name, None)
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    rest = raw[20 + size:]
    head = raw[:8] + (20 + len(text) + len(rest)).to_bytes(4, "little") + len(text).to_bytes(4, "little") + b"JSON"
    made = Path(folder) / f"{Path(path).stem}_plain.glb"
    made.write_bytes(head + text + rest)
    return made


def imported(path):
    """The objects of a GLB or VRM file."""
    before = set(bpy.data.objects)
    with tempfile.TemporaryDirectory() as folder:
        file = stripped(path, folder)
        bpy.ops.import_scene.gltf(filepath=str(file), bone_heuristic="TEMPERANCE", disable_bone_shape=True)
    return [thing for thing in bpy.data.objects if thing not in before]


def rows(things, key, width=3):
    """A property of all elements as rows."""
    made = np.empty(len(things) * width, np.float32)
    things.foreach_get(key, made)
    return made.reshape(-1, width)


def placed(thing, local):
    """Places in world space."""
    matrix = np.array(thing.matrix_world)
    return local @ matrix[:3, :3].T + matrix[:3, 3]


def vertices(thing):
    """The vertices of a mesh in world space."""
    return placed(thing, rows(thing.data.vertices, "co"))


def convert(armature, **given):
    """Runs the operator on a character; gives what it made."""
    bpy.context.view_layer.objects.active = armature
    before = set(bpy.data.objects)
    assert bpy.ops.object.superdeform(**given) == {"FINISHED"}
    made = [thing for thing in bpy.data.objects if thing not in before]
    assert made
    return made


def refusal(armature, **given):
    """The sentence with which the operator refuses a character."""
    try:
        convert(armature, **given)
    except RuntimeError as fault:
        return str(fault).removeprefix("Error: ").strip()
    raise AssertionError("it was not refused")


def leave(failed):
    """Ends with exit code 1 where something failed, and without what Blender 4.5 does at its end, where it may wait for its own
    threads for ever."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(bool(failed))
