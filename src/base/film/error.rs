//! Errors of image files.

use crate::exr_file::NoPicture;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// An error of reading, writing or comparing images.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system; no `source`, because the message contains it.
        error: io::Error,
    },
    /// The file is not a supported OpenEXR image.
    #[error("{} is not a readable OpenEXR image: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// Description of the error.
        reason: String,
    },
    /// No channels are clearly the colour of the image.
    #[error("{}: {none}", path.display())]
    NoPicture {
        /// The file.
        path: PathBuf,
        /// Channels of the file, and the remedy.
        none: NoPicture,
    },
    /// The image has no colour of the requested name.
    #[error("{} has no {wanted}; its channels are: {}", path.display(), channels.join(", "))]
    NoColor {
        /// The file.
        path: PathBuf,
        /// Requested name.
        wanted: String,
        /// Names of its channels.
        channels: Vec<String>,
    },
    /// An image cannot be written to the requested path; found before rendering.
    #[error("cannot write {}: {reason}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// Reason and remedy.
        reason: String,
    },
    /// Writing failed. The file's former content is unchanged.
    #[error("cannot write {}: {error}; an existing file is unchanged", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Error of the operating system; no `source`, because the message contains it.
        error: io::Error,
    },
    /// Images that belong together differ in size.
    #[error("{what}: {}x{} and {}x{} pixels", sizes[0][0], sizes[0][1], sizes[1][0], sizes[1][1])]
    Size {
        /// Description of the images.
        what: String,
        /// Width and height of both.
        sizes: [[u32; 2]; 2],
    },
}
