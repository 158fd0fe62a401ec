//! Temporary files that killed processes left beside the files which they were to become.
//!
//! A temporary file is locked as long as it is written: one that is not is nobody's. Where files cannot be locked, none
//! is removed.

use rustix::fs::{FlockOperation, flock};
use std::fs::{self, File};
use std::path::Path;

/// Ending of temporary files' names.
pub const SUFFIX: &str = ".tmp";

/// Beginning of the names of a file's temporary files.
pub fn prefix(target: &Path) -> String {
    // Names have at most 255 bytes, those of temporary files included.
    let name: String = target.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    format!(".{name}.")
}

/// Locks a temporary file until it is closed; false if it is another's.
pub fn lock(file: &File) -> bool {
    flock(file, FlockOperation::NonBlockingLockExclusive).is_ok()
}

/// Removes the temporary files of `target`, in `folder`, that nobody writes. That they cannot be removed is no harm.
pub fn remove(target: &Path, folder: &Path) {
    let prefix = prefix(target);
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_temporary =
            name.to_str().is_some_and(|name| name.starts_with(&prefix) && name.ends_with(SUFFIX));
        if is_temporary && File::open(entry.path()).is_ok_and(|file| lock(&file)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}
