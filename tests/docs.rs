//! The documents speak of files, decisions and numbers that are there.

use regex_lite::Regex;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

const DOCUMENTS: [&str; 6] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/batch.md",
    "docs/method.md",
    "docs/constants.md",
    "tests/MODELS.md",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// All Rust sources under `folder`, by path from the root.
fn sources(folder: &str) -> BTreeMap<String, String> {
    let paths = files(folder).into_iter().filter(|path| path.ends_with(".rs"));
    let found: BTreeMap<String, String> = paths.map(|path| (path.clone(), text(&path))).collect();
    assert!(!found.is_empty(), "{folder} has no sources");
    found
}

/// What a link to a place in `document` may say after `#`.
fn anchors(document: &str) -> BTreeSet<String> {
    let own = Regex::new(r#"<a id="([^"]+)">"#).unwrap();
    let heading = Regex::new(r"(?m)^#+ (.+)$").unwrap();
    let slug = |title: &str| {
        let kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
        title.to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-")
    };
    let ids = own.captures_iter(document).map(|found| found[1].to_string());
    ids.chain(heading.captures_iter(document).map(|found| slug(&found[1]))).collect()
}

#[test]
fn links_lead_somewhere() {
    let link = Regex::new(r"\]\(([^)\s]+)\)").unwrap();
    let mut broken = Vec::new();
    let mut count = 0;
    for name in DOCUMENTS {
        let document = text(name);
        let folder = Path::new(name).parent().unwrap();
        for target in link.captures_iter(&document).map(|found| found[1].to_string()) {
            if target.starts_with("http") {
                continue;
            }
            count += 1;
            let (path, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let path = if path.is_empty() { PathBuf::from(name) } else { folder.join(path) };
            let exists = root().join(&path).exists();
            if !exists || !(anchor.is_empty() || anchors(&text(path.to_str().unwrap())).contains(anchor)) {
                broken.push(format!("{name}: {target}"));
            }
        }
    }
    assert!(count > 20, "only {count} links were found");
    assert!(broken.is_empty(), "links that lead nowhere: {broken:#?}");
}

#[test]
fn files_that_documents_name_are_there() {
    // Paths in code spans, from the root or from src.
    let span = Regex::new(r"`([a-z_.]+/[A-Za-z0-9_./~-]*)`").unwrap();
    let mut missing = Vec::new();
    let mut count = 0;
    for name in ["README.md", "CONTRIBUTING.md", "docs/method.md"] {
        for path in span.captures_iter(&text(name)).map(|found| found[1].to_string()) {
            // What a build or a run writes is not in the repository.
            if ["target/", "superdeform-out/", "../"].iter().any(|made| path.starts_with(made)) {
                continue;
            }
            count += 1;
            if !root().join(&path).exists() && !root().join("src").join(&path).exists() {
                missing.push(format!("{name}: {path}"));
            }
        }
    }
    assert!(count > 40, "only {count} paths were found");
    assert!(missing.is_empty(), "files that are not there: {missing:#?}");
}

/// So that who reads `hanging.rs` anywhere knows which file is meant.
#[test]
fn no_two_files_of_the_source_have_one_name() {
    let mut by_name = BTreeMap::<String, Vec<String>>::new();
    for path in sources("src").into_keys() {
        let name = path.rsplit('/').next().unwrap().to_string();
        by_name.entry(name).or_default().push(path);
    }
    by_name.remove("mod.rs");
    let twice: Vec<_> = by_name.values().filter(|paths| paths.len() > 1).collect();
    assert!(twice.is_empty(), "files of one name: {twice:?}");
}

#[test]
fn decisions_that_the_source_cites_are_written_down() {
    let cited = Regex::new(r"\bD(\d{1,2})\b").unwrap();
    let method = anchors(&text("docs/method.md"));
    let mut count = 0;
    for (path, source) in sources("src") {
        for line in source.lines().filter(|line| line.contains("//")) {
            for number in cited.captures_iter(&line[line.find("//").unwrap()..]) {
                count += 1;
                assert!(
                    method.contains(&format!("d{}", &number[1])),
                    "{path} cites D{}, which docs/method.md does not have",
                    &number[1]
                );
            }
        }
    }
    assert!(count > 15, "only {count} citations were found");
}

#[test]
fn the_readme_names_every_folder_of_the_source() {
    let readme = text("README.md");
    let folders: BTreeSet<String> =
        sources("src").into_keys().filter_map(|path| Some(path.rsplit_once('/')?.0.to_string())).collect();
    let missing: Vec<&String> = folders
        .iter()
        .filter(|folder| *folder != "src" && !readme.contains(&format!("`{folder}`")))
        .collect();
    assert!(folders.len() > 15 && missing.is_empty(), "README.md does not name {missing:?}");
}

/// CONTRIBUTING tells, by the example of `hair_lay`, which files an option that is one number takes by hand.
#[test]
fn an_option_takes_the_files_that_contributing_lists() {
    let contributing = text("CONTRIBUTING.md");
    let (_, told) = contributing.split_once("**An option that is one number**").expect("how to add one");
    let (told, _) = told.split_once("\n**").expect("an end");
    let rows: String = told.lines().filter(|line| line.starts_with("| `")).collect();
    let path = Regex::new("`([A-Za-z/_.]+)`").unwrap();
    let mut folder = String::new();
    let by_hand: BTreeSet<String> = path
        .captures_iter(&rows)
        .map(|found| found.get(1).unwrap().as_str())
        .filter(|path| path.contains('.'))
        .map(|path| match path.rsplit_once('/') {
            Some((of, _)) => {
                folder = of.to_string();
                path.to_string()
            }
            None => format!("{folder}/{path}"),
        })
        .collect();
    let generated = [
        "include/superdeform.h",
        "cpp_tests/layout.inc",
        "unity/Runtime/Native.g.cs",
        "python/superdeform/abi.py",
    ];
    assert!(generated.iter().all(|path| told.contains(path)), "{told}");

    let named = Regex::new(r"hair_lay|hair-lay|HairLay").unwrap();
    let folders = [
        "src",
        "capi",
        "host",
        "examples/superdeform",
        "include",
        "unity/Runtime",
        "unity/Editor",
        "blender",
        "python/superdeform",
        "web/src",
        "web/npm",
    ];
    let found: BTreeSet<String> = folders
        .iter()
        .flat_map(|folder| files(folder))
        .filter(|path| !generated.contains(&path.as_str()) && named.is_match(&text(path)))
        .collect();
    assert_eq!(found, by_hand);
}

/// The paths of all files of text below a folder.
fn files(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root().join(folder)).unwrap().flatten() {
        let path = format!("{folder}/{}", entry.file_name().into_string().unwrap());
        if entry.path().is_dir() {
            found.extend(files(&path));
        } else if fs::read_to_string(entry.path()).is_ok() {
            found.push(path);
        }
    }
    found
}
