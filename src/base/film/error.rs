//! Errors of picture files.

use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// An error reading, writing or comparing pictures.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system; no `source`, since the message holds it.
        error: io::Error,
    },
    /// The file is not a supported OpenEXR picture.
    #[error("{} is not a readable OpenEXR picture: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// Description of the error.
        reason: String,
    },
    /// The picture has no colour of the name asked for.
    #[error("{} has no {wanted}; its channels are: {}", path.display(), channels.join(", "))]
    NoColor {
        /// The file.
        path: PathBuf,
        /// Name asked for.
        wanted: String,
        /// Names of its channels.
        channels: Vec<String>,
    },
    /// A picture cannot be written to the path asked for; found before rendering.
    #[error("cannot write {}: {reason}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// Reason and remedy.
        reason: String,
    },
    /// Writing failed; the file's former content is untouched.
    #[error("writing {} failed: {error}; the file, if there was one, is as it was before", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Error of the operating system; no `source`, since the message holds it.
        error: io::Error,
    },
    /// The images of one film, or two to compare, differ in size.
    #[error("{what}: {}x{} and {}x{} pixels", sizes[0][0], sizes[0][1], sizes[1][0], sizes[1][1])]
    Size {
        /// Description of the images.
        what: String,
        /// Width and height of both.
        sizes: [[u32; 2]; 2],
    },
}
