//! Errors of reading scenes, and warnings about features that are not supported.
//!
//! Both name the file and, if possible, the line.

use super::built_in;
use base::file_kind::FileKind;
use base::shown::shown_line;
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};

/// A file, and a line of it if known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The file.
    pub path: PathBuf,
    /// Line, counted from 1.
    pub line: Option<u32>,
}

impl Location {
    /// Returns the location of a file as a whole.
    pub fn file(path: &Path) -> Location {
        Location { path: path.to_owned(), line: None }
    }

    /// Returns the location of a line, counted from 1.
    pub fn line(path: &Path, line: u32) -> Location {
        Location { path: path.to_owned(), line: Some(line) }
    }

    /// Returns the error of a wrong value here.
    pub fn wrong(&self, what: impl Into<String>, remedy: impl Into<String>) -> SceneError {
        SceneError::Value { place: self.clone(), what: one_line(what), remedy: one_line(remedy) }
    }

    /// Returns the error of a name that is used here and not defined.
    pub fn undefined(&self, kind: &'static str, name: &str) -> SceneError {
        SceneError::Reference { place: self.clone(), kind, name: one_line(name) }
    }

    /// Returns the error of a requested camera that the scene lacks.
    pub(crate) fn no_camera(&self, name: &str, remedy: impl Into<String>) -> SceneError {
        SceneError::Camera { place: self.clone(), name: one_line(name), remedy: one_line(remedy) }
    }

    /// Returns the error of text that is not well-formed here.
    pub(crate) fn malformed(&self, message: impl Into<String>) -> SceneError {
        SceneError::Syntax { place: self.clone(), message: one_line(message) }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}", shown_path(&self.path)),
            None => f.write_str(&shown_path(&self.path)),
        }
    }
}

/// Returns a message as one line, without characters that act on a terminal.
fn one_line(text: impl Into<String>) -> String {
    shown_line(&text.into()).into_owned()
}

/// Returns the name of a file for messages.
fn shown_path(path: &Path) -> String {
    one_line(path.to_string_lossy())
}

/// Severity of a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The expected image is the one described, apart from filtering or tessellation.
    Note,
    /// The image differs from the one described. This is an error under `strict`.
    Warning,
}

/// A feature requested by a scene file that is not supported, and its replacement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Location of the request.
    pub place: Location,
    /// Severity.
    pub severity: Severity,
    /// The feature requested.
    pub what: String,
    /// The replacement.
    pub fallback: String,
}

impl Warning {
    /// Returns a warning about a change of the image.
    pub(crate) fn new(place: Location, what: impl Into<String>, fallback: impl Into<String>) -> Warning {
        Warning { place, severity: Severity::Warning, what: what.into(), fallback: fallback.into() }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&shown_line(&format!("{}: {}; {}", self.place, self.what, self.fallback)))
    }
}

/// Reasons why a scene could not be read. Every message ends in a remedy.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A file that cannot be opened or read.
    #[error("{}cannot read {}: {error}; check the name and its permissions", asker(.from, .path), shown_path(.path))]
    Read {
        /// The file.
        path: PathBuf,
        /// Location of the reference to the file.
        from: Location,
        /// Error of the operating system; no `source`, because the message contains it.
        error: std::io::Error,
    },
    /// A file that is something else than its name says.
    #[error("{}{}: this is {}; {}", asker(.from, .path), shown_path(.path), .kind.what, .kind.remedy)]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Location of the reference to the file.
        from: Location,
        /// Kind of the file by its first bytes.
        kind: FileKind,
    },
    /// A file whose extension belongs to no supported format.
    #[error("{}: {}", shown_path(.path), way_out(.path, .kind))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Kind of the file by its first bytes.
        kind: Option<FileKind>,
    },
    /// Text that is not well-formed XML or TOML.
    #[error("{place}: {message}; correct the file's syntax")]
    Syntax {
        /// Location of the error.
        place: Location,
        /// Message of the parser.
        message: String,
    },
    /// A value that is missing, of the wrong type or out of range.
    #[error("{place}: {what}; {remedy}")]
    Value {
        /// Location of the value.
        place: Location,
        /// Description of the error.
        what: String,
        /// Remedy.
        remedy: String,
    },
    /// A reference to a name that is not defined in the scene.
    #[error("{place}: there is no {kind} called \"{name}\"; define it or correct the name")]
    Reference {
        /// Location of the reference.
        place: Location,
        /// Kind of object referred to.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A requested camera that the scene lacks.
    #[error("{place}: there is no camera \"{name}\"; {remedy}")]
    Camera {
        /// The scene.
        place: Location,
        /// Number or name of the camera.
        name: String,
        /// Remedy, with a list of the scene's cameras.
        remedy: String,
    },
    /// A mesh file with wrong contents.
    #[error("{place}: {what}; repair or re-export the mesh")]
    Mesh {
        /// Location of the error.
        place: Location,
        /// Description of the error.
        what: String,
    },
    /// An image that cannot be decoded.
    #[error("{place}: cannot decode {}: {what}; convert it to PNG, JPEG, BMP, TGA, Radiance HDR or OpenEXR", shown_path(.path))]
    Image {
        /// Location of the reference to the file.
        place: Location,
        /// The image file.
        path: PathBuf,
        /// Message of the decoder.
        what: String,
    },
    /// Errors of several parts of a scene, in the order of the description.
    #[error("{}{}", lines(.first), more(.left_out))]
    Several {
        /// The first errors, at most [`MAX_ERRORS`].
        first: Vec<SceneError>,
        /// Number of errors after these.
        left_out: usize,
    },
    /// A warning, under `strict`.
    #[error("{0} (an error because of --strict); remove the cause, or leave --strict out")]
    Strict(Warning),
}

/// Returns what a file of an unknown format is, and how to get a scene from it.
fn way_out(path: &Path, kind: &Option<FileKind>) -> String {
    if let Some(kind) = kind.filter(FileKind::is_substitute) {
        return format!("this is {}; {}", kind.what, kind.remedy);
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let from_blender =
        "export glTF 2.0 (.glb) from Blender, with Include > Cameras and Punctual Lights ticked";
    let (what, remedy) = match extension.as_str() {
        "blend" => ("a file of Blender", from_blender.to_owned()),
        "fbx" | "dae" | "3ds" | "abc" | "x3d" | "wrl" => {
            ("a format that is not read", format!("import it in Blender, then {from_blender}"))
        }
        "usd" | "usda" | "usdc" | "usdz" => {
            ("a USD scene, which is not read", format!("import it in Blender, then {from_blender}"))
        }
        "pbrt" => ("a scene of pbrt", "convert it to Mitsuba 3 (.xml), or export glTF 2.0 (.glb)".to_owned()),
        "ma" | "mb" | "max" | "c4d" | "hip" | "skp" | "3dm" => {
            ("a file of a modelling program", "export glTF 2.0 (.glb) from that program".to_owned())
        }
        "step" | "stp" | "iges" | "igs" => {
            ("a CAD model without triangles", "export STL or glTF 2.0".to_owned())
        }
        "exr" | "png" | "jpg" | "jpeg" | "hdr" => {
            ("an image, not a scene", "name a scene, and an image for its light with --env".to_owned())
        }
        "json" if kind.is_none() => {
            ("no scene", "name text of glTF .gltf, and give a list of cameras to `views`".to_owned())
        }
        "mtl" => ("a library of materials", "name the .obj file that uses it".to_owned()),
        "serialized" => ("a mesh without a scene", "name a Mitsuba or TOML scene that uses it".to_owned()),
        "off" => ("a mesh in the format OFF", "convert it to PLY or OBJ".to_owned()),
        "" if kind.is_none() => (
            "neither a file with a known extension nor a built-in scene",
            format!(
                "name a .glb, .gltf, .obj, .ply, .stl, .toml or .xml file, or one of {}",
                built_in::names()
            ),
        ),
        _ => match kind {
            Some(kind) => (kind.what, kind.remedy.to_owned()),
            None => (
                "an unknown kind of scene",
                "name a .glb, .gltf, .obj, .ply, .stl, .toml (native) or .xml (Mitsuba) file".to_owned(),
            ),
        },
    };
    format!("this is {what}; {remedy}")
}

/// Maximum number of errors in one message.
const MAX_ERRORS: usize = 10;

/// Returns the location that refers to a file, if it is in another file.
fn asker(from: &Location, path: &Path) -> String {
    if *from == Location::file(path) { String::new() } else { format!("{from}: ") }
}

fn lines(errors: &[SceneError]) -> String {
    errors.iter().map(SceneError::to_string).collect::<Vec<_>>().join("\n")
}

fn more(left_out: &usize) -> String {
    if *left_out > 0 { format!("\nand {left_out} more errors") } else { String::new() }
}

impl SceneError {
    /// Returns one error for all of `errors`, without repetitions.
    pub fn all(errors: Vec<SceneError>) -> SceneError {
        let mut said = BTreeSet::new();
        let mut first: Vec<SceneError> =
            errors.into_iter().filter(|error| said.insert(error.to_string())).collect();
        let left_out = first.len().saturating_sub(MAX_ERRORS);
        first.truncate(MAX_ERRORS);
        if first.len() == 1 { first.remove(0) } else { SceneError::Several { first, left_out } }
    }

    /// Returns the error of a wrong mesh file.
    pub fn mesh(place: Location, what: impl Into<String>) -> SceneError {
        SceneError::Mesh { place, what: one_line(what) }
    }
}

/// Log of warnings, and of the errors of independent parts of a description.
///
/// Under `strict`, warnings are errors.
#[derive(Debug, Default)]
pub(crate) struct Log {
    strict: bool,
    warnings: Vec<Warning>,
    errors: Vec<SceneError>,
}

impl Log {
    /// Returns an empty log; in a `strict` one, warnings are errors.
    pub fn new(strict: bool) -> Log {
        Log { strict, ..Log::default() }
    }

    /// Returns the value of a part of the description, or stores its error and returns `None`.
    pub fn part<T>(&mut self, outcome: Result<T, SceneError>) -> Option<T> {
        outcome.map_err(|error| self.errors.push(error)).ok()
    }

    /// Returns the value of the last part, or the errors of all parts if there are any.
    pub fn conclude<T>(&mut self, last: Result<T, SceneError>) -> Result<T, SceneError> {
        let mut errors = std::mem::take(&mut self.errors);
        match last.map_err(|error| errors.push(error)) {
            Ok(value) if errors.is_empty() => Ok(value),
            _ => Err(SceneError::all(errors)),
        }
    }

    /// Adds a warning about a change of the image.
    ///
    /// # Errors
    /// Under `strict`.
    pub fn warn(
        &mut self,
        place: &Location,
        what: impl Into<String>,
        fallback: impl Into<String>,
    ) -> Result<(), SceneError> {
        self.add(Warning::new(place.clone(), what, fallback))
    }

    /// Adds a warning that was made elsewhere.
    ///
    /// # Errors
    /// Under `strict`, unless it is a note.
    pub fn add(&mut self, warning: Warning) -> Result<(), SceneError> {
        if self.strict && warning.severity == Severity::Warning {
            return Err(SceneError::Strict(warning));
        }
        self.push(warning);
        Ok(())
    }

    /// Adds a note about a feature that does not change the expected image.
    pub fn note(&mut self, place: &Location, what: impl Into<String>, fallback: impl Into<String>) {
        self.push(Warning {
            place: place.clone(),
            severity: Severity::Note,
            what: what.into(),
            fallback: fallback.into(),
        });
    }

    /// Adds a warning, unless the log already contains it.
    fn push(&mut self, warning: Warning) {
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// Returns the warnings in the order in which they were added.
    pub fn into_warnings(self) -> Vec<Warning> {
        self.warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_parts_are_told_together_each_once_and_no_more_than_ten() {
        let mut log = Log::new(false);
        let place = |line| Location::line(Path::new("s.xml"), line);
        assert_eq!(log.part(Ok(7)), Some(7));
        assert!(log.conclude(Ok(())).is_ok());
        log.part::<()>(Err(place(1).wrong("a", "b")));
        assert_eq!(log.conclude(Ok(())).unwrap_err().to_string(), "s.xml:1: a; b");
        assert!(log.conclude(Ok(())).is_ok());
        for line in (1..=12).flat_map(|line| [line, line]) {
            log.part::<()>(Err(place(line).wrong("a", "b")));
        }
        let text = log.conclude(Ok(())).unwrap_err().to_string();
        assert_eq!(text.lines().count(), 11, "{text}");
        assert!(text.contains("s.xml:10: a; b\nand 2 more errors"), "{text}");
    }
}
