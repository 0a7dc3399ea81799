//! The committed header, C# imports and layout are those that the sources generate, and both say the same as the library.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use superdeform::options::table::Default;
use superdeform::options::{NUMBERS, OptionInfo, Scope, TABLE, Values, find};
use superdeform_headers::csharp::{constants_of, pascal, printed};
use superdeform_headers::{
    EXPORT, SECTIONS, abi, broken, c_header, csharp, layout, numbers_of, python, root, source,
};

#[test]
fn the_readme_lists_the_options_that_are_one_number() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap().replace("\r\n", "\n");
    let start = |info: &OptionInfo| format!("| `--{} ", info.name.replace('_', "-"));
    let row = |info: &OptionInfo| {
        let [low, high, usual] = numbers_of(info);
        format!("{}{low}..{high}` | {}; {usual} unless set |", start(info), info.text)
    };
    let lines: Vec<&str> = readme.lines().collect();
    let place = |info: &OptionInfo| lines.iter().position(|line| line.starts_with(&start(info)));
    let [first, last] = [&NUMBERS[0], &NUMBERS[NUMBERS.len() - 1]].map(|info| place(info).expect(info.name));
    let rows: Vec<String> = NUMBERS.iter().map(row).collect();
    let parts = [lines[..first].join("\n"), rows.join("\n"), lines[last + 1..].join("\n")];
    check("README.md", &(parts.join("\n") + "\n"));
}

/// Compares a generated text with the committed file, or writes it where `SUPERDEFORM_BLESS` is set.
fn check(path: &str, text: &str) {
    let file = root().join(path);
    if std::env::var_os("SUPERDEFORM_BLESS").is_some() {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, text).unwrap();
    }
    let committed = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    let line = committed.lines().zip(text.lines()).position(|(old, new)| old != new);
    assert!(
        committed == text,
        "{path} is not what src/ffi generates (first at line {:?}): set SUPERDEFORM_BLESS=1 and run again",
        line.map(|line| line + 1)
    );
}

#[test]
fn the_committed_header_is_generated() {
    check("include/superdeform.h", &c_header());
}

#[test]
fn the_committed_imports_are_generated() {
    check("unity/Runtime/Native.g.cs", &csharp());
}

#[test]
fn the_committed_ctypes_are_generated() {
    check("python/superdeform/abi.py", &python());
}

/// C compilers compare it with what they make of the header, in `cpp_tests`.
#[test]
fn the_committed_layout_is_generated() {
    check("cpp_tests/layout.inc", &layout(&c_header()));
}

/// What hosts that were built with version 1 need: functions and constants may be added, fields at the end of structs. The
/// file is written once for each version of the ABI, with `SUPERDEFORM_FREEZE`.
#[test]
fn the_frozen_abi_is_kept() {
    let now = abi(&c_header());
    let version = now.iter().find_map(|line| line.strip_prefix("constant SDEF_ABI_VERSION ")).unwrap();
    let file = root().join(format!("tests/headers/abi_{version}.txt"));
    if std::env::var_os("SUPERDEFORM_FREEZE").is_some() {
        std::fs::write(&file, now.join("\n") + "\n").unwrap();
    }
    let frozen: Vec<String> =
        std::fs::read_to_string(&file).expect("the version is frozen").lines().map(str::to_string).collect();
    assert!(frozen.len() > 300, "{} lines", frozen.len());
    let broken = broken(&frozen, &now);
    assert!(broken.is_empty(), "hosts of this version of the ABI would break: {}", broken.join("; "));
}

#[test]
fn what_would_break_hosts_is_found() {
    let before = "#define SDEF_A 1\ntypedef uint32_t SdefStatus;\ntypedef struct SdefS {\n  uint32_t struct_size;\n  uint32_t a;\n  \
                  double b;\n  uint32_t c;\n} SdefS;\ntypedef struct SdefH { uint64_t id; } SdefH;\n\
                  SDEF_API SdefStatus sdef_f(SdefH h,\n    SdefS *s, uint32_t n);\n";
    let frozen = abi(before);
    let found = |from: &str, to: &str| broken(&frozen, &abi(&before.replace(from, to)));
    assert_eq!(found("", ""), Vec::<String>::new());
    // What is added at the end, or beside it, breaks nobody.
    for (from, to) in [
        ("  uint32_t c;\n", "  uint32_t c;\n  double d;\n"),
        ("#define", "#define SDEF_B 2\n#define"),
        ("SDEF_API", "SDEF_API SdefStatus sdef_g(void);\nSDEF_API"),
    ] {
        assert_eq!(found(from, to), Vec::<String>::new(), "{to}");
    }
    for (from, to) in [
        ("SDEF_A 1", "SDEF_A 2"),
        ("  double b;\n", ""),
        ("double b", "size_t b"),
        ("  uint32_t a;\n  double b;\n", "  double b;\n  uint32_t a;\n"),
        // In the padding that an older host left.
        ("  uint32_t c;\n", "  uint32_t c;\n  uint32_t d;\n"),
        // A handle goes by value: with a second number it lies in other registers.
        ("{ uint64_t id; }", "{ uint64_t id; uint64_t generation; }"),
        ("{ uint64_t id; }", "{ uint32_t id; }"),
        ("uint32_t n", "uint64_t n"),
        ("sdef_f", "sdef_h"),
        ("typedef uint32_t SdefStatus", "typedef int32_t SdefStatus"),
    ] {
        assert!(!found(from, to).is_empty(), "{from} to {to}");
    }
}

#[test]
fn the_header_is_easy_to_read() {
    let header = c_header();
    for (number, line) in header.lines().enumerate() {
        assert!(line.chars().count() <= 120, "line {} is too long: {line}", number + 1);
    }
    assert!(header.is_ascii());
}

/// Of every function the return type and the arguments, as how many pointers each is and whether it is a plain number,
/// a struct or a callback.
type Functions = BTreeMap<String, Vec<String>>;

/// Reads declarations of functions, in C or in C#.
fn functions_of(text: &str) -> Functions {
    let code: String = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or("").trim())
        .filter(|line| !line.starts_with('#') && !line.starts_with('*') && !line.starts_with("/*"))
        .collect::<Vec<_>>()
        .join(" ");
    let mut functions = Functions::new();
    for (at, _) in code.match_indices("sdef_") {
        let rest = &code[at..];
        let name: String = rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
        let after = rest[name.len()..].trim_start();
        if !after.starts_with('(') {
            continue;
        }
        let mut depth = 0;
        let end = after
            .find(|c| {
                depth += i32::from(c == '(') - i32::from(c == ')');
                depth == 0
            })
            .expect("an end of the arguments");
        let before = &code[..at];
        let start = before.rfind([';', '}', '{', ']']).map_or(0, |at| at + 1);
        let mut parts = vec![shape(&before[start..])];
        let (mut depth, mut argument) = (0, String::new());
        for letter in after[1..end].chars().chain([',']) {
            depth += i32::from(letter == '(') - i32::from(letter == ')');
            if letter == ',' && depth == 0 {
                parts.push(shape(&std::mem::take(&mut argument)));
            } else {
                argument.push(letter);
            }
        }
        parts.retain(|part| part != "no argument");
        functions.insert(name, parts);
    }
    functions
}

/// What a type is, in words that both generators share.
fn shape(declared: &str) -> String {
    let declared = declared.trim();
    if declared == "void" || declared.is_empty() {
        return "no argument".to_string();
    }
    if ["(*", "_fptr", "SdefProgress", "SdefJobs"].iter().any(|callback| declared.contains(callback)) {
        return "callback".to_string();
    }
    let depth = declared.matches('*').count();
    let words: Vec<&str> =
        declared.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|w| !w.is_empty()).collect();
    let base = words
        .iter()
        .find(|word| !["const", "extern", "internal", "static", "struct"].contains(word))
        .unwrap_or(&"")
        .trim_end_matches("_t")
        .to_lowercase();
    let base = match base.as_str() {
        "sdefstatus" | "uint32" => "uint32",
        "char" | "int8" | "sbyte" => "char",
        "uintptr" | "size" => "size",
        "single" => "float",
        other => other,
    };
    format!("{base} {}", "*".repeat(depth)).trim_end().to_string()
}

#[test]
fn both_generators_see_the_same_functions() {
    // What stands before each says nothing of a type.
    let ours = functions_of(&c_header().replace("SDEF_API ", ""));
    let exports: usize = SECTIONS.iter().map(|section| source(section).matches(EXPORT).count()).sum();
    assert_eq!(ours.len(), exports);
    assert_eq!(ours, functions_of(&printed(safer_ffi::headers::Language::C)));
    assert_eq!(ours, functions_of(&csharp()));
}

#[test]
fn both_files_have_every_constant() {
    let (header, imports) = (c_header(), csharp());
    for section in SECTIONS {
        for (name, number) in constants_of(&source(section)) {
            let number = if number == "0xFFFFFFFF" { "UINT32_MAX".to_string() } else { number };
            let defined = [format!("#define {name} {number}"), format!("{name} = {number}")];
            assert!(defined.iter().any(|line| header.contains(line)), "{name}");
            assert!(imports.contains(&format!("const UInt32 {name} = ")), "{name}");
        }
    }
}

/// The comment of each field in a source of Rust or C#.
fn comments(source: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut comment = String::new();
    for line in source.lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("///") {
            comment = comment + " " + text.trim();
        } else if let Some(declared) = line.strip_prefix("pub ").or(line.strip_prefix("public ")) {
            let declared = declared.split([':', '=', ';', '(']).next().unwrap_or_default();
            let name = declared.split_whitespace().last().unwrap_or_default().to_string();
            found.insert(name, std::mem::take(&mut comment));
        } else if !line.starts_with("#[") && !line.starts_with('[') {
            comment.clear();
        }
    }
    found
}

/// Whether `comment` names `number`, standing alone.
fn names(comment: &str, number: f64) -> bool {
    comment
        .split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-')
        .any(|word| word.trim_end_matches('.').parse() == Ok(number))
}

/// What is missing in the comment of an option: an end of its range, or its default.
fn missing(info: &OptionInfo, comment: &str) -> Vec<String> {
    let mut numbers = Vec::new();
    match info.values {
        Values::Number { low, high } => numbers.extend([low, high]),
        Values::Count { low, high } => numbers.extend([low, high].map(f64::from)),
        _ => {}
    }
    match info.default {
        Default::Number(usual) => numbers.push(usual),
        Default::ByMode { product, paper } => numbers.extend([product, paper]),
        _ => {}
    }
    let mut missing: Vec<String> =
        numbers.into_iter().filter(|&number| !names(comment, number)).map(|n| n.to_string()).collect();
    let comment = comment.to_lowercase();
    if info.default != Default::Found && !comment.contains("default") {
        missing.push("the default".to_string());
    }
    if let Default::Choice(usual) = info.default
        && !comment.contains(usual)
    {
        missing.push(usual.to_string());
    }
    missing
}

#[test]
fn comments_say_the_ranges_and_defaults_of_the_table() {
    let c = comments(&source("options"));
    // What is generated of Options stands last in its file.
    let of = |file: &str| std::fs::read_to_string(root().join("unity/Runtime").join(file)).unwrap();
    let cs = comments(&(of("Native.g.cs") + &of("Options.cs")));
    let mut wrong = Vec::new();
    let mut seen = 0;
    for info in TABLE.iter().filter(|info| matches!(info.scope, Scope::Plain | Scope::Group | Scope::Rig)) {
        for (file, name, all) in
            [("src/ffi/options.rs", info.name.to_string(), &c), ("Options.cs", pascal(info.name), &cs)]
        {
            match all.get(&name) {
                Some(comment) => {
                    let missing = missing(info, comment).join(", ");
                    if !missing.is_empty() {
                        wrong.push(format!("{file} says of {name}:{comment}: it lacks {missing}"));
                    }
                    seen += 1;
                }
                None => wrong.push(format!("{file} has no field {name}")),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen >= 40);
    let heads = find("heads").unwrap().values.to_string();
    assert!(source("style_handle").contains(&format!("heads: {heads}")), "{heads}");
}

/// The shared library: that of `SUPERDEFORM_LIBRARY`, or the one that cargo links beside this test.
fn library() -> Option<PathBuf> {
    if let Some(library) = std::env::var_os("SUPERDEFORM_LIBRARY") {
        return Some(library.into());
    }
    let name = format!("{}superdeform{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    // With the workspace's features and those of its examples, so that nothing is compiled anew where all tests run.
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--workspace", "--lib", "--examples"]).current_dir(root());
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    assert!(cargo.status().ok()?.success(), "cargo build failed");
    Some(std::env::current_exe().ok()?.parent()?.parent()?.join(&name))
}

fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).ok()
}

#[test]
fn the_library_exports_what_the_header_says_and_nothing_else() {
    let Some(library) = library() else { return };
    let Some(symbols) = output("nm", &["-D", "--defined-only", &library.display().to_string()]) else {
        println!("there is no nm: the exported symbols are not checked");
        return;
    };
    let exported: Vec<&str> = symbols.lines().filter_map(|line| line.split_whitespace().last()).collect();
    let ours = functions_of(&c_header());
    let names: Vec<&str> = ours.keys().map(String::as_str).collect();
    let mut sorted = exported.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, names);
    if let Some(dynamic) = output("readelf", &["-d", &library.display().to_string()]) {
        assert!(dynamic.contains("Library soname: [libsuperdeform.so]"), "{dynamic}");
    }
}

#[test]
fn the_header_compiles_without_warnings() {
    let folder = std::env::temp_dir().join(format!("superdeform-compile-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let source = "#include \"superdeform.h\"\n#include \"superdeform.h\"\n\
        uint32_t version(void) { SdefError error = SDEF_ERROR_INIT; return error.struct_size + sdef_abi_version(); }\n";
    let mut checked = 0;
    for (compilers, ending, standards) in [
        (["gcc", "clang", "x86_64-w64-mingw32-gcc"], "c", ["c99", "c11", "c17"]),
        (["g++", "clang++", "x86_64-w64-mingw32-g++"], "cpp", ["c++11", "c++17", "c++20"]),
    ] {
        let file = folder.join(format!("unit.{ending}"));
        std::fs::write(&file, source).unwrap();
        for compiler in compilers {
            if Command::new(compiler).arg("--version").output().is_err() {
                println!("there is no {compiler}");
                continue;
            }
            for standard in standards {
                compiles(compiler, standard, &file, &folder);
                checked += 1;
            }
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    println!("{checked} compilations");
}

fn compiles(compiler: &str, standard: &str, file: &Path, folder: &Path) {
    let result = Command::new(compiler)
        .arg(format!("-std={standard}"))
        .args(["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-c", "-I"])
        .arg(root().join("include"))
        .arg(file)
        .arg("-o")
        .arg(folder.join("unit.o"))
        .output()
        .unwrap();
    assert!(result.status.success(), "{compiler} {standard}: {}", String::from_utf8_lossy(&result.stderr));
}

#[test]
fn the_imports_compile() {
    if Command::new("mcs").arg("--version").output().is_err() {
        println!("there is no mcs: the C# imports are not compiled");
        return;
    }
    let to = std::env::temp_dir().join(format!("superdeform-{}.dll", std::process::id()));
    let result = Command::new("mcs")
        .args(["-unsafe", "-langversion:7.2", "-target:library", "-warnaserror"])
        .arg(format!("-out:{}", to.display()))
        .args(["Native.g.cs", "OptionRange.cs"].map(|file| root().join("unity/Runtime").join(file)))
        .output()
        .unwrap();
    let _ = std::fs::remove_file(&to);
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
}
