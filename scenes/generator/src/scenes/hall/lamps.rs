//! Lamps: bowls under the trusses that throw all their light up at the roof, and enamelled shades over the
//! work places.

use super::plan::{BAYS, EAVES, line_z};
use crate::shapes::Part;
use crate::shapes::{at, lathe, pipe, rod};
use glam::{Affine3A, Vec2, Vec3};

/// What lamps are made of.
#[derive(Default)]
pub struct Parts {
    /// Bowls and shades.
    pub housings: Part,
    /// Rods and cords.
    pub rods: Part,
    /// Emitters that look up at the roof.
    pub uplights: Part,
    /// Emitters under shades.
    pub work_lights: Part,
}

/// Appends all lamps.
pub fn build(parts: &mut Parts) {
    for line in 1..BAYS {
        for x in [-6.9, 0.0, 6.9] {
            uplight(parts, &at(x, EAVES - 0.55, line_z(line)));
        }
    }
    for (x, y, z) in [
        (6.6, 3.1, -1.9),
        (-8.0, 3.0, -14.2),
        (9.9, 3.2, -8.8),
        (5.6, 3.6, -27.2),
        (-9.6, 3.1, -20.5),
        (-9.6, 3.1, -27.5),
    ] {
        shade(parts, &at(x, y, z), 2.4);
    }
}

/// A bowl, open at the top, about its rim's centre.
fn uplight(parts: &mut Parts, place: &Affine3A) {
    let bowl: Vec<Vec2> = [
        (0.0, -0.34),
        (0.08, -0.34),
        (0.12, -0.3),
        (0.24, -0.24),
        (0.36, -0.12),
        (0.42, 0.02),
        (0.44, 0.05),
        (0.42, 0.05),
        (0.4, 0.02),
        (0.34, -0.1),
        (0.22, -0.21),
        (0.0, -0.24),
    ]
    .map(|(x, y)| Vec2::new(x, y))
    .to_vec();
    parts.housings.add_at(&lathe(&bowl, 14), place);
    // A disc a little above the bottom of the bowl.
    let disc: Vec<Vec2> = vec![Vec2::new(0.24, -0.17), Vec2::new(0.0, -0.17)];
    parts.uplights.add_at(&lathe(&disc, 16), place);
    for x in [-0.42, 0.42] {
        parts.rods.add_at(&rod(Vec3::new(x, 0.0, 0.0), Vec3::new(0.25 * x, 0.7, 0.0), 0.012, 6), place);
    }
}

/// A shade on a cord, about the centre of its rim.
fn shade(parts: &mut Parts, place: &Affine3A, cord: f32) {
    let bell: Vec<Vec2> = [
        (0.3, 0.0),
        (0.31, 0.01),
        (0.27, 0.08),
        (0.16, 0.18),
        (0.08, 0.23),
        (0.06, 0.36),
        (0.0, 0.37),
        (0.0, 0.2),
        (0.06, 0.2),
        (0.15, 0.165),
        (0.26, 0.07),
    ]
    .map(|(x, y)| Vec2::new(x, y))
    .to_vec();
    // The outer skin upwards, then the inner one back down to the rim.
    let (outer, inner) = bell.split_at(7);
    let mut rim: Vec<Vec2> = inner.to_vec();
    rim.push(outer[0]);
    parts.housings.add_at(&lathe(outer, 18), place);
    parts.housings.add_at(&lathe(&rim, 18), place);
    let disc: Vec<Vec2> = vec![Vec2::new(0.0, 0.1), Vec2::new(0.09, 0.1)];
    parts.work_lights.add_at(&lathe(&disc, 12), place);
    parts
        .housings
        .add_at(&lathe(&[Vec2::new(0.05, 0.22), Vec2::new(0.092, 0.105), Vec2::new(0.0, 0.105)], 12), place);
    parts.rods.add_at(&pipe(&[Vec3::Y * 0.36, Vec3::Y * (0.36 + cord)], 0.008, 5), place);
}
