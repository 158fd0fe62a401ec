//! Rolled sections, and bars of them between two points.

use crate::shapes::*;
use glam::{Vec2, Vec3};

/// I section of height `h` and flange width `w`, about its middle.
pub fn i_section(h: f32, w: f32, flange: f32, web: f32) -> Vec<Vec2> {
    let (y, x, t) = (0.5 * h, 0.5 * w, 0.5 * web);
    let i = y - flange;
    let right = [[-x, -y], [x, -y], [x, -i], [t, -i], [t, i], [x, i]];
    let left = [[x, y], [-x, y], [-x, i], [-t, i], [-t, -i], [-x, -i]];
    points(&[right, left].concat())
}

/// Angle with legs of length `leg` along +x and +y from its heel.
pub fn angle_section(leg: f32, t: f32) -> Vec<Vec2> {
    points(&[[0.0, 0.0], [leg, 0.0], [leg, t], [t, t], [t, leg], [0.0, leg]])
}

/// Channel of height `h`, open towards +x.
pub fn channel_section(h: f32, w: f32, t: f32) -> Vec<Vec2> {
    let y = 0.5 * h;
    points(&[[0.0, -y], [w, -y], [w, t - y], [t, t - y], [t, y - t], [w, y - t], [w, y], [0.0, y]])
}

/// Straight bar of `section`, its y axis towards `up`.
pub fn bar(section: &[Vec2], from: impl Into<Vec3>, to: impl Into<Vec3>, up: Vec3) -> Shell {
    sweep(section, &[from.into(), to.into()], up).creased(20.0)
}

/// Hexagonal bolt head or nut, open at its foot, on a surface with normal `normal`.
pub fn bolt(foot: impl Into<Vec3>, normal: Vec3, size: f32) -> Shell {
    let sunk = foot.into() - normal * (0.1 * size);
    let (radius, height) = (0.5 * size, 0.5 * size);
    let profile = [[radius, 0.0], [radius, height], [0.0, height]];
    lathe(&profile, 6).creased(0.0).transformed(standing_on(sunk, sunk + normal))
}
