//! Writes the C header and the C# imports from `src/ffi/exports`.

// Linked for the list of its exports.
use superdeform as _;

mod c_header;
pub mod csharp;

pub use c_header::c_header;
pub use csharp::csharp;

use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .expect("the package stands in the repository")
}

/// The files of `src/ffi/exports` whose sections make the header, in order.
pub const SECTIONS: [&str; 7] = ["basics", "options", "character", "rig", "style", "deformer", "once"];

/// The source of a section.
pub fn source(section: &str) -> String {
    let path = root().join(format!("src/ffi/exports/{section}.rs"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The module's own comment, without its marks.
fn module_comment(source: &str) -> Vec<&str> {
    source
        .lines()
        .take_while(|line| line.starts_with("//!"))
        .map(|line| line.strip_prefix("//! ").unwrap_or(""))
        .collect()
}
