//! The travelling crane: two box girders on end trucks with wheels, a trolley with its drum, the hook on its
//! ropes, a walkway and the driver's cab.

use super::access::{grating, railing};
use super::plan::RAIL;
use crate::shapes::Part;
use crate::shapes::{
    at, beveled_box, block, cylinder, extrude, fillet, frustum, helix, mirror_x, pipe, ring, rod, standing_on,
};
use glam::{Affine3A, Vec2, Vec3};

/// z of the crane.
const Z: f32 = -17.0;
/// Half the distance between its girders.
const GAUGE: f32 = 1.1;
/// x of the trolley.
const TROLLEY: f32 = 2.6;
/// Height of the hook block.
const HOOK: f32 = 4.9;

/// What the crane is made of.
#[derive(Default)]
pub struct Parts {
    /// Painted girders, trucks, trolley.
    pub paint: Part,
    /// Bare steel: wheels, shafts, ropes, walkway.
    pub bare: Part,
}

/// Appends the crane.
pub fn build(parts: &mut Parts) {
    let place = at(0.0, RAIL[1], Z);
    for z in [-GAUGE, GAUGE] {
        // A girder tapers towards its ends.
        let half = RAIL[0] - 0.2;
        let side = [
            [-half, 0.05],
            [-half + 1.2, -0.1],
            [-half + 2.2, -0.45],
            [half - 2.2, -0.45],
            [half - 1.2, -0.1],
            [half, 0.05],
            [half, 0.55],
            [-half, 0.55],
        ]
        .map(|p| Vec2::new(p[0], p[1] + 0.2));
        parts.paint.add_at(&extrude(&side, &[], 0.4), &(place * at(0.0, 0.0, z - 0.2)));
        for k in 0..18 {
            let x = -half + 1.4 + (2.0 * half - 2.8) * k as f32 / 17.0;
            for face in [-0.215, 0.2] {
                let low = Vec3::new(x - 0.008, -0.05, z + face);
                parts.paint.add_at(&block(low, low + Vec3::new(0.016, 0.75, 0.015)), &place);
            }
        }
        let flange = block(Vec3::new(-half, 0.74, z - 0.25), Vec3::new(half, 0.77, z + 0.25));
        parts.paint.add_at(&flange, &place);
        let rail = block(Vec3::new(-half + 0.3, 0.765, z - 0.03), Vec3::new(half - 0.3, 0.83, z + 0.03));
        parts.bare.add_at(&rail, &place);
    }
    for side in [place, mirror_x(0.0) * place] {
        end_truck(parts, &side);
    }
    trolley(parts, &(place * at(TROLLEY, 0.83, 0.0)));
    walkway(parts, &place);
    cab(parts, &(place * at(-7.4, 0.0, GAUGE)));
}

fn end_truck(parts: &mut Parts, place: &Affine3A) {
    let x = RAIL[0];
    let body = beveled_box(Vec3::new(x - 0.2, 0.12, -2.0), Vec3::new(x + 0.2, 0.6, 2.0), 0.03);
    parts.paint.add_at(&body, place);
    for z in [-1.65, 1.65] {
        let axle = standing_on(Vec3::new(x - 0.09, 0.25, z), Vec3::new(x + 1.0, 0.25, z));
        let wheel = *place * axle;
        parts.bare.add_at(&cylinder(0.25, 0.18, 24), &wheel);
        parts.bare.add_at(&ring(0.1, 0.29, -0.02, 0.005, 24), &wheel);
        parts.bare.add_at(&ring(0.1, 0.29, 0.175, 0.2, 24), &wheel);
        let buffer = standing_on(Vec3::new(x, 0.36, z * 1.2), Vec3::new(x, 0.36, z * 2.0));
        parts.bare.add_at(&cylinder(0.09, 0.22, 14), &(*place * buffer));
    }
}

fn trolley(parts: &mut Parts, place: &Affine3A) {
    parts.paint.add_at(&beveled_box(Vec3::new(-0.9, 0.12, -1.25), Vec3::new(-0.7, 0.36, 1.25), 0.02), place);
    parts.paint.add_at(&beveled_box(Vec3::new(0.7, 0.12, -1.25), Vec3::new(0.9, 0.36, 1.25), 0.02), place);
    for z in [-1.25, -0.55, 0.55, 1.1] {
        parts.paint.add_at(&block(Vec3::new(-0.75, 0.14, z), Vec3::new(0.75, 0.33, z + 0.12)), place);
    }
    for (x, z) in [(-0.8, -GAUGE), (-0.8, GAUGE), (0.8, -GAUGE), (0.8, GAUGE)] {
        let axle = standing_on(Vec3::new(x, 0.17, z - 0.06), Vec3::new(x, 0.17, z + 1.0));
        parts.bare.add_at(&cylinder(0.17, 0.12, 20), &(*place * axle));
    }
    // The drum lies along z with the rope wound on it.
    let drum = standing_on(Vec3::new(0.0, 0.62, -0.8), Vec3::new(0.0, 0.62, 1.0));
    parts.paint.add_at(&cylinder(0.24, 1.6, 24), &(*place * drum));
    for y in [-0.04, 1.6] {
        parts.paint.add_at(&cylinder(0.36, 0.04, 24), &(*place * drum * at(0.0, y, 0.0)));
    }
    parts.bare.add_at(&pipe(&helix(0.255, 0.045, 30.0, 12), 0.02, 4), &(*place * drum * at(0.0, 0.12, 0.0)));
    parts.paint.add_at(&beveled_box(Vec3::new(-0.45, 0.3, 0.85), Vec3::new(0.35, 1.0, 1.22), 0.05), place);
    let motor = standing_on(Vec3::new(-0.55, 0.62, -1.2), Vec3::new(-0.55, 0.62, 1.0));
    parts.paint.add_at(&cylinder(0.2, 0.7, 20), &(*place * motor));
    for k in 0..9 {
        parts.paint.add_at(
            &ring(0.19, 0.235, 0.08 + 0.065 * k as f32, 0.1 + 0.065 * k as f32, 20),
            &(*place * motor),
        );
    }
    hook(parts, place);
}

fn hook(parts: &mut Parts, place: &Affine3A) {
    let top = 0.62;
    let block_y = HOOK - (RAIL[1] + 0.83);
    for (x, z) in [(-0.25, -0.3), (-0.25, 0.3), (0.25, -0.3), (0.25, 0.3)] {
        let rope = rod(Vec3::new(0.8 * x, block_y, 0.6 * z), Vec3::new(x, top, z), 0.014, 6);
        parts.bare.add_at(&rope, place);
    }
    let cheek = crate::shapes::rectangle(Vec2::new(-0.32, -0.28), Vec2::new(0.32, 0.25));
    for z in [-0.2, 0.16] {
        parts.paint.add_at(&extrude(&cheek, &[], 0.04), &(*place * at(0.0, block_y, z)));
    }
    let sheave = standing_on(Vec3::new(0.0, block_y, -0.14), Vec3::new(0.0, block_y, 1.0));
    for y in [0.0, 0.16] {
        parts.bare.add_at(&cylinder(0.25, 0.1, 20), &(*place * sheave * at(0.0, y, 0.0)));
    }
    parts.bare.add_at(
        &frustum(Vec3::new(-0.1, block_y - 0.5, -0.1), Vec3::new(0.1, block_y - 0.25, 0.1), Vec2::splat(1.3)),
        place,
    );
    let curve = [
        Vec3::new(0.0, -0.45, 0.0),
        Vec3::new(0.0, -0.72, 0.0),
        Vec3::new(0.2, -0.85, 0.0),
        Vec3::new(0.2, -1.12, 0.0),
        Vec3::new(-0.02, -1.25, 0.0),
        Vec3::new(-0.24, -1.12, 0.0),
        Vec3::new(-0.26, -0.95, 0.0),
    ];
    let bent = fillet(&curve, 0.14, 20.0);
    parts.bare.add_at(&pipe(&bent, 0.06, 10), &(*place * at(0.0, block_y, 0.0)));
}

fn walkway(parts: &mut Parts, place: &Affine3A) {
    let (z, half) = (-GAUGE - 0.25, RAIL[0] - 0.6);
    let mut floor = Part::default();
    grating(&mut floor, Vec3::new(-half, 0.74, z), Vec3::NEG_Z * 0.75, Vec3::X * (2.0 * half), 0.06);
    let edge = Vec3::new(0.0, 0.74, z - 0.75);
    railing(&mut floor, &[edge - Vec3::X * half, edge + Vec3::X * half]);
    parts.bare.append(&floor, place);
    for k in 0..10 {
        let x = -half + 2.0 * half * k as f32 / 9.0;
        parts
            .paint
            .add_at(&block(Vec3::new(x - 0.03, 0.62, z - 0.74), Vec3::new(x + 0.03, 0.7, z + 0.1)), place);
    }
}

/// The driver's cab hangs under the near girder.
fn cab(parts: &mut Parts, place: &Affine3A) {
    let (half, low, high) = (0.75, -2.3, -0.3);
    let face =
        |width: f32| crate::shapes::rectangle(Vec2::new(-0.5 * width, low), Vec2::new(0.5 * width, high));
    let pane = |width: f32| {
        crate::shapes::rectangle(
            Vec2::new(-0.5 * width + 0.09, low + 0.85),
            Vec2::new(0.5 * width - 0.09, high - 0.12),
        )
    };
    let wall = extrude(&face(1.5), &[pane(1.5)], 0.05);
    for turn in 0..4 {
        let side = crate::shapes::turned(90.0 * turn as f32, Vec3::ZERO);
        let inset = if turn % 2 == 0 { 0.0 } else { 0.05 };
        let shrink = Affine3A::from_scale(Vec3::new(1.0 - inset / half, 1.0, 1.0));
        parts.paint.add_at(&wall, &(*place * side * at(0.0, 0.0, half - 0.05) * shrink));
    }
    for y in [low - 0.04, high - 0.01] {
        parts
            .paint
            .add_at(&beveled_box(Vec3::new(-0.8, y, -0.8), Vec3::new(0.8, y + 0.08, 0.8), 0.02), place);
    }
    for (x, z) in [(-0.5, -0.3), (0.5, -0.3), (-0.5, 0.15), (0.5, 0.15)] {
        parts
            .paint
            .add_at(&block(Vec3::new(x - 0.05, high, z - 0.05), Vec3::new(x + 0.05, 0.02, z + 0.05)), place);
    }
}
