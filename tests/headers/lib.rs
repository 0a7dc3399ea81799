//! Writes the C header, the imports for C# and Python and the layout that hosts check from `src/ffi`.

mod c_header;
pub mod csharp;
mod frozen;
mod layout;
mod python;

pub use c_header::c_header;
pub use csharp::csharp;
pub use frozen::{abi, broken};
pub use layout::layout;
pub use python::python;

use std::path::{Path, PathBuf};
use superdeform::options::table::Default;
use superdeform::options::{NUMBERS, OptionInfo, Values};

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .expect("the package stands in the repository")
}

/// The modules of `src/ffi` that are the header's sections, in order.
pub const SECTIONS: [&str; 9] =
    ["basics", "lifetime", "jobs", "options", "character", "rig", "style_handle", "deformer", "all_at_once"];

/// What stands before each exported function.
pub const EXPORT: &str = "#[cfg_attr(not(target_arch = \"wasm32\"), ffi_export)]\n#[cfg_attr(target_arch = \"wasm32\", unsafe(no_mangle))]";

/// The text of a file of `src/ffi`.
fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(root().join("src/ffi").join(path)).ok()
}

/// The source of a section: of a module that is a folder, what hosts see of it.
pub fn source(section: &str) -> String {
    expanded(&text_of(section))
}

fn text_of(section: &str) -> String {
    if let Some(source) = read(&format!("{section}.rs")) {
        return source;
    }
    let source =
        read(&format!("{section}/mod.rs")).unwrap_or_else(|| panic!("there is no src/ffi/{section}"));
    let Some(types) = read(&format!("{section}/{section}_types.rs")) else { return source };
    let (comment, rest) = source.split_once("\n\n").expect("a comment and items");
    let types = types.split_once("\n\n").expect("a comment and items").1;
    format!("{comment}\n\n{types}\n{rest}")
}

/// The least, the greatest and the default of an option that is one number.
pub fn numbers_of(info: &OptionInfo) -> [f64; 3] {
    let (Values::Number { low, high }, Default::Number(usual)) = (info.values, info.default) else {
        panic!("{} is not one number", info.name)
    };
    [low, high, usual]
}

/// What an option that is one number does, its range and its default.
pub fn described(info: &OptionInfo) -> String {
    let [low, high, usual] = numbers_of(info);
    format!("{}; {low} to {high}, default {usual}", info.text)
}

/// A source with the struct that a macro makes as it comes out of it: the options that are one number have their comments, and those
/// that no line declares stand where the macro has them.
fn expanded(source: &str) -> String {
    let Some((before, rest)) = source.split_once("macro_rules! sdef_options {\n") else {
        return source.to_string();
    };
    let (_, rest) = rest.split_once("=> {\n").expect("what the macro makes");
    let (made, rest) = rest.split_once("\n    };\n}\n").expect("the end of the macro");
    let (_, after) = rest.split_once('\n').expect("the macro's call");
    let declared = |info: &&OptionInfo| made.contains(&format!(" pub {}: f64,", info.name));
    let field = |info: &OptionInfo| format!("    /// {}\n    pub {}: f64,", described(info), info.name);
    let mut lines = Vec::new();
    for line in made.lines().map(|line| line.strip_prefix("        ").unwrap_or(line)) {
        if line == "    /// see the list" {
            continue;
        }
        let of = NUMBERS.iter().find(|info| line == format!("    pub {}: f64,", info.name));
        if line.contains("pub $name") {
            lines.extend(NUMBERS.iter().filter(|info| !declared(info)).map(field));
        } else {
            lines.push(of.map_or_else(|| line.to_string(), field));
        }
    }
    format!("{before}{}\n{after}", lines.join("\n"))
}

/// The header's first comment.
fn conventions() -> String {
    module_comment(&read("mod.rs").expect("src/ffi/mod.rs")).join("\n")
}

/// The module's own comment, without its marks.
fn module_comment(source: &str) -> Vec<&str> {
    source
        .lines()
        .take_while(|line| line.starts_with("//!"))
        .map(|line| line.strip_prefix("//! ").unwrap_or(""))
        .collect()
}
