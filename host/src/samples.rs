//! The models to test and measure with: where they lie, and what is said of those that are not there.
//!
//! The sample pair stands in `tests/data`. The rest lie in the folder that `SUPERDEFORM_MODELS` names, `../shared/models`
//! beside the repository where it names none.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The sample pair's folder.
pub fn data() -> PathBuf {
    repository().join("tests/data")
}

/// The folder of more models, which need not be there.
pub fn folder() -> PathBuf {
    std::env::var_os("SUPERDEFORM_MODELS")
        .map_or_else(|| repository().join("../shared/models"), PathBuf::from)
}

fn repository() -> &'static Path {
    let host = Path::new(env!("CARGO_MANIFEST_DIR"));
    host.parent().unwrap_or(host)
}

/// The path of the file called `name`; where it is not there, `None`, and the calling test is [`skipped`].
pub fn path(name: &str) -> Option<PathBuf> {
    let found = [data(), folder()].into_iter().map(|folder| folder.join(name)).find(|path| path.is_file());
    if found.is_none() {
        skipped(name);
    }
    found
}

/// Says that the calling test lacks a file, or several, and so does not do all that its name says:
/// `skipped: BINARY::TEST (no NAME in FOLDER)`.
///
/// The line goes past the capture of `cargo test` to standard error, once for each test and name; `.ci/test` counts
/// these lines.
pub fn skipped(name: &str) {
    static SAID: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let line = format!("skipped: {} (no {name} in {})\n", caller(), folder().display());
    if SAID.lock().unwrap_or_else(PoisonError::into_inner).insert(line.clone()) {
        // A line that cannot be written is no reason to fail. One call, so that lines of several processes do not mix.
        let _ = std::io::stderr().write_all(line.as_bytes());
    }
}

/// The test that runs in this thread, after the binary's name without its hash.
fn caller() -> String {
    let binary = std::env::current_exe().ok().and_then(|path| Some(path.file_stem()?.to_str()?.to_string()));
    let binary = binary.unwrap_or_default();
    let binary = binary.rsplit_once('-').map_or(binary.as_str(), |(name, _)| name);
    match std::thread::current().name() {
        Some(test) if test != "main" => format!("{binary}::{test}"),
        _ => binary.to_string(),
    }
}
