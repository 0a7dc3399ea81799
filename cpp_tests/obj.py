"""obj.py MODEL.glb OUT.obj: the triangles of a GLB without a skin, as lines "v x y z" and "f a b c"."""

import json
import struct
import sys

with open(sys.argv[1], "rb") as file:
    data = file.read()
length = struct.unpack_from("<I", data, 12)[0]
gltf, binary = json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def numbers(index, width):
    """The elements of an accessor."""
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    letter = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[accessor["componentType"]]
    stride = view.get("byteStride", width * struct.calcsize(letter))
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return [struct.unpack_from(f"<{width}{letter}", binary, start + i * stride) for i in range(accessor["count"])]


if any(key in node for node in gltf["nodes"] for key in ("matrix", "translation", "rotation", "scale", "skin")):
    sys.exit(f"{sys.argv[1]}: its nodes move its meshes, which is not done here")
with open(sys.argv[2], "w", encoding="ascii") as out:
    first = 1
    for primitive in (primitive for mesh in gltf["meshes"] for primitive in mesh["primitives"]):
        points = numbers(primitive["attributes"]["POSITION"], 3)
        corners = [first + index for (index,) in numbers(primitive["indices"], 1)]
        out.writelines("v %.9g %.9g %.9g\n" % point for point in points)
        out.writelines("f %d %d %d\n" % tuple(corners[i : i + 3]) for i in range(0, len(corners), 3))
        first += len(points)
