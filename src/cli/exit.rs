//! Exit codes of a run.

use std::fmt;
use std::path::Path;

/// The run succeeded.
pub const SUCCESS: u8 = 0;
/// Rendering failed.
pub const RENDER: u8 = 1;
/// The command line is wrong, or the scene lacks what it asks for.
pub const USAGE: u8 = 2;
/// An input file, a scene or an image, is invalid.
pub const INPUT: u8 = 3;
/// The result cannot be written.
pub const OUTPUT: u8 = 4;
/// Some images of a batch failed; the others are complete.
pub const IN_PART: u8 = 5;
/// A signal stopped the run, which cleaned up. The run may be started again.
///
/// Schedulers requeue a job that ends with this code, `EX_TEMPFAIL` of sysexits.h.
pub const INTERRUPTED: u8 = 75;
/// A second signal stopped the run at once.
pub const ABORTED: u8 = 130;

/// Text of `--help` about exit codes.
pub const HELP: &str = "\
Exit codes:
    0  success
    1  rendering failed
    2  invalid arguments, or the scene lacks what they ask for
    3  invalid scene or image
    4  the result cannot be written
    5  some images of a batch failed, the others are complete
   75  stopped by a signal, may be started again
  130  stopped at once by a second signal

A still that is stopped by a signal is written as a partial image. If no pixel is rendered yet, nothing is written.
Frames of a walk and views of a list are complete or absent.";

/// Reason why a run failed, with its exit code.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    error: anyhow::Error,
}

impl Failure {
    /// Builds a failure of rendering.
    pub fn render(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: RENDER, error: error.into() }
    }

    /// Builds a failure due to a wrong command line.
    pub fn usage(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: USAGE, error: error.into() }
    }

    /// Builds a failure due to an invalid input file.
    pub fn input(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: INPUT, error: error.into() }
    }

    /// Builds a failure of writing a result.
    pub fn output(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: OUTPUT, error: error.into() }
    }

    /// Builds a failure of a part of the results.
    pub fn in_part(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: IN_PART, error: error.into() }
    }

    /// Adds the file that the failure is about.
    pub fn within(self, path: &Path) -> Failure {
        Failure { error: self.error.context(path.display().to_string()), ..self }
    }

    /// Adds the place in a job file.
    pub fn at(self, place: &str) -> Failure {
        Failure { error: self.error.context(place.to_owned()), ..self }
    }

    /// Builds a failure due to a signal.
    pub fn interrupted(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: INTERRUPTED, error: error.into() }
    }

    /// Returns the exit code of the process.
    pub fn code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The alternate form appends the causes to the message, separated by colons.
        write!(f, "{:#}", self.error)
    }
}
