"""Faults put into a copy of the package, one for each thing that package_check.py must see."""

import shutil


def read(path):
    return path.read_text(encoding="utf-8")


def edit(path, before, after):
    text = read(path)
    if before not in text:
        raise AssertionError(f"{path} has no {before!r} to break")
    path.write_text(text.replace(before, after, 1), encoding="utf-8")


def put(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


# The check that must find it, what is broken, how, and words of the sentence that the check must then say.
FAULTS = [
    ("metas", "a file without meta", lambda root: (root / "README.md.meta").unlink(), "README.md.meta is missing"),
    ("metas", "a meta without file", lambda root: put(root / "gone.txt.meta", "guid: 1\n"), "belongs to no file"),
    ("metas", "a GUID twice", lambda root: (root / "README.md.meta").write_text(read(root / "LICENSE.md.meta")),
     "GUID"),
    ("metas", "another importer", lambda root: edit(root / "Runtime/Native.g.cs.meta", "MonoImporter", "Default"),
     "differs"),
    ("json", "a comma too many", lambda root: edit(root / "package.json", "{", "{,"), "package.json"),
    ("manifest", "another version", lambda root: edit(root / "package.json", '"version": "', '"version": "9'),
     "version is 9"),
    ("manifest", "a version without a word of what is new",
     lambda root: edit(root / "CHANGELOG.md", "## [1", "## [Unreleased"), "CHANGELOG.md has no entry"),
    ("manifest", "a newer editor", lambda root: edit(root / "package.json", "2021.3", "2022.3"), "unity is"),
    ("manifest", "no sample", lambda root: shutil.rmtree(root / "Samples~"), "has no script"),
    ("manifest", "no licence", lambda root: (root / "LICENSE.md").unlink(), "LICENSE.md is missing"),
    ("modules", "a module that is not named",
     lambda root: edit(root / "package.json", "modules.physics", "modules.wind"), "names no com.unity.modules.physics"),
    ("modules", "a module without use",
     lambda root: edit(root / "package.json", '"dependencies": {', '"dependencies": { "com.unity.modules.vr": "1.0.0",'),
     "names com.unity.modules.vr"),
    ("paths", "names that differ in case", lambda root: put(root / "readme.md", ""), "one file on Windows"),
    ("paths", "a long path", lambda root: put(root / ("a" * 80) / ("b" * 80), ""), "too long"),
    ("assemblies", "a reference to nothing",
     lambda root: edit(root / "Editor/SuperDeform.Editor.asmdef", '"SuperDeform",\n', '"SuperDeformed",\n'),
     "nobody defines"),
    ("assemblies", "UniVRM wanted always",
     lambda root: edit(root / "Editor/Vrm0/SuperDeform.Editor.Vrm0.asmdef", '"SUPERDEFORM_VRM0"\n    ],', "],"),
     "constrain it"),
    ("assemblies", "the engine in the runtime",
     lambda root: put(root / "Runtime/Engine.cs", "using UnityEngine;\n"), "uses the engine"),
    ("assemblies", "a source without assembly", lambda root: put(root / "Loose.cs", "class Loose { }\n"),
     "belongs to no assembly"),
    ("imports", "a function that is not imported",
     lambda root: edit(root / "Runtime/Native.g.cs", "sdef_destroy", "sdef_destroyed"), "sdef_destroy stands"),
    ("imports", "an older ABI",
     lambda root: edit(root / "Runtime/Native.g.cs", "SDEF_ABI_VERSION = 1;", "SDEF_ABI_VERSION = 0;"), "ABI version"),
    ("api", "a function that the newest editors refuse",
     lambda root: edit(root / "Editor/Writing/SourceIdentity.cs", "#if UNITY_6000_5_OR_NEWER", "#if UNITY_2021_3_OR_NEWER"), "no more in 6000.5"),
    ("api", "a newer function",
     lambda root: put(root / "Editor/Newer.cs", "class Newer { object all = Object.FindObjectsByType<int>(0); }\n"),
     "Editor/Newer.cs:1"),
    ("api", "newer C#", lambda root: put(root / "Editor/Newer.cs", "namespace A;\n"), "Editor/Newer.cs:1"),
    ("dialect", "a private that is said", lambda root: put(root / "Editor/Newer.cs", "class A {\n    private int a;\n}\n"),
     "Editor/Newer.cs:2"),
    ("dialect", "a statement on a line of its own",
     lambda root: put(root / "Editor/Newer.cs", "class A {\n    void B()\n    {\n        if (true\n            && true)\n            B();\n    }\n}\n"),
     "Editor/Newer.cs:4"),
    ("dialect", "a getter in braces",
     lambda root: put(root / "Editor/Newer.cs", "class A\n{\n    int B\n    {\n        get { return 1; }\n    }\n}\n"), "Editor/Newer.cs:3"),
    ("dialect", "a method that only returns",
     lambda root: put(root / "Editor/Newer.cs", "class A\n{\n    int B()\n    {\n        return 1;\n    }\n}\n"), "Editor/Newer.cs:3"),
    ("dialect", "a variable that waits for out",
     lambda root: put(root / "Editor/Newer.cs", "    int b;\n    if (A(out b)) return b;\n"), "Editor/Newer.cs:1"),
    ("dialect", "a type named twice", lambda root: put(root / "Editor/Newer.cs", "    A b = new A(1);\n"), "Editor/Newer.cs:1"),
    ("dialect", "a type named nowhere", lambda root: put(root / "Editor/Newer.cs", "    var b = Make();\n"), "Editor/Newer.cs:1"),
    ("strings", "a key without text",
     lambda root: put(root / "Editor/Key.cs", 'class Key { string text = Strings.Get("no.such.key"); }\n'),
     "no.such.key"),
    ("strings", "a text without Japanese", lambda root: edit(root / "Editor/Localization/en.json", "{",
                                                                 '{ "only.english": "one",'), "ja.json lacks"),
    ("strings", "a value lost in Japanese",
     lambda root: [edit(root / f"Editor/Localization/{language}.json", "{", f'{{ "a.value": "{text}",')
                   for language, text in (("en", "{0}"), ("ja", "x"))], "a.value has the values"),
    ("strings", "a text that nothing says",
     lambda root: [edit(root / f"Editor/Localization/{language}.json", "{", '{ "unsaid": "x",')
                   for language in ("en", "ja")], "nothing says unsaid"),
    ("documentation", "a sentence unexplained",
     lambda root: edit(root / "Editor/Localization/en.json", "{", '{ "moon_is_full": "The moon is full.",'),
     "moon_is_full"),
    ("documentation", "a dead link", lambda root: put(root / "README.md", "[a](nowhere.md)"), "nowhere.md"),
    ("libraries", "a library of another system",
     lambda root: put(root / "Plugins/x86_64/superdeform.dll", "\x7fELF"), "no library for its system"),
    ("libraries", "a library of another version",
     lambda root: put(root / "Plugins/x86_64/superdeform.dll", "MZ"), "another version's"),
]
