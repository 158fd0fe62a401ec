//! Lamps: bowls that throw all their light up, and enamelled shades over work places: parts "lamp_housings",
//! "lamp_rods", "uplights", "work_lights".

use crate::shapes::*;
use glam::{Affine3A, Vec3};

const HOUSING: &str = "lamp_housings";

#[rustfmt::skip]
mod section {
    pub const BOWL: [[f32; 2]; 12] = [[0.0, -0.34], [0.08, -0.34], [0.12, -0.3], [0.24, -0.24], [0.36, -0.12],
        [0.42, 0.02], [0.44, 0.05], [0.42, 0.05], [0.4, 0.02], [0.34, -0.1], [0.22, -0.21], [0.0, -0.24]];
    /// Outer skin of a shade upwards from the rim.
    pub const SHADE: [[f32; 2]; 7] = [[0.3, 0.0], [0.31, 0.01], [0.27, 0.08], [0.16, 0.18], [0.08, 0.23],
        [0.06, 0.36], [0.0, 0.37]];
    /// Inner skin back down to it.
    pub const LINING: [[f32; 2]; 5] = [[0.0, 0.2], [0.06, 0.2], [0.15, 0.165], [0.26, 0.07], [0.3, 0.0]];
}

/// Bowl, open at the top, in the frame `place`, whose origin is the middle of the rim.
pub fn uplight(place: Affine3A) -> Assembly {
    let mut lamp = Assembly::framed(place);
    lamp.add(HOUSING, &lathe(&section::BOWL, 14));
    // A disc a little above the bottom of the bowl.
    lamp.add("uplights", &lathe(&[[0.24, -0.17], [0.0, -0.17]], 16));
    for x in [-0.42, 0.42] {
        lamp.add("lamp_rods", &rod([x, 0.0, 0.0], [0.25 * x, 0.7, 0.0], 0.012, 6));
    }
    lamp
}

/// Shade that hangs by `cord` metres, in the frame `place`, whose origin is the middle of the rim.
pub fn work_light(place: Affine3A, cord: f32) -> Assembly {
    let mut lamp = Assembly::framed(place);
    lamp.add(HOUSING, &lathe(&section::SHADE, 18));
    lamp.add(HOUSING, &lathe(&section::LINING, 18));
    lamp.add("work_lights", &lathe(&[[0.0, 0.1], [0.09, 0.1]], 12));
    lamp.add(HOUSING, &lathe(&[[0.05, 0.22], [0.092, 0.105], [0.0, 0.105]], 12));
    lamp.add("lamp_rods", &pipe(&[Vec3::Y * 0.36, Vec3::Y * (0.36 + cord)], 0.008, 5));
    lamp
}
