//! Options for reading a scene.

use crate::error::{Location, SceneError};
use crate::file::fnv1a;
use crate::lighting::{Lighting, UpAxis};
use crate::looks::Looks;
use crate::viewpoint::Viewpoint;
use std::path::Path;

/// Options for reading a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadOptions {
    /// True if warnings of [`Severity::Warning`](crate::Severity::Warning) are errors.
    pub strict: bool,
    /// Number, counted from 1, or name of the camera to use. `None` stands for the first.
    pub camera: Option<String>,
    /// Names and values of a Mitsuba scene's `$parameters`. They replace the defaults of the scene.
    pub parameters: Vec<(String, String)>,
    /// Frame, counted from 1, whose pose a glTF model takes; `None` for its pose at rest.
    pub frame: Option<usize>,
    /// Light in addition to that of the scene, or in place of it.
    pub lighting: Lighting,
    /// Changes of the camera.
    pub viewpoint: Viewpoint,
    /// Changes of what the scene shows.
    pub looks: Looks,
    /// Number of triangles up to which instances are copies; `None` for the default.
    pub most_copied: Option<u64>,
    /// Units of a glTF model's lamps that count for one watt; `None` for the units of its exporter.
    pub lumens_per_watt: Option<f32>,
    /// True if glass without a volume is thin, even if Blender wrote a closed mesh.
    pub thin_glass: bool,
    /// Upward axis for light and camera; `None` stands for z for STL files, and for y otherwise.
    pub up: Option<UpAxis>,
}

impl LoadOptions {
    /// Returns the upward axis of the scene at `path`, if it is known. Models for printing and from computer-aided
    /// design (STL) stand on z.
    pub fn upward(&self, path: &Path) -> Option<UpAxis> {
        let is_stl = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("stl"));
        self.up.or(is_stl.then_some(UpAxis::Z))
    }

    /// Rejects parameters, and any camera but the first, for formats with one camera.
    pub(crate) fn no_choice(&self, path: &Path) -> Result<(), SceneError> {
        self.no_parameters(path)?;
        let Some(camera) = self.camera.as_deref().filter(|camera| *camera != "1") else { return Ok(()) };
        let remedy = "a TOML scene has one camera: leave --camera out, which is for Mitsuba scenes (.xml) and glTF \
                      models";
        Err(Location::file(path).no_camera(camera, remedy))
    }

    /// Rejects what only a glTF model has.
    pub(crate) fn no_model(&self, path: &Path) -> Result<(), SceneError> {
        let what = match (self.lumens_per_watt, self.thin_glass) {
            (Some(_), _) => "--lumens-per-watt",
            (None, true) => "--thin-glass",
            (None, false) => return Ok(()),
        };
        let remedy = format!("leave {what} out; a mesh in a TOML scene has a key for it");
        Err(Location::file(path).wrong(format!("{what} is for glTF models"), remedy))
    }

    /// Rejects parameters, for formats without parameters.
    pub(crate) fn no_parameters(&self, path: &Path) -> Result<(), SceneError> {
        let Some((name, _)) = self.parameters.first() else { return Ok(()) };
        let remedy = "leave --define out; it gives values to parameters that a Mitsuba scene (.xml) declares";
        Err(Location::file(path).wrong(format!("there is no parameter \"{name}\""), remedy))
    }

    /// Returns the hash of a scene with these options; `files` is the hash of its files.
    pub(crate) fn hash(&self, files: u64) -> u64 {
        let LoadOptions { strict, frame, camera, parameters, lighting, viewpoint, most_copied, up, .. } =
            self;
        // The frame counts only if a model takes its pose.
        if *self == (LoadOptions { strict: *strict, frame: *frame, ..LoadOptions::default() }) {
            return files;
        }
        let files = most_copied.map_or(files, |most| fnv1a(format!("{files} {most}").as_bytes()));
        let files = match (self.lumens_per_watt, self.thin_glass) {
            (None, false) => files,
            units_and_glass => fnv1a(format!("{files} {units_and_glass:?}").as_bytes()),
        };
        let files = match &self.looks {
            looks if *looks == Looks::default() => files,
            looks => fnv1a(format!("{files} {looks:?}").as_bytes()),
        };
        if *lighting == Lighting::default() && *viewpoint == Viewpoint::default() && up.is_none() {
            return fnv1a(format!("{files} {camera:?} {parameters:?}").as_bytes());
        }
        let added = format!("{lighting:?} {viewpoint:?} {up:?}");
        fnv1a(format!("{files} {camera:?} {parameters:?} {added}").as_bytes())
    }
}
