//! Curtains and rugs.

use crate::shapes::*;
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Curtain of `width` that hangs `drop` metres from y = 0 in `folds`, about the plane z = 0 from x = 0;
/// the folds open towards the hem. A sheet for both sides.
fn curtain(width: f32, drop: f32, folds: usize) -> Shell {
    patch(folds * 8, 6, |u, v| {
        let phase = TAU * folds as f32 * u + 0.5 * (7.0 * u).sin();
        let depth = 0.035 * (0.75 + 0.35 * v) * (1.0 + 0.25 * (13.0 * u + 2.0).sin());
        let sway = 0.012 * v * v * (9.0 * u + 1.0).sin();
        Vec3::new(u * width + 0.3 * depth * (2.0 * phase).sin(), -v * drop, depth * phase.sin() + sway)
    })
    .flipped()
}

/// Two curtains of `width` at the ends of a rail of `length` that hangs at the height `rail` before the wall z = 0,
/// from x = 0: parts "lamp_metal" and "curtains".
pub fn drapes(rail: f32, length: f32, width: f32, folds: usize) -> Assembly {
    let mut drapes = Assembly::new();
    drapes.add("lamp_metal", &rod([0.0, rail, 0.1], [length, rail, 0.1], 0.012, 12));
    drapes.add_each(
        "lamp_metal",
        &ellipsoid(Vec3::splat(0.028), 12, 8),
        [0.0, length].map(|x| at(x, rail, 0.1)),
    );
    for x in [0.12, length - 0.12] {
        drapes.add("lamp_metal", &rod([x, rail, 0.0], [x, rail, 0.1], 0.008, 8));
    }
    let places = [0.03, length - (width + 0.03)].map(|x| at(x, rail - 0.005, 0.1));
    drapes.add_each("curtains", &curtain(width, rail - 0.04, folds), places);
    drapes
}

/// Rug of `size` about the origin, with a soft edge.
pub fn rug(size: Vec2) -> Shell {
    let half = 0.5 * size;
    rounded_box([-half.x, 0.0005, -half.y], [half.x, 0.014, half.y], 0.006, 2)
}
