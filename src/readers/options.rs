//! Options for reading a scene.

use crate::error::{Location, SceneError};
use crate::file::fnv1a;
use std::path::Path;

/// Options for reading a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// True if warnings of [`Severity::Warning`] are errors.
    pub strict: bool,
    /// Camera of the scene by its number, counted from 1, or its name, in place of the first.
    pub camera: Option<String>,
    /// Names and values of a Mitsuba scene's `$parameters`, in place of its defaults.
    pub parameters: Vec<(String, String)>,
}

impl LoadOptions {
    /// Rejects the choice of a camera but the first, for formats with one, and parameters.
    pub(crate) fn no_choice(&self, path: &Path) -> Result<(), SceneError> {
        self.no_parameters(path)?;
        let Some(camera) = self.camera.as_deref().filter(|camera| *camera != "1") else { return Ok(()) };
        let remedy = "a TOML scene has one: leave --camera out, which chooses among those of a Mitsuba scene (.xml) or a \
                      glTF model";
        Err(Location::file(path).no_camera(camera, remedy))
    }

    /// Rejects parameters, for formats without.
    pub(crate) fn no_parameters(&self, path: &Path) -> Result<(), SceneError> {
        let Some((name, _)) = self.parameters.first() else { return Ok(()) };
        let remedy = "leave --define out; it gives values to parameters that a Mitsuba scene (.xml) declares";
        Err(Location::file(path).wrong(format!("there is no parameter \"{name}\""), remedy))
    }

    /// Hash of a scene whose files have the hash `files`, with these options.
    pub(crate) fn hash(&self, files: u64) -> u64 {
        if self.camera.is_none() && self.parameters.is_empty() {
            return files;
        }
        fnv1a(format!("{files} {:?} {:?}", self.camera, self.parameters).as_bytes())
    }
}
