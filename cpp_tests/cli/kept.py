"""kept.py BEFORE AFTER OTHER: what a GLB held before and does not hold after, but for what was reshaped; and what its
VRM extensions hold otherwise than those of OTHER, which another host has made. Exit code 1 if there is any."""

import json
import struct
import sys


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack_from("<I", data, 12)[0]
    binary = data[20 + length + 8 :]
    return json.loads(data[20 : 20 + length]), binary


def image(gltf, binary, index):
    """The bytes of an image in the file, or its address."""
    view = gltf["images"][index].get("bufferView")
    if view is None:
        return gltf["images"][index].get("uri")
    view = gltf["bufferViews"][view]
    start = view.get("byteOffset", 0)
    return binary[start : start + view["byteLength"]]


# Reshaped, and what names it; tinygltf writes defaults of its own here.
RESHAPED = {"translation", "matrix", "accessors", "bufferViews", "buffers", "min", "max", "images", "generator", "skin",
            "inverseBindMatrices", "targets"}
# In model units, in VRM extensions.
POINTS = {"offset", "tail", "radius", "hitRadius", "stiffness", "stiffiness", "gravityPower", "offsetFromHeadBone",
          "firstPersonBoneOffset"}
# What tinygltf's model has no place for: other members of the file than these, and empty lists and objects.
MEMBERS = {"extensionsUsed", "extensionsRequired", "accessors", "animations", "asset", "buffers", "bufferViews", "cameras",
           "images", "materials", "meshes", "nodes", "samplers", "scene", "scenes", "skins", "textures", "extensions",
           "extras"}
DEFAULTS = (0, 1, -1, "", False, [0, 0, 0], [1, 1, 1, 1], [0, 0, 0, 1], [1, 1, 1], "OPAQUE", 0.5, "LINEAR", None)


def is_empty(value):
    """Whether there is nothing in it, at any depth."""
    values = value.values() if isinstance(value, dict) else value
    return isinstance(value, (dict, list)) and all(is_empty(inner) for inner in values)


def lost(before, after, place="", ignored=RESHAPED | POINTS):
    """Places of `before` that `after` lacks or has otherwise."""
    if isinstance(before, dict):
        if not isinstance(after, dict):
            return [] if is_empty(before) else [place]
        found = []
        for key, value in before.items():
            if key in ignored:
                continue
            if key == "attributes":
                found += [f"{place}.{key}.{name}" for name in value if name not in after.get(key, {})]
            elif key not in after:
                found += [] if value in DEFAULTS or is_empty(value) else [f"{place}.{key}"]
            else:
                found += lost(value, after[key], f"{place}.{key}", ignored)
        return found
    if isinstance(before, list):
        if not isinstance(after, list) or len(after) < len(before):
            return [place]
        return [entry for index, value in enumerate(before) for entry in lost(value, after[index], f"{place}[{index}]", ignored)]
    if isinstance(before, (int, float)) and isinstance(after, (int, float)):
        return [] if abs(before - after) <= 1e-6 * max(1, abs(before)) else [place]
    return [] if before == after else [place]


(before, old_binary), (after, new_binary) = read(sys.argv[1]), read(sys.argv[2])
missing = lost({key: value for key, value in before.items() if key in MEMBERS}, after)
for index in range(len(before.get("images", []))):
    if image(before, old_binary, index) != image(after, new_binary, index):
        missing.append(f".images[{index}]: other bytes")
if len(sys.argv) > 3:
    other, _ = read(sys.argv[3])
    for name in ("VRM", "VRMC_vrm", "VRMC_springBone"):
        if name in other.get("extensions", {}):
            # Outlines are materials', which this host leaves alone.
            left_alone = {"materialProperties"}
            missing += lost(other["extensions"][name], after["extensions"][name], f"other.{name}", left_alone)
if missing:
    print(f"{len(missing)} places were lost or changed:", *missing[:20], sep="\n  ")
    sys.exit(1)
print("everything else is kept")
