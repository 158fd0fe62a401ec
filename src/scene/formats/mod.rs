//! Scene readers: native TOML and Mitsuba XML, one model.
//!
//! A reader turns its text into a `Plan`, which opens meshes and pictures in parallel; the result is
//! sanitised and recentred. Features that the model lacks are replaced, with a [`Warning`] for each
//! replacement; under [`LoadOptions::strict`] the first of them is an error. Whatever the bytes, reading ends
//! in a scene or a [`SceneError`].

mod check;
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
pub(crate) use plan::fnv1a;

/// Options for reading a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadOptions {
    /// True if the first [`Level::Warning`] is an error.
    pub strict: bool,
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
    if scene.focuses_point_lights() {
        let what = "light of point, spot and directional lights that comes through solid glass is not found";
        let fallback =
            "surfaces behind the glass lack it; thin glass lets it pass, and light of small lamps is found";
        log.warn(&Place::file(path), what, fallback)?;
    }
    Ok(Loaded { scene, cameras, warnings: log.into_warnings(), repairs, hash, generator })
}
