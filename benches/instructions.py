#!/usr/bin/env python3
"""Counts the instructions of five hot paths under valgrind's callgrind, and compares them with benches/instructions.json.

    python3 benches/instructions.py [EXECUTABLE]           exit code 1 where one is off by more than 5 %, 77 where nothing
                                                           can be compared: no valgrind, another compiler or processor
    python3 benches/instructions.py [EXECUTABLE] --write   writes the counts of this compiler

EXECUTABLE is the example `hot_paths`, built by cargo's dev profile; without it, it is built. Counts say what work is
done, whatever else the machine does meanwhile; they say nothing of memory. A change of them is meant to be seen: where it is
right, write them anew.
"""

import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

MOST = 0.05
PATHS = ["positions", "directions", "slider", "rays", "heat"]
HERE = pathlib.Path(__file__).resolve().parent
KEPT = HERE / "instructions.json"


def compiler():
    return subprocess.run(["rustc", "--version"], check=True, capture_output=True, text=True).stdout.strip()


def processor():
    """The processor's kind, and whether the sparse solver finds what it asks for."""
    flags = pathlib.Path("/proc/cpuinfo")
    return platform.machine() + (" avx2" if flags.exists() and "avx2" in flags.read_text() else "")


def count(executable, path):
    """Instructions within the function hot_PATH and what it calls."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", "--collect-atstart=no",
                   f"--toggle-collect=*hot_{path}*", str(executable), path]
        said = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    return int(re.search(r"Collected : (\d+)", said)[1])


def main():
    write = "--write" in sys.argv
    given = [argument for argument in sys.argv[1:] if argument != "--write"]
    this = {"compiler": compiler(), "processor": processor()}
    if not shutil.which("valgrind"):
        print("valgrind is not installed")
        return 77
    kept = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    if not write and {name: kept.get(name) for name in this} != this:
        print(f"counts are kept for {kept.get('compiler')} on {kept.get('processor')}, this is {this['compiler']} on {this['processor']}")
        return 77
    executable = pathlib.Path(given[0]) if given else HERE.parent / "target/debug/examples/hot_paths"
    if not given:
        # As .ci/test builds it: what is built bit by bit is inlined otherwise.
        subprocess.run(["cargo", "build", "--quiet", "--locked", "--workspace", "--example", "hot_paths"], check=True,
                       cwd=HERE.parent, env={**os.environ, "CARGO_INCREMENTAL": "0"})
    counts = {path: count(executable, path) for path in PATHS}
    if write:
        KEPT.write_text(json.dumps({**this, "counts": counts}, indent=2) + "\n")
    failed = 0
    for path, found in counts.items():
        off = found / kept["counts"][path] - 1 if not write else 0.0
        failed += abs(off) > MOST
        print(f"{path}: {found:,} instructions, {off:+.1%}{'' if abs(off) <= MOST else ' FAILED'}")
    print(f"{len(PATHS) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
