#!/usr/bin/env python3
"""Springs of VRM files as plain lines in Unity's space, so that a test can make components of them and compare them.

springs.py fixture IN.glb OUT.vrm  makes a VRM 1.0 of the sample character (joints as in kaykit_rogue.glb), with springs and
                                   a collider of every shape
springs.py list IN.vrm             prints a line for each spring, collider and viewpoint

Vectors of VRM 1.0 have x negated, as UniVRM reads them; those of VRM 0.x stand as Unity has them (z is negated in the file).
"""

import json
import struct
import sys
from pathlib import Path

HUMANOID = {"hips": "hips", "spine": "spine", "chest": "chest", "head": "head"}
for side, end in (("left", "l"), ("right", "r")):
    for bone, joint in (("UpperArm", "upperarm"), ("LowerArm", "lowerarm"), ("Hand", "hand"), ("UpperLeg", "upperleg"),
                        ("LowerLeg", "lowerleg"), ("Foot", "foot"), ("Toes", "toes")):
        HUMANOID[side + bone] = f"{joint}.{end}"

SHAPES = [
    ("head", "sphere", {"offset": [0.05, 0.4, 0.1], "radius": 0.3}),
    ("head", "sphere", {"offset": [0, 0.3, 0], "radius": 0.6, "inside": True}),
    ("chest", "capsule", {"offset": [0.1, 0.05, 0.02], "tail": [-0.1, 0.2, 0.03], "radius": 0.12}),
    ("upperarm.l", "capsule", {"offset": [0, 0.02, 0], "tail": [0, 0.2, 0], "radius": 0.05, "inside": True}),
    ("spine", "plane", {"offset": [0, 0.1, 0.05], "normal": [0.2672612, 0.5345225, 0.8017837]}),
    ("hand.r", "sphere", {"offset": [0.01, 0.02, 0.03], "radius": 0.05}),
    # The left elbow and the right foot are just outside, and come nearer: one yields enough, the other does not.
    ("spine", "sphere", {"radius": 0.65}),
    ("hips", "sphere", {"radius": 0.27}),
]
CHAINS = [["upperarm.l", "lowerarm.l", "wrist.l", "hand.l", "handslot.l"], ["head"],
          ["upperleg.r", "lowerleg.r", "foot.r", "toes.r"]]


def read(path):
    data = Path(path).read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20:20 + length]), data[20 + length:]


def write(path, document, rest):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    Path(path).write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + rest)


def fixture(source, target):
    document, rest = read(source)
    node = {entry["name"]: index for index, entry in enumerate(document["nodes"])}
    colliders = []
    for name, kind, body in SHAPES:
        extended = kind == "plane" or body.get("inside")
        collider = {"node": node[name], "shape": {kind: body}}
        if extended:
            # What hosts without the extension see: a sphere far away.
            collider["shape"] = {"sphere": {"offset": [0, -10000, 0], "radius": 0}}
            collider["extensions"] = {"VRMC_springBone_extended_collider": {"specVersion": "1.0", "shape": {kind: body}}}
        colliders.append(collider)
    springs = [{"joints": [{"node": node[name], "hitRadius": 0.03 + 0.01 * index, "stiffness": 1.5, "gravityPower": 0.25,
                            "dragForce": 0.4} for index, name in enumerate(chain)], "colliderGroups": [0]} for chain in CHAINS]
    document.setdefault("extensions", {}).update({
        "VRMC_vrm": {
            "specVersion": "1.0",
            "meta": {"name": "rogue", "authors": ["Kay Lousberg"], "licenseUrl": "https://vrm.dev/licenses/1.0/",
                     "modification": "allowModificationRedistribution"},
            "humanoid": {"humanBones": {bone: {"node": node[name]} for bone, name in HUMANOID.items()}},
            "lookAt": {"type": "bone", "offsetFromHeadBone": [0.02, 0.35, 0.3]},
        },
        "VRMC_springBone": {"specVersion": "1.0", "colliders": colliders, "springs": springs,
                            "colliderGroups": [{"colliders": list(range(len(colliders)))}]},
    })
    document["extensionsUsed"] = sorted({*document.get("extensionsUsed", []), *document["extensions"],
                                         "VRMC_springBone_extended_collider"})
    write(target, document, rest)


def say(*words):
    print(" ".join(f"{word + 0.0:.9g}" if isinstance(word, float) else str(word) for word in words))


def floats(values):
    return [float(value) for value in values]


def list_vrm1(document, names):
    def turned(vector):
        return [-float(vector[0]), float(vector[1]), float(vector[2])]

    for collider in document["extensions"].get("VRMC_springBone", {}).get("colliders", []):
        extension = collider.get("extensions", {}).get("VRMC_springBone_extended_collider")
        shape = (extension or collider)["shape"]
        kind, body = next(iter(shape.items()))
        say("collider", names[collider["node"]], kind + ("-inside" if body.get("inside") else ""),
            *turned(body.get("offset", [0, 0, 0])), *turned(body.get("tail", [0, 0, 0])),
            *turned(body.get("normal", [0, 0, 1])), float(body.get("radius", 0)))
    for spring in document["extensions"].get("VRMC_springBone", {}).get("springs", []):
        # Of which the one group of colliders keeps out.
        if spring.get("colliderGroups"):
            say("chain", ",".join(names[joint["node"]] for joint in spring["joints"]))
        for joint in spring["joints"]:
            say("joint", names[joint["node"]],
                *floats([joint.get("hitRadius", 0), joint.get("stiffness", 1), joint.get("gravityPower", 0)]))
    offset = document["extensions"]["VRMC_vrm"].get("lookAt", {}).get("offsetFromHeadBone")
    if offset:
        say("look-at", *turned(offset))


def list_vrm0(document, names):
    vrm = document["extensions"]["VRM"]

    def vector(value):
        return floats([value["x"], value["y"], value["z"]])

    for group in vrm["secondaryAnimation"]["colliderGroups"]:
        for collider in group["colliders"]:
            say("group-collider", names[group["node"]], *vector(collider["offset"]), float(collider["radius"]))
    for group in vrm["secondaryAnimation"]["boneGroups"]:
        say("spring", ",".join(names[bone] for bone in group["bones"]),
            ",".join(names[vrm["secondaryAnimation"]["colliderGroups"][index]["node"]] for index in group["colliderGroups"]) or "-",
            *floats([group["hitRadius"], group["stiffiness"], group["gravityPower"]]))
    first = vrm["firstPerson"]
    say("viewpoint", names[first["firstPersonBone"]], *vector(first["firstPersonBoneOffset"]))


def main():
    if sys.argv[1] == "fixture":
        fixture(sys.argv[2], sys.argv[3])
        return
    document, _ = read(sys.argv[2])
    names = [entry.get("name", "") for entry in document["nodes"]]
    if any(" " in name for name in names):
        sys.exit(f"{sys.argv[2]}: names with spaces cannot stand in the lines")
    (list_vrm0 if "VRM" in document["extensions"] else list_vrm1)(document, names)


if __name__ == "__main__":
    main()
