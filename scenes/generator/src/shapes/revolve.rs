//! Surfaces of revolution about the y axis.

use super::{Shell, grid, points, spline};
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Turns `profile`, points (radius, height) from bottom to top with the material on the axis side, in
/// `segments` around the y axis. The ends are open unless they lie on the axis. Corners of the profile
/// sharper than 40° stay sharp.
pub fn lathe(profile: &[impl Into<Vec2> + Copy], segments: usize) -> Shell {
    turn(&points(profile), segments, false)
}

/// Part of a lathe between two angles (degrees, from +x towards +z), open along both cuts: half shafts
/// against a wall.
pub fn lathe_sector(
    profile: &[impl Into<Vec2> + Copy],
    from_degrees: f32,
    to_degrees: f32,
    segments: usize,
) -> Shell {
    let rows: Vec<Vec<Vec3>> = points(profile)
        .iter()
        .map(|p| {
            (0..=segments)
                .map(|i| {
                    let degrees = to_degrees + (from_degrees - to_degrees) * i as f32 / segments as f32;
                    let (sin, cos) = degrees.to_radians().sin_cos();
                    Vec3::new(p.x * cos, p.y, p.x * sin)
                })
                .collect()
        })
        .collect();
    let step = (to_degrees - from_degrees).abs() / segments as f32;
    grid(&rows, false, false, f32::max(40.0, step + 1.0))
}

/// Turned post: the smooth curve through `profile` in `steps` between two points, closed by flat ends.
pub fn spindle(profile: &[impl Into<Vec2> + Copy], steps: usize, segments: usize) -> Shell {
    let curve = spline(profile, steps);
    let on_axis = |p: Option<&Vec2>| p.map(|p| Vec2::new(0.0, p.y));
    let mut closed: Vec<Vec2> = on_axis(curve.first()).into_iter().collect();
    closed.extend(&curve);
    closed.extend(on_axis(curve.last()));
    lathe(&closed, segments)
}

/// Turns a closed `profile` that does not touch the axis (rings, rims), given counter-clockwise with radius to the
/// right and height upwards, in `segments` around the y axis.
pub fn profile_lathe(profile: &[impl Into<Vec2> + Copy], segments: usize) -> Shell {
    turn(&points(profile), segments, true)
}

fn turn(profile: &[Vec2], segments: usize, closed: bool) -> Shell {
    let rows: Vec<Vec<Vec3>> = profile
        .iter()
        .map(|p| {
            (0..segments)
                .map(|i| {
                    // Clockwise about +y, so that across x up looks outwards.
                    let (sin, cos) = (-TAU * i as f32 / segments as f32).sin_cos();
                    Vec3::new(p.x * cos, p.y, p.x * sin)
                })
                .collect()
        })
        .collect();
    // Few segments must still look round across them.
    let crease = f32::max(40.0, 360.0 / segments as f32 + 1.0);
    grid(&rows, true, closed, crease)
}

/// Closed cylinder on the y axis from the origin to `height`.
pub fn cylinder(radius: f32, height: f32, segments: usize) -> Shell {
    cone(radius, radius, height, segments)
}

/// Closed truncated cone on the y axis from the origin; a radius of 0 gives a point.
pub fn cone(bottom_radius: f32, top_radius: f32, height: f32, segments: usize) -> Shell {
    let mut profile = vec![Vec2::new(0.0, 0.0)];
    if bottom_radius > 0.0 {
        profile.push(Vec2::new(bottom_radius, 0.0));
    }
    if top_radius > 0.0 {
        profile.push(Vec2::new(top_radius, height));
    }
    profile.push(Vec2::new(0.0, height));
    lathe(&profile, segments)
}

/// Closed ring of rectangular section (a flange, a hoop) between two heights.
pub fn ring(inner_radius: f32, outer_radius: f32, low: f32, high: f32, segments: usize) -> Shell {
    let section = [[inner_radius, low], [outer_radius, low], [outer_radius, high], [inner_radius, high]];
    profile_lathe(&section, segments)
}

/// Ring of round section about the y axis.
pub fn torus(major_radius: f32, minor_radius: f32, segments: usize, section_segments: usize) -> Shell {
    let profile: Vec<Vec2> = (0..section_segments)
        .map(|k| {
            let (sin, cos) = (TAU * k as f32 / section_segments as f32).sin_cos();
            Vec2::new(major_radius + minor_radius * cos, minor_radius * sin)
        })
        .collect();
    profile_lathe(&profile, segments).creased(75.0)
}

/// Ellipsoid about the origin.
pub fn ellipsoid(radii: impl Into<Vec3>, segments: usize, rings: usize) -> Shell {
    let radii = radii.into();
    let profile: Vec<Vec2> = (0..=rings)
        .map(|k| {
            let polar = PI * k as f32 / rings as f32;
            let radius = if k == 0 || k == rings { 0.0 } else { polar.sin() };
            Vec2::new(radius, -polar.cos())
        })
        .collect();
    lathe(&profile, segments).creased(75.0).mapped(|p| p * radii)
}
