#!/usr/bin/env python3
"""What each constant does: changes one at a time and measures what comes out.

    python3 benches/constants.py SCRATCH --out constants.json [--files REGEX] [--only REGEX] [--references A B ...]
                                 [--targets REGEX] [--options "--rig auto"] [--factors 0.7 1.3] [--set SITE=VALUE ...] [--jobs N]

SCRATCH is a copy of the repository that may be written to (a git worktree). Its sources are rewritten once so that every
float constant, and every float literal that is not 0, 0.5, 1 or 2, can be set from the environment; it is built once; then
the example runs on every target with every reference, with one number changed at a time. For each change the file that
is written is read again and compared with the unchanged one:

    moved    the furthest that any vertex of any target moves, as a share of the target's height, and on which target
    targets  on how many targets anything moves by more than a hundred-thousandth of the height
    turned   triangles whose normal turned over against the input, less those of the unchanged run; `worst` on one target
    heads    change of the mean error of the head count
    marks    the furthest that any landmark of the result moves, as a share of the height
    joints   with --options "--rig auto": change of the mean distance to the file's own joints, as a share of the height;
             joint_moved: the furthest that a joint moves, joint_worse and joint_better: the most that one loses and gains
    warned   warnings that come or go: code, how often more or less
    refused  targets that are refused

Needs numpy. Results are added to --out as they come; what stands there already is not measured again.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

import numpy as np

PROBE = '''
/// Numbers that the environment may set.
#[doc(hidden)]
pub mod probe {
    use std::sync::OnceLock;
    #[allow(missing_docs)]
    pub trait Number: Copy {
        fn of(value: f64) -> Self;
    }
    impl Number for f32 { fn of(value: f64) -> Self { value as f32 } }
    impl Number for f64 { fn of(value: f64) -> Self { value } }
    impl Number for usize { fn of(value: f64) -> Self { value as usize } }
    impl Number for i32 { fn of(value: f64) -> Self { value as i32 } }
    #[allow(missing_docs)]
    #[inline]
    pub fn value<T: Number>(name: &str, value: T, cell: &'static OnceLock<Option<f64>>) -> T {
        let set = cell.get_or_init(|| {
            let text = std::env::var("SUPERDEFORM_PROBE").ok()?;
            let number = text.split(';').filter_map(|one| one.rsplit_once('=')).find(|&(set, _)| set == name)?.1;
            number.parse().ok()
        });
        set.map_or(value, T::of)
    }
}
#[doc(hidden)]
#[macro_export]
macro_rules! probed {
    ($name:literal, $value:expr) => {{
        static CELL: std::sync::OnceLock<Option<f64>> = std::sync::OnceLock::new();
        $crate::probe::value($name, $value, &CELL)
    }};
}
'''

CONSTANT = re.compile(r"^(\s*)(?:pub(?:\([a-z]+\))? )?const ([A-Z][A-Z_0-9]*): ([^=]+?) = (.*)$")
LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:e-?\d+)?|\d+e-?\d+)(f32|f64)?(?![\w.])")
SCALARS = ("f64", "f32", "usize", "i32")
PLAIN = (0.0, 0.5, 1.0, 2.0)


def code_of(line):
    """The part of a line before its comment."""
    if line.lstrip().startswith("//"):
        return ""
    return line.split(" // ")[0]


def in_string(code, place):
    return code[:place].count('"') % 2 == 1


def components(kind):
    """The parts of a constant's type that can be set: [(how it is written after the name, scalar)], or None."""
    kind = kind.strip()
    if kind in SCALARS:
        return [("", kind)]
    if kind.startswith("(") and kind.endswith(")"):
        parts = [part.strip() for part in kind[1:-1].split(",")]
        return [(f".{n}", part) for n, part in enumerate(parts)] if all(p in SCALARS for p in parts) else None
    array = re.fullmatch(r"\[(f64|f32); (\d+)\]", kind)
    return [(f"[{n}]", array[1]) for n in range(int(array[2]))] if array else None


def number(text):
    """What a Rust number literal (with underscores, a sign, a product) is worth; None for anything else."""
    text = text.replace("_", "").strip().rstrip(";,")
    if not re.fullmatch(r"[-+*/ ().0-9e]+", text):
        return None
    try:
        return float(eval(text))  # digits and signs only
    except (SyntaxError, ZeroDivisionError):
        return None


def rewrite(path, name):
    """Rewrites one file; returns its sites: [{name, line, value, text}]."""
    lines = path.read_text().split("\n")
    end = next((n for n, line in enumerate(lines) if line.strip() == "#[cfg(test)]"), len(lines))
    body = "\n".join(lines[:end])
    sites, functions, replaced = [], {}, []
    for n in range(end):
        found = CONSTANT.match(lines[n])
        if not found:
            continue
        indent, constant, kind, value = found.groups()
        parts = components(kind)
        if parts is None or re.search(rf"(; *|::){constant}\b", body) or not value.rstrip().endswith(";"):
            continue
        inner = value.rstrip().rstrip(";").strip()
        values = [inner] if len(parts) == 1 and parts[0][0] == "" else inner.strip("()[]").split(",")
        values = [number(v) for v in values if v.strip()]
        if len(values) != len(parts) or None in values:
            continue
        probes = []
        for (suffix, _), worth in zip(parts, values):
            site = f"{name}:{constant}{suffix}"
            sites.append({"site": site, "line": n + 1, "value": worth, "whole": kind.strip() in ("usize", "i32")})
            probes.append(f'crate::probed!("{site}", {constant}{suffix})')
        made = probes[0] if parts[0][0] == "" else (f"[{', '.join(probes)}]" if parts[0][0][0] == "[" else f"({', '.join(probes)})")
        functions[n] = f"{indent}#[allow(non_snake_case, dead_code)] fn {constant}_() -> {kind.strip()} {{ {made} }}"
        replaced.append(constant)
    in_constant = False
    for n in range(end):
        line = lines[n]
        code = code_of(line)
        if re.match(r"\s*(pub(\([a-z]+\))? )?(const|static) ", code) and "const fn" not in code:
            in_constant = not code.rstrip().endswith(";")
            continue
        if in_constant:
            in_constant = not code.rstrip().endswith(";")
            continue
        if not code.strip() or code.lstrip().startswith("#["):
            continue
        out, last = [], 0
        for found in LITERAL.finditer(code):
            worth = float(found[1])
            if in_string(code, found.start()) or worth in PLAIN or abs(worth) < 1e-7 or "=>" in code[found.end():] and code.strip().startswith(found[0]):
                continue
            same = sum(1 for site in sites if site["site"].startswith(f"{name}:{n + 1}:{found[1]}"))
            site = f"{name}:{n + 1}:{found[1]}" + (f"#{same + 1}" if same else "")
            sites.append({"site": site, "line": n + 1, "value": worth, "whole": False, "text": code.strip()})
            out += [code[last:found.start()], f'crate::probed!("{site}", {found[0]})']
            last = found.end()
        line = "".join(out) + code[last:] + line[len(code):]
        for constant in replaced:
            line = re.sub(rf"(?<![\w:{{\"]){constant}(?![\w(])", f"{constant}_()", line)
            # What the probes name is the constant itself.
        lines[n] = line
    for n in sorted(functions, reverse=True):
        lines[n] = lines[n] + "\n" + functions[n]
    path.write_text("\n".join(lines))
    return sites


def prepare(scratch, files):
    """Rewrites and builds `scratch`; returns executable and sites."""
    listed = scratch / "target" / "constants.json"
    if not listed.exists():
        sites = []
        sources = scratch / "src"
        for path in sorted(sources.rglob("*.rs")):
            name = str(path.relative_to(sources))
            if re.search(files, name) and not name.startswith("ffi"):
                sites += rewrite(path, name)
        library = sources / "lib.rs"
        text = library.read_text()
        library.write_text(re.sub(r"\n((?:pub )?mod character;)", lambda found: PROBE + found[0], text, count=1))
        listed.parent.mkdir(exist_ok=True)
        listed.write_text(json.dumps(sites))
    environment = {**os.environ, "CARGO_PROFILE_RELEASE_DEBUG": "0", "CARGO_PROFILE_RELEASE_OPT_LEVEL": "2", "CARGO_INCREMENTAL": "0"}
    build = ["cargo", "build", "--release", "--quiet", "--example", "superdeform", "--target-dir", scratch / "target"]
    subprocess.run(build, cwd=scratch, env=environment, check=True)
    return scratch / "target/release/examples/superdeform", json.loads(listed.read_text())


TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Model:
    """Rest-pose vertices and triangles of a GLB, as glTF's skinning puts them."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.bytes = data[28 + length:]
        worlds = self.worlds()
        points, triangles, start = [], [], 0
        for index, node in enumerate(self.json.get("nodes", [])):
            if "mesh" not in node:
                continue
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                if primitive.get("mode", 4) != 4:
                    continue
                p = self.array(primitive["attributes"]["POSITION"]).astype(float)
                if "skin" in node:
                    p = self.skinned(p, primitive["attributes"], self.json["skins"][node["skin"]], worlds)
                else:
                    p = p @ worlds[index][:3, :3].T + worlds[index][:3, 3]
                if "indices" in primitive:
                    corners = self.array(primitive["indices"]).reshape(-1, 3).astype(int)
                else:
                    corners = np.arange(len(p)).reshape(-1, 3)
                points.append(p)
                triangles.append(corners + start)
                start += len(p)
        self.points = np.concatenate(points)
        self.triangles = np.concatenate(triangles)

    def array(self, index):
        accessor = self.json["accessors"][index]
        kind, size = np.dtype(TYPES[accessor["componentType"]]), SIZES[accessor["type"]]
        count = accessor["count"]
        if "bufferView" not in accessor:
            return np.zeros((count, size), kind)
        view = self.json["bufferViews"][accessor["bufferView"]]
        offset = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", kind.itemsize * size)
        rows = np.ndarray((count, size), kind, self.bytes, offset, (stride, kind.itemsize))
        if accessor.get("normalized"):
            rows = rows / np.iinfo(kind).max
        return rows

    def worlds(self):
        nodes = self.json.get("nodes", [])
        local = []
        for node in nodes:
            if "matrix" in node:
                local.append(np.array(node["matrix"]).reshape(4, 4).T)
                continue
            x, y, z, w = node.get("rotation", [0, 0, 0, 1])
            turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
            m = np.eye(4)
            m[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]))
            m[:3, 3] = node.get("translation", [0, 0, 0])
            local.append(m)
        worlds = [None] * len(nodes)
        parents = {child: n for n, node in enumerate(nodes) for child in node.get("children", [])}

        def world(n):
            if worlds[n] is None:
                worlds[n] = world(parents[n]) @ local[n] if n in parents else local[n]
            return worlds[n]

        for n in range(len(nodes)):
            world(n)
        return worlds

    def skinned(self, p, attributes, skin, worlds):
        joints = skin["joints"]
        inverse = self.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1) if "inverseBindMatrices" in skin else np.tile(np.eye(4), (len(joints), 1, 1))
        matrices = np.array([worlds[joint] for joint in joints]) @ inverse
        total, out, layer = 0.0, np.zeros_like(p), 0
        homogeneous = np.concatenate([p, np.ones((len(p), 1))], axis=1)
        while f"JOINTS_{layer}" in attributes:
            rows = self.array(attributes[f"JOINTS_{layer}"]).astype(int)
            weights = self.array(attributes[f"WEIGHTS_{layer}"]).astype(float)
            for k in range(4):
                w = weights[:, k:k + 1]
                out += w * np.einsum("nij,nj->ni", matrices[rows[:, k]][:, :3], homogeneous)
                total = total + w
            layer += 1
        return out / np.maximum(total, 1e-9)


def normals(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def run(executable, target, reference, options, folder, probe, known=None):
    """The report and the model that come out; a sentence where the target is refused. A file whose digest is `known` is
    not read again: `None` stands for its model."""
    name = f"{target.stem}_{pathlib.Path(reference).stem}_{os.getpid()}_{abs(hash(probe))}"
    out = pathlib.Path(folder, name + target.suffix)
    report = out.with_suffix(".json")
    how = ["--heads", reference] if re.fullmatch(r"[\d.]+", reference) else [reference]
    command = [executable, target, *how, "-o", out, "--report", report, "--quiet", "--threads", "1", *options]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "SUPERDEFORM_PROBE": probe or ""})
    if done.returncode != 0:
        return done.stderr.strip(), None, None
    digest = hashlib.sha256(out.read_bytes()).hexdigest()
    found = json.loads(report.read_text()), None if digest == known else Model(out)
    out.unlink()
    report.unlink()
    return *found, digest


def asked_heads(reference, report):
    return float(reference) if report.get("reference") is None else report["reference"]["heads"]


def error_of(reference, report):
    return abs(report["result"]["heads"] / asked_heads(reference, report) - 1)


def turned(before, after, triangles):
    if len(before) != len(after):  # the writer split a mesh
        return 0
    return int((np.einsum("ij,ij->i", normals(before, triangles), normals(after, triangles)) < 0).sum())


def joint_errors(report):
    """How far each joint is from the file's own, as a share of the height; nothing for a rig that was kept."""
    ours, own = report["target"]["joints"], report["target"]["file_joints"]
    height = report["target"]["height"]
    return {role: float(np.linalg.norm(np.subtract(ours[role], own[role]))) / height for role in ours if role in own and ours != own}


def joint_moves(before, after):
    height = before["target"]["height"]
    old, new = before["target"]["joints"], after["target"]["joints"]
    return {role: float(np.linalg.norm(np.subtract(old[role], new[role]))) / height for role in old if role in new}


class Bench:
    def __init__(self, options):
        self.options = options
        models = pathlib.Path(options.models)
        files = sorted(p for p in models.iterdir() if p.suffix in (".glb", ".vrm") and re.search(options.targets, p.name))
        self.references = [r if re.fullmatch(r"[\d.]+", r) else str(models / r) for r in options.references]
        self.pairs = [(t, r) for t in files for r in self.references]
        self.extra = options.options.split()
        self.executable, self.sites = prepare(pathlib.Path(options.scratch).resolve(), options.files)
        self.folder = tempfile.mkdtemp(prefix="constants")

    def base(self, pool):
        found = pool.map(lambda pair: run(self.executable, *pair, self.extra, self.folder, None), self.pairs)
        self.unchanged, self.inputs = {}, {}
        for (target, reference), (report, model, digest) in zip(self.pairs, found):
            if model is None:
                print(f"refused: {target.name} {reference}: {report}", file=sys.stderr)
                continue
            if target not in self.inputs:
                self.inputs[target] = Model(target)
            before = self.inputs[target]
            flips = turned(before.points, model.points, before.triangles)
            self.unchanged[target, reference] = report, model.points.astype(np.float32), flips, digest
        self.pairs = list(self.unchanged)

    def change(self, site, value, pool):
        """What one changed number does, over all pairs."""
        probe = f"{site}={value}"

        def one(pair):
            target, reference = pair
            report, points, flips, digest = self.unchanged[pair]
            new, model, after = run(self.executable, target, reference, self.extra, self.folder, probe, digest)
            if after is None:
                return pair, None
            height = report["target"]["height"]
            apart, turns = 0.0, 0
            if model is not None:
                before = self.inputs[target]
                apart = float(np.linalg.norm(model.points - points, axis=1).max()) / height
                turns = turned(before.points, model.points, before.triangles) - flips
            marks = max(abs(new["result"]["landmarks"][k] - v) for k, v in report["result"]["landmarks"].items()) / height
            own = max(abs(new["target"]["landmarks"][k] - v) for k, v in report["target"]["landmarks"].items()) / height
            codes = collections.Counter(w["code"] for w in new["warnings"])
            codes.subtract(w["code"] for w in report["warnings"])
            joints = (joint_errors(report), joint_errors(new), joint_moves(report, new))
            return pair, dict(apart=apart, marks=marks, own=own, codes=codes, turns=turns, joints=joints,
                              heads=error_of(reference, new) - error_of(reference, report))

        found = list(pool.map(one, self.pairs))
        row = {"site": site, "value": value, "pairs": len(self.pairs)}
        refused = [pair[0].name for pair, what in found if what is None]
        found = [(pair, what) for pair, what in found if what is not None]
        short = lambda pair: f"{pair[0].name} {pathlib.Path(pair[1]).name}"
        if refused:
            row["refused"] = sorted(set(refused))
        if not any(what for _, what in found):
            return row
        changed = {pair[0].name for pair, what in found if what["apart"] > 1e-5}
        row["targets"] = len(changed)
        worst = max(found, key=lambda item: item[1]["apart"])
        row["moved"], row["moved_on"] = round(worst[1]["apart"], 5), short(worst[0])
        row["mean_moved"] = round(float(np.mean([what["apart"] for _, what in found])), 5)
        row["turned"] = sum(what["turns"] for _, what in found)
        most = max(found, key=lambda item: abs(item[1]["turns"]))
        row["worst"], row["worst_on"] = most[1]["turns"], short(most[0])
        row["heads"] = round(float(np.mean([what["heads"] for _, what in found])), 5)
        most = max(found, key=lambda item: abs(item[1]["heads"]))
        row["heads_most"], row["heads_on"] = round(most[1]["heads"], 4), short(most[0])
        row["marks"] = round(max(what["marks"] for _, what in found), 5)
        row["own_marks"] = round(max(what["own"] for _, what in found), 5)
        change = {(short(pair), role): new[role] - error for pair, what in found for old, new, _ in [what["joints"]]
                  for role, error in old.items() if role in new}
        if change:
            row["joints"] = round(float(np.mean(list(change.values()))), 5)
            moves = {(short(pair), role): d for pair, what in found for role, d in what["joints"][2].items()}
            for name, values, choose in [("joint_moved", moves, max), ("joint_worse", change, max), ("joint_better", change, min)]:
                where = choose(values, key=values.get)
                row[name] = [round(values[where], 4), *where]
            row["joints_moved"] = sum(d > 1e-4 for d in moves.values())
        codes = collections.Counter()
        for _, what in found:
            codes.update(what["codes"])
        row["warned"] = {code: count for code, count in codes.items() if count}
        return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scratch")
    parser.add_argument("--out", required=True)
    parser.add_argument("--models", default=os.environ.get("SUPERDEFORM_MODELS", "../shared/models"))
    parser.add_argument("--files", default="", help="sources that are rewritten, the first time")
    parser.add_argument("--only", default="", help="numbers that are changed")
    parser.add_argument("--targets", default="")
    parser.add_argument("--references", nargs="+", default=["kaykit_rogue.glb", "godette.vrm", "2.5"])
    parser.add_argument("--options", default="")
    parser.add_argument("--factors", nargs="+", type=float, default=[0.7, 1.3])
    parser.add_argument("--set", nargs="+", metavar="SITE=VALUE", help="these values instead of --only and --factors; SITE=VALUE;SITE=VALUE sets two at once")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()

    bench = Bench(options)
    out = pathlib.Path(options.out)
    rows = json.loads(out.read_text()) if out.exists() else []
    known = {(row["site"], row["value"]) for row in rows}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        bench.base(pool)
        total = sum(flips for _, _, flips, _ in bench.unchanged.values())
        errors = [error_of(pair[1], report) for pair, (report, *_) in bench.unchanged.items()]
        print(f"{len(bench.pairs)} pairs, {total} triangles turned, heads off by {100 * np.mean(errors):.2f} % in the mean", flush=True)
        chosen = [site for site in bench.sites if re.search(options.only, site["site"])]
        values = [(site, site["value"] * factor) for site in chosen for factor in options.factors]
        if options.set:
            by_name = {site["site"]: site for site in bench.sites}
            values = [(by_name[text.split("=")[0]], text.partition("=")[2]) for text in options.set]
        for site, value in values:
            if not isinstance(value, str):
                value = round(value) if site["whole"] else value
            if value != site["value"] and (site["site"], value) not in known:
                row = bench.change(site["site"], value, pool)
                row["was"], row["line"] = site["value"], site["line"]
                rows.append(row)
                out.write_text(json.dumps(rows, indent=1))
                print({k: v for k, v in row.items() if k not in ("pairs", "line")}, flush=True)


if __name__ == "__main__":
    main()
