//! Repairs of meshes.

use super::reach::MAX_COORDINATE;
use super::report::SanitizeReport;
use crate::draft::DraftMesh;
use crate::local::LocalCoordinates;
use glam::{DVec3, Vec3};
use scene::AttributeValues;

/// Drops triangles with invalid corners, and triangles without area.
pub(super) fn drop_unusable(mesh: &mut DraftMesh, report: &mut SanitizeReport) {
    mesh.retain_triangles(|positions, t| {
        let [Some(&a), Some(&b), Some(&c)] = t.map(|i| positions.get(i as usize)) else {
            report.out_of_range += 1;
            return false;
        };
        let corners = [a, b, c];
        if !corners.iter().all(|p| p.is_finite()) {
            report.not_finite += 1;
            return false;
        }
        if corners.iter().any(|p| p.abs().max_element() > MAX_COORDINATE) {
            report.huge += 1;
            return false;
        }
        report.degenerate += usize::from(!has_area(corners));
        has_area(corners)
    });
}

fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a) != DVec3::ZERO
}

/// Drops triangles that have no area in f32, or lie beyond its reach; returns their number.
pub(super) fn drop_rounded(
    mesh: &mut DraftMesh,
    coordinates: &LocalCoordinates,
    report: &mut SanitizeReport,
) -> usize {
    let before = mesh.triangles.len();
    mesh.retain_triangles(|positions, t| {
        let local = |i: u32| positions.get(i as usize).map_or(Vec3::INFINITY, |p| coordinates.local(*p));
        let corners = t.map(local);
        let is_huge = corners.iter().any(|p| !(p.abs().max_element() <= MAX_COORDINATE as f32));
        let is_degenerate = !is_huge && !has_area(corners.map(|p| p.as_dvec3()));
        report.huge += usize::from(is_huge);
        report.degenerate += usize::from(is_degenerate);
        !is_huge && !is_degenerate
    });
    before - mesh.triangles.len()
}

/// Drops vertices that no triangle uses, and attributes that some vertices lack.
pub(super) fn use_all_vertices(mesh: &mut DraftMesh) {
    let count = mesh.positions.len();
    if mesh.normals.len() != count {
        mesh.normals.clear();
    }
    if mesh.uvs.len() != count {
        mesh.uvs.clear();
    }
    if mesh.tangents.len() != count {
        mesh.tangents.clear();
    }
    let triangle_count = mesh.triangles.len();
    mesh.attributes.retain(|attribute| match &attribute.values {
        AttributeValues::Vertices(values) => values.len() == count,
        AttributeValues::Triangles(values) => values.len() == triangle_count,
    });
    let mut renumbered = vec![u32::MAX; count];
    mesh.triangles.iter().flatten().for_each(|&i| renumbered[i as usize] = 0);
    if !renumbered.contains(&u32::MAX) {
        return;
    }
    for (next, number) in (0..).zip(renumbered.iter_mut().filter(|n| **n == 0)) {
        *number = next;
    }
    let used = |i: usize| renumbered[i] != u32::MAX;
    keep(&mut mesh.positions, used);
    keep(&mut mesh.normals, used);
    keep(&mut mesh.uvs, used);
    keep(&mut mesh.tangents, used);
    for attribute in &mut mesh.attributes {
        if let AttributeValues::Vertices(values) = &mut attribute.values {
            keep(values, used);
        }
    }
    mesh.triangles.iter_mut().flatten().for_each(|i| *i = renumbered[*i as usize]);
}

fn keep<T>(values: &mut Vec<T>, wanted: impl Fn(usize) -> bool) {
    let mut i = 0;
    values.retain(|_| {
        i += 1;
        wanted(i - 1)
    });
}

pub(super) fn repair_normals(mesh: &mut DraftMesh, report: &mut SanitizeReport) {
    let bad = |n: &Vec3| !n.is_finite() || n.length_squared() < 0.25;
    if !mesh.normals.iter().any(bad) {
        return;
    }
    let geometric = crate::smooth_normals(&mesh.positions, &mesh.triangles);
    for (normal, geometric) in mesh.normals.iter_mut().zip(geometric) {
        if bad(normal) {
            match normal.is_finite() {
                true => report.bad_normals += 1,
                false => report.nan_normals += 1,
            }
            // If faces cancel, any unit vector is valid.
            *normal = if geometric == Vec3::ZERO { Vec3::Z } else { geometric };
        }
    }
}
