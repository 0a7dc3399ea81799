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
    let mut found = BTreeMap::new();
    let mut folders = vec![PathBuf::from(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap().map(Result::unwrap) {
            let path = folder.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let name = path.to_str().unwrap().to_string();
                found.insert(name.clone(), text(&name));
            }
        }
    }
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

/// The constants of `source` that are numbers, with their values as they are written.
fn constants(source: &str) -> BTreeMap<String, String> {
    let source = source.split("#[cfg(test)]").next().unwrap();
    let constant =
        Regex::new(r"(?ms)^ *(?:pub(?:\([a-z]+\))? )?const ([A-Z][A-Z_0-9]*): ([^=]+?) =\s*(.*?);$").unwrap();
    let of_numbers = Regex::new(r"^[(\[]?(f32|f64|usize|u32|i32)[, )\];f0-9a-z]*$").unwrap();
    constant
        .captures_iter(source)
        .filter(|found| of_numbers.is_match(&found[2]) && !found[3].contains(" as "))
        .map(|found| (found[1].to_string(), found[3].trim_matches(['(', ')', '[', ']']).to_string()))
        .collect()
}

#[test]
fn the_table_of_constants_has_all_of_them_with_their_values() {
    let document = text("docs/constants.md");
    let section = Regex::new(r"(?m)^### `(src/[^`]+)`$").unwrap();
    let row = Regex::new(r"(?m)^\| `([A-Z][A-Z_0-9]*)` \| ([^|]+?) \|").unwrap();
    let starts: Vec<(String, usize, usize)> = section
        .captures_iter(&document)
        .map(|found| (found[1].to_string(), found.get(0).unwrap().start(), found.get(0).unwrap().end()))
        .collect();
    assert!(starts.len() > 10, "only {} files have a section", starts.len());
    let mut wrong = Vec::new();
    for (index, (path, _, start)) in starts.iter().enumerate() {
        let end = starts.get(index + 1).map_or(document.len(), |next| next.1);
        let table: BTreeMap<String, String> = row
            .captures_iter(&document[*start..end])
            .map(|found| (found[1].to_string(), found[2].to_string()))
            .collect();
        let of_file = constants(&text(path));
        assert!(!of_file.is_empty(), "{path} has no constants");
        for (name, value) in &of_file {
            match table.get(name) {
                None => wrong.push(format!("{path}: no row for {name} ({value})")),
                Some(told) if told != value => {
                    wrong.push(format!("{path}: {name} is {value}, the table says {told}"));
                }
                Some(_) => {}
            }
        }
        for name in table.keys().filter(|name| !of_file.contains_key(*name)) {
            wrong.push(format!("{path}: the table has {name}, the source has not"));
        }
    }
    assert!(wrong.is_empty(), "docs/constants.md: {wrong:#?}");
}
