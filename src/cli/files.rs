//! Writes small files.

use super::exit::Failure;
use super::talk;
use base::film::{ImageError, atomic};
use std::io::Write;
use std::path::Path;

/// Writes text to a file. The file is complete or unchanged.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, text: &str) -> Result<(), Failure> {
    save(path, text.as_bytes())?;
    talk::wrote(&format!("wrote {}", path.display()), &[path.to_owned()]);
    Ok(())
}

/// Writes bytes to a file without a message. The file is complete or unchanged.
///
/// # Errors
/// If the file cannot be written.
pub fn save(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    atomic::write_atomically(path, |file| file.write_all(bytes))
        .map_err(|error| ImageError::Write { path: path.to_owned(), error })
        .map_err(Failure::output)
}
