//! Errors of studies.

use render::session::OpenError;

/// Reason for which a study ended early. Images rendered until then are stored.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene cannot be read or prepared.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// Images cannot be compared, or figures of other programs cannot be read.
    #[error("{0}")]
    Input(String),
    /// The name of a setting to vary does not exist.
    #[error("{0}")]
    Usage(String),
    /// An image cannot be denoised, or threads cannot be started.
    #[error("{0}")]
    Render(String),
    /// A file cannot be written.
    #[error("{0}")]
    Output(String),
    /// The study was cancelled.
    #[error("interrupted; rendered images are kept, and the same command goes on from there")]
    Interrupted,
}

impl StudyError {
    /// Returns the error of a folder or file that cannot be written.
    pub fn write(path: &std::path::Path, source: std::io::Error) -> StudyError {
        StudyError::Output(format!("cannot write {}: {source}", path.display()))
    }
}
