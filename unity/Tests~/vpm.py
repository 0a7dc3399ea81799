#!/usr/bin/env python3
"""What package managers other than Unity's own read: VRChat's Creator Companion (VPM), ALCOM, and OpenUPM.

vpm.py manifest FOLDER            writes the addresses of a release into FOLDER/package.json
vpm.py release FOLDER OUT [LIST]  writes OUT/NAME-VERSION.zip with package.json at its root, OUT/package.json, the listing
                                  OUT/index.json (LIST: the listing before, whose versions stay) and OUT/NAME.yml for OpenUPM
vpm.py check OUT                  checks what `release` wrote; ends with `N passed, N failed`

SUPERDEFORM_URL    the repository's address, such as https://github.com/OWNER/superdeform: releases are below it
SUPERDEFORM_EMAIL  the author's address, which VPM demands
"""

import hashlib
import json
import os
import re
import sys
import zipfile
from pathlib import Path

# VRChat: what a package must name (docs of vcc.docs.vrchat.com, VPM packages).
REQUIRED = ("name", "displayName", "version", "url", "author")


def address():
    url = os.environ.get("SUPERDEFORM_URL", "").rstrip("/")
    if not re.match(r"https://[^/]+/.+", url):
        sys.exit("set SUPERDEFORM_URL to the repository's address, such as https://github.com/OWNER/superdeform")
    return url


def write(path, value):
    path.write_text(json.dumps(value, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def give_addresses(folder):
    """The manifest with everything that points to the repository; for the tarball and the zip alike."""
    manifest, url = read(folder / "package.json"), address()
    release = f"v{manifest['version']}"
    manifest["documentationUrl"] = f"{url}/blob/{release}/unity/Documentation~/superdeform.md"
    manifest["changelogUrl"] = f"{url}/blob/{release}/unity/CHANGELOG.md"
    manifest["licensesUrl"] = f"{url}/blob/{release}/unity/LICENSE.md"
    manifest["repository"] = {"type": "git", "url": f"{url}.git", "directory": "unity"}
    manifest["author"] = {"name": manifest["author"]["name"], "email": os.environ.get("SUPERDEFORM_EMAIL", ""), "url": url}
    manifest["url"] = f"{url}/releases/download/{release}/{manifest['name']}-{manifest['version']}.zip"
    # Nothing is needed: Modular Avatar, NDMF, UniVRM and VRChat's SDK are used where they are.
    manifest["vpmDependencies"] = {}
    write(folder / "package.json", manifest)


def pack(folder, file):
    """The contents of the folder, not the folder; the same files give the same bytes."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            # The Creator Companion embeds what it installs, and Unity compiles the tests of embedded packages.
            if path.relative_to(folder).parts[0] in ("Tests", "Tests.meta"):
                continue
            entry = zipfile.ZipInfo(path.relative_to(folder).as_posix(), date_time=(1985, 10, 26, 8, 15, 0))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes(), compresslevel=9)


def release(folder, out, before):
    out.mkdir(parents=True, exist_ok=True)
    manifest, url = read(folder / "package.json"), address()
    name, version = manifest["name"], manifest["version"]
    file = out / f"{name}-{version}.zip"
    pack(folder, file)
    write(out / "package.json", manifest)
    listing = read(before) if before else {"name": "Super Deform", "id": "com.superdeform.listing", "packages": {}}
    listing["author"] = manifest["author"]["email"]
    listing["url"] = f"{url}/releases/latest/download/index.json"
    versions = listing["packages"].setdefault(name, {"versions": {}})["versions"]
    versions[version] = {**manifest, "zipSHA256": hashlib.sha256(file.read_bytes()).hexdigest()}
    write(out / "index.json", listing)
    (out / f"{name}.yml").write_text(f"""name: {name}
aliases: []
repoUrl: '{url}'
displayName: {manifest['displayName']}
description: >-
  {manifest['description']}
licenseSpdxId: {manifest['license']}
licenseName: MIT or Apache-2.0
topics:
  - animation
  - editor-enhancement
  - vrchat
hunter: ''
gitTagPrefix: v
gitTagIgnore: ''
minVersion: ''
image: null
readme: 'main:unity/README.md'
trackingMode: githubRelease
githubReleaseAssetName: superdeform-{version}.tgz
""", encoding="utf-8")
    print(f"{file}: {file.stat().st_size} bytes")


def check(out):
    said = []
    passed = 0

    def expect(what, holds):
        nonlocal passed
        passed += bool(holds)
        if not holds:
            said.append(what)
        print(f"{'passed' if holds else 'FAILED'}: {what}")

    listing, manifest = read(out / "index.json"), read(out / "package.json")
    name, version = manifest["name"], manifest["version"]
    file = out / f"{name}-{version}.zip"
    entry = listing["packages"].get(name, {}).get("versions", {}).get(version, {})
    expect("the listing has name, id, url, author and packages",
           all(listing.get(key) for key in ("name", "id", "url", "author", "packages")))
    expect("its entry is the package's manifest and the checksum of its zip",
           entry == {**manifest, "zipSHA256": hashlib.sha256(file.read_bytes()).hexdigest()})
    expect("the manifest names what VPM demands", all(manifest.get(key) for key in REQUIRED)
           and all(manifest["author"].get(key) for key in ("name", "email")))
    expect("the zip is where its address says", manifest["url"].endswith(f"/{file.name}"))
    expect("documentation, changelog and repository have addresses",
           all(str(manifest.get(key, "")).startswith("https://") for key in ("documentationUrl", "changelogUrl"))
           and manifest["repository"]["url"].startswith("https://"))
    with zipfile.ZipFile(file) as archive:
        names = archive.namelist()
        expect("the zip has package.json at its root and the same in it", json.loads(archive.read("package.json")) == manifest)
        expect("every file of the zip that Unity sees has its meta",
               all(f"{entry}.meta" in names for entry in names if not entry.endswith(".meta")
                   and not any(part.endswith("~") for part in entry.split("/"))))
        expect("the zip has no tests, which its users would compile", not any(entry.startswith("Tests") for entry in names))
        expect("the zip has a native library", any(entry.startswith("Plugins/") for entry in names))
    expect("OpenUPM's file is called like the package and takes its release",
           f"name: {name}\n" in (text := (out / f"{name}.yml").read_text(encoding="utf-8"))
           and f"superdeform-{version}.tgz" in text)
    print(f"{passed} passed, {len(said)} failed")
    return 1 if said else 0


def main():
    command, folder = sys.argv[1], Path(sys.argv[2])
    if command == "manifest":
        give_addresses(folder)
    elif command == "release":
        release(folder, Path(sys.argv[3]), Path(sys.argv[4]) if len(sys.argv) > 4 else None)
    else:
        sys.exit(check(folder))


if __name__ == "__main__":
    main()
