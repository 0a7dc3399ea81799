//! Files that are there whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

/// Writes `bytes` to `path` by way of a file beside it, making folders as needed: a reader never sees half a
/// file, and a failure leaves what was there before.
///
/// # Errors
/// One sentence with the path and the system's reason.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let fail = |error: std::io::Error| format!("{}: cannot be written ({error})", path.display());
    if let Some(folder) = path.parent()
        && !folder.as_os_str().is_empty()
    {
        fs::create_dir_all(folder).map_err(fail)?;
    }
    if path.is_dir() {
        return Err(format!("{}: cannot be written (it is a folder)", path.display()));
    }
    let temporary = beside(path);
    fs::write(&temporary, bytes)
        .and_then(|()| fs::rename(&temporary, path))
        .map_err(|error| {
            // The first error is the one to tell; the temporary file may not even exist.
            let _ = fs::remove_file(&temporary);
            fail(error)
        })
}

/// A name in the same folder, because a rename works only within one file system.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("superdeform-output-{}", std::process::id()));
        let inside = folder.join("a/b.txt");
        write(&inside, b"one").unwrap();
        write(&inside, b"two").unwrap();
        assert_eq!(fs::read(&inside).unwrap(), b"two");
        let error = write(&folder.join("a"), b"three").unwrap_err();
        assert!(error.contains("cannot be written"), "{error}");
        assert!(write(&inside.join("c"), b"four").is_err());
        assert_eq!(fs::read_dir(folder.join("a")).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }
}
