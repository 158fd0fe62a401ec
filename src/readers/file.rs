//! Files of scene descriptions, and files that they refer to.

use super::budget::lacking;
use super::built_in;
use super::error::{Location, SceneError};
use std::fs;
use std::io;
use std::path::Path;

/// Memory per byte of a mesh file: its bytes, and the growing arrays of its content, old and new.
const BYTES_PER_FILE_BYTE: u64 = 3;

/// Reads a file that `from` refers to, or a file of a built-in scene.
pub(crate) fn read_file(path: &Path, from: &Location) -> Result<Vec<u8>, SceneError> {
    if let Some(bytes) = built_in::bytes(path) {
        return Ok(bytes.to_vec());
    }
    let fail = |error| SceneError::Read { path: path.to_owned(), from: from.clone(), error };
    let length = regular_length(path).map_err(fail)?;
    if let Some(lack) = lacking(length.saturating_mul(BYTES_PER_FILE_BYTE)) {
        let what = format!("reading it takes {lack}");
        return Err(Location::file(path).wrong(what, "divide or simplify it, or give more memory"));
    }
    fs::read(path).map_err(fail)
}

/// Reads a regular file.
///
/// # Errors
/// If the file cannot be read, or is a device, pipe or folder.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    regular_length(path)?;
    fs::read(path)
}

/// Returns the length of a regular file. Devices have no end, and pipes may block.
fn regular_length(path: &Path) -> io::Result<u64> {
    let metadata = fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(io::Error::other("this is not a regular file"));
    }
    Ok(metadata.len())
}

/// Reads a description's own file, to which `from` refers; returns the text and the hash of its bytes.
pub(crate) fn read_text(path: &Path, from: &Location) -> Result<(String, u64), SceneError> {
    let bytes = read_file(path, from)?;
    let hash = fnv1a(&bytes);
    let text = String::from_utf8(bytes).map_err(|e| {
        let line = e.as_bytes()[..e.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        Location::line(path, line as u32 + 1).malformed("the text is not UTF-8")
    })?;
    Ok((text, hash))
}

/// Returns the folder of a file.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// Returns a file's name without its folder and extension.
pub(crate) fn stem_of(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Computes the 64-bit FNV-1a hash of bytes.
pub fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}
