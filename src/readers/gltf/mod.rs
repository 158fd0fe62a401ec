//! glTF 2.0, as text or binary: meshes by instance, metallic-roughness materials, punctual lights, and cameras with
//! their animation.
//!
//! The data model is that of the crate `gltf-json`, the lower half of `gltf`. The upper half panics where an accessor
//! has another type than it should, or a primitive an accessor that does not exist, and follows cycles of nodes; so
//! objects are looked up, and accessors read, by the checks here.
//!
//! Deviations: surfaces have two sides even where the file asks for culling, which is an economy of rasterisers.
//! Instances of a mesh are copies. Whatever else a model asks for and does not get is named, with the objects that ask
//! for it.
//!
//! Units: as `light` says.

mod accessor;
mod animation;
mod camera;
mod document;
mod light;
mod material;
mod mesh;
mod nodes;
mod report;
mod texture;

use super::LoadOptions;
use super::error::{Log, Place, SceneError};
use super::file::stem_of;
use super::mesh::{Normals, Placement, RawMesh};
use super::plan::{Contents, Geometry, Look, MaterialPlan, MeshPlan, PictureSource, Plan, Selection};
use crate::draft::{DEFAULT_RESOLUTION, DraftCamera, Shot};
use crate::finish::framing;
use base::math::right_of;
use camera::Viewer;
use document::Document;
use glam::{DMat4, DVec3};
use gltf_json::Index;
use gltf_json::mesh::Mesh;
use material::Surface;
use nodes::Placed;
use report::Report;
use scene::{Emission, MaterialId};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(crate) use camera::FRAMES_PER_SECOND;

/// Ways in which a model becomes a part of a scene.
#[derive(Clone, Debug)]
pub(crate) struct ImportOptions {
    pub to_world: DMat4,
    pub selection: Selection,
    pub flip_normals: bool,
    /// Material and emission in place of the model's.
    pub material: Option<MaterialId>,
    pub emission: Option<Emission>,
    /// Units of its lights for one of the renderer's, if not those of its exporter.
    pub lumens_per_watt: Option<f32>,
    /// Frames a second of its camera's animation.
    pub fps: f64,
    /// Name, or number from 1, of its camera.
    pub camera: Option<String>,
}

impl Default for ImportOptions {
    fn default() -> ImportOptions {
        ImportOptions {
            to_world: DMat4::IDENTITY,
            selection: Selection::default(),
            flip_normals: false,
            material: None,
            emission: None,
            lumens_per_watt: None,
            fps: FRAMES_PER_SECOND,
            camera: None,
        }
    }
}

/// Everything of a model besides what went into the contents of a scene.
pub(crate) struct Imported {
    pub shot: Option<Shot>,
    /// Files read, with the hash of their bytes.
    pub sources: Vec<(PathBuf, u64)>,
}

/// Reads the model at `path` as a scene.
pub(super) fn read(path: &Path, options: &LoadOptions, log: &mut Log) -> Result<Plan, SceneError> {
    let mut contents = Contents::default();
    let import_options = ImportOptions { camera: options.camera.clone(), ..ImportOptions::default() };
    let imported = import(path, &Place::file(path), &import_options, &mut contents, log)?;
    let shot = imported.shot.unwrap_or_else(|| {
        let forward = -framing::outlook(DVec3::Y);
        let right = right_of(forward, DVec3::Y).unwrap_or(DVec3::X);
        let camera = DraftCamera { forward, right, up: right.cross(forward), ..DraftCamera::default() };
        Shot { camera, fits: true, path: Vec::new(), resolution: DEFAULT_RESOLUTION, crop: None }
    });
    Ok(Plan {
        name: stem_of(path),
        sources: imported.sources,
        generator: None,
        shot,
        max_depth: None,
        hides_emitters: false,
        contents,
    })
}

/// Adds the model at `path`, to which `from` refers, to the contents of a scene.
pub fn import(
    path: &Path,
    from: &Place,
    options: &ImportOptions,
    contents: &mut Contents,
    log: &mut Log,
) -> Result<Imported, SceneError> {
    let document = Document::open(path, from)?;
    let tree = nodes::tree(&document, &options.selection)?;
    if !tree.iter().any(|placed| placed.selected) && !options.selection.only.is_empty() {
        return Err(from.undefined("node", &options.selection.only.join("\", \"")));
    }
    let mut importer = Importer {
        document: &document,
        options,
        contents,
        report: Report::default(),
        surfaces: BTreeMap::new(),
        pictures: BTreeMap::new(),
        meshes: BTreeMap::new(),
    };
    for placed in tree.iter().filter(|placed| placed.selected) {
        importer.node(placed)?;
    }
    let mut report = importer.report;
    for name in document::unread_extensions(&document.root) {
        report.lacks(&format!("the extension {name} is not modelled"), "it is left out", "");
    }
    let viewer = Viewer { document: &document, tree: &tree, to_world: options.to_world, fps: options.fps };
    let shot = viewer.shot(options.camera.as_deref(), &mut report)?;
    report.write(&document.place, log)?;
    Ok(Imported { shot, sources: document.sources })
}

/// A model on its way into a scene.
struct Importer<'a> {
    document: &'a Document,
    options: &'a ImportOptions,
    contents: &'a mut Contents,
    report: Report,
    /// Surfaces by number of the material.
    surfaces: BTreeMap<Option<usize>, Surface>,
    pictures: BTreeMap<usize, PictureSource>,
    /// Primitives that are read, by number of the mesh.
    meshes: BTreeMap<usize, Vec<(Arc<RawMesh>, Look)>>,
}

impl Importer<'_> {
    fn node(&mut self, placed: &Placed) -> Result<(), SceneError> {
        let document = self.document;
        let node = &document.root.nodes[placed.node];
        let name = node.name.clone().unwrap_or_else(|| format!("node {}", placed.node));
        if !placed.to_file.is_finite() {
            return Err(document.wrong(format!("the transform of {name} is not finite")));
        }
        let to_world = self.options.to_world * placed.to_file;
        if node.skin.is_some() {
            self.report.lacks("skins are not modelled", "the mesh stands as at rest", &name);
        }
        let light = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        if let Some(light) = light {
            let light = document.get(light.light, "light")?;
            let lumens = self.options.lumens_per_watt.unwrap_or(light::lumens_per_watt(document));
            let light = light::read(light, &name, &to_world, lumens, document, &mut self.report)?;
            self.contents.lights.push(light);
        }
        if let Some(mesh) = node.mesh {
            for (raw, look) in self.primitives(mesh)? {
                self.add(raw, look, &name, to_world)?;
            }
        }
        Ok(())
    }

    fn add(&mut self, raw: Arc<RawMesh>, look: Look, name: &str, to_world: DMat4) -> Result<(), SceneError> {
        let (material, emission) = match self.options.material {
            Some(material) => (material, None),
            None => (look.material, look.emission),
        };
        self.contents.add_mesh(MeshPlan {
            place: self.document.place.clone(),
            name: name.to_owned(),
            geometry: Geometry::Shared(raw),
            placement: Placement {
                to_world,
                normals: Normals::AsGiven,
                flip_normals: self.options.flip_normals,
                v_down: true,
                needs_uv: false,
            },
            material: MaterialPlan::One(material),
            emission: self.options.emission.or(emission),
        })
    }

    /// The primitives of a mesh, each read once.
    fn primitives(&mut self, index: Index<Mesh>) -> Result<Vec<(Arc<RawMesh>, Look)>, SceneError> {
        if let Some(primitives) = self.meshes.get(&index.value()) {
            return Ok(primitives.clone());
        }
        let document = self.document;
        let mesh = document.get(index, "mesh")?;
        let mut primitives = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let name = mesh.name.as_deref().unwrap_or("mesh");
            let what = format!("{name} {}, primitive {i}", index.value());
            let surface = self.surface(primitive.material)?;
            let raw = mesh::read(document, primitive, surface.uv_set, &what, &mut self.report)?;
            primitives.extend(raw.map(|raw| (Arc::new(raw), surface.look)));
        }
        self.meshes.insert(index.value(), primitives.clone());
        Ok(primitives)
    }
}

#[cfg(test)]
mod tests;
