//! Repairs of the places of groups.

use super::reach::MAX_COORDINATE;
use super::report::SanitizeReport;
use crate::draft::Draft;
use crate::finish::corners;
use crate::local::LocalCoordinates;
use base::math::Placement;
use glam::{DMat4, Vec3};

/// Determinant of a placement in local coordinates below which its inverse leaves the range of f32.
const MIN_DETERMINANT: f32 = 1e-30;

/// Chooses the local coordinates of all groups.
pub(super) fn set_coordinates(draft: &mut Draft) {
    let boxes = corners::boxes(draft);
    for (group, corners) in draft.groups.iter_mut().zip(boxes) {
        if let Some([low, high]) = corners {
            group.coordinates = LocalCoordinates::of_group(low, high);
        }
    }
}

/// Drops places beyond the reach of f32, and places at which a group is too small for f32. Returns the number of
/// triangles that the latter lose, and of all triangles at other places than the first.
pub(super) fn drop_places(
    draft: &mut Draft,
    coordinates: &LocalCoordinates,
    report: &mut SanitizeReport,
) -> (usize, usize) {
    let (mut lost, mut all) = (0, 0);
    for (number, group) in draft.groups.iter_mut().enumerate() {
        let members = draft.meshes.iter().filter(|mesh| mesh.group == Some(number));
        let triangles: usize = members.map(|mesh| mesh.triangles.len()).sum();
        all += triangles * group.placements.len().saturating_sub(1);
        let own = group.coordinates;
        group.placements.retain(|to_world| {
            let placement = own.placed(to_world, coordinates);
            let is_within = is_within_reach(to_world, &placement);
            let has_size = !(placement.determinant().abs() < MIN_DETERMINANT);
            report.huge += if is_within { 0 } else { triangles };
            lost += if is_within && !has_size { triangles } else { 0 };
            is_within && has_size
        });
    }
    report.degenerate += lost;
    (lost, all)
}

/// True if f32 can represent a group at a place.
fn is_within_reach(to_world: &DMat4, placement: &Placement) -> bool {
    let [low, high] = placement.bounds([Vec3::NEG_ONE, Vec3::ONE]);
    let local = low.abs().max(high.abs()).max_element();
    let world = to_world.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    local <= MAX_COORDINATE as f32 && world <= MAX_COORDINATE
}
