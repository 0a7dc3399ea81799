#!/usr/bin/env python3
"""What is linked into the library, the command line, the Python wheel's library or the page's WebAssembly: third-party notices
and a bill of materials (CycloneDX).

    bill.py library|program|wheel|page notices|sbom TARGET...   prints it, for these targets of rustc; the same bytes on every run

Read from cargo and the sources that it has fetched: normal dependencies, and for the command line, which is an example,
those of examples too; without what only runs while it is built.
"""

import json
import re
import subprocess
import sys
import uuid
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OWN = {"superdeform", "superdeform-files", "superdeform-host", "superdeform-web"}
INDEX = "registry+https://github.com/rust-lang/crates.io-index"

HEAD = """# Third-party notices

{what} links the Rust packages below, and Rust's standard library (MIT OR Apache-2.0, https://github.com/rust-lang/rust).
"""
TABLE = """
Where a package offers several licences, it is used under MIT, where that is none of them under all. The texts follow the table.

| Package | Version | Licence | Source |
| --- | --- | --- | --- |
"""
WHAT = {"library": "The library", "program": "The command line `superdeform`", "wheel": "The Python wheel's library",
        "page": "The WebAssembly of the page and of the npm package"}
PACKAGE = {"wheel": "superdeform-files", "page": "superdeform-web"}


def cargo(*arguments):
    return subprocess.run(["cargo", *arguments], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def linked(what, targets):
    """Name, version, licence and source of all that is linked, by name."""
    edges = "normal,dev,no-proc-macro" if what == "program" else "normal,no-proc-macro"
    more = ["--package", "superdeform-host", "--features", "superdeform-host/meshopt"] if what == "program" else []
    found = set()
    for target in targets:
        lines = cargo("tree", "--locked", "--edges", edges, "--prefix", "none", "--package", PACKAGE.get(what, "superdeform"), *more,
                      "--target", target, "--format", "{p}|{l}|{r}").splitlines()
        for line in filter(None, lines):
            name, licence, source = line.replace(" (*)", "").split("|")
            name, version = name.split(" ")[:2]
            if name not in OWN:
                found.add((name, version.lstrip("v"), re.sub(r"\s*/\s*", " OR ", licence), source))
    return sorted(found)


def metadata():
    """What cargo knows of the lock file: each package by name and version, and what each of them needs."""
    whole = json.loads(cargo("metadata", "--locked", "--format-version", "1", "--features", "superdeform-host/meshopt"))
    return {(package["name"], package["version"]): package for package in whole["packages"]}, whole["resolve"]["nodes"]


def text_of(folder, licence):
    """The MIT text of a package's folder, else all its licences; their copyright lines differ from package to package."""
    named = sorted(path for path in folder.iterdir()
                   if re.match(r"(?i)(licen[cs]e|copying|unlicense)", path.name) and path.is_file())
    texts = {path: path.read_text(encoding="utf-8", errors="replace").strip() for path in named}
    mit = [path for path in named if re.search(r"(?i)mit", path.name)]
    if "MIT" in licence:
        named = [path for path in mit + named if "Permission is hereby granted, free of charge" in texts[path]][:1]
    elif not named:
        sys.exit(f"{folder.name} is under {licence} and carries no text: put it into the notices by hand")
    return "\n\n".join("\n".join(line.rstrip() for line in texts[path].splitlines()) for path in named)


def texts(found):
    """A chapter for each text, under the names of the packages that it is of."""
    known, _ = metadata()
    of = {}
    for name, version, licence, _ in found:
        text = text_of(Path(known[name, version]["manifest_path"]).parent, licence)
        of.setdefault(text, []).append(name)
    chapters = []
    for text, names in sorted(of.items(), key=lambda item: item[1]):
        body = f"```\n{text}\n```\n" if text else "MIT; the package carries no text of its own.\n"
        chapters.append(f"\n## {', '.join(names)}\n\n{body}")
    return "".join(chapters)


def rows(found):
    return "".join(f"| {name} | {version} | {licence} | {source} |\n" for name, version, licence, source in found)


def notices(what, targets):
    found = linked(what, targets)
    return HEAD.format(what=WHAT[what]) + TABLE + rows(found) + texts(found)


def sbom(what, targets):
    """CycloneDX 1.5."""
    known, resolved = metadata()
    lock = re.findall(r'\[\[package\]\]\nname = "(.+?)"\nversion = "(.+?)"\n(?:source = "(.+?)"\nchecksum = "(.+?)"\n)?',
                      (ROOT / "Cargo.lock").read_text())
    checksums = {(name, version): checksum for name, version, source, checksum in lock if source == INDEX}
    found = linked(what, targets)
    here = {(name, version) for name, version, *_ in found}
    names = {package["id"]: key for key, package in known.items()}
    edges = {names[node["id"]]: sorted({names[of] for of in node["dependencies"]} & here) for node in resolved}
    url = lambda key: f"pkg:cargo/{key[0]}@{key[1]}"
    own = next(key for key in known if key[0] == PACKAGE.get(what, "superdeform"))

    def component(name, version, licence, source):
        made = {"type": "library", "bom-ref": url((name, version)), "name": name, "version": version,
                "purl": url((name, version)), "licenses": [{"expression": licence}]}
        if (name, version) in checksums:
            made["hashes"] = [{"alg": "SHA-256", "content": checksums[name, version]}]
        if source:
            made["externalReferences"] = [{"type": "vcs", "url": source}]
        return made

    direct = sorted({of for name in OWN for key in edges if key[0] == name for of in edges[key]})
    bill = {
        "$schema": "http://cyclonedx.org/schema/bom-1.5.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application" if what == "program" else "library", "bom-ref": url(own),
                                   "name": own[0], "version": own[1], "purl": url(own),
                                   "licenses": [{"expression": "MIT OR Apache-2.0"}]}},
        "components": [component(*row) for row in found],
        "dependencies": [{"ref": url(own), "dependsOn": [url(of) for of in direct]}] +
                        [{"ref": url(key), "dependsOn": [url(of) for of in edges[key]]} for key in sorted(here)],
    }
    text = json.dumps(bill, sort_keys=True)
    bill["serialNumber"] = uuid.uuid5(uuid.NAMESPACE_URL, text).urn
    return json.dumps(bill, indent=2) + "\n"


def main():
    what, kind, *targets = sys.argv[1:]
    sys.stdout.write({"notices": notices, "sbom": sbom}[kind](what, targets))


if __name__ == "__main__":
    main()
