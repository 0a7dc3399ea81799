#!/usr/bin/env python3
"""Checks the package without Unity: metas, manifest, assemblies, imports, API, texts, libraries.

package_check.py        checks the package of this repository; then tries each check on a copy with a fault put in:
                        a check that says nothing there is broken itself
package_check.py ROOT   checks a package elsewhere, such as one unpacked from a tarball

Each check gives a sentence for each fault. Ends with `N passed, N failed`; exit code 1 where one failed.
"""

import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import metas  # noqa: E402
from package_faults import FAULTS  # noqa: E402

REPOSITORY = HERE.parent.parent
NAME = metas.PACKAGE

# Assemblies that other packages bring, and the one define without which they may be missing (None: always there).
FOREIGN = {"UnityEngine.TestRunner": "UNITY_INCLUDE_TESTS", "UnityEditor.TestRunner": "UNITY_INCLUDE_TESTS",
           "VRM": "SUPERDEFORM_VRM0", "VRM10": "SUPERDEFORM_VRM1", "nadena.dev.ndmf": "SUPERDEFORM_NDMF",
           "nadena.dev.ndmf.runtime": "SUPERDEFORM_NDMF"}

# Assemblies that use one of those where its define stands, and compile without.
EITHER_WAY = {"SuperDeform.Avatar", "SuperDeform.Editor"}

# What Unity 2021.3 or the C# and .NET of its editor do not know. That everything else exists there is seen by compiling
# against the stubs, which hold nothing newer; this list names what is written by habit.
NEWER = {
    r"\bFind(Objects|FirstObject|AnyObject)ByType\b": "Object.FindObjectsOfType",
    r"\bFindObjectsSortMode\b": "Object.FindObjectsOfType",
    r"\bAwaitable\b": "a coroutine or EditorApplication.update",
    r"\bdestroyCancellationToken\b|\bexitCancellationToken\b": "a token of your own",
    r"\b(Get|Set)(Local)?PositionAndRotation\s*\(\s*out\b": "position and rotation one by one",
    r"\b(Inverse)?Transform(Points|Vectors|Directions)\s*\(": "TransformPoint for each",
    r"\bAssetPathExists\b": "AssetDatabase.GetMainAssetTypeAtPath",
    r"\bReplacePrefabAssetOfPrefabInstance\b|\bConvertToPrefabInstance\b|\bFindAllInstancesOfPrefab\b":
        "PrefabUtility.SaveAsPrefabAsset",
    r"\bPhysicsMaterial\b|\blinearVelocity\b|\blinearDamping\b": "the names before Unity 6",
    r"\bGetEntityId\b|\bEntityId\b|\bInstantiateAsync\b": "the names before Unity 6",
    r"\blodSelectionCurve\b|\bMeshLodUtility\b": "no levels of detail in meshes",
    r"\[UxmlElement|\[UxmlAttribute": "IMGUI",
    r"\bArgumentNullException\.ThrowIfNull\b|\bRandom\.Shared\b|\bConvert\.ToHexString\b|\bSystem\.Text\.Json\b"
    r"|\bEnvironment\.ProcessId\b|\bFile\.(Write|Read)AllTextAsync\b.*\bappend\b": "what .NET Standard 2.1 has",
    r"^\s*namespace\s+[\w.]+\s*;": "a namespace with braces",
    r"\bglobal\s+using\b|\brecord\s+(class\s+|struct\s+)?\w+|\brequired\s+\w+\s+\w+\s*\{": "C# 7.2",
    r"\{[^}]*\binit\s*;": "set",
}

# What Unity refuses to compile from 6000.5 on. Of all other members that the package names, none is gone in 6000.7.0a1 or an error there.
GONE = {
    r"\b\w*[iI]nstanceID\w*\b": "GetEntityId",
}


# Which types come with which module of Unity.
MODULES = {
    "animation": "Animator|Avatar|AvatarBuilder|HumanDescription|HumanBodyBones|AnimationClip",
    "audio": "AudioSource|AudioClip", "cloth": "Cloth|ClothSphereColliderPair",
    "imageconversion": "ImageConversion|EncodeToPNG", "imgui": "GUI|GUILayout|GUIStyle|GUIContent",
    "jsonserialize": "JsonUtility", "particlesystem": "ParticleSystem",
    "physics": "SphereCollider|CapsuleCollider|BoxCollider|MeshCollider|CharacterController|Rigidbody|Joint",
    "physics2d": "Collider2D|Rigidbody2D", "uielements": "VisualElement", "unitywebrequest": "UnityWebRequest",
}


def read(path):
    return path.read_text(encoding="utf-8")


def sources(root, folder=""):
    """C# files that Unity compiles, and those of the samples."""
    return sorted(path for path in (root / folder).rglob("*.cs")
                  if not metas.hidden(path.relative_to(root).parts[:-1]) or "Samples~" in path.relative_to(root).parts)


def bare(text):
    """C# without comments and without what stands in quotes."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|@"(?:[^"]|"")*"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'',
                  lambda match: '""' if match.group()[0] in '@"' else " ", text, flags=re.S)


def assemblies(root):
    return {path: json.loads(read(path)) for path in sorted(root.rglob("*.asmdef"))
            if not metas.hidden(path.relative_to(root).parts)}


def owner(root, source, definitions):
    """The assembly definition whose folder is nearest above a source."""
    for folder in source.parents:
        for path in definitions:
            if path.parent == folder:
                return path
        if folder == root:
            return None
    return None


def check_metas(root):
    return metas.faults(root)


def check_json(root):
    said = []
    for path in sorted(root.rglob("*.json")) + sorted(root.rglob("*.asmdef")):
        try:
            json.loads(read(path))
        except ValueError as error:
            said.append(f"{path.relative_to(root)}: {error}")
    return said


def check_manifest(root):
    said = []
    manifest = json.loads(read(root / "package.json"))
    for key, value in {"name": NAME, "unity": "2021.3", "license": "MIT OR Apache-2.0"}.items():
        if manifest.get(key) != value:
            said.append(f"package.json: {key} is {manifest.get(key)!r}, not {value!r}")
    version = manifest.get("version", "")
    cargo = root.parent / "Cargo.toml"
    cargo = cargo if cargo.exists() else REPOSITORY / "Cargo.toml"
    library = re.search(r'^version = "(.*)"$', read(cargo), re.M).group(1) if cargo.exists() else version
    if version != library:
        said.append(f"package.json: version is {version}, the library's is {library}")
    if f"## [{version}]" not in read(root / "CHANGELOG.md"):
        said.append(f"CHANGELOG.md has no entry for {version}")
    for sample in manifest.get("samples", []):
        if not any((root / sample["path"]).rglob("*.cs")):
            said.append(f"package.json: the sample {sample['displayName']} has no script in {sample['path']}")
    for file in ["README.md", "CHANGELOG.md", "LICENSE.md", "Third Party Notices.md", "Documentation~/superdeform.md"]:
        if not (root / file).is_file():
            said.append(f"{file} is missing")
    return said


def check_modules(root):
    """Unity's own modules can be turned off in a project: those whose types are used are named in the manifest."""
    needed = set(json.loads(read(root / "package.json")).get("dependencies", {}))
    text = "\n".join(bare(read(source)) for source in sources(root) if "Tests" not in source.parts)
    used = {f"com.unity.modules.{module}" for module, types in MODULES.items() if re.search(rf"\b({types})\b", text)}
    return ([f"package.json names no {module}, of which types are used" for module in sorted(used - needed)]
            + [f"package.json names {module}, of which nothing is used" for module in sorted(needed - used)])


def check_paths(root):
    said, lower = [], {}
    for path in metas.seen(root):
        if path.lower() in lower:
            said.append(f"{path} and {lower[path.lower()]} are one file on Windows")
        lower[path.lower()] = path
        # Library/PackageCache/NAME@VERSION before it, and Windows takes 260.
        if len(path) > 140:
            said.append(f"{path} is too long for Windows")
    return said


def check_assemblies(root):
    said = []
    definitions = assemblies(root)
    names = {definition["name"]: path for path, definition in definitions.items()}
    if len(names) != len(definitions):
        said.append("two assemblies have the same name")
    for path, definition in definitions.items():
        name = definition["name"]
        if path.stem != name:
            said.append(f"{path.relative_to(root)} defines {name}")
        defines = {entry["define"] for entry in definition.get("versionDefines", [])} | {"UNITY_INCLUDE_TESTS"}
        for reference in definition.get("references", []):
            if reference in names:
                other = definitions[names[reference]]
                if "Editor" in other["includePlatforms"] and "Editor" not in definition["includePlatforms"]:
                    said.append(f"{name} is for all platforms but refers to {reference}, which is for the editor")
            elif reference not in FOREIGN:
                said.append(f"{name} refers to {reference}, which nobody defines")
            elif FOREIGN[reference] not in defines or (name not in EITHER_WAY
                                                       and FOREIGN[reference] not in definition["defineConstraints"]):
                said.append(f"{name} refers to {reference} but compiles where that is missing: constrain it to "
                            f"{FOREIGN[reference]}")
    for source in sources(root):
        path = owner(root, source, definitions)
        if path is None:
            if "Samples~" not in source.parts:
                said.append(f"{source.relative_to(root)} belongs to no assembly")
            continue
        definition = definitions[path]
        text = bare(read(source))
        if definition["noEngineReferences"] and re.search(r"\bUnity(Engine|Editor)\b", text):
            said.append(f"{source.relative_to(root)} uses the engine, but {definition['name']} does without")
        if re.search(r"\bunsafe\b", text) and not definition["allowUnsafeCode"]:
            said.append(f"{source.relative_to(root)} is unsafe, but {definition['name']} does not allow it")
        if re.search(r"\bUnityEditor\b", text) and "Editor" not in definition["includePlatforms"]:
            said.append(f"{source.relative_to(root)} uses the editor, but {definition['name']} is for all platforms")
    return said


def header(root):
    for folder in (root.parent, REPOSITORY):
        path = folder / "include" / "superdeform.h"
        if path.is_file():
            return read(path)
    return None


def check_imports(root):
    """The C# imports are the header's functions."""
    declared = header(root)
    if declared is None:
        return []
    functions = set(re.findall(r"^(?!//)[^\n(]*?\b(sdef_\w+)\(", declared, re.M))
    imports = read(root / "Runtime" / "Native.g.cs")
    imported = re.findall(r"\[DllImport\([^\]]*\]\s*internal static[^;(]*?\b(sdef_\w+)\s*\(", imports)
    said = [f"{name} stands in the header but is not imported" for name in sorted(functions - set(imported))]
    said += [f"{name} is imported but stands not in the header" for name in sorted(set(imported) - functions)]
    if imports.count("[DllImport") != len(imported) or not functions:
        said.append(f"{imports.count('[DllImport')} imports, {len(imported)} understood, {len(functions)} functions")
    version = re.search(r"#define SDEF_ABI_VERSION (\d+)", declared).group(1)
    if f"SDEF_ABI_VERSION = {version};" not in imports:
        said.append(f"the header's ABI version {version} is not that of the imports")
    return said


def by_editor(lines):
    """(Number, line, whether editors compile it: those of 2021.3, the newest) of a source."""
    old = new = True
    for number, line in enumerate(lines, 1):
        directive = line.strip()
        if directive.startswith("#if"):
            newer = re.search(r"(!?)\bUNITY_6000_\d+_OR_NEWER", directive)
            old, new = (True, True) if newer is None else (bool(newer.group(1)), not newer.group(1))
        elif directive.startswith("#else"):
            old, new = (True, True) if old and new else (new, old)
        elif directive.startswith("#endif"):
            old = new = True
        yield number, line, old, new


def check_api(root):
    said = []
    for source in sources(root):
        for number, line, old, new in by_editor(bare(read(source)).splitlines()):
            for pattern, instead in NEWER.items():
                if old and re.search(pattern, line):
                    said.append(f"{source.relative_to(root)}:{number} is newer than 2021.3: use {instead}")
            for pattern, instead in GONE.items():
                if new and re.search(pattern, line):
                    said.append(f"{source.relative_to(root)}:{number} is no more in 6000.5: use {instead} where UNITY_6000_5_OR_NEWER stands")
    return said


# What holds a statement, with its condition, on a line or on several.
HOLDER = re.compile(r"(?:else if|if|for|foreach|while|using|lock|fixed) \(|else$")


def alone(lines):
    """The numbers of lines whose statement stands on a line of its own without braces."""
    for start, line in enumerate(lines):
        text = line.strip()
        if not HOLDER.match(text):
            continue
        depth, end = 0, start
        for end in range(start, len(lines)):
            depth += lines[end].count("(") - lines[end].count(")")
            if depth <= 0:
                break
        below = next((line for line in lines[end + 1:] if line.strip()), "")
        deeper = len(below) - len(below.lstrip()) > len(line) - len(line.lstrip())
        if lines[end].rstrip().endswith((")", "else")) and deeper and not below.strip().startswith("{"):
            yield start + 1


# Names of types that stand twice in a declaration, and `var` where the type is not named at all.
TYPE_TWICE = re.compile(r"\s*(?:using \()?([A-Z][\w<>\[\],. ]*?) \w+ = new \1(?:[({;]| [({]|$)(?!.*\)\.)")
TYPE_NOWHERE = re.compile(r"\bvar \w+ = (?!new [\w(])")


def wordy(lines):
    """(Number, sentence) of what C# 7 says in fewer words: it is the newest that mono compiles; Unity 2021.3 knows C# 9."""
    for number, line in enumerate(lines, 1):
        text, below = line.strip(), [other.strip() for other in lines[number:number + 3]]
        if re.search(r"[^=] \{ get \{ return [^;]*; \} \}$", text):
            yield number, "is a property that only returns: write =>"
        if below[:1] == ["{"] and below[2:] == ["}"] and len(line) + len(below[1]) < 142:
            getter = re.match(r"get \{ return .*; \}$", below[1])
            method = re.match(r"return .*;$", below[1]) and re.match(r"(?!else|if|for|while|switch|using|lock|fixed|catch)[\w<>\[\],. ]+ \w+(<\w+>)?\(", text)
            if getter or method and "delegate" not in text:
                yield number, "only returns: write =>"
        declared = re.match(r"(?!return|using|throw|goto)[\w<>\[\], .]+ (\w+);$", text)
        if declared and below and re.search(rf"\bout {declared.group(1)}\b", below[0]) and not re.search(rf"\b{declared.group(1)}\b.*\bout {declared.group(1)}", below[0]):
            yield number, "declares what an out parameter receives: write the type behind out"
        # Several things of one type are declared by its name.
        if TYPE_TWICE.match(line) and not re.search(r"\), \w+ = ", line):
            yield number, "names a type twice: write var"
        if TYPE_NOWHERE.search(line):
            yield number, "does not say of which type it is: write the type"


def check_dialect(root):
    """One way to write C#: what is private is not said to be; a statement stands behind its condition, or in braces; few words."""
    said = []
    # Stand-ins of others' classes are written as those are.
    tests = sorted(path for path in (root / "Tests~").rglob("*.cs") if "Stubs" not in str(path.relative_to(root)))
    for source in sources(root) + tests:
        if source.name.endswith(".g.cs"):
            continue
        lines = [bare(line) for line in read(source).splitlines()]
        said += [f"{source.relative_to(root)}:{number} says private: leave it out"
                 for number, line in enumerate(lines, 1) if re.match(r"\s*(?:\[[^]]*\] )*private (?!protected)", line)]
        said += [f"{source.relative_to(root)}:{number} has its statement on a line of its own: put it behind, or in braces"
                 for number in alone(lines)]
        if source not in tests:
            said += [f"{source.relative_to(root)}:{number} {what}" for number, what in wordy(lines)]
    return said


def texts(root, language):
    return json.loads(read(root / "Editor" / "Localization" / f"{language}.json"))


def keys_used(root):
    """Keys in the sources: what is handed to Strings.Get or said of a finding."""
    used = {}
    for source in sources(root, "Editor"):
        # Comments show examples.
        text = re.sub(r"^\s*//[^\n]*", "", read(source), flags=re.M)
        for key in re.findall(r'(?:Strings\.Get|Finding|WithFix|FixKey\s*=|Key\s*=)\s*\(?\s*"([\w.]+)"(?!\s*\+)', text):
            used.setdefault(key, source.relative_to(root))
    return used


def check_strings(root):
    said = []
    english = texts(root, "en")
    for language, name in {"ja": "Japanese", "ko": "Korean", "zh": "Chinese"}.items():
        other = texts(root, language)
        said += [f"en.json lacks {key}" for key in sorted(other.keys() - english.keys())]
        said += [f"{language}.json lacks {key}" for key in sorted(english.keys() - other.keys())]
        for key in sorted(english.keys() & other.keys()):
            places = [set(re.findall(r"\{(\d+)", text)) for text in (english[key], other[key])]
            if places[0] != places[1]:
                said.append(f"{key} has the values {sorted(places[0])} in English, {sorted(places[1])} in {name}")
    for key, source in sorted(keys_used(root).items()):
        if key not in english:
            said.append(f"{source} says {key}, of which en.json knows nothing")
    literals = set(re.findall(r'"([\w.]+)"', "\n".join(read(source) for source in sources(root, "Editor"))))
    for key in sorted(english):
        if not is_said(key, literals):
            said.append(f"nothing says {key}: delete it from the texts")
    return said


def is_said(key, literals):
    """Does it stand in the sources, whole or put together: "group." + name, or key + ".tooltip"?"""
    heads = {key[:place + 1] for place in range(len(key)) if key[place] in "._"}
    base, dot, tail = key.rpartition(".")
    return key in literals or bool(heads & literals) or (dot + tail in literals and is_said(base, literals))


def failures(root):
    """Keys whose sentence a person reads when something is wrong: findings have no dot in their keys."""
    kinds = (r"(error|warning|menu)\.|report\.(no_|not_)|batch\.(no|not|bad|two|style_not|unknown|twice)"
             r"|(?!stage_|fix|show$)\w+$")
    return [key for key in texts(root, "en") if re.match(kinds, key)]


def plain(text):
    """Words alone: marks of Markdown and values do not count."""
    return re.sub(r"[\s`*_|]+", " ", re.sub(r"\{\d+[^}]*\}", "…", text)).strip()


def check_documentation(root):
    """Every sentence of a failure stands in the manual; so does every link's target."""
    manual = read(root / "Documentation~" / "superdeform.md")
    words = plain(manual)
    said = [f"Documentation~/superdeform.md does not explain {key}: {texts(root, 'en')[key]}"
            for key in failures(root) if plain(texts(root, "en")[key]) not in words]
    for page in [root / "README.md", *sorted((root / "Documentation~").glob("*.md"))]:
        for target in re.findall(r"\]\((?!https?:|#)([^)#]+)", read(page)):
            if not (page.parent / target.replace("%20", " ")).exists():
                said.append(f"{page.relative_to(root)} links to {target}, which is not there")
    return said


MAGIC = {"superdeform.dll": (b"MZ",), "libsuperdeform.so": (b"\x7fELF",),
         "libsuperdeform.dylib": (b"\xca\xfe\xba\xbe", b"\xcf\xfa\xed\xfe")}


def check_libraries(root):
    """Libraries of a packed tree are what their names say and bring every function."""
    said = []
    plugins = root / "Plugins"
    if not plugins.is_dir():
        return said
    declared = header(root)
    for path in sorted(file for file in plugins.rglob("*") if file.is_file() and file.suffix != ".meta"):
        content = path.read_bytes()
        if path.name not in MAGIC or not content.startswith(MAGIC[path.name]):
            said.append(f"{path.relative_to(root)} is no library for its system")
        for name in set(re.findall(r"^(?!//)[^\n(]*?\b(sdef_\w+)\(", declared or "", re.M)):
            if name.encode() not in content:
                said.append(f"{path.relative_to(root)} has no {name}: it is another version's")
    return said


CHECKS = [check_metas, check_json, check_manifest, check_modules, check_paths, check_assemblies, check_imports, check_api,
          check_dialect, check_strings, check_documentation, check_libraries]


def try_checks(root, result):
    """Each check finds the faults that are there to be found."""
    print("=== each check, on a copy with a fault")
    with tempfile.TemporaryDirectory() as folder:
        for name, fault, damage, words in FAULTS:
            check = globals()["check_" + name]
            copy = Path(folder) / "package"
            shutil.copytree(root, copy, ignore=shutil.ignore_patterns("Tests~", "Plugins", "Plugins.meta"))
            try:
                damage(copy)
                said = check(copy)
                result(f"{name} finds {fault}",
                       [] if any(words in sentence for sentence in said) else [f"it said {said}, not {words!r}"])
            except (OSError, ValueError, KeyError, AssertionError) as error:
                result(f"{name} finds {fault}", [repr(error)])
            shutil.rmtree(copy)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent).resolve()
    passed = failed = 0

    def result(name, said):
        nonlocal passed, failed
        passed, failed = passed + (not said), failed + bool(said)
        print(f"{'FAILED' if said else 'passed'}: {name}")
        for sentence in said:
            print(f"    {sentence}")

    print(f"=== {root}")
    for check in CHECKS:
        try:
            result(check.__name__[6:], check(root))
        except (OSError, ValueError, KeyError) as error:
            result(check.__name__[6:], [f"cannot be checked: {error!r}"])
    if header(root) is None:
        print("    without include/superdeform.h: imports and libraries were not compared with it")

    if len(sys.argv) == 1:
        try_checks(root, result)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
