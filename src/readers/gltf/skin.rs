//! Skins: joints place the vertices of a mesh.
//!
//! The transform of a vertex is the mean, by weights, of the transforms of its joints. A joint's transform is that of
//! its node to the file's coordinates, after the inverse of its transform when the skin was bound. The transform of
//! the node that shows the mesh does not count (glTF 2.0 specification, section 3.7.3.3).

use super::document::GltfFile;
use super::nodes::Placed;
use crate::error::SceneError;
use crate::mesh::{RawMesh, normal_matrix};
use base::math::unit;
use glam::{DMat3, DMat4};
use gltf_json::Index;
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::skin::Skin;
use gltf_json::validation::Checked;

/// Returns the transform of each joint of a skin, from the coordinates of a mesh to the file's.
pub(super) fn joints(
    document: &GltfFile,
    index: Index<Skin>,
    tree: &[Placed],
) -> Result<Vec<DMat4>, SceneError> {
    let skin = document.get(index, "skin")?;
    let what = format!("skin {}", index.value());
    let mut to_file = vec![None; document.root.nodes.len()];
    tree.iter().for_each(|placed| to_file[placed.node] = Some(placed.place.to_file));
    let inverse = match skin.inverse_bind_matrices {
        Some(accessor) => document.vectors::<16>(accessor, &what)?,
        None => Vec::new(),
    };
    if skin.inverse_bind_matrices.is_some() && inverse.len() < skin.joints.len() {
        let problem = format!("{what} has {} joints and {} matrices", skin.joints.len(), inverse.len());
        return Err(document.wrong(problem));
    }
    let joint = |(i, joint): (usize, &Index<_>)| {
        document.get(*joint, "node")?;
        let missing =
            || document.wrong(format!("{what}: its joint, node {}, is not in the scene", joint.value()));
        let to_file = to_file[joint.value()].ok_or_else(missing)?;
        let bound = inverse.get(i).map_or(DMat4::IDENTITY, |m| DMat4::from_cols_array(&m.map(f64::from)));
        Ok(to_file * bound)
    };
    skin.joints.iter().enumerate().map(joint).collect()
}

/// Joints of the vertices of a primitive, by sets.
pub(super) struct Influences(Vec<InfluenceSet>);

/// Four joints of each vertex.
struct InfluenceSet {
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Influences {
    /// Reads the joints and weights of a primitive of `vertices` vertices; `what` names it in messages.
    ///
    /// Returns `None` if the primitive has no joints.
    pub fn read(
        document: &GltfFile,
        primitive: &Primitive,
        vertices: usize,
        what: &str,
    ) -> Result<Option<Influences>, SceneError> {
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let mut sets = Vec::new();
        for set in 0.. {
            let (joints, weights) = (attribute(Semantic::Joints(set)), attribute(Semantic::Weights(set)));
            let (joints, weights) = match (joints, weights) {
                (Some(joints), Some(weights)) => (joints, weights),
                (None, None) => break,
                _ => {
                    return Err(
                        document.wrong(format!("{what} has joints without weights, or weights without"))
                    );
                }
            };
            let (joints, weights) =
                (document.integers::<4>(joints, what)?, document.vectors::<4>(weights, what)?);
            if joints.len() != vertices || weights.len() != vertices {
                let counts = format!("{} joints and {} weights", joints.len(), weights.len());
                return Err(document.wrong(format!("{what} has {vertices} vertices, and {counts} of them")));
            }
            sets.push(InfluenceSet { joints, weights });
        }
        Ok((!sets.is_empty()).then_some(Influences(sets)))
    }

    /// Returns the transform of a vertex; that of its first joint if all weights are 0.
    fn transform(&self, vertex: usize, joints: &[DMat4]) -> Option<DMat4> {
        let (mut sum, mut total) = (DMat4::ZERO, 0.0);
        for set in &self.0 {
            for (joint, weight) in set.joints[vertex].iter().zip(set.weights[vertex]) {
                if weight != 0.0 {
                    sum += *joints.get(*joint as usize)? * f64::from(weight);
                    total += f64::from(weight);
                }
            }
        }
        // Weights of bytes and shorts do not sum up to 1 exactly.
        if total != 0.0 {
            Some(sum * (1.0 / total))
        } else {
            joints.get(self.0[0].joints[vertex][0] as usize).copied()
        }
    }
}

/// Moves the vertices of a mesh to the file's coordinates; `what` names the mesh in messages.
pub(super) fn bend(
    raw: &mut RawMesh,
    influences: &Influences,
    joints: &[DMat4],
    document: &GltfFile,
    what: &str,
) -> Result<(), SceneError> {
    let mut is_mirrored = Vec::with_capacity(raw.positions.len());
    for vertex in 0..raw.positions.len() {
        let transform = influences.transform(vertex, joints);
        let Some(transform) = transform else {
            let problem =
                format!("{what}: vertex {vertex} has a joint beyond the {} of its skin", joints.len());
            return Err(document.wrong(problem));
        };
        let linear = DMat3::from_mat4(transform);
        raw.positions[vertex] = transform.transform_point3(raw.positions[vertex]);
        if let Some(normal) = raw.normals.get_mut(vertex) {
            *normal = unit(normal_matrix(&linear) * normal.as_dvec3()).unwrap_or_default().as_vec3();
        }
        let mirrors = linear.determinant() < 0.0;
        if let Some(tangent) = raw.tangents.get_mut(vertex) {
            let along = unit(linear * tangent.truncate().as_dvec3()).unwrap_or_default().as_vec3();
            *tangent = along.extend(if mirrors { -tangent.w } else { tangent.w });
        }
        is_mirrored.push(mirrors);
    }
    let mirrored = |i: u32| is_mirrored.get(i as usize).is_some_and(|mirrored| *mirrored);
    for triangle in &mut raw.triangles {
        if triangle.iter().filter(|i| mirrored(**i)).count() > 1 {
            triangle.swap(1, 2);
        }
    }
    Ok(())
}
