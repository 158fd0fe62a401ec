//! Scene readers: native TOML, Mitsuba XML and glTF, one model.
//!
//! A reader turns its text into a `Plan`, which opens meshes and pictures in parallel; the result is
//! sanitised and recentred. Features that the model lacks are replaced, with a [`Warning`] for each
//! replacement; under [`LoadOptions::strict`] they are errors. Whatever the bytes, reading ends
//! in a scene or a [`SceneError`].

#![forbid(unsafe_code)]

mod budget;
mod check;
mod constants;
mod draft;
pub mod error;
mod file;
mod finish;
mod gltf;
mod layers;
mod mesh;
mod mitsuba;
mod native;
mod picture;
mod plan;
#[cfg(test)]
mod requirements_tests;
mod sky;

use error::Log;
use finish::{divide, recentre, sanitize};
use scene::{Cameras, Scene};
use std::path::Path;

pub use error::{Level, Place, SceneError, Warning};
pub use file::{fnv1a, read_regular};
pub use finish::sanitize::SanitizeReport;
pub(crate) use mesh::smooth_normals;

/// Options for reading a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// True if warnings of [`Level::Warning`] are errors.
    pub strict: bool,
    /// Camera of the scene by its number, counted from 1, or its name, in place of the first.
    pub camera: Option<String>,
    /// Names and values of a Mitsuba scene's `$parameters`, in place of its defaults.
    pub parameters: Vec<(String, String)>,
}

impl LoadOptions {
    /// Rejects the choice of a camera but the first, for formats with one, and parameters.
    fn no_choice(&self, path: &Path) -> Result<(), SceneError> {
        self.no_parameters(path)?;
        let Some(camera) = self.camera.as_deref().filter(|camera| *camera != "1") else { return Ok(()) };
        let remedy = "a TOML scene has one: leave --camera out, which chooses among those of a Mitsuba scene (.xml) or a \
                      glTF model";
        Err(Place::file(path).no_camera(camera, remedy))
    }

    /// Rejects parameters, for formats without.
    fn no_parameters(&self, path: &Path) -> Result<(), SceneError> {
        let Some((name, _)) = self.parameters.first() else { return Ok(()) };
        let remedy = "leave --define out; it gives values to parameters that a Mitsuba scene (.xml) declares";
        Err(Place::file(path).wrong(format!("there is no parameter \"{name}\""), remedy))
    }

    /// Hash of a scene whose files have the hash `files`, with these options.
    fn hash(&self, files: u64) -> u64 {
        if self.camera.is_none() && self.parameters.is_empty() {
            return files;
        }
        fnv1a(format!("{files} {:?} {:?}", self.camera, self.parameters).as_bytes())
    }
}

/// A scene, its cameras, and reports of reading it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, sanitised and recentred.
    pub scene: Scene,
    /// Cameras and film size that its file describes.
    pub cameras: Cameras,
    /// Warnings about replacements, in the order of the description.
    pub warnings: Vec<Warning>,
    /// Report of repairs.
    pub repairs: SanitizeReport,
    /// Hash over the bytes of all source files, in order (64-bit FNV-1a).
    pub hash: u64,
    /// The generator of its geometry, if any.
    pub generator: Option<String>,
}

/// Reads the scene at `path`: `.toml` is native, `.xml` Mitsuba's, `.glb` and `.gltf` glTF.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let mut log = Log::new(options.strict);
    let plan = match extension.as_deref() {
        Some("toml") => {
            options.no_choice(path)?;
            native::read(path, &mut log)?
        }
        Some("xml") => mitsuba::read(path, options, &mut log)?,
        Some("glb" | "gltf") => {
            options.no_parameters(path)?;
            gltf::read(path, options, &mut log)?
        }
        _ => return Err(SceneError::UnknownFormat(path.to_owned())),
    };
    let generator = plan.generator.clone();
    let (mut draft, hash) = plan.realise(&mut log)?;
    let hash = options.hash(hash);
    let (repairs, coordinates) = sanitize::sanitize(&mut draft, &mut log)?;
    divide::divide(&mut draft, &coordinates);
    let (scene, cameras) = recentre::recentre(draft, &coordinates);
    if scene.is_dark() {
        let fallback = "the picture will be black; add an emitter, a light or an environment";
        log.warn(&Place::file(path), "the scene has no light that is modelled", fallback)?;
    }
    Ok(Loaded { scene, cameras, warnings: log.into_warnings(), repairs, hash, generator })
}
