#!/usr/bin/env python3
"""Times of an apply and of sliders on one thread, beside plain linear blend skinning in C, in one run.

    python3 benches/peers/speed.py [MODEL...]

Builds `skinning.c` with the system's C compiler and the example `speed`, runs them in turn, and prints the least of all runs,
in milliseconds, as the table of benches/README.md. Names of models may follow, files of the folder that the tests use.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

ROUNDS = 3
HERE = pathlib.Path(__file__).resolve().parent


def out_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=HERE.parent.parent).stdout


def ours(models):
    """By model and line, the least of the run's numbers."""
    found, model = {}, None
    for line in out_of("target/release/examples/speed", *models).splitlines():
        if not line.startswith(" "):
            model = line
        else:
            name, numbers = re.match(r"  (.+?)\s{2,}(.*)", line).groups()
            found[model, name] = [float(number) for number in re.findall(r"\d+\.\d+", numbers)]
    return found


def main():
    subprocess.run(["cargo", "build", "--quiet", "--release", "--workspace", "--example", "speed"], check=True, cwd=HERE)
    least = {}

    def keep(key, numbers):
        before = least.get(key, numbers)
        least[key] = [min(pair) for pair in zip(before, numbers)]

    with tempfile.TemporaryDirectory() as folder:
        skinning = pathlib.Path(folder, "skinning")
        subprocess.run(["cc", "-O3", HERE / "skinning.c", "-lm", "-o", skinning], check=True)
        for _ in range(ROUNDS):
            found = ours(sys.argv[1:])
            for model, count in {(model, re.search(r"(\d+) vertices", model)[1]) for model, _ in found}:
                numbers = [float(number) for number in out_of(skinning, count).split()]
                keep((model, "C: positions"), numbers[:1])
                keep((model, "C: positions, normals, tangents"), numbers[1:])
            for key, numbers in found.items():
                keep(key, numbers)
    models = list(dict.fromkeys(model for model, _ in least))
    rows = list(dict.fromkeys(name for _, name in least))
    print("| ms | " + " | ".join(models) + " |")
    print("| --- |" + " --- |" * len(models))
    for name in rows:
        cells = [" / ".join(f"{number:.2f}" for number in least.get((model, name), [])) for model in models]
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
