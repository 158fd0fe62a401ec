//! Readers of scene files: native TOML, Mitsuba XML and glTF.
//!
//! Stages: each reader parses its text into a `ScenePlan`. `realise` opens the meshes and images of the plan in
//! parallel and returns a `Draft`. `finish` repairs and recentres the draft and returns the [`Scene`].
//!
//! Features that the model lacks are replaced, with a [`Warning`] each; under [`LoadOptions::strict`] they are errors.
//! Reading any bytes ends in a scene or a [`SceneError`].

#![forbid(unsafe_code)]

mod attenuation;
#[cfg(test)]
mod attribute_tests;
mod attributes;
mod budget;
mod built_in;
mod check;
mod colour_profile;
mod constants;
mod decode;
mod draft;
pub mod error;
mod file;
mod findings;
mod finish;
mod gltf;
#[cfg(test)]
mod instance_tests;
mod instances;
mod json_text;
mod lacking_uvs;
mod layers;
mod lighting;
mod local;
mod looks;
mod mend;
mod mesh;
#[cfg(test)]
mod mirrored_tests;
#[cfg(test)]
mod missing_tests;
mod mitsuba;
mod native;
mod options;
#[cfg(test)]
mod picture_tests;
mod plan;
mod realise;
#[cfg(test)]
mod requirements_tests;
mod selection;
mod sky;
mod stand_in;
mod statements;
mod surfaces;
#[cfg(test)]
mod texel_tests;
mod viewpoint;
mod views;

use error::Log;
use finish::{divide, recentre, sanitize, wanted};
use plan::Motion;
use scene::{Cameras, MAX_FRAMES, Scene};
use std::path::Path;

pub use built_in::{is_built_in, names as built_in_scenes};
pub use error::{Location, SceneError, Severity, Warning};
pub use file::{fnv1a, read_regular, text_of};
pub use finish::sanitize::SanitizeReport;
pub use lighting::{EnvironmentChoice, Lighting, UpAxis};
pub use looks::Looks;
pub(crate) use mesh::smooth_normals;
pub use options::LoadOptions;
pub use viewpoint::{Lens, Viewpoint};
pub use views::{SceneView, ViewList};

/// A scene, its cameras, and reports of reading it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, sanitised and recentred.
    pub scene: Scene,
    /// Cameras and film size that its file describes.
    pub cameras: Cameras,
    /// Names of the cameras among which `--camera` chooses, in their order; empty names for cameras without one.
    pub camera_names: Vec<String>,
    /// Number of frames of the camera path or of the model's animation; 0 without both.
    pub animation_frames: usize,
    /// Warnings about replacements, in the order of the description.
    pub warnings: Vec<Warning>,
    /// Report of repairs.
    pub repairs: SanitizeReport,
    /// Hash over the bytes of all source files in order, and over the options (64-bit FNV-1a).
    pub hash: u64,
    /// True if the options ask for a frame of a model whose meshes or lights move.
    pub moves: bool,
}

/// Reads the scene at `path`: `.toml` is native, `.xml` Mitsuba's, `.glb` and `.gltf` glTF. `.obj`, `.ply` and `.stl`
/// are meshes alone. A name without folder and extension, which no file has, means a built-in scene.
///
/// A glTF file or mesh without a lamp gets a default sky, unless the options say otherwise.
///
/// # Errors
/// If a file cannot be read or decoded, or the scene is invalid. Under [`LoadOptions::strict`] also if a feature is not
/// modelled.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    let built_in = built_in::resolve(path);
    let path = built_in.as_deref().unwrap_or(path);
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let mut log = Log::new(options.strict);
    let is_model = !matches!(extension.as_str(), "toml" | "xml");
    if !matches!(extension.as_str(), "glb" | "gltf") {
        options.no_model(path)?;
    }
    let mut plan = match extension.as_str() {
        "toml" => {
            options.no_choice(path)?;
            native::read(path, &mut log)?
        }
        "xml" => mitsuba::read(path, options, &mut log)?,
        "glb" | "gltf" => {
            options.no_parameters(path)?;
            gltf::read(path, options, &mut log)?
        }
        "obj" | "ply" | "stl" => {
            options.no_choice(path)?;
            native::read_model(path, &extension, &mut log)?
        }
        _ => return Err(SceneError::UnknownFormat { path: path.to_owned(), kind: file::kind_of(path) }),
    };
    let up = options.upward(path);
    options.lighting.apply(&mut plan.contents, up.unwrap_or(UpAxis::Y), is_model, path, &mut log)?;
    let Motion { frames, animation_frames, moves } = plan.motion;
    let posed_frames = frames.min(MAX_FRAMES);
    let camera_names = plan.shot.names.clone();
    let animation_frames = animation_frames.min(MAX_FRAMES).max(plan.shot.path.len());
    let (mut draft, hash) = plan.realise(options.most_copied.unwrap_or(instances::MOST_COPIED), &mut log)?;
    // A mesh file is opened after its material libraries, and is the main file.
    let sources = &mut draft.scene.sources;
    if let Some(at) = sources.iter().position(|source| source == path) {
        sources[..=at].rotate_right(1);
    }
    let hash = match options.frame.filter(|_| posed_frames > 0) {
        Some(frame) => fnv1a(format!("{} {frame}", options.hash(hash)).as_bytes()),
        None => options.hash(hash),
    };
    options.looks.apply(&mut draft, &Location::file(path))?;
    wanted::choose(&mut draft, &mut log)?;
    options.viewpoint.apply(&mut draft, up, &Location::file(path))?;
    let (repairs, coordinates) = sanitize::sanitize(&mut draft, &mut log)?;
    divide::divide(&mut draft, &coordinates);
    let (mut scene, mut cameras) = recentre::recentre(draft, &coordinates);
    scene.hides_background = options.lighting.hides_background;
    // The camera stands still while the model moves on behind its path.
    if cameras.path.is_empty() || moves && cameras.path.len() < posed_frames {
        let last = cameras.path.last().copied().unwrap_or(cameras.still);
        cameras.path.resize(posed_frames, last);
    }
    if scene.is_dark() {
        let fallback = "the image will be black; add light with --env sky, or a lamp to the scene";
        log.warn(&Location::file(path), "the scene has no light that is supported", fallback)?;
    }
    let warnings = log.into_warnings();
    Ok(Loaded { scene, cameras, camera_names, animation_frames, warnings, repairs, hash, moves })
}
