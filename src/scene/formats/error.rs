//! What can be wrong with a scene, and what was understood only in part: both name the file and the line.

use std::fmt;
use std::path::{Path, PathBuf};

/// A file, and a line where one is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub path: PathBuf,
    /// Line, counted from 1.
    pub line: Option<u32>,
}

impl Place {
    /// The file as a whole.
    pub fn file(path: &Path) -> Place {
        Place { path: path.to_owned(), line: None }
    }

    /// Line `line` (from 1) of the file.
    pub fn line(path: &Path, line: u32) -> Place {
        Place { path: path.to_owned(), line: Some(line) }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}", self.path.display()),
            None => write!(f, "{}", self.path.display()),
        }
    }
}

/// How much a warning matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// The expected picture is what the file asks for, to within filtering or tessellation.
    Note,
    /// The picture will differ from what the file asks for; an error under `strict`.
    Warning,
}

/// Something a scene file asks for that is not modelled, and what is done instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where it is asked for.
    pub place: Place,
    /// How much it matters.
    pub level: Level,
    /// What is asked for.
    pub what: String,
    /// What is done instead.
    pub fallback: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}; {}", self.place, self.what, self.fallback)
    }
}

/// Why a scene could not be read. Every message ends in a remedy.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A file that cannot be opened or read.
    #[error("{}: cannot read {}: {source}; check the name and its permissions", .from, .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Where it is asked for.
        from: Place,
        /// What the system said.
        source: std::io::Error,
    },
    /// Neither extension that is understood.
    #[error("{}: unknown kind of scene; name a .toml (native) or .xml (Mitsuba) file", .0.display())]
    UnknownFormat(PathBuf),
    /// Text that is not well-formed XML or TOML.
    #[error("{place}: {message}; correct the file's syntax")]
    Syntax {
        /// Where.
        place: Place,
        /// What the parser said.
        message: String,
    },
    /// A value that is missing, of the wrong type or out of range.
    #[error("{place}: {what}; {remedy}")]
    Value {
        /// Where.
        place: Place,
        /// What is wrong.
        what: String,
        /// What to do.
        remedy: String,
    },
    /// A name that nothing in the scene bears.
    #[error("{place}: there is no {kind} called \"{name}\"; define it or correct the name")]
    Reference {
        /// Where it is used.
        place: Place,
        /// What kind of thing is meant.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A mesh file with wrong contents.
    #[error("{place}: {what}; repair or re-export the mesh")]
    Mesh {
        /// Where.
        place: Place,
        /// What is wrong.
        what: String,
    },
    /// A picture that cannot be decoded.
    #[error("{place}: cannot decode {}: {what}; convert it to PNG, JPEG, BMP, TGA, Radiance HDR or OpenEXR", .path.display())]
    Picture {
        /// Where it is asked for.
        place: Place,
        /// The picture.
        path: PathBuf,
        /// What the decoder said.
        what: String,
    },
    /// A warning, under `strict`.
    #[error("{0} (an error because of strict reading); remove it, or read without strict")]
    Strict(Warning),
}

impl SceneError {
    /// A wrong value.
    pub(crate) fn value(place: &Place, what: impl Into<String>, remedy: impl Into<String>) -> SceneError {
        SceneError::Value { place: place.clone(), what: what.into(), remedy: remedy.into() }
    }

    /// A wrong mesh file.
    pub(crate) fn mesh(place: Place, what: impl Into<String>) -> SceneError {
        SceneError::Mesh { place, what: what.into() }
    }
}

/// Collects warnings, or turns the first into an error under `strict`.
#[derive(Debug, Default)]
pub(crate) struct Log {
    strict: bool,
    warnings: Vec<Warning>,
}

impl Log {
    pub fn new(strict: bool) -> Log {
        Log { strict, warnings: Vec::new() }
    }

    /// Something that changes the picture.
    pub fn warn(
        &mut self,
        place: &Place,
        what: impl Into<String>,
        fallback: impl Into<String>,
    ) -> Result<(), SceneError> {
        let warning = Warning {
            place: place.clone(),
            level: Level::Warning,
            what: what.into(),
            fallback: fallback.into(),
        };
        if self.strict {
            return Err(SceneError::Strict(warning));
        }
        self.push(warning);
        Ok(())
    }

    /// Something that does not change the expected picture.
    pub fn note(&mut self, place: &Place, what: impl Into<String>, fallback: impl Into<String>) {
        self.push(Warning {
            place: place.clone(),
            level: Level::Note,
            what: what.into(),
            fallback: fallback.into(),
        });
    }

    /// The same thing at the same place is said once.
    fn push(&mut self, warning: Warning) {
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    pub fn into_warnings(self) -> Vec<Warning> {
        self.warnings
    }
}
