//! Scene readers: native TOML and Mitsuba XML, one model.
//!
//! A reader turns its text into a `Plan`, which opens meshes and pictures in parallel; the result is
//! sanitised and recentred. A description that asks for something the model lacks is read as far as it goes,
//! with a [`Warning`] for each replacement; under [`LoadOptions::strict`] the first of them is an error.
//! Whatever the bytes, reading ends in a scene or a [`SceneError`].

mod constants;
pub(crate) mod error;
mod mesh;
mod mitsuba;
mod native;
mod picture;
mod plan;

use super::{Cameras, Scene, recentre, sanitize};
use error::Log;
use std::path::Path;

pub use super::sanitize::SanitizeReport;
pub use error::{Level, Place, SceneError, Warning};
pub(crate) use mesh::smooth_normals;

/// How to read a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadOptions {
    /// Treat the first [`Level::Warning`] as an error.
    pub strict: bool,
}

/// A scene and what was noticed on the way.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, sanitised and recentred.
    pub scene: Scene,
    /// From where its file wants it to be seen.
    pub cameras: Cameras,
    /// What was replaced, in the order of the description.
    pub warnings: Vec<Warning>,
    /// What had to be repaired.
    pub repairs: SanitizeReport,
    /// Hash over the bytes of all source files, in order (64-bit FNV-1a).
    pub hash: u64,
    /// The generator of its geometry, where it has one.
    pub generator: Option<String>,
}

/// Reads the scene at `path`: `.toml` is native, `.xml` Mitsuba's.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let mut log = Log::new(options.strict);
    let plan = match extension.as_deref() {
        Some("toml") => native::read(path, &mut log)?,
        Some("xml") => mitsuba::read(path, &mut log)?,
        _ => return Err(SceneError::UnknownFormat(path.to_owned())),
    };
    let generator = plan.generator.clone();
    let (mut draft, hash) = plan.realise()?;
    let (repairs, centre) = sanitize::sanitize(&mut draft)?;
    let (scene, cameras) = recentre::recentre(draft, centre);
    Ok(Loaded { scene, cameras, warnings: log.into_warnings(), repairs, hash, generator })
}
