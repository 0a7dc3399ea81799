"""A VRM through Blender and back, by the VRM add-on: imported, converted, exported, beside the command line's file.

    python vrm.py ADDON MODEL... [--out FOLDER]

ADDON is the add-on's folder (`io_scene_vrm`). Roles, colliders and springs of what the add-on exports are those of the command
line's file; exit code 1 where they are not.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Quaternion, Vector
from start import convert, fresh, leave

import addon_utils  # There once bpy is.

# Over the height: the add-on writes what empties have, which pass through single precision and Blender's own matrices.
BOUND = 1e-4


def document(path):
    """The JSON of a GLB."""
    raw = Path(path).read_bytes()
    return json.loads(raw[20:20 + int.from_bytes(raw[12:16], "little")])


def height(path):
    """From the lowest to the highest vertex, as the bounds of its meshes say."""
    file = document(path)
    bounds = [file["accessors"][primitive["attributes"]["POSITION"]] for mesh in file["meshes"] for primitive in mesh["primitives"]]
    return max(each["max"][1] for each in bounds) - min(each["min"][1] for each in bounds)


def turns(file):
    """How each node is turned in the scene: the add-on's export turns nodes as Blender's bones lie."""
    found = {}

    def visit(index, above):
        found[index] = above @ Quaternion(np.roll(file["nodes"][index].get("rotation", (0, 0, 0, 1)), 1))
        for child in file["nodes"][index].get("children", []):
            visit(child, found[index])

    for root in file["scenes"][file.get("scene", 0)]["nodes"]:
        visit(root, Quaternion())
    return found


def springs(file):
    """Colliders and springs of VRM 0.x and 1.0, as (what and whose, numbers), in the order of their names; vectors of 1.0 as they
    lie in the scene."""
    name = lambda index: file["nodes"][index]["name"]
    turned = turns(file)
    found = []
    secondary = file["extensions"].get("VRM", {}).get("secondaryAnimation", {})
    for group in secondary.get("colliderGroups", []):
        for ball in group["colliders"]:
            found.append((f"collider of {name(group['node'])}", [*(ball["offset"][axis] for axis in "xyz"), ball["radius"]]))
    for group in secondary.get("boneGroups", []):
        numbers = [group[key] for key in ("hitRadius", "stiffiness", "gravityPower")]
        found.append((f"spring of {sorted(map(name, group['bones']))}", numbers))
    new = file["extensions"].get("VRMC_springBone", {})
    for each in new.get("colliders", []):
        (kind, shape), = each["shape"].items()
        ends = [turned[each["node"]] @ Vector(shape[key]) for key in ("offset", "tail") if key in shape]
        found.append((f"{kind} of {name(each['node'])}", [*(number for end in ends for number in end), shape["radius"]]))
    for spring in new.get("springs", []):
        # The last joint of a chain only says where it ends.
        for joint in spring["joints"][:-1]:
            numbers = [joint.get(key, usual) for key, usual in (("hitRadius", 0), ("stiffness", 1), ("gravityPower", 0))]
            found.append((f"spring of {name(joint['node'])}", numbers))
    return sorted(found, key=lambda each: (each[0], np.round(each[1], 3).tolist()))


def roles(file):
    name = lambda index: file["nodes"][index]["name"]
    old = file["extensions"].get("VRM", {}).get("humanoid", {}).get("humanBones", [])
    new = file["extensions"].get("VRMC_vrm", {}).get("humanoid", {}).get("humanBones", {})
    return {each["bone"]: name(each["node"]) for each in old} | {role: name(each["node"]) for role, each in new.items()}


def compared(model, folder):
    """What differs, as sentences, and the largest difference over the height."""
    fresh()
    addon_utils.enable("bl_ext.user_default.vrm", default_set=True)
    assert bpy.ops.import_scene.vrm(filepath=str(model), use_addon_preferences=False) == {"FINISHED"}
    armature = next(thing for thing in bpy.data.objects if thing.type == "ARMATURE")
    made = convert(armature, heads=2.5)
    copy = next(thing for thing in made if thing.type == "ARMATURE")
    # The export takes what is in the scene.
    for thing in [thing for thing in bpy.data.objects if thing not in made]:
        bpy.data.objects.remove(thing)
    ours, theirs = folder / f"{model.stem}_blender.vrm", folder / f"{model.stem}_command_line.vrm"
    assert bpy.ops.export_scene.vrm(filepath=str(ours), armature_object_name=copy.name, use_addon_preferences=False,
                                    ignore_warning=True) == {"FINISHED"}
    subprocess.run([os.environ["SUPERDEFORM_EXAMPLE"], str(model), "--heads", "2.5", "-q", "-o", str(theirs)], check=True)
    one, other, tall = document(ours), document(theirs), height(theirs)
    faults = [f"{role}: {roles(one).get(role)} instead of {bone}" for role, bone in roles(other).items() if roles(one).get(role) != bone]
    mine, wanted = springs(one), springs(other)
    if [what for what, _ in mine] != [what for what, _ in wanted]:
        faults.append(f"other springs: {[what for what, _ in mine]} instead of {[what for what, _ in wanted]}")
        return faults, 0.0, len(wanted)
    worst = 0.0
    for (what, numbers), (_, asked) in zip(mine, wanted):
        apart = float(np.abs(np.array(numbers) - asked).max()) / tall
        worst = max(worst, apart)
        if apart > BOUND:
            faults.append(f"{what}: {np.round(numbers, 5).tolist()} instead of {np.round(asked, 5).tolist()}")
    return faults, worst, len(wanted)


def main(given):
    kept = Path(given[given.index("--out") + 1]) if "--out" in given else None
    addon, *models = [Path(each) for each in (given[:given.index("--out")] if kept else given)]
    home = Path(os.environ["BLENDER_USER_RESOURCES"]) / "extensions" / "user_default" / "vrm"
    shutil.copytree(addon, home, dirs_exist_ok=True)
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for model in models:
            faults, worst, count = compared(model, kept or Path(folder))
            failed += bool(faults)
            print(f"{'FAILED' if faults else 'passed'}: {model.stem}: {count} colliders and springs, {worst:.1e} of the height apart", flush=True)
            for fault in faults:
                print(f"    {fault}")
    print(f"Blender {bpy.app.version_string}, VRM add-on: {len(models) - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    leave(main(sys.argv[1:]))
