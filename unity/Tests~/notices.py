#!/usr/bin/env python3
"""Writes "Third Party Notices.md": what is linked into the native library, with its licences and their texts.

notices.py          writes the file
notices.py --check  exit code 1 where it is not what would be written

Read from cargo and the sources that it has fetched: normal dependencies of the library alone, without those that only
run while it is built.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REPOSITORY = ROOT.parent
sys.path.insert(0, str(REPOSITORY / ".ci"))
sys.dont_write_bytecode = True
from bill import linked, rows, texts  # noqa: E402

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


def notices():
    found = linked("library", TARGETS)
    return HEAD + rows(found) + texts(found)


def main():
    made = notices()
    if "--check" in sys.argv:
        if FILE.read_text(encoding="utf-8") != made:
            sys.exit(f"{FILE.name} is not what cargo links: run notices.py")
        return
    FILE.write_text(made, encoding="utf-8", newline="\n")
    print(f"{made.count(chr(10) + chr(35) * 2)} texts")


if __name__ == "__main__":
    main()
