//! Meshes of a scene as input of acceleration structures.

use crate::material::Materials;
use embree::{Accel, EmbreeError, TriangleMesh};
use scene::Scene;

/// Returns the meshes of a scene as input of an acceleration structure.
pub fn triangle_meshes<'a>(scene: &'a Scene, materials: &Materials) -> Vec<TriangleMesh<'a>> {
    let straight: Vec<bool> = materials.averages().map(|average| average.passes_straight()).collect();
    let meshes = scene.meshes.iter().map(|mesh| TriangleMesh {
        positions: &mesh.positions,
        triangles: &mesh.triangles,
        occludes: !straight[mesh.material.0 as usize],
    });
    meshes.collect()
}

/// The sheets of a scene beside the structure `whole` over all its meshes; `None` if there are none.
pub(super) fn sheets(
    scene: &Scene,
    materials: &Materials,
    whole: &Accel,
) -> Result<Option<Accel>, EmbreeError> {
    let mut meshes = triangle_meshes(scene, materials);
    if meshes.iter().all(|mesh| mesh.occludes) {
        return Ok(None);
    }
    // Meshes keep their numbers.
    meshes.iter_mut().filter(|mesh| mesh.occludes).for_each(|mesh| mesh.triangles = &[]);
    Accel::build(whole.device(), &meshes).map(Some)
}
