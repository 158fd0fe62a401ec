//! Errors of reading OpenEXR files.

use ::exr::error::Error;
use std::io;

/// An error of reading an OpenEXR file.
#[derive(Debug, thiserror::Error)]
pub enum ExrError {
    /// The file cannot be read.
    #[error("{0}")]
    Io(io::Error),
    /// The file is damaged, or has features that are not read.
    #[error("{0}")]
    Content(String),
}

impl ExrError {
    /// Returns the error of wrong or unread content.
    pub(super) fn content(what: impl Into<String>) -> ExrError {
        ExrError::Content(what.into())
    }
}

impl From<Error> for ExrError {
    fn from(error: Error) -> ExrError {
        match error {
            Error::Io(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                ExrError::Content("the file ends too early".to_owned())
            }
            Error::Io(error) => ExrError::Io(error),
            other => ExrError::Content(other.to_string()),
        }
    }
}
