//! Files of scene descriptions, and files that they refer to.

use super::budget::lacking;
use super::built_in;
use super::error::{Location, SceneError};
use base::file_kind::{FileKind, file_kind, from_utf16};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Memory per byte of a mesh file: its bytes, and the growing arrays of its content, old and new.
const BYTES_PER_FILE_BYTE: u64 = 3;
/// Bytes of a file that tell its kind.
const HEAD: u64 = 1024;
/// Extensions of files that are texts, or may be.
const TEXTS: [&str; 9] = ["obj", "mtl", "stl", "ply", "toml", "xml", "json", "gltf", "spd"];

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
    let bytes = fs::read(path).map_err(fail)?;
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match file_kind(&bytes) {
        Some(kind) if !kind.is_read_as(&extension) => {
            Err(SceneError::Foreign { path: path.to_owned(), from: from.clone(), kind })
        }
        _ if TEXTS.contains(&extension.as_str()) => Ok(in_utf8(bytes)),
        _ => Ok(bytes),
    }
}

/// Returns the kind of a file that begins as files of a known kind.
pub(crate) fn kind_of(path: &Path) -> Option<FileKind> {
    regular_length(path).ok()?;
    let mut head = Vec::new();
    File::open(path).ok()?.take(HEAD).read_to_end(&mut head).ok()?;
    file_kind(&head)
}

/// Returns a text in UTF-16 as UTF-8, and other bytes as they are.
fn in_utf8(bytes: Vec<u8>) -> Vec<u8> {
    if let Some(text) = from_utf16(&bytes) {
        return text.into_bytes();
    }
    match bytes.strip_prefix(b"\xEF\xBB\xBF") {
        Some(text) => text.to_vec(),
        None => bytes,
    }
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
    let text = text_of(bytes).map_err(|line| {
        Location::line(path, line).wrong("the text is not UTF-8", "save the file as text in UTF-8")
    })?;
    Ok((text, hash))
}

/// Returns the text in UTF-8, in UTF-16, or in Latin-1 if an XML declaration says so, with line ends of Unix in place
/// of line ends of old Macintoshes.
///
/// # Errors
/// The line from which on the bytes are no text.
pub fn text_of(bytes: Vec<u8>) -> Result<String, u32> {
    let text = String::from_utf8(in_utf8(bytes)).or_else(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.into_bytes();
        match is_latin_1(&bytes) {
            true => Ok(bytes.iter().copied().map(char::from).collect()),
            false => Err(bytes[..valid].iter().filter(|&&b| b == b'\n').count() as u32 + 1),
        }
    })?;
    Ok(if text.contains('\n') { text } else { text.replace('\r', "\n") })
}

/// True if the declaration of an XML file names the encoding Latin-1.
fn is_latin_1(bytes: &[u8]) -> bool {
    let end = bytes.iter().position(|&byte| byte == b'>').unwrap_or_default();
    let declaration = String::from_utf8_lossy(&bytes[..end]).to_ascii_lowercase();
    declaration.starts_with("<?xml") && ["iso-8859-1", "latin1"].iter().any(|name| declaration.contains(name))
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
