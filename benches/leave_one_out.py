#!/usr/bin/env python3
"""Whether constants were fitted to the models: each character is left out once, the value is chosen anew by all others.

    python3 benches/leave_one_out.py SCRATCH --out leave_one_out.json [--files REGEX] [--only REGEX] [--factors 0.7 1.3]
                                     [--parts stripped solids]

SCRATCH is a copy of the repository that may be written to (a git worktree); it is made settable as `constants.py` does it,
and `tests/rig_found.rs` is built there once. For each constant and each factor it measures the limb joints of every model
without its rig, and of its solid of 160 cells. A character costs the mean distance of its joints, each no more than 0.1 of
its height. Files of one character (twins, formats) are left out together.

Prints a table: how many characters any of the factors moves; the factor that all characters choose; the factors that are
chosen with one left out; how much more those left out cost, in the mean, with the one that the others chose than with the
value that stands; which loses most.
`SUPERDEFORM_MODELS` names the folder of models. Results are added to --out as they come.
"""

import argparse
import collections
import json
import os
import pathlib
import re
import subprocess

import constants

CAP = 0.1
TWIN = re.compile(r"(_vrm1|_unrigged|_target|_rigged|_reference|_hooded|_dress|_casual)*\.(glb|vrm).*")
JOINT = re.compile(r" (?:an|el|hi|kn|sh|wr)(\d+\.\d{3})[ !?-]\d+")


def prepare(scratch, files):
    """Rewrites `scratch` and builds the survey; returns its executable and the constants that can be set."""
    listed = scratch / "target" / "leave_one_out.json"
    if not listed.exists():
        sources, sites = scratch / "src", []
        for path in sorted(sources.rglob("*.rs")):
            name = str(path.relative_to(sources))
            if re.search(files, name):
                sites += constants.rewrite(path, name)
        library = sources / "lib.rs"
        text = re.sub(r"\n((?:pub )?mod character;)", lambda found: constants.PROBE + found[0], library.read_text(), count=1)
        library.write_text(text)
        listed.parent.mkdir(exist_ok=True)
        listed.write_text(json.dumps([site for site in sites if "text" not in site]))
    command = ["cargo", "test", "--release", "--test", "rig_found", "--no-run", "--message-format", "json",
               "--target-dir", scratch / "target"]
    environment = {**os.environ, "CARGO_PROFILE_RELEASE_DEBUG": "0", "CARGO_INCREMENTAL": "0"}
    done = subprocess.run(command, cwd=scratch, env=environment, check=True, capture_output=True, text=True)
    made = [json.loads(line) for line in done.stdout.splitlines()]
    executable = next(one["executable"] for one in made if one.get("executable") and one["target"]["name"] == "rig_found")
    return executable, json.loads(listed.read_text())


def measure(executable, scratch, parts, probe):
    """The cost of each character with one constant set."""
    environment = {**os.environ, "SUPERDEFORM_PROBE": probe, "PART": ",".join(parts), "CELLS": "160", "LINES": "1"}
    command = [executable, "survey", "--ignored", "--nocapture"]
    done = subprocess.run(command, cwd=scratch, env=environment, capture_output=True, text=True)
    offs = collections.defaultdict(list)
    for line in done.stdout.splitlines():
        if re.match(r"[\w.]+\.(glb|vrm)", line):
            offs[TWIN.sub("", line)] += [min(float(off), CAP) for off in JOINT.findall(line)]
    if not offs:
        raise SystemExit(f"no model was measured: {done.stdout[-500:]}{done.stderr[-500:]}")
    return {character: sum(all) / len(all) for character, all in offs.items() if all}


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def chosen(costs, without):
    """The factor with the least mean cost of all characters but one; of several the one that changes least."""
    def cost(factor):
        return round(mean(one for character, one in costs[factor].items() if character != without), 7), abs(float(factor) - 1)
    return min(costs, key=cost)


def row(site, costs):
    left = {character: chosen(costs, character) for character in costs["1"]}
    stands = costs["1"]
    more = {character: costs[factor][character] - stands[character] for character, factor in left.items()}
    worst = max(more, key=more.get)
    counts = ", ".join(f"{count} × {factor}" for factor, count in sorted(collections.Counter(left.values()).items()))
    lost = f"{more[worst]:.4f} ({worst})" if more[worst] > 0 else "none"
    name = site["site"].split(":", 1)[1]
    moved = {one for cost in costs.values() for one in stands if abs(cost[one] - stands[one]) > 1e-9}
    return (f"| `{name}` | {site['value']:g} | {len(moved)} | {chosen(costs, None)} | {counts} | "
            f"{mean(more.values()):+.4f} | {lost} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scratch", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--files", default=r"^rig/arm_choice\.rs$")
    parser.add_argument("--only", default="")
    parser.add_argument("--factors", nargs="+", default=["0.7", "1.3"])
    parser.add_argument("--parts", nargs="+", default=["stripped", "solids"])
    args = parser.parse_args()
    executable, sites = prepare(args.scratch.resolve(), args.files)
    known = json.loads(args.out.read_text()) if args.out.exists() else {}
    if "" not in known:
        known[""] = measure(executable, args.scratch, args.parts, "")
    rows = []
    for site in sites:
        if site["whole"] or not re.search(args.only, site["site"]):
            continue
        costs = {"1": known[""]}
        for factor in args.factors:
            probe = f"{site['site']}={site['value'] * float(factor)}"
            if probe not in known:
                known[probe] = measure(executable, args.scratch, args.parts, probe)
                args.out.write_text(json.dumps(known, indent=1))
            costs[factor] = known[probe]
        rows.append(row(site, costs))
        print(rows[-1], flush=True)
    print(f"\n{len(known[''])} characters cost {mean(known[''].values()):.4f} with the values that stand.\n")
    print("| Constant | Value | Moves | All choose | Chosen with one left out | More, mean | Most |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    print("\n".join(rows))


if __name__ == "__main__":
    main()
