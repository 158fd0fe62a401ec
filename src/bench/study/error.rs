//! Errors of studies.

use base::film::ImageError;
use render::denoise::DenoiseError;
use render::session::OpenError;
use std::path::PathBuf;

/// Reason for which a study ended early. Images rendered until then are stored.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene cannot be read or prepared.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// Images of different sizes are compared.
    #[error(transparent)]
    Compare(ImageError),
    /// A result cannot be written.
    #[error(transparent)]
    Write(ImageError),
    /// A folder or a scene of the study's own cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// Path of the folder or file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A file of other programs' figures cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A line of other programs' figures is wrong.
    #[error(
        "{}:{line}: {what}; a line is a JSON object with name, scene, seconds, and rel_mse or flip, see \
         docs/benchmarks.md",
        path.display()
    )]
    Figures {
        /// Path of the file.
        path: PathBuf,
        /// Number of the line.
        line: usize,
        /// Description of the error.
        what: String,
    },
    /// The name of a setting to vary does not exist.
    #[error("there is no knob {name}; there are: {known}")]
    Knob {
        /// Name asked for.
        name: String,
        /// Names that exist.
        known: String,
    },
    /// An image cannot be denoised.
    #[error(transparent)]
    Denoise(DenoiseError),
    /// Threads cannot be started.
    #[error("cannot start {threads} threads; try fewer with --threads: {source}")]
    Threads {
        /// Number asked for.
        threads: usize,
        /// Reason.
        source: rayon::ThreadPoolBuildError,
    },
    /// The study was cancelled.
    #[error("interrupted; rendered images are kept, and the same command goes on from there")]
    Interrupted,
}
