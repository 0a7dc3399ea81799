"""Compares our weights and Blender's automatic weights with artists', by where they put the vertices of posed models.

    pip install bpy numpy        (in an environment of the Python version that bpy is built for)
    cargo run --release -p superdeform-benches --example posed_weights -- FOLDER
    python posed_weights.py FOLDER

Every rigged model loses its weights and keeps its artist's joints. Ours and Blender's weights on those are posed (walk,
squat, arms up; head and trunk bent), and the mean distance of their vertices to those of the artist's weights is
printed, in thousandths of the height. Blender gets each mesh for itself, its vertices welded, ten times as large; what
it leaves without weights is left out for both, and counted. Its weights are kept in FOLDER beside the files.
"""

import json
import pathlib
import sys

import numpy

UP, FORWARD, LEFT = numpy.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
SCALE = 10.0
# Of several segments the one that a bone of an artist's skeleton has.
GOES_ON = {"hips": "spine", "leftHand": "leftMiddleProximal", "rightHand": "rightMiddleProximal"}
POSES = ["walk", "squat", "arms up", "bent"]


def turn(axis, degrees):
    """The rotation about an axis."""
    axis = axis / numpy.linalg.norm(axis)
    x, y, z = axis
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = numpy.radians(degrees)
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def between(one, other):
    """The rotation that takes a direction to another the short way."""
    one, other = one / numpy.linalg.norm(one), other / numpy.linalg.norm(other)
    axis = numpy.cross(one, other)
    if numpy.linalg.norm(axis) < 1e-9:
        return numpy.eye(3)
    return turn(axis, numpy.degrees(numpy.arccos(numpy.clip(one @ other, -1, 1))))


def arm(case, side, target, bend):
    """Turns that point an upper arm at `target` and bend the elbow forward."""
    at = dict(zip(case["roles"], numpy.array(case["joints"])))
    upper, lower = side + "UpperArm", side + "LowerArm"
    if upper not in at or lower not in at:
        return {}
    way = at[lower] - at[upper]
    turned = between(way, target)
    # The axis of the elbow as it lies in the rest pose.
    axis = turned.T @ numpy.cross(target, FORWARD)
    return {upper: turned, lower: turn(axis, bend) if numpy.linalg.norm(axis) > 1e-6 else numpy.eye(3)}


def pose(case, name):
    """By role the rotation against the parent, about axes of the rest pose."""
    turns = {}
    for side, out, swing in (("left", LEFT, 1), ("right", -LEFT, -1)):
        if name == "walk":
            turns[side + "UpperLeg"] = turn(LEFT, -30 if swing > 0 else 25)
            turns[side + "LowerLeg"] = turn(LEFT, 15 if swing > 0 else 40)
            down = -UP * 0.93 + out * 0.3 - FORWARD * 0.35 * swing
            turns |= arm(case, side, down, 25)
        if name == "squat":
            turns[side + "UpperLeg"] = turn(UP, 12 * swing) @ turn(LEFT, -85)
            turns[side + "LowerLeg"] = turn(LEFT, 100)
            turns[side + "Foot"] = turn(LEFT, -15)
            turns |= arm(case, side, FORWARD - 0.4 * UP + 0.2 * out, 20)
        if name == "arms up":
            turns |= arm(case, side, UP + 0.45 * out, 10)
        if name == "bent":
            turns |= arm(case, side, -UP + 0.35 * out, 10)
    if name == "squat":
        turns["spine"] = turn(LEFT, 15)
    if name == "bent":
        turns["spine"] = turn(FORWARD, 10) @ turn(LEFT, 20)
        turns["chest"] = turn(UP, 12) @ turn(LEFT, 12)
        turns["neck"] = turn(LEFT, 8)
        turns["head"] = turn(UP, 30) @ turn(LEFT, 15)
    return turns


def matrices(case, name):
    """One 3 x 4 matrix a role."""
    joints, turns = numpy.array(case["joints"]), pose(case, name)
    done = {}

    def of(index):
        if index not in done:
            above = numpy.eye(3, 4) if case["parents"][index] is None else of(case["parents"][index])
            own = turns.get(case["roles"][index], numpy.eye(3))
            local = numpy.column_stack([own, joints[index] - own @ joints[index]])
            done[index] = above[:, :3] @ local + numpy.column_stack([numpy.zeros((3, 3)), above[:, 3]])
        return done[index]

    return numpy.array([of(index) for index in range(len(joints))])


def posed(positions, weights, transforms):
    """Linear blend skinning."""
    blended = numpy.tensordot(weights, transforms, 1)
    return numpy.einsum("vij,vj->vi", blended[:, :, :3], positions) + blended[:, :, 3]


def dense(rows, count):
    """Rows of pairs as a matrix whose rows sum to 1."""
    weights = numpy.zeros((len(rows), count))
    for vertex, row in enumerate(rows):
        for column, weight in row:
            weights[vertex, column] += weight
    sums = weights.sum(axis=1, keepdims=True)
    return weights / numpy.where(sums > 0, sums, 1)


def bones_of(case):
    """(column, [head, tail]) of a bone for each role that has one."""
    at = dict(zip(case["roles"], case["joints"]))
    bones = []
    for column, segments in case["bones"]:
        role = case["roles"][column]
        ends = segments[0]
        if role in GOES_ON and GOES_ON[role] in at:
            ends = [case["joints"][column], at[GOES_ON[role]]]
        bones.append((column, ends))
    return bones


def blender(path, case):
    """Blender's weights of all vertices in a row, kept beside the file."""
    kept = path.with_suffix(".blender.npz")
    if kept.exists():
        return numpy.load(kept)["weights"]
    from blender_heat import blender_weights

    bones = bones_of(case)
    everything = []
    for mesh in case["meshes"]:
        positions = numpy.array(mesh["positions"]).reshape(-1, 3)
        places, first, welded = numpy.unique(positions.round(6), axis=0, return_index=True, return_inverse=True)
        corners = welded.reshape(-1)[numpy.array(mesh["triangles"], dtype=int).reshape(-1, 3)]
        whole = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
        corners = corners[whole]
        rows = numpy.zeros((len(positions), len(case["roles"])))
        if len(corners):
            found = blender_weights(positions[first], corners.tolist(), [ends for _, ends in bones], SCALE)
            rows[:, [column for column, _ in bones]] = found[welded.reshape(-1)]
        everything.append(rows)
    weights = numpy.concatenate(everything)
    numpy.savez_compressed(kept, weights=weights)
    return weights


def compared(path):
    """The distances of ours and Blender's by pose, the share without Blender's weights."""
    case = json.loads(path.read_text())
    count = len(case["roles"])
    positions = numpy.concatenate([numpy.array(mesh["positions"]).reshape(-1, 3) for mesh in case["meshes"]])
    artist, ours = (
        numpy.concatenate([dense(mesh[whose], count) for mesh in case["meshes"]]) for whose in ("artist", "ours")
    )
    theirs = blender(path, case)
    sums = theirs.sum(axis=1)
    known = (sums > 0) & (artist.sum(axis=1) > 0)
    theirs = theirs / numpy.where(sums > 0, sums, 1)[:, None]
    rows = []
    for name in POSES:
        transforms = matrices(case, name)
        truth = posed(positions, artist, transforms)
        gaps = [numpy.linalg.norm(posed(positions, w, transforms) - truth, axis=1) for w in (ours, theirs)]
        rows.append([1000 * gap[known].mean() if known.any() else float("nan") for gap in gaps])
    return case, rows, (sums == 0).mean()


def main():
    folder = pathlib.Path(sys.argv[1])
    print("distance to the artist's posed mesh, H / 1000: ours, Blender's")
    print(f"{'':34} {'':8}" + "".join(f"{name:>14}" for name in POSES) + f"{'all':>14}  Blender leaves out")
    nearer, cases = numpy.zeros(len(POSES) + 2, dtype=int), 0
    known = []
    for path in sorted(folder.glob("*.json")):
        case, rows, missing = compared(path)
        rows = numpy.array(rows)
        if any(numpy.allclose(rows[:, 1], theirs, rtol=1e-4, equal_nan=True) for theirs in known):
            continue  # The same model in another format.
        known.append(rows[:, 1])
        line = f"{case['name'][:33]:34} {case['method']:8}"
        for ours, theirs in [*rows, rows.mean(axis=0)]:
            line += f"{ours:7.1f}{theirs:6.1f}{'*' if ours < theirs else ' '}"
        print(line + f"  {100 * missing:.1f} %", flush=True)
        if missing < 1:
            cases += 1
            parts = [*rows, rows[:3].mean(axis=0), rows.mean(axis=0)]
            nearer += numpy.array([ours < theirs for ours, theirs in parts])
    for name, count in zip([*POSES, "the first three", "all four"], nearer):
        print(f"{name}: ours nearer in {count} of {cases}")


if __name__ == "__main__":
    main()
