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

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .expect("the package stands in the repository")
}

/// The modules of `src/ffi` that are the header's sections, in order.
pub const SECTIONS: [&str; 9] =
    ["basics", "lifetime", "jobs", "options", "character", "rig", "style", "deformer", "all_at_once"];

/// The text of a file of `src/ffi`.
fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(root().join("src/ffi").join(path)).ok()
}

/// The source of a section: of a module that is a folder, what hosts see of it.
pub fn source(section: &str) -> String {
    if let Some(source) = read(&format!("{section}.rs")) {
        return source;
    }
    let source =
        read(&format!("{section}/mod.rs")).unwrap_or_else(|| panic!("there is no src/ffi/{section}"));
    let Some(types) = read(&format!("{section}/types.rs")) else { return source };
    let (comment, rest) = source.split_once("\n\n").expect("a comment and items");
    let types = types.split_once("\n\n").expect("a comment and items").1;
    format!("{comment}\n\n{types}\n{rest}")
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
