#!/usr/bin/env python3
"""All figures of benches/README.md, made anew on this machine in one go: some five minutes where nothing else runs.

    python3 benches/table.py [PART...]

PART: speed, rays, growth, silences, instructions, memory; all without one. What a part needs that is not there (Embree, valgrind,
models) is said, and the part left out. Prints `N parts made, N left out`; ends with 1 where one failed.
"""

import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
HOT_PATHS = ["cargo", "build", "--quiet", "--workspace", "--example", "hot_paths"]


def example(name):
    """Builds an example, as part of the workspace like all else, and runs it."""
    return [["cargo", "build", "--quiet", "--release", "--workspace", "--example", name], [f"target/release/examples/{name}"]]


def embree():
    found = any(pathlib.Path(folder).glob("**/libembree3.so*") for folder in ("/usr/lib", "/usr/local/lib"))
    return None if found else "there is no Embree 3 (Debian: libembree-dev)"


def valgrind():
    return None if shutil.which("valgrind") else "there is no valgrind"


PARTS = {
    "speed": ([["python3", "benches/peers/speed.py"]], None),
    "rays": ([["python3", "benches/peers/rays.py"]], embree),
    "growth": (example("growth"), None),
    "silences": (example("silences"), None),
    "instructions": ([HOT_PATHS, ["python3", "benches/instructions.py", "target/debug/examples/hot_paths"]], valgrind),
    "memory": ([["cargo", "bench", "--quiet", "--workspace", "--bench", "memory"]], None),
}


def main():
    asked = sys.argv[1:] or list(PARTS)
    unknown = [name for name in asked if name not in PARTS]
    if unknown:
        sys.exit(f"there is no part {unknown[0]}: name some of {', '.join(PARTS)}")
    made, left_out, failed = 0, 0, 0
    for name in asked:
        commands, missing = PARTS[name]
        print(f"\n## {name}\n", flush=True)
        if missing and missing():
            print(f"left out: {missing()}")
            left_out += 1
            continue
        # One at a time: what is measured must have the machine for itself.
        if all(subprocess.run(command, cwd=ROOT).returncode == 0 for command in commands):
            made += 1
        else:
            failed += 1
    print(f"\n{made} parts made, {left_out} left out, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
