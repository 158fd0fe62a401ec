//! Conversion of a model's nodes to meshes and lights of a plan.

use super::camera::FRAMES_PER_SECOND;
use super::document::GltfFile;
use super::instancing;
use super::light;
use super::mesh;
use super::mesh::VertexColours;
use super::morph;
use super::nodes::Placed;
use super::pose::Pose;
use super::skin;
use super::skin::Influences;
use super::transform::Place;
use crate::error::SceneError;
use crate::findings::Findings;
use crate::mesh::{Normals, Placement, RawMesh};
use crate::plan::{Appearance, Contents, ImageSource, MaterialPlan, MeshPlan, MeshSource};
use crate::selection::PartSelection;
use base::math::unflattened;
use glam::DMat4;
use gltf_json::Index;
use gltf_json::mesh::Mesh;
use scene::{Emission, MaterialId, Relief};
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
    /// True if glass without a volume is thin, even if Blender wrote a closed mesh.
    pub thin_glass: bool,
    /// True if the model is the scene itself, whose animation `walk` renders.
    pub is_scene: bool,
    /// Frames per second of the animation.
    pub fps: f64,
    /// Time in seconds whose pose the model takes; `None` for its pose at rest.
    pub time: Option<f64>,
    /// Frame of the animation, counted from 1, whose pose the model takes if there is no time.
    pub frame: Option<usize>,
    /// Name of the camera, or number from 1.
    pub camera: Option<String>,
    /// Number of the group that gets the meshes.
    pub group: Option<usize>,
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
            thin_glass: false,
            is_scene: false,
            fps: FRAMES_PER_SECOND,
            time: None,
            frame: None,
            camera: None,
            group: None,
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

/// A primitive as its file describes it.
#[derive(Clone)]
pub(super) struct Part {
    /// Index in the mesh.
    primitive: usize,
    raw: Arc<RawMesh>,
    appearance: Appearance,
}

/// Import of a model into a plan.
pub(super) struct Importer<'a> {
    pub document: &'a GltfFile,
    pub tree: &'a [Placed],
    pub pose: &'a Pose,
    pub options: &'a ImportOptions,
    pub contents: &'a mut Contents,
    pub report: Findings,
    /// Materials read so far, by index, by the colours of vertices that they are multiplied with, and by whether glass
    /// without a volume is solid.
    pub surfaces: BTreeMap<(Option<usize>, VertexColours, bool), MaterialUse>,
    pub images: BTreeMap<usize, ImageSource>,
    /// Primitives read so far, by index of the mesh.
    pub meshes: BTreeMap<usize, Vec<Part>>,
    /// Groups of meshes, by index of the mesh.
    pub groups: BTreeMap<usize, usize>,
}

impl Importer<'_> {
    /// Adds the light and the mesh of a node.
    pub fn node(&mut self, placed: &Placed) -> Result<(), SceneError> {
        let document = self.document;
        let node = &document.root.nodes[placed.node];
        let name = node.name.clone().unwrap_or_else(|| format!("node {}", placed.node));
        if !placed.place.to_file.is_finite() {
            return Err(document.wrong(format!("the transform of {name} is not finite")));
        }
        let to_world = self.options.to_world * placed.place.to_file;
        let light = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        if let (Some(_), Some(_)) = (light, self.options.group) {
            self.report.lacks("lights of a model in a group are not supported", "they are left out", &name);
        } else if let Some(light) = light {
            let light = document.get(light.light, "light")?;
            let given = self.options.lumens_per_watt;
            let lumens = light::lumens_per_watt(light, given, document, &name, &mut self.report);
            let place =
                Place { to_file: to_world, axes: unflattened(self.options.to_world) * placed.place.axes };
            let light = light::read(light, &name, &place, lumens, document, &mut self.report)?;
            self.contents.lights.push(light);
        }
        if let Some(mesh) = node.mesh {
            self.mesh(mesh, placed, &name, to_world)?;
        }
        Ok(())
    }

    /// Adds a mesh in the pose of its node.
    fn mesh(
        &mut self,
        index: Index<Mesh>,
        placed: &Placed,
        name: &str,
        to_world: DMat4,
    ) -> Result<(), SceneError> {
        let document = self.document;
        let (node, mesh) = (&document.root.nodes[placed.node], document.get(index, "mesh")?);
        let weights = self.pose.weights(placed.node, node, mesh);
        let joints = node.skin.map(|skin| skin::joints(document, skin, self.tree)).transpose()?;
        let morphs = weights.iter().any(|weight| *weight != 0.0);
        let places = instancing::places(document, placed.node, &mut self.report)?;
        if joints.is_none() && !morphs {
            let places = places.unwrap_or_else(|| vec![DMat4::IDENTITY]);
            return places.iter().try_for_each(|place| self.show(index, name, to_world * *place));
        }
        if places.is_some() {
            let lack = "instances of a mesh with a skin or morph targets are not supported";
            self.report.lacks(lack, "one instance stands at the node", name);
        }
        for Part { primitive, mut raw, appearance } in self.primitives(index)? {
            let what = primitive_name(mesh, index, primitive);
            let source = &mesh.primitives[primitive];
            if source.targets.is_some() && morphs {
                morph::add_targets(Arc::make_mut(&mut raw), document, source, &weights, &what)?;
            }
            let mut to_world = to_world;
            if let Some(joints) = &joints {
                match Influences::read(document, source, raw.positions.len(), &what)? {
                    Some(influences) => {
                        skin::bend(Arc::make_mut(&mut raw), &influences, joints, document, &what)?;
                        to_world = self.options.to_world;
                    }
                    None => {
                        let lack = "a skin whose mesh has no joints and weights";
                        self.report.lacks(lack, "the node places the mesh", name);
                    }
                }
            }
            self.add(self.plan(raw, appearance, name, to_world))?;
        }
        Ok(())
    }

    /// Adds a mesh at one place.
    fn add(&mut self, plan: MeshPlan) -> Result<(), SceneError> {
        match self.options.group {
            Some(group) => self.contents.add_member(group, plan),
            None => self.contents.add_mesh(plan),
        }
    }

    /// Shows a mesh that may be seen at several places.
    fn show(&mut self, index: Index<Mesh>, name: &str, to_world: DMat4) -> Result<(), SceneError> {
        if self.options.group.is_some() {
            for Part { raw, appearance, .. } in self.primitives(index)? {
                self.add(self.plan(raw, appearance, name, to_world))?;
            }
            return Ok(());
        }
        let group = match self.groups.get(&index.value()) {
            Some(group) => *group,
            None => {
                let group = self.contents.add_group();
                self.groups.insert(index.value(), group);
                for Part { raw, appearance, .. } in self.primitives(index)? {
                    let plan = self.plan(raw, appearance, name, DMat4::IDENTITY);
                    self.contents.add_member(group, plan)?;
                }
                group
            }
        };
        self.contents.show_group(group, to_world, Some(name));
        Ok(())
    }

    fn plan(&self, raw: Arc<RawMesh>, appearance: Appearance, name: &str, to_world: DMat4) -> MeshPlan {
        let (material, emission) = match self.options.material {
            Some(material) => (material, None),
            None => (appearance.material, appearance.emission),
        };
        MeshPlan {
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
        }
    }

    /// True if the material of an appearance, or that which replaces it, knows a direction on its surface.
    fn has_direction(&self, appearance: Appearance) -> bool {
        let material = self.options.material.unwrap_or(appearance.material);
        self.contents.materials.get(material.0 as usize).is_some_and(|material| {
            matches!(material.relief, Some(Relief::Normals { .. })) || material.anisotropy_axis().is_some()
        })
    }

    /// Returns the primitives of a mesh; each mesh is read once.
    fn primitives(&mut self, index: Index<Mesh>) -> Result<Vec<Part>, SceneError> {
        if let Some(primitives) = self.meshes.get(&index.value()) {
            return Ok(primitives.clone());
        }
        let document = self.document;
        let mesh = document.get(index, "mesh")?;
        let mut primitives = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let what = primitive_name(mesh, index, i);
            let is_solid = self.is_solid(primitive, mesh, &what)?;
            let surface =
                self.surface(primitive.material, VertexColours::read(document, primitive)?, is_solid)?;
            let has_tangents = self.has_direction(surface.appearance);
            let raw = mesh::read(document, primitive, surface.uv_set, has_tangents, &what, &mut self.report)?;
            let part = |raw| Part { primitive: i, raw: Arc::new(raw), appearance: surface.appearance };
            primitives.extend(raw.map(part));
        }
        self.meshes.insert(index.value(), primitives.clone());
        Ok(primitives)
    }
}

/// Returns the name of a primitive in messages.
fn primitive_name(mesh: &Mesh, index: Index<Mesh>, primitive: usize) -> String {
    format!("{} {}, primitive {primitive}", mesh.name.as_deref().unwrap_or("mesh"), index.value())
}
