#!/usr/bin/env python3
"""Writes the .meta of every file and folder of the package; a GUID is the MD5 of package name and path, and so stays.

metas.py [ROOT]          writes what is missing, mends what differs, removes what belongs to nothing
metas.py [ROOT] --check  changes nothing; exit code 1 where something is missing, orphaned, doubled or different

ROOT is the package's folder (default: the one that holds this script's folder). Names that end in ~ or begin with a dot
are not seen by Unity and get no meta. Libraries in Plugins get theirs like everything else, so they are packed together.
"""

import hashlib
import sys
from pathlib import Path

PACKAGE = "com.superdeform.converter"

# Editor only: the library converts in the editor; a player would carry it without use.
LIBRARIES = {"superdeform.dll": ("x86_64", "Windows"), "libsuperdeform.so": ("x86_64", "Linux"),
             "libsuperdeform.dylib": ("AnyCPU", "OSX")}

TAIL = "  userData: \n  assetBundleName: \n  assetBundleVariant: \n"
PLAIN = "  externalObjects: {}\n" + TAIL
MONO = ("  externalObjects: {}\n  serializedVersion: 2\n  defaultReferences: []\n  executionOrder: 0\n"
        "  icon: %s\n" + TAIL)

# What objects and assets of these classes are drawn with.
ICON = "Editor/Icons/SuperDeform.png"
WITH_ICON = {"SuperDeformAvatar.cs", "SuperDeformPreset.cs"}

# A picture of the editor's own drawing: as it lies there, in its own pixels.
TEXTURE = """  internalIDToNameTable: []
  externalObjects: {}
  serializedVersion: 11
  mipmaps:
    mipMapMode: 0
    enableMipMap: 0
    sRGBTexture: 0
  isReadable: 0
  textureFormat: 1
  maxTextureSize: 2048
  textureSettings:
    serializedVersion: 2
    filterMode: 1
    aniso: 1
    mipBias: 0
    wrapU: 1
    wrapV: 1
    wrapW: 1
  nPOTScale: 0
  alphaUsage: 1
  alphaIsTransparency: 1
  textureType: 2
  textureShape: 1
  platformSettings:
  - serializedVersion: 3
    buildTarget: DefaultTexturePlatform
    maxTextureSize: 2048
    resizeAlgorithm: 0
    textureFormat: -1
    textureCompression: 0
    compressionQuality: 50
    crunchedCompression: 0
    allowsAlphaSplitting: 0
    overridden: 0
"""

PLUGIN = """  externalObjects: {{}}
  serializedVersion: 2
  iconMap: {{}}
  executionOrder: {{}}
  defineConstraints: []
  isPreloaded: 0
  isOverridable: 0
  isExplicitlyReferenced: 0
  validateReferences: 1
  platformData:
  - first:
      : Any
    second:
      enabled: 0
      settings:
        Exclude Editor: 0
        Exclude Linux64: 1
        Exclude OSXUniversal: 1
        Exclude Win: 1
        Exclude Win64: 1
  - first:
      Any: 
    second:
      enabled: 0
      settings: {{}}
  - first:
      Editor: Editor
    second:
      enabled: 1
      settings:
        CPU: {processor}
        DefaultValueInitialized: true
        OS: {system}
  - first:
      Standalone: Linux64
    second:
      enabled: 0
      settings:
        CPU: None
  - first:
      Standalone: OSXUniversal
    second:
      enabled: 0
      settings:
        CPU: None
  - first:
      Standalone: Win
    second:
      enabled: 0
      settings:
        CPU: None
  - first:
      Standalone: Win64
    second:
      enabled: 0
      settings:
        CPU: None
"""


def seen(root):
    """Every file that Unity imports and every folder with such a file, relative to the root, without metas."""
    found = set()
    for path in root.rglob("*"):
        parts = path.relative_to(root).parts
        if hidden(parts) or path.suffix == ".meta" or path.is_dir():
            continue
        # An empty folder is no part of a package: neither git nor a tarball of files keeps it.
        found.update("/".join(parts[:depth]) for depth in range(1, len(parts) + 1))
    return sorted(found)


def hidden(parts):
    return any(part.endswith("~") or part.startswith(".") for part in parts)


def guid(path):
    return hashlib.md5(f"{PACKAGE}/{path}".encode()).hexdigest()


def importer(root, path):
    """The importer's block, as Unity 2021.3 writes it."""
    name = path.rsplit("/", 1)[-1]
    suffix = name.rsplit(".", 1)[-1].lower()
    if (root / path).is_dir():
        return "folderAsset: yes\nDefaultImporter:\n" + PLAIN
    if name in LIBRARIES:
        processor, system = LIBRARIES[name]
        return "PluginImporter:\n" + PLUGIN.format(processor=processor, system=system) + TAIL
    if path == "package.json":
        return "PackageManifestImporter:\n" + PLAIN
    if suffix == "cs":
        shown = f"{{fileID: 2800000, guid: {guid(ICON)}, type: 3}}" if name in WITH_ICON else "{instanceID: 0}"
        return "MonoImporter:\n" + MONO % shown
    if suffix == "png":
        return "TextureImporter:\n" + TEXTURE + TAIL
    if suffix == "asmdef":
        return "AssemblyDefinitionImporter:\n" + PLAIN
    if suffix in ("json", "md", "txt"):
        return "TextScriptImporter:\n" + PLAIN
    return "DefaultImporter:\n" + PLAIN


def wanted(root):
    """The text of every meta, by its path."""
    return {f"{path}.meta": f"fileFormatVersion: 2\nguid: {guid(path)}\n{importer(root, path)}" for path in seen(root)}


def present(root):
    return {path.relative_to(root).as_posix(): path for path in root.rglob("*.meta")
            if not hidden(path.relative_to(root).parts)}


def faults(root):
    """A sentence for everything that `metas.py` would change, and for every GUID that two metas share."""
    said, owners = [], {}
    should, there = wanted(root), present(root)
    for path in sorted(should.keys() - there.keys()):
        said.append(f"{path} is missing: run metas.py")
    for path in sorted(there.keys() - should.keys()):
        said.append(f"{path} belongs to no file: run metas.py")
    for path in sorted(there):
        text = there[path].read_text(encoding="utf-8")
        lines = [line for line in text.splitlines() if line.startswith("guid: ")]
        if len(lines) == 1:
            owners.setdefault(lines[0][6:], []).append(path)
        if path in should and text != should[path]:
            said.append(f"{path} differs from what metas.py writes: run metas.py")
    for owner, paths in sorted(owners.items()):
        if len(paths) > 1:
            said.append(f"GUID {owner} stands in {' and '.join(paths)}: run metas.py")
    return said


def write(root):
    """Makes the metas right; gives the number of files changed."""
    should, there = wanted(root), present(root)
    changed = 0
    for path in there.keys() - should.keys():
        there[path].unlink()
        changed += 1
    for path, text in should.items():
        if path not in there or there[path].read_text(encoding="utf-8") != text:
            (root / path).write_text(text, encoding="utf-8", newline="\n")
            changed += 1
    return changed


def main(arguments):
    check = "--check" in arguments
    names = [argument for argument in arguments if argument != "--check"]
    root = Path(names[0]) if names else Path(__file__).resolve().parent.parent
    if not check:
        print(f"{write(root)} changed, {len(wanted(root))} metas")
        return 0
    said = faults(root)
    for sentence in said:
        print(sentence)
    print(f"{len(wanted(root))} metas, {len(said)} faults")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
