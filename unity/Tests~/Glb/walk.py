#!/usr/bin/env python3
"""Gives a GLB a clip "Walk" that sets places of joints, as exporters of Generic characters write it.

walk.py IN.glb OUT.glb

Every joint has a key at 0 s, its rest, and one at 1 s. Those of legs stay at rest. Hips travel, and what hangs from them and is
no leg's moves by a thirtieth of the figure's height: the command line keeps such a clip's own keys, since its feet stay where
they are above the floor.
"""

import json
import struct
import sys
from pathlib import Path

LEGS = ("upperleg", "lowerleg", "foot", "toes")


def main():
    data = Path(sys.argv[1]).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    gltf, binary = json.loads(data[20:20 + length]), bytearray(data[28 + length:])
    nodes = gltf["nodes"]
    joints = sorted(set(gltf["skins"][0]["joints"]))

    def accessor(numbers, kind):
        view = {"buffer": 0, "byteOffset": len(binary), "byteLength": 4 * len(numbers)}
        binary.extend(struct.pack(f"<{len(numbers)}f", *numbers))
        size = {"SCALAR": 1, "VEC3": 3}[kind]
        told = {"bufferView": len(gltf["bufferViews"]), "componentType": 5126, "count": len(numbers) // size, "type": kind}
        if kind == "SCALAR":
            told.update(min=[min(numbers)], max=[max(numbers)])
        gltf["bufferViews"].append(view)
        gltf["accessors"].append(told)
        return len(gltf["accessors"]) - 1

    height = max(a["max"][1] for a in gltf["accessors"] if a.get("type") == "VEC3" and "max" in a)
    times, samplers, channels = accessor([0.0, 1.0], "SCALAR"), [], []
    below = {child for node in nodes if node["name"] == "hips" for child in node["children"]}
    while more := {child for node in below for child in nodes[node].get("children", [])} - below:
        below |= more
    for joint in joints:
        name, rest = nodes[joint]["name"], nodes[joint].get("translation", [0.0, 0.0, 0.0])
        step = [0.0, 0.0, 0.0]
        if name == "hips":
            step = [0.0, 0.0, 0.3 * height]
        elif joint in below and not name.startswith(LEGS):
            step = [height / 30, height / 60, -height / 45]
        samplers.append({"input": times, "output": accessor(rest + [a + b for a, b in zip(rest, step)], "VEC3")})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": joint, "path": "translation"}})
    gltf["animations"] = [{"name": "Walk", "samplers": samplers, "channels": channels}]
    gltf["buffers"][0]["byteLength"] = len(binary)
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    Path(sys.argv[2]).write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
                                  + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


if __name__ == "__main__":
    main()
