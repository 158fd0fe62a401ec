//! Glass without a stated thickness: thin by the standard, solid if Blender wrote a closed mesh.
//!
//! Blender's exporter writes the transmission of solid glass without a volume.

use super::document::GltfFile;
use super::generator::Generator;
use super::importer::Importer;
use super::mesh;
use crate::error::SceneError;
use glam::DVec3;
use gltf_json::Index;
use gltf_json::material::Material;
use gltf_json::mesh::{Mesh, Primitive, Semantic};
use gltf_json::validation::Checked;
use std::collections::BTreeMap;

impl Importer<'_> {
    /// Returns true if a primitive is solid glass whose file states no thickness. `mesh` is its mesh, and `what` names
    /// the primitive in errors.
    pub(super) fn is_solid(
        &mut self,
        primitive: &Primitive,
        mesh: &Mesh,
        what: &str,
    ) -> Result<bool, SceneError> {
        let document = self.document;
        let Some(index) = primitive.material else { return Ok(false) };
        let material = document.get(index, "material")?;
        if !transmits_without_volume(material) || self.options.thin_glass || self.options.material.is_some() {
            return Ok(false);
        }
        let name = name_of(material, index);
        let is_solid = Generator::read(document).is_blender()
            && (is_closed(document, std::slice::from_ref(primitive), what)?
                || is_closed(document, &mesh.primitives, what)?);
        match is_solid {
            true => self.report.note(
                "glass without a volume is solid, as Blender renders closed meshes",
                "--thin-glass, or thin_glass of a mesh in a TOML scene, makes thin walls of it",
                &name,
            ),
            false => self.report.note(
                "glass without a volume is a thin wall, which does not refract",
                "thicknessFactor above 0 (KHR_materials_volume) makes solid glass of it",
                &name,
            ),
        }
        Ok(is_solid)
    }
}

fn name_of(material: &Material, index: Index<Material>) -> String {
    material.name.clone().unwrap_or_else(|| format!("material {}", index.value()))
}

fn transmits_without_volume(material: &Material) -> bool {
    material.extensions.as_ref().is_some_and(|extensions| {
        let transmits = extensions.transmission.as_ref().is_some_and(|t| t.transmission_factor.0 > 0.0);
        transmits && extensions.volume.is_none()
    })
}

/// Returns true if the triangles of primitives have each edge as often in one direction as in the other. Vertices at
/// equal positions are one.
fn is_closed(document: &GltfFile, primitives: &[Primitive], what: &str) -> Result<bool, SceneError> {
    let mut vertices: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    // Surplus of each edge in the direction from its first to its second vertex.
    let mut edges: BTreeMap<[u32; 2], i64> = BTreeMap::new();
    for primitive in primitives {
        let Some(positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
            continue;
        };
        let positions = document.vectors::<3>(*positions, what)?;
        let mut number = |position: &[f32; 3]| {
            // Adding 0 makes one number of the two zeros.
            let bits = DVec3::from(position.map(f64::from)).to_array().map(|x| (x + 0.0).to_bits());
            let next = vertices.len() as u32;
            *vertices.entry(bits).or_insert(next)
        };
        let merged: Vec<u32> = positions.iter().map(&mut number).collect();
        let corners = mesh::corners(document, primitive, positions.len(), what)?;
        let Checked::Valid(mode) = primitive.mode else { return Ok(false) };
        for triangle in mesh::triangles(&corners, mode) {
            let [a, b, c] = triangle.map(|corner| merged.get(corner as usize).copied().unwrap_or(u32::MAX));
            if a == b || b == c || c == a {
                continue;
            }
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
    }
    Ok(!edges.is_empty() && edges.values().all(|surplus| *surplus == 0))
}
