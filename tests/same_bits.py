#!/usr/bin/env python3
"""Whether two builds of the example give the same bits: every model, with every reference, in both modes.

    python3 tests/same_bits.py OLD NEW [--models FOLDER] [--only TEXT] [--jobs N] [--times]

OLD and NEW are executables of examples/superdeform, or files that an earlier run wrote with --save. Compared are the
bytes of the model that is written and the report without its times. Of warnings the codes count and of refusals that
there is one; --words compares their sentences too. Prints each pair that differs and where its report does, and ends
with `N passed, N failed`.

    python3 tests/same_bits.py OLD --save bits.json     keeps what OLD gives, for later
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile

REFERENCES = ["kaykit_rogue.glb", "godette.vrm", "makehuman_baby_reference.glb"]
MODES = {"product": [], "paper": ["--paper"]}


def report_without_times(text):
    report = json.loads(text)
    report.pop("timing_ms", None)
    return report


def bits(executable, target, reference, mode, folder):
    """What `executable` gives for one pair: a digest of the model, and the report."""
    out = pathlib.Path(folder, f"{target.stem}_{reference.stem}_{mode}{target.suffix}")
    report = out.with_suffix(".json")
    command = [executable, target, reference, "-o", out, "--report", report, "--quiet", "--threads", "1", *MODES[mode]]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        return {"refused": done.stderr.strip()}
    found = {"model": hashlib.sha256(out.read_bytes()).hexdigest(), "report": report_without_times(report.read_text())}
    out.unlink()
    report.unlink()
    return found


def run(executable, pairs, jobs):
    """What `executable` gives for all `pairs`, by name; what a file kept where it is no executable."""
    path = pathlib.Path(executable)
    if path.suffix == ".json":
        return json.loads(path.read_text())
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        names = [f"{target.name} {reference.name} {mode}" for target, reference, mode in pairs]
        found = pool.map(lambda pair: bits(path.resolve(), *pair, folder), pairs)
        return dict(zip(names, found))


def without_words(found):
    """A result with the codes of its warnings alone, and without the sentence of a refusal."""
    if "refused" in found:
        return {"refused": True}
    report = dict(found["report"])
    report["warnings"] = [warning["code"] for warning in report["warnings"]]
    return {**found, "report": report}


def differences(old, new, path=""):
    """The places where two reports differ."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(set(old) | set(new)):
            yield from differences(old.get(key), new.get(key), f"{path}.{key}" if path else key)
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for index, (a, b) in enumerate(zip(old, new)):
            yield from differences(a, b, f"{path}[{index}]")
    elif old != new:
        yield f"{path}: {old} -> {new}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new", nargs="?")
    parser.add_argument("--models", default=os.environ.get("SUPERDEFORM_MODELS", "../shared/models"))
    parser.add_argument("--only", default="", help="only pairs whose names hold this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--words", action="store_true", help="compares sentences too")
    parser.add_argument("--save", help="keeps what OLD gives in this file")
    options = parser.parse_args()

    models = pathlib.Path(options.models)
    if not models.is_dir():
        print(f"no folder {models}: name one with --models or SUPERDEFORM_MODELS")
        return 1
    targets = sorted(path for path in models.iterdir() if path.suffix in (".glb", ".vrm"))
    pairs = [(target, models / reference, mode) for target in targets for reference in REFERENCES for mode in MODES]
    pairs = [pair for pair in pairs if options.only in f"{pair[0].name} {pair[1].name} {pair[2]}"]

    if not pairs:
        print(f"no pair of {models} holds {options.only!r}")
        return 1

    old = run(options.old, pairs, options.jobs)
    if options.save:
        pathlib.Path(options.save).write_text(json.dumps(old))
    if options.new is None:
        print(f"{len(old)} pairs")
        return 0
    new = run(options.new, pairs, options.jobs)
    if not options.words:
        old, new = ({name: without_words(result) for name, result in found.items()} for found in (old, new))
    failed = 0
    for name in (name for name in old if name in new):
        if old[name] == new[name]:
            continue
        failed += 1
        print(f"{name}:", "the model differs" if old[name].get("model") != new[name].get("model") else "the report alone differs")
        lines = list(differences(old[name].get("report", old[name]), new[name].get("report", new[name])))
        for line in lines[:6]:
            print(f"    {line[:180]}")
        if len(lines) > 6:
            print(f"    and {len(lines) - 6} more")
    print(f"{len(new) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
