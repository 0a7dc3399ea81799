//! What the library says: sentences name options by a field, and each host spells them its own way.

use std::path::{Path, PathBuf};
use superdeform::options::find;

/// A string of the source, and where it stands.
struct Literal {
    place: String,
    text: String,
    /// What stands right before it.
    before: String,
}

/// Every source file below `folder`, without files of unit tests.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the sources can be read").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs")
            && path.file_name().is_some_and(|name| name != "tests.rs")
        {
            found.push(path);
        }
    }
    found
}

/// The strings of `source`, without those of comments and of its unit tests.
fn literals(name: &str, source: &str) -> Vec<Literal> {
    let source = source.split("#[cfg(test)]").next().unwrap_or_default();
    let characters: Vec<char> = source.chars().collect();
    let at = |index: usize| characters.get(index).copied().unwrap_or(' ');
    let mut found = Vec::new();
    let (mut index, mut line) = (0, 1);
    while index < characters.len() {
        match at(index) {
            '/' if at(index + 1) == '/' => {
                while index < characters.len() && at(index) != '\n' {
                    index += 1;
                }
                continue;
            }
            // A quotation mark as a character.
            '\'' if at(index + 1) == '"' && at(index + 2) == '\'' => index += 2,
            '"' => {
                let hashes = (0..index).rev().take_while(|&before| at(before) == '#').count();
                let is_raw = index > hashes && at(index - hashes - 1) == 'r';
                let before: String = characters[index.saturating_sub(12)..index].iter().collect();
                let (start, first_line) = (index + 1, line);
                index += 1;
                while index < characters.len() {
                    let closes =
                        at(index) == '"' && (!is_raw || (1..=hashes).all(|hash| at(index + hash) == '#'));
                    if closes {
                        break;
                    }
                    let length = if at(index) == '\\' && !is_raw { 2 } else { 1 };
                    line += (index..index + length).filter(|&index| at(index) == '\n').count();
                    index += length;
                }
                let text = characters[start..index.min(characters.len())].iter().collect();
                found.push(Literal { place: format!("{name}:{first_line}"), text, before });
            }
            '\n' => line += 1,
            _ => {}
        }
        index += 1;
    }
    found
}

fn literals_of_the_library() -> Vec<Literal> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    for path in sources(&root) {
        let name = path.strip_prefix(&root).expect("it is below").to_string_lossy().replace('\\', "/");
        found.extend(literals(&name, &std::fs::read_to_string(&path).expect("the source can be read")));
    }
    // Sentences of every subject; a scan that stopped early would find fewer.
    for part in ["no joint has the role", "give a number from", "there is no bone group", "reaches"] {
        assert!(found.iter().any(|literal| literal.text.contains(part)), "no sentence with {part:?}");
    }
    assert!(found.len() > 700, "only {} strings were found", found.len());
    found
}

fn check(what: &str, is_wrong: impl Fn(&Literal) -> bool) {
    let wrong: Vec<String> = literals_of_the_library()
        .iter()
        .filter(|literal| is_wrong(literal))
        .map(|literal| format!("{}: {:?}", literal.place, literal.text))
        .collect();
    assert!(wrong.is_empty(), "{what}:\n{}", wrong.join("\n"));
}

#[test]
fn strings_are_told_from_comments_and_characters() {
    let source = r##"
        // "a comment"
        let a = '"'; let b = "one"; let c = "t\"wo"; let d = r#"thr"ee"#; // "four"
        #[cfg(test)] mod tests { const E: &str = "five"; }
    "##;
    let found = literals("made", source);
    let texts: Vec<&str> = found.iter().map(|literal| literal.text.as_str()).collect();
    assert_eq!(texts, ["one", "t\\\"wo", "thr\"ee"]);
    assert!(found.iter().all(|literal| literal.place == "made:3"));
}

#[test]
fn no_sentence_speaks_the_command_line() {
    check("flags", |literal| literal.text.contains("--"));
}

#[test]
fn no_sentence_outside_of_the_abi_speaks_c() {
    check("names of the ABI", |literal| {
        !literal.place.starts_with("ffi/") && literal.text.to_lowercase().contains("sdef_")
    });
}

#[test]
fn no_sentence_shows_a_name_of_the_code() {
    check("Debug output", |literal| literal.text.contains(":?}"));
}

#[test]
fn every_option_that_a_sentence_is_about_stands_in_the_table() {
    let all = literals_of_the_library();
    let named: Vec<&Literal> = all.iter().filter(|literal| literal.before.ends_with(".about(")).collect();
    assert!(named.len() >= 8, "only {} sentences name an option", named.len());
    for literal in named {
        assert!(find(&literal.text).is_some(), "{}: {}", literal.place, literal.text);
    }
}
