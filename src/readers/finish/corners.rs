//! Corners of all triangles in world coordinates, those of groups at each of their places.

use crate::draft::{Draft, DraftMesh};
use glam::{DMat4, DVec3};

/// Returns points whose bounding box holds all triangles: the corners of meshes, and of boxes around groups.
pub fn hull(draft: &Draft) -> impl Iterator<Item = DVec3> {
    draft.meshes.iter().filter(|mesh| mesh.group.is_none()).flat_map(used).chain(placed(draft))
}

/// Returns the corners of boxes around groups at all their places.
pub fn placed(draft: &Draft) -> impl Iterator<Item = DVec3> {
    let known = draft.groups.iter().zip(boxes(draft)).filter_map(|(group, corners)| Some((group, corners?)));
    known.flat_map(|(group, corners)| {
        let at = move |to_world: &DMat4| {
            box_corners(corners).map({
                let to_world = *to_world;
                move |p| to_world.transform_point3(p)
            })
        };
        group.placements.iter().flat_map(at)
    })
}

/// Returns the largest distance along an axis from the middle of a placed group to its sides; 0 without groups.
pub fn reach(draft: &Draft) -> f64 {
    let mut most: f64 = 0.0;
    for (group, corners) in draft.groups.iter().zip(boxes(draft)) {
        let Some([low, high]) = corners else { continue };
        let half = 0.5 * (high - low);
        for DMat4 { x_axis, y_axis, z_axis, .. } in &group.placements {
            let reach = x_axis.abs() * half.x + y_axis.abs() * half.y + z_axis.abs() * half.z;
            most = most.max(reach.truncate().max_element());
        }
    }
    most
}

/// Returns the boxes around the triangles of each group, in its own coordinates; `None` without triangles.
pub fn boxes(draft: &Draft) -> Vec<Option<[DVec3; 2]>> {
    let mut boxes = vec![None; draft.groups.len()];
    for mesh in &draft.meshes {
        let Some(found) = mesh.group.and_then(|group| boxes.get_mut(group)) else { continue };
        for p in used(mesh).filter(|p| p.is_finite()) {
            let [low, high] = found.unwrap_or([p, p]);
            *found = Some([low.min(p), high.max(p)]);
        }
    }
    boxes
}

/// Returns about `count` corners, spread evenly over all triangles at all places.
pub fn sample(draft: &Draft, count: usize) -> Vec<DVec3> {
    let mut parts: Vec<(&DraftMesh, &[DMat4])> = Vec::new();
    for mesh in &draft.meshes {
        let placements =
            mesh.group.and_then(|group| draft.groups.get(group)).map(|group| &group.placements[..]);
        parts.push((mesh, placements.unwrap_or(&[DMat4::IDENTITY])));
    }
    let corners = |mesh: &DraftMesh| 3 * mesh.triangles.len();
    let all: usize = parts.iter().map(|(mesh, placements)| corners(mesh) * placements.len()).sum();
    let step = all.div_ceil(count).max(1);
    let (mut sample, mut next) = (Vec::new(), 0);
    for (mesh, placements) in parts {
        let here = corners(mesh) * placements.len();
        while next < here {
            let (place, corner) = (next / corners(mesh), next % corners(mesh));
            let vertex = mesh.triangles[corner / 3][corner % 3];
            let placed = |p: &DVec3| match mesh.group {
                None => *p,
                Some(_) => placements[place].transform_point3(*p),
            };
            sample.extend(mesh.positions.get(vertex as usize).map(placed));
            next += step;
        }
        next -= here;
    }
    sample
}

fn used(mesh: &DraftMesh) -> impl Iterator<Item = DVec3> {
    mesh.triangles.iter().flatten().filter_map(|&i| mesh.positions.get(i as usize).copied())
}

fn box_corners([low, high]: [DVec3; 2]) -> impl Iterator<Item = DVec3> {
    let pick = move |i: usize, axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
    (0..8).map(move |i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2)))
}
