//! Meshes of a scene as input of acceleration structures.

use crate::material::Materials;
use embree::{Accel, Device, EmbreeError, PlacedGroup, TriangleMesh};
use scene::Scene;

/// Returns the stored meshes of a scene as input of an acceleration structure.
pub fn triangle_meshes<'a>(scene: &'a Scene, materials: &Materials) -> Vec<TriangleMesh<'a>> {
    let straight: Vec<bool> = materials.averages().map(|average| average.passes_straight()).collect();
    let meshes = scene.meshes.iter().map(|mesh| TriangleMesh {
        positions: &mesh.positions,
        triangles: &mesh.triangles,
        occludes: !straight[mesh.material.0 as usize],
    });
    meshes.collect()
}

/// Builds the structure over all meshes at all places.
///
/// # Errors
/// If Embree cannot build the structure.
pub(super) fn build(device: &Device, scene: &Scene, materials: &Materials) -> Result<Accel, EmbreeError> {
    build_of(device, scene, &triangle_meshes(scene, materials))
}

/// Builds the structure over the given meshes at the places of a scene.
fn build_of(device: &Device, scene: &Scene, meshes: &[TriangleMesh]) -> Result<Accel, EmbreeError> {
    let placed = scene
        .groups
        .iter()
        .map(|group| PlacedGroup { meshes: &meshes[group.meshes.clone()], placements: &group.placements });
    let groups: Vec<PlacedGroup> = placed.collect();
    Accel::build_placed(device, &meshes[..scene.own_mesh_count()], &groups)
}

/// Builds the structure over the surfaces that light passes straight through; `None` if there are none. `all` is the
/// structure over all meshes.
///
/// # Errors
/// If Embree cannot build the structure.
pub(super) fn sheets(
    scene: &Scene,
    materials: &Materials,
    all: &Accel,
) -> Result<Option<Accel>, EmbreeError> {
    let mut meshes = triangle_meshes(scene, materials);
    if meshes.iter().all(|mesh| mesh.occludes) {
        return Ok(None);
    }
    // Emptied meshes keep the numbers of the others the same.
    meshes.iter_mut().filter(|mesh| mesh.occludes).for_each(|mesh| mesh.triangles = &[]);
    build_of(all.device(), scene, &meshes).map(Some)
}
