#!/usr/bin/env python3
"""What a player of each system gets of the package: compiles the assemblies that Unity would compile for it, and looks for
the library's functions in them. A function that is imported there, the linker of iOS and of the web cannot find.

players.py STANDINS OUT   STANDINS: folder with the stand-ins' assemblies; OUT: folder for what is compiled

Ends with `N passed, N failed`; exit code 1 where one failed.
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# The name in assembly definitions, and the symbols that Unity defines for its players.
PLATFORMS = {
    "iOS": ["UNITY_IOS", "ENABLE_IL2CPP"], "WebGL": ["UNITY_WEBGL", "ENABLE_IL2CPP"],
    "Android": ["UNITY_ANDROID", "ENABLE_IL2CPP"], "WindowsStandalone64": ["UNITY_STANDALONE", "UNITY_STANDALONE_WIN"],
    "LinuxStandalone64": ["UNITY_STANDALONE", "UNITY_STANDALONE_LINUX"],
    "macOSStandalone": ["UNITY_STANDALONE", "UNITY_STANDALONE_OSX"],
}


def holds(constraint, defines):
    """Unity's rule: words with || between them, of which one must hold; ! before a word turns it round."""
    words = [word.strip() for word in constraint.split("||")]
    return any((word[1:] not in defines) if word.startswith("!") else word in defines for word in words)


def compiled(definition, platform, defines):
    include, exclude = definition["includePlatforms"], definition["excludePlatforms"]
    return ((not include or platform in include) and platform not in exclude
            and all(holds(constraint, defines) for constraint in definition["defineConstraints"]))


def player(standins, out, platform, extra):
    """The player's assemblies of the package: name -> whether they import the library."""
    # With every package there that an assembly looks for: so more is compiled, not less.
    definitions = {path: json.loads(path.read_text(encoding="utf-8")) for path in sorted(ROOT.rglob("*.asmdef"))
                   if not any(part.endswith("~") for part in path.relative_to(ROOT).parts)}
    found = {}
    for path, definition in definitions.items():
        defines = ["UNITY_5_3_OR_NEWER", "UNITY_2021_3_OR_NEWER", *PLATFORMS[platform], *extra]
        defines += [entry["define"] for entry in definition["versionDefines"]]
        if not compiled(definition, platform, defines):
            continue
        nested = [other.parent for other in definitions if other != path]
        sources = [str(source) for source in sorted(path.parent.rglob("*.cs"))
                   if not any(folder in source.parents and path.parent in folder.parents for folder in nested)]
        made = out / f"{definition['name']}.{platform}{'.'.join(['', *extra])}.dll"
        references = [str(standins / f"{name}.dll") for name in ("UnityEngine", *definition["references"])
                      if (standins / f"{name}.dll").exists()]
        subprocess.run(["mcs", "-nologo", "-langversion:7.2", "-unsafe", "-target:library", f"-out:{made}",
                        *[f"-r:{reference}" for reference in references], *[f"-d:{define}" for define in defines],
                        *sources], check=True)
        found[definition["name"]] = b"sdef_" in made.read_bytes()
    return found


def main():
    standins, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    passed = failed = 0
    for platform in PLATFORMS:
        for extra in ([], ["SUPERDEFORM_RUNTIME"]):
            found = player(standins, out, platform, extra)
            # Asked for, it is there: so the look for it is a look that sees.
            right = any(found.values()) == bool(extra)
            passed, failed = passed + right, failed + (not right)
            print(f"{'passed' if right else 'FAILED'}: {platform} {' '.join(extra)}: {found}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
