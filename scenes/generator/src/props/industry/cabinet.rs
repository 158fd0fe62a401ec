//! Electrical cabinets: parts "cabinets" and "brackets".

use crate::shapes::*;
use glam::{Affine3A, Vec3};

/// Control cabinet with `dials` in the frame `place`, its back towards +x, with a conduit to a tray above it.
pub fn cabinet(place: Affine3A, dials: usize) -> Assembly {
    let mut cabinet = Assembly::framed(place);
    cabinet.add("cabinets", &beveled_box([-0.5, 0.1, -0.5], [0.1, 2.05, 0.5], 0.015));
    cabinet.add("brackets", &block([-0.47, 0.0, -0.48], [0.1, 0.11, 0.48]));
    for (low, high) in [(-0.48, -0.005), (0.005, 0.48)] {
        cabinet.add("cabinets", &beveled_box([-0.525, 0.16, low], [-0.49, 2.0, high], 0.01));
        for k in 0..6 {
            let y = 0.3 + 0.05 * k as f32;
            cabinet.add("brackets", &block([-0.532, y, low + 0.1], [-0.52, y + 0.02, high - 0.1]));
        }
    }
    cabinet.add("brackets", &block([-0.56, 1.0, -0.06], [-0.52, 1.18, -0.035]));
    let dial = lathe(&[[0.0, 0.0], [0.06, 0.0], [0.065, 0.02], [0.05, 0.03], [0.0, 0.026]], 14);
    for k in 0..dials {
        let centre = Vec3::new(-0.52, 1.72, -0.36 + 0.19 * k as f32);
        cabinet.add_at("brackets", &dial, standing_on(centre, centre - Vec3::X));
    }
    cabinet.add("brackets", &rod([-0.2, 2.0, 0.0], [-0.2, 5.92, 0.0], 0.03, 8));
    cabinet
}
