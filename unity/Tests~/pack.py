#!/usr/bin/env python3
"""Packs a folder as npm and Unity's Package Manager do: a tarball whose one folder is called `package`.

pack.py FOLDER FILE.tgz   the same files give the same bytes
"""

import gzip
import io
import sys
import tarfile
from pathlib import Path


def main():
    folder, file = Path(sys.argv[1]), Path(sys.argv[2])
    archive = io.BytesIO()
    with tarfile.open(fileobj=archive, mode="w", format=tarfile.USTAR_FORMAT) as tar:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            entry = tarfile.TarInfo("package/" + path.relative_to(folder).as_posix())
            entry.size, entry.mode = path.stat().st_size, 0o644
            # npm's own date: some file systems have no dates before 1980.
            entry.mtime = 499162500
            with path.open("rb") as content:
                tar.addfile(entry, content)
    file.write_bytes(gzip.compress(archive.getvalue(), compresslevel=9, mtime=0))
    print(f"{file}: {file.stat().st_size} bytes")


if __name__ == "__main__":
    main()
