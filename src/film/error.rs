//! What can go wrong with picture files.

use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// An error reading, writing or comparing pictures.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is not an OpenEXR picture we can read.
    #[error("{} is not a readable OpenEXR picture: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The picture has no colour under the name asked for.
    #[error("{} has no {wanted}; its channels are: {}", path.display(), channels.join(", "))]
    NoColor {
        /// The file.
        path: PathBuf,
        /// What was looked for.
        wanted: String,
        /// What there is.
        channels: Vec<String>,
    },
    /// A picture cannot be written where the user asked for it; found before rendering.
    #[error("cannot write {}: {reason}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// Why, and what to do.
        reason: String,
    },
    /// Writing failed; what the file held before is untouched.
    #[error("writing {} failed: {source}; the file, if there was one, is as it was before", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The images of one film, or two to compare, differ in size.
    #[error("{what}: {}x{} and {}x{} pixels", sizes[0][0], sizes[0][1], sizes[1][0], sizes[1][1])]
    Size {
        /// Which images.
        what: String,
        /// Width and height of both.
        sizes: [[u32; 2]; 2],
    },
}
