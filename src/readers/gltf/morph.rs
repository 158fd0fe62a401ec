//! Morph targets: weighted displacements of the vertices of a primitive.

use super::document::GltfFile;
use crate::error::SceneError;
use crate::mesh::RawMesh;
use glam::{DVec3, Vec3};
use gltf_json::mesh::Primitive;

/// Adds the morph targets of a primitive to its mesh, times their weights; `what` names the primitive in messages.
pub(super) fn add_targets(
    raw: &mut RawMesh,
    document: &GltfFile,
    primitive: &Primitive,
    weights: &[f32],
    what: &str,
) -> Result<(), SceneError> {
    let targets = primitive.targets.iter().flatten().enumerate();
    for ((number, target), &weight) in targets.zip(weights).filter(|(_, weight)| **weight != 0.0) {
        let what = format!("{what}, morph target {number}");
        let check = |length: usize, wanted: usize| {
            let problem =
                || document.wrong(format!("{what} has {length} displacements of {wanted} vertices"));
            if length == wanted { Ok(()) } else { Err(problem()) }
        };
        if let Some(positions) = target.positions {
            let moved = document.vectors::<3>(positions, &what)?;
            check(moved.len(), raw.positions.len())?;
            for (p, by) in raw.positions.iter_mut().zip(moved) {
                *p += DVec3::from(by.map(f64::from)) * f64::from(weight);
            }
        }
        if let (Some(normals), false) = (target.normals, raw.normals.is_empty()) {
            let moved = document.vectors::<3>(normals, &what)?;
            check(moved.len(), raw.normals.len())?;
            raw.normals.iter_mut().zip(moved).for_each(|(n, by)| *n += Vec3::from(by) * weight);
        }
        if let (Some(tangents), false) = (target.tangents, raw.tangents.is_empty()) {
            let moved = document.vectors::<3>(tangents, &what)?;
            check(moved.len(), raw.tangents.len())?;
            raw.tangents
                .iter_mut()
                .zip(moved)
                .for_each(|(t, by)| *t += (Vec3::from(by) * weight).extend(0.0));
        }
    }
    Ok(())
}
