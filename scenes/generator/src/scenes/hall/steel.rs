//! Rolled sections, and bars of them between two points.

use crate::shapes::{Shell, lathe, standing_on, sweep};
use glam::{Vec2, Vec3};

/// An I section of height `h` and flange width `w`, about its middle.
pub fn i_section(h: f32, w: f32, flange: f32, web: f32) -> Vec<Vec2> {
    let (y, x, t) = (0.5 * h, 0.5 * w, 0.5 * web);
    let i = y - flange;
    [
        (-x, -y),
        (x, -y),
        (x, -i),
        (t, -i),
        (t, i),
        (x, i),
        (x, y),
        (-x, y),
        (-x, i),
        (-t, i),
        (-t, -i),
        (-x, -i),
    ]
    .map(|(a, b)| Vec2::new(a, b))
    .to_vec()
}

/// An angle with legs of length `leg` along +x and +y from its heel.
pub fn angle_section(leg: f32, t: f32) -> Vec<Vec2> {
    [(0.0, 0.0), (leg, 0.0), (leg, t), (t, t), (t, leg), (0.0, leg)].map(|(a, b)| Vec2::new(a, b)).to_vec()
}

/// A channel of height `h`, open towards +x.
pub fn channel_section(h: f32, w: f32, t: f32) -> Vec<Vec2> {
    let y = 0.5 * h;
    [(0.0, -y), (w, -y), (w, t - y), (t, t - y), (t, y - t), (w, y - t), (w, y), (0.0, y)]
        .map(|(a, b)| Vec2::new(a, b))
        .to_vec()
}

/// A straight bar of `section`, its y axis towards `up`.
pub fn bar(section: &[Vec2], from: Vec3, to: Vec3, up: Vec3) -> Shell {
    sweep(section, &[from, to], up).creased(20.0)
}

/// A hexagonal bolt head or nut, open at its foot, on a surface with normal `normal`.
pub fn bolt(foot: Vec3, normal: Vec3, size: f32) -> Shell {
    let sunk = foot - normal * (0.1 * size);
    let (radius, height) = (0.5 * size, 0.5 * size);
    let profile = [Vec2::new(radius, 0.0), Vec2::new(radius, height), Vec2::new(0.0, height)];
    lathe(&profile, 6).creased(0.0).transformed(&standing_on(sunk, sunk + normal))
}
