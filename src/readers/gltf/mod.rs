//! glTF 2.0, as text or binary: meshes by instance, in the pose of their skins and morph targets, metallic-roughness
//! materials, punctual lights, and cameras with their animation.
//!
//! The data model is that of the crate `gltf-json`, the lower half of `gltf`. The upper half panics on wrong accessor
//! types and missing accessors, and follows cycles of nodes. So the checks here look up objects and read accessors.
//!
//! Deviations: surfaces have two sides even if the file asks for culling. A warning
//! names every unsupported feature and the objects that ask for it. Without tangents, the frames of normal maps are
//! those of the triangles, not those of MikkTSpace.
//!
//! Units: see `light`.

mod accessor;
mod animation;
mod camera;
mod container;
mod document;
mod draco;
mod generator;
mod glass;
mod importer;
mod instancing;
mod json;
mod light;
mod lost_lamps;
mod material;
mod mesh;
mod meshopt;
mod morph;
mod nodes;
mod pose;
mod skin;
mod statements;
mod texture;
mod transform;
mod uri;
mod volume;

use crate::draft::{DEFAULT_RESOLUTION, DraftCamera, DraftView, Shot};
use crate::error::{Location, Log, SceneError};
use crate::file::stem_of;
use crate::findings::Findings;
use crate::finish::framing;
use crate::options::LoadOptions;
use crate::plan::{Contents, Motion, ScenePlan};
use crate::selection::PartSelection;
use animation::Clip;
use base::math::right_of;
use camera::Viewer;
use document::GltfFile;
use glam::{DMat4, DVec3};
use importer::Importer;
use pose::Pose;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub(crate) use camera::FRAMES_PER_SECOND;
pub(crate) use importer::ImportOptions;

/// Content of a model that is not part of the plan's contents.
pub(crate) struct Imported {
    pub shot: Option<Shot>,
    /// Motion by the animation.
    pub motion: Motion,
    /// Files read, with the hash of the bytes of each.
    pub sources: Vec<(PathBuf, u64)>,
}

/// Reads the model at `path` as a scene.
pub(super) fn read(path: &Path, options: &LoadOptions, log: &mut Log) -> Result<ScenePlan, SceneError> {
    let mut contents = Contents::default();
    let import_options = ImportOptions {
        camera: options.camera.clone(),
        frame: options.frame,
        lumens_per_watt: options.lumens_per_watt,
        thin_glass: options.thin_glass,
        is_scene: true,
        ..ImportOptions::default()
    };
    let imported = import(path, &Location::file(path), &import_options, &mut contents, log)?;
    let shot = imported.shot.unwrap_or_else(|| {
        let forward = -framing::outlook(DVec3::Y);
        let right = right_of(forward, DVec3::Y).unwrap_or(DVec3::X);
        let camera = DraftCamera { forward, right, up: right.cross(forward), ..DraftCamera::default() };
        let (names, path) = (Vec::new(), Vec::new());
        Shot { camera, names, fits: true, path, resolution: DEFAULT_RESOLUTION, crop: None }
    });
    Ok(ScenePlan {
        name: stem_of(path),
        sources: imported.sources,
        shot,
        max_depth: None,
        hides_emitters: false,
        motion: imported.motion,
        contents,
    })
}

/// Reads all cameras of the model at `path`, in its pose at rest. Its meshes are not read.
pub(super) fn read_views(path: &Path) -> Result<Vec<Result<DraftView, SceneError>>, SceneError> {
    let document = GltfFile::without_buffers(path, &Location::file(path))?;
    let (pose, to_world, fps) = (Pose::default(), DMat4::IDENTITY, FRAMES_PER_SECOND);
    let tree = nodes::tree(&document, &PartSelection::default(), |node| pose.local(&document, node))?;
    Viewer { document: &document, tree: &tree, pose: &pose, to_world, fps }.views()
}

/// Adds the model at `path`, to which `from` refers, to the contents of a scene.
pub fn import(
    path: &Path,
    from: &Location,
    options: &ImportOptions,
    contents: &mut Contents,
    log: &mut Log,
) -> Result<Imported, SceneError> {
    let document = GltfFile::open(path, from)?;
    if let (Some(time), true) = (options.time, document.root.animations.is_empty()) {
        let what = format!("time is {time}, and {} has no animation", path.display());
        return Err(from.wrong(what, "leave time out"));
    }
    let mut report = Findings::default();
    let clip = match Clip::read(&document) {
        Err(error) if options.time.is_none() && options.frame.is_none() => {
            report.lacks(&format!("the animation is damaged: {error}"), "the model stands still", "");
            Clip::default()
        }
        clip => clip?,
    };
    let animation_frames = clip.frames(options.fps);
    let of_frame = |frame: usize| frame.saturating_sub(1) as f64 / options.fps;
    let posed_frame = options.frame.filter(|_| animation_frames > 0);
    let pose = Pose { clip, time: options.time.or(posed_frame.map(of_frame)) };
    let tree = nodes::tree(&document, &options.selection, |node| pose.local(&document, node))?;
    if !tree.iter().any(|placed| placed.selected) && !options.selection.only.is_empty() {
        return Err(from.undefined("node", &options.selection.only.join("\", \"")));
    }
    let mut importer = Importer {
        document: &document,
        tree: &tree,
        pose: &pose,
        options,
        contents,
        report,
        surfaces: BTreeMap::new(),
        images: BTreeMap::new(),
        meshes: BTreeMap::new(),
        groups: BTreeMap::new(),
    };
    for placed in tree.iter().filter(|placed| placed.selected) {
        importer.node(placed)?;
    }
    let mut report = importer.report;
    for (what, name) in &document.unread.findings {
        report.lacks(what, "it is left out", name);
    }
    for name in document::unread_extensions(&document) {
        report.lacks(&format!("the extension {name} is not supported"), "it is left out", "");
    }
    lost_lamps::report(&document, &tree, &mut report);
    let viewer = Viewer {
        document: &document,
        tree: &tree,
        pose: &pose,
        to_world: options.to_world,
        fps: options.fps,
    };
    let shot = viewer.shot(options.camera.as_deref(), &mut report)?;
    pose.report(&document, &tree, options.is_scene, animation_frames, &mut report);
    report.write(&document.place, log)?;
    let frames = posed_frame.map_or(0, |_| animation_frames);
    let motion = Motion { frames, animation_frames, moves: frames > 0 && pose.moves(&document, &tree) };
    Ok(Imported { shot, motion, sources: document.sources })
}

#[cfg(test)]
mod tests;
