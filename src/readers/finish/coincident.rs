//! Removal of emitting triangles that coincide with others.
//!
//! A ray hits one of two coincident triangles, so as a surface the emitter shines once. As a source of samples it would
//! count twice.

use super::dark::is_dark_emission;
use crate::Location;
use crate::draft::{Draft, DraftMesh};
use crate::error::{Log, SceneError};
use glam::DVec3;
use std::collections::HashSet;

/// Drops emitting triangles with the corners and the front side of an earlier emitting triangle, with a warning.
pub fn drop_coincident_emitters(
    draft: &mut Draft,
    place: &Location,
    log: &mut Log,
) -> Result<(), SceneError> {
    let mut seen = HashSet::new();
    let scene = &draft.scene;
    let shines = |mesh: &&mut DraftMesh| {
        mesh.emission.is_some_and(|emission| !is_dark_emission(&emission, mesh.material, scene))
    };
    for mesh in draft.meshes.iter_mut().filter(shines) {
        let before = mesh.triangles.len();
        mesh.retain_triangles(|positions, t| {
            let corners = t.map(|i| positions.get(i as usize).copied().unwrap_or_default());
            seen.insert(turned_to_least(corners))
        });
        let dropped = before - mesh.triangles.len();
        if dropped > 0 {
            let what = format!(
                "{dropped} triangles of the emitter \"{}\" coincide with triangles of another emitter",
                mesh.name
            );
            log.warn(
                place,
                what,
                "they give no light of their own; remove the copy, or raise the radiance of the first",
            )?;
        }
    }
    Ok(())
}

/// Returns the bits of the corners, rotated so that the smallest corner comes first. The front side is unchanged.
fn turned_to_least(corners: [DVec3; 3]) -> [[u64; 3]; 3] {
    // Adding 0 turns -0 into 0.
    let [a, b, c] = corners.map(|p| (p + DVec3::ZERO).to_array().map(f64::to_bits));
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or([a, b, c])
}
