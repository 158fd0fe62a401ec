//! Conversion of a model's nodes to meshes and lights of a plan.

use super::camera::FRAMES_PER_SECOND;
use super::document::GltfFile;
use super::light;
use super::mesh;
use super::mesh::VertexColours;
use super::nodes::Placed;
use super::report::Findings;
use crate::error::SceneError;
use crate::mesh::{Normals, Placement, RawMesh};
use crate::plan::{Appearance, Contents, ImageSource, MaterialPlan, MeshPlan, MeshSource};
use crate::selection::PartSelection;
use glam::DMat4;
use gltf_json::Index;
use gltf_json::mesh::Mesh;
use scene::{Emission, MaterialId};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Options for importing a model.
#[derive(Clone, Debug)]
pub(crate) struct ImportOptions {
    pub to_world: DMat4,
    pub selection: PartSelection,
    pub flip_normals: bool,
    /// Material that replaces the materials of the model.
    pub material: Option<MaterialId>,
    /// Emission that replaces the emission of the model.
    pub emission: Option<Emission>,
    /// Units of the model's lights per unit of the renderer; `None` for the units of the exporter.
    pub lumens_per_watt: Option<f32>,
    /// Frames per second of the camera's animation.
    pub fps: f64,
    /// Name of the camera, or number from 1.
    pub camera: Option<String>,
}

impl Default for ImportOptions {
    fn default() -> ImportOptions {
        ImportOptions {
            to_world: DMat4::IDENTITY,
            selection: PartSelection::default(),
            flip_normals: false,
            material: None,
            emission: None,
            lumens_per_watt: None,
            fps: FRAMES_PER_SECOND,
            camera: None,
        }
    }
}

/// Material of a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaterialUse {
    pub appearance: Appearance,
    /// Index of the set of texture coordinates.
    pub uv_set: u32,
}

/// Import of a model into a plan.
pub(super) struct Importer<'a> {
    pub document: &'a GltfFile,
    pub options: &'a ImportOptions,
    pub contents: &'a mut Contents,
    pub report: Findings,
    /// Materials read so far, by index and by the colours of vertices that they are multiplied with.
    pub surfaces: BTreeMap<(Option<usize>, VertexColours), MaterialUse>,
    pub images: BTreeMap<usize, ImageSource>,
    /// Primitives read so far, by index of the mesh.
    pub meshes: BTreeMap<usize, Vec<(Arc<RawMesh>, Appearance)>>,
}

impl Importer<'_> {
    /// Adds the light and the mesh of a node.
    pub fn node(&mut self, placed: &Placed) -> Result<(), SceneError> {
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
            for (raw, appearance) in self.primitives(mesh)? {
                self.add(raw, appearance, &name, to_world)?;
            }
        }
        Ok(())
    }

    fn add(
        &mut self,
        raw: Arc<RawMesh>,
        appearance: Appearance,
        name: &str,
        to_world: DMat4,
    ) -> Result<(), SceneError> {
        let (material, emission) = match self.options.material {
            Some(material) => (material, None),
            None => (appearance.material, appearance.emission),
        };
        self.contents.add_mesh(MeshPlan {
            place: self.document.place.clone(),
            name: name.to_owned(),
            geometry: MeshSource::Shared(raw),
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

    /// Returns the primitives of a mesh; each mesh is read once.
    fn primitives(&mut self, index: Index<Mesh>) -> Result<Vec<(Arc<RawMesh>, Appearance)>, SceneError> {
        if let Some(primitives) = self.meshes.get(&index.value()) {
            return Ok(primitives.clone());
        }
        let document = self.document;
        let mesh = document.get(index, "mesh")?;
        let mut primitives = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let name = mesh.name.as_deref().unwrap_or("mesh");
            let what = format!("{name} {}, primitive {i}", index.value());
            let surface = self.surface(primitive.material, VertexColours::of(document, primitive)?)?;
            let raw = mesh::read(document, primitive, surface.uv_set, &what, &mut self.report)?;
            primitives.extend(raw.map(|raw| (Arc::new(raw), surface.appearance)));
        }
        self.meshes.insert(index.value(), primitives.clone());
        Ok(primitives)
    }
}
