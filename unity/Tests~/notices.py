#!/usr/bin/env python3
"""Writes "Third Party Notices.md": what is linked into the native library, with its licences and their texts.

notices.py          writes the file
notices.py --check  exit code 1 where it is not what would be written

Read from cargo and the sources that it has fetched: normal dependencies of the library alone, without those that only
run while it is built.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REPOSITORY = ROOT.parent
FILE = ROOT / "Third Party Notices.md"
TARGETS = ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu", "x86_64-pc-windows-msvc", "x86_64-apple-darwin",
           "aarch64-apple-darwin"]

HEAD = """# Third-party notices

The native library of this package (`superdeform.dll`, `libsuperdeform.so`, `libsuperdeform.dylib`) links the Rust packages
below, and Rust's standard library (MIT OR Apache-2.0, https://github.com/rust-lang/rust). The C# sources use nothing but
Unity. Made by `Tests~/notices.py` from `Cargo.lock`.

Where a package offers several licences, it is used under MIT. The texts follow the table.

| Package | Version | Licence | Source |
| --- | --- | --- | --- |
"""


def cargo(*arguments):
    return subprocess.run(["cargo", *arguments], cwd=REPOSITORY, check=True, capture_output=True, text=True).stdout


def packages():
    """Name, version, licence and source of all that is linked, by name."""
    found = set()
    for target in TARGETS:
        lines = cargo("tree", "--locked", "--edges", "normal,no-proc-macro", "--prefix", "none", "--package", "superdeform",
                      "--target", target, "--format", "{p}|{l}|{r}").splitlines()
        for line in lines:
            name, licence, source = line.replace(" (*)", "").split("|")
            name, version = name.split(" ")[:2]
            if name != "superdeform":
                found.add((name, version.lstrip("v"), re.sub(r"\s*/\s*", " OR ", licence), source))
    return sorted(found)


def text_of(folder):
    """The MIT text of a package's folder; its copyright lines differ from package to package."""
    named = sorted(path for path in folder.iterdir()
                   if re.match(r"(?i)(licen[cs]e|copying|unlicense)", path.name) and path.is_file())
    mit = [path for path in named if re.search(r"(?i)mit", path.name)]
    for path in mit + named:
        text = path.read_text(encoding="utf-8", errors="replace").strip()
        if "Permission is hereby granted, free of charge" in text:
            return "\n".join(line.rstrip() for line in text.splitlines())
    return ""


def notices():
    found = packages()
    folders = {(package["name"], package["version"]): Path(package["manifest_path"]).parent
               for package in json.loads(cargo("metadata", "--locked", "--format-version", "1"))["packages"]}
    texts = {}
    for name, version, licence, _ in found:
        if "MIT" not in licence:
            sys.exit(f"{name} {version} is under {licence}, not MIT: put its text into the notices by hand")
        texts.setdefault(text_of(folders[name, version]), []).append(name)
    out = HEAD + "".join(f"| {name} | {version} | {licence} | {source} |\n" for name, version, licence, source in found)
    for text, names in sorted(texts.items(), key=lambda item: item[1]):
        out += f"\n## {', '.join(names)}\n\n"
        out += f"```\n{text}\n```\n" if text else "MIT; the package carries no text of its own.\n"
    return out


def main():
    made = notices()
    if "--check" in sys.argv:
        if FILE.read_text(encoding="utf-8") != made:
            sys.exit(f"{FILE.name} is not what cargo links: run notices.py")
        return
    FILE.write_text(made, encoding="utf-8", newline="\n")
    print(f"{len(packages())} packages")


if __name__ == "__main__":
    main()
