//! Files that are there whole or not at all.

use std::fs;
use std::path::Path;
use superdeform_host::file::write_atomically;

/// Writes `bytes` to `path`, making folders as needed: a reader never sees half a file, and a failure leaves what was
/// there before.
///
/// # Errors
/// One sentence with the path and the system's reason.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder)
            .map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
    }
    // A rename would put a file in the place of a device or a pipe such as /dev/null.
    let special = fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir());
    if special {
        return fs::write(path, bytes)
            .map_err(|error| format!("{} cannot be written: {error}", path.display()));
    }
    write_atomically(path, bytes).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_written_into_and_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        use std::os::unix::net::UnixListener;
        let path = std::env::temp_dir().join(format!("superdeform-socket-{}", std::process::id()));
        let _listener = UnixListener::bind(&path).unwrap();
        // A socket cannot be opened as a file: an error, and the socket is still there.
        assert!(write(&path, b"one").is_err());
        assert!(fs::metadata(&path).unwrap().file_type().is_socket());
        fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("superdeform-output-{}", std::process::id()));
        let inside = folder.join("a/b.txt");
        write(&inside, b"one").unwrap();
        write(&inside, b"two").unwrap();
        assert_eq!(fs::read(&inside).unwrap(), b"two");
        let error = write(&folder.join("a"), b"three").unwrap_err();
        assert!(error.contains("folder"), "{error}");
        assert!(write(&inside.join("c"), b"four").is_err());
        assert_eq!(fs::read_dir(folder.join("a")).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }
}
