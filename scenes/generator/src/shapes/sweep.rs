//! Profiles swept along polylines with mitred corners: pipes, mouldings, ribs, rails, cables.

use super::{Faces, Shell, circle, extrude::triangulate, grid, points};
use glam::{Vec2, Vec3};

/// Profile of a sweep, in the plane across the path as someone sees it who travels along: x to the
/// right, y up.
#[derive(Clone, Copy, Debug)]
pub struct Section<'a> {
    /// Points, counter-clockwise with x to the right and y up. Of an open profile, the outside is on the
    /// right of the direction in which its points follow each other.
    pub points: &'a [Vec2],
    /// True if the last point is joined to the first; an open profile gives an open sheet.
    pub closed: bool,
    /// Faces of the profile that meet at more than this stay sharp.
    pub crease_degrees: f32,
}

/// Sweeps a closed profile along `path`, with ends. `up` fixes the roll at the start and may not be parallel
/// to the first segment.
pub fn sweep(profile: &[impl Into<Vec2> + Copy], path: &[Vec3], up: Vec3) -> Shell {
    let section = Section { points: &points(profile), closed: true, crease_degrees: 35.0 };
    sweep_along(section, path, up, false, Faces::ALL)
}

/// Sweeps `section` along `path`. The roll is carried along without twist; a `path_closed` path must lie in
/// a plane for its ends to meet. `faces` says which ends of a closed profile on an open path are closed.
pub fn sweep_along(section: Section, path: &[Vec3], up: Vec3, path_closed: bool, faces: Faces) -> Shell {
    let rows = stations(section.points, path, up, path_closed);
    // Along the path only real corners stay sharp; arcs are cut finer than the crease angle.
    let mut shell = grid(&rows, section.closed, path_closed, section.crease_degrees).flipped();
    if section.closed && !path_closed {
        let count = section.points.len() as u32;
        let last = (path.len() as u32 - 1) * count;
        for [a, b, c] in triangulate(section.points, &[]) {
            let uvs = [a, b, c].map(|i| section.points[i as usize]);
            if faces.back {
                shell.triangle([a, b, c], uvs);
            }
            if faces.front {
                shell.triangle([last + a, last + c, last + b], [uvs[0], uvs[2], uvs[1]]);
            }
        }
    }
    shell
}

/// Profile placed at every point of the path, in the mitre plane there.
fn stations(profile: &[Vec2], path: &[Vec3], up: Vec3, closed: bool) -> Vec<Vec<Vec3>> {
    let count = path.len();
    let direction = |k: usize| (path[(k + 1) % count] - path[k % count]).normalize();
    let mut tangent = direction(0);
    let mut up = (up - tangent * up.dot(tangent)).normalize();
    (0..count)
        .map(|k| {
            let incoming = match (k, closed) {
                (0, false) => direction(0),
                (0, true) => direction(count - 1),
                _ => direction(k - 1),
            };
            let outgoing = if k + 1 == count && !closed { incoming } else { direction(k) };
            if k > 0 {
                // Parallel transport over the corner that lies behind us.
                up = (up - incoming * up.dot(incoming)).normalize();
                tangent = incoming;
            }
            let right = tangent.cross(up);
            let mitre = (incoming + outgoing).normalize();
            let row = profile
                .iter()
                .map(|p| {
                    let offset = right * p.x + up * p.y;
                    // Slide along the segment into the mitre plane.
                    path[k] + offset - tangent * (offset.dot(mitre) / tangent.dot(mitre))
                })
                .collect();
            if k + 1 < count || closed {
                up = rotate_into(up, incoming, outgoing);
            }
            row
        })
        .collect()
}

/// `v` turned by the shortest rotation that takes `from` to `to`.
fn rotate_into(v: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    glam::Quat::from_rotation_arc(from, to) * v
}

/// Round pipe along `path`, closed at the ends.
pub fn pipe(path: &[impl Into<Vec3> + Copy], radius: f32, segments: usize) -> Shell {
    let path: Vec<Vec3> = path.iter().map(|&p| p.into()).collect();
    let profile = circle(radius, segments);
    let first = (path[1] - path[0]).normalize();
    let up = if first.y.abs() > 0.9 { Vec3::X } else { Vec3::Y };
    let crease = f32::max(40.0, 360.0 / segments as f32 + 1.0);
    let section = Section { points: &profile, closed: true, crease_degrees: crease };
    sweep_along(section, &path, up, false, Faces::ALL)
}

/// Straight round bar between two points, closed at the ends.
pub fn rod(from: impl Into<Vec3>, to: impl Into<Vec3>, radius: f32, segments: usize) -> Shell {
    pipe(&[from.into(), to.into()], radius, segments)
}
