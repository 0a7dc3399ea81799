#!/usr/bin/env python3
"""Rays beside Embree's (Debian: libembree-dev) on one thread, on the same triangles and rays, in turn: prints a table.

    python3 benches/peers/rays.py
"""

import pathlib
import subprocess
import tempfile

ROUNDS = 3
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def numbers(*command):
    said = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    return [[float(number) for number in line.split()] for line in said.splitlines()]


def main():
    subprocess.run(["cargo", "build", "--quiet", "--release", "--workspace", "--example", "rays"], check=True, cwd=HERE)
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder, "embree")
        subprocess.run(["cc", "-O3", HERE / "embree.c", "-lembree3", "-lm", "-o", program], check=True)
        for _ in range(ROUNDS):
            plain, many = numbers("target/release/examples/rays", folder)
            found = {"ours": plain, "ours, for many": many, "Embree": numbers(program, folder)[0]}
            for name, row in found.items():
                rows[name] = [min(pair) for pair in zip(row, rows.get(name, row))]
    print("| ms | build | first hits | found | all hits | found | first, Embree over it | all, Embree over it |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    best = rows["Embree"]
    for name, (build, first, first_found, every, every_found) in rows.items():
        print(f"| {name} | {build:.1f} | {first:.1f} | {first_found:.0f} | {every:.1f} | {every_found:.0f} "
              f"| {best[1] / first:.2f} | {best[3] / every:.2f} |")


if __name__ == "__main__":
    main()
