//! Removal of temporary files that killed processes have left.
//!
//! A temporary file is locked while it is written, so an unlocked one has no writer. On file systems without locks, no
//! file is removed.

use rustix::fs::{FlockOperation, flock};
use std::fs::{self, File};
use std::path::Path;

/// Suffix of the names of temporary files.
pub const SUFFIX: &str = ".tmp";

/// Returns the prefix of the names of a file's temporary files.
pub fn prefix(target: &Path) -> String {
    // File names have at most 255 bytes.
    let name: String = target.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    format!(".{name}.")
}

/// Locks a temporary file until it is closed; returns false if another process has locked it.
pub fn lock(file: &File) -> bool {
    flock(file, FlockOperation::NonBlockingLockExclusive).is_ok()
}

/// Removes the temporary files of `target` in `folder` that nobody writes. Failures are ignored.
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
