//! Exit codes of a run.

use std::fmt;
use std::path::Path;

/// All went well.
pub const SUCCESS: u8 = 0;
/// Rendering failed.
pub const RENDER: u8 = 1;
/// The command line is wrong, or asks for what the scene has not.
pub const USAGE: u8 = 2;
/// A scene or picture that was given is invalid.
pub const INPUT: u8 = 3;
/// The result cannot be written.
pub const OUTPUT: u8 = 4;
/// Some pictures of a batch failed; the others are done.
pub const IN_PART: u8 = 5;
/// Stopped by a signal after tidying up: the same run, begun again, may well succeed. This is the code `EX_TEMPFAIL` of
/// sysexits.h, by which schedulers know that a job asks to be queued again.
pub const INTERRUPTED: u8 = 75;
/// Stopped at once, by a second signal.
pub const ABORTED: u8 = 130;

/// Text of `--help` about exit codes.
pub const HELP: &str = "Exit codes: 0 done; 1 rendering failed; 2 wrong command line, or one that asks for what the \
scene has not; 3 invalid scene or picture; 4 the result cannot be written; 5 some pictures of a batch failed, the \
others are done; 75 stopped by a signal (a still is written as far as it is rendered, marked as partial, and nothing \
while planning or before its first pixel; frames of a walk are whole or not written): queue it again; 130 stopped at \
once by a second signal.";

/// Why a run ended without success.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    error: anyhow::Error,
}

impl Failure {
    /// Rendering failed.
    pub fn render(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: RENDER, error: error.into() }
    }

    /// The command line is wrong.
    pub fn usage(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: USAGE, error: error.into() }
    }

    /// A scene or picture that was given is invalid.
    pub fn input(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: INPUT, error: error.into() }
    }

    /// The result cannot be written.
    pub fn output(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: OUTPUT, error: error.into() }
    }

    /// A part of the results failed.
    pub fn in_part(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: IN_PART, error: error.into() }
    }

    /// The same, with the file that it is about.
    pub fn within(self, path: &Path) -> Failure {
        Failure { error: self.error.context(path.display().to_string()), ..self }
    }

    /// The same, with its place in a job file.
    pub fn at(self, place: &str) -> Failure {
        Failure { error: self.error.context(place.to_owned()), ..self }
    }

    /// Interrupted by a signal.
    pub fn interrupted(error: impl Into<anyhow::Error>) -> Failure {
        Failure { code: INTERRUPTED, error: error.into() }
    }

    /// The process's exit code.
    pub fn code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The alternate form puts the causes behind the message, separated by colons.
        write!(f, "{:#}", self.error)
    }
}
