//! The travelling crane: two box girders on end trucks with wheels, a trolley with its drum, the hook on its
//! ropes, a walkway and the driver's cab: parts "crane_paint" and "crane_steel".

use super::ways::{grating, railing};
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

const PAINT: &str = "crane_paint";
const STEEL: &str = "crane_steel";
/// Half the distance between its girders.
const GAUGE: f32 = 1.1;
/// x of the trolley.
const TROLLEY: f32 = 2.6;

/// Crane across x in the frame `place`, whose origin is between the tops of its rails, `rail` to either side; the hook
/// block hangs at `hook` above the trolley's rails.
pub fn crane(place: Affine3A, rail: f32, hook: f32) -> Assembly {
    let mut crane = Assembly::framed(place);
    for z in [-GAUGE, GAUGE] {
        girder(&mut crane, z, rail - 0.2);
    }
    for side in [place, mirror_x() * place] {
        crane.merge(end_truck(side, rail));
    }
    crane.merge(trolley(place * at(TROLLEY, 0.83, 0.0), hook));
    walkway(&mut crane, rail - 0.6);
    crane.merge(cab(place * at(-7.4, 0.0, GAUGE)));
    crane
}

/// Girder of length 2 `half` at `z` that tapers towards its ends, with stiffeners, a flange and a rail.
fn girder(crane: &mut Assembly, z: f32, half: f32) {
    let lower = [[-half, 0.05], [-half + 1.2, -0.1], [-half + 2.2, -0.45], [half - 2.2, -0.45]];
    let upper = [[half - 1.2, -0.1], [half, 0.05], [half, 0.55], [-half, 0.55]];
    let side: Vec<Vec2> = lower.iter().chain(&upper).map(|&[x, y]| Vec2::new(x, y + 0.2)).collect();
    crane.add_at(PAINT, &extrude(&side, &[], 0.4), at(0.0, 0.0, z - 0.2));
    for k in 0..18 {
        let x = -half + 1.4 + (2.0 * half - 2.8) * k as f32 / 17.0;
        for face in [-0.215, 0.2] {
            let low = Vec3::new(x - 0.008, -0.05, z + face);
            crane.add(PAINT, &block(low, low + Vec3::new(0.016, 0.75, 0.015)));
        }
    }
    crane.add(PAINT, &block([-half, 0.74, z - 0.25], [half, 0.77, z + 0.25]));
    crane.add(STEEL, &block([-half + 0.3, 0.765, z - 0.03], [half - 0.3, 0.83, z + 0.03]));
}

fn end_truck(place: Affine3A, x: f32) -> Assembly {
    let mut truck = Assembly::framed(place);
    truck.add(PAINT, &beveled_box([x - 0.2, 0.12, -2.0], [x + 0.2, 0.6, 2.0], 0.03));
    for z in [-1.65, 1.65] {
        let wheel = standing_on([x - 0.09, 0.25, z], [x + 1.0, 0.25, z]);
        truck.add_at(STEEL, &cylinder(0.25, 0.18, 24), wheel);
        truck.add_at(STEEL, &ring(0.1, 0.29, -0.02, 0.005, 24), wheel);
        truck.add_at(STEEL, &ring(0.1, 0.29, 0.175, 0.2, 24), wheel);
        let buffer = standing_on([x, 0.36, z * 1.2], [x, 0.36, z * 2.0]);
        truck.add_at(STEEL, &cylinder(0.09, 0.22, 14), buffer);
    }
    truck
}

fn trolley(place: Affine3A, hook_height: f32) -> Assembly {
    let mut trolley = Assembly::framed(place);
    trolley.add(PAINT, &beveled_box([-0.9, 0.12, -1.25], [-0.7, 0.36, 1.25], 0.02));
    trolley.add(PAINT, &beveled_box([0.7, 0.12, -1.25], [0.9, 0.36, 1.25], 0.02));
    for z in [-1.25, -0.55, 0.55, 1.1] {
        trolley.add(PAINT, &block([-0.75, 0.14, z], [0.75, 0.33, z + 0.12]));
    }
    for (x, z) in [(-0.8, -GAUGE), (-0.8, GAUGE), (0.8, -GAUGE), (0.8, GAUGE)] {
        let axle = standing_on([x, 0.17, z - 0.06], [x, 0.17, z + 1.0]);
        trolley.add_at(STEEL, &cylinder(0.17, 0.12, 20), axle);
    }
    // The drum lies along z with the rope wound on it.
    let mut drum = Assembly::framed(place * standing_on([0.0, 0.62, -0.8], [0.0, 0.62, 1.0]));
    drum.add(PAINT, &cylinder(0.24, 1.6, 24));
    drum.add_each(PAINT, &cylinder(0.36, 0.04, 24), [-0.04, 1.6].map(|y| at(0.0, y, 0.0)));
    drum.add_at(STEEL, &pipe(&helix(0.255, 0.045, 30.0, 12), 0.02, 4), at(0.0, 0.12, 0.0));
    trolley.merge(drum);
    trolley.add(PAINT, &beveled_box([-0.45, 0.3, 0.85], [0.35, 1.0, 1.22], 0.05));
    let motor = standing_on([-0.55, 0.62, -1.2], [-0.55, 0.62, 1.0]);
    trolley.add_at(PAINT, &cylinder(0.2, 0.7, 20), motor);
    for k in 0..9 {
        let fin = ring(0.19, 0.235, 0.08 + 0.065 * k as f32, 0.1 + 0.065 * k as f32, 20);
        trolley.add_at(PAINT, &fin, motor);
    }
    trolley.merge(hook(place, hook_height));
    trolley
}

/// Hook, hook block at height `y` and ropes.
fn hook(place: Affine3A, y: f32) -> Assembly {
    let mut hook = Assembly::framed(place);
    for (x, z) in [(-0.25, -0.3), (-0.25, 0.3), (0.25, -0.3), (0.25, 0.3)] {
        hook.add(STEEL, &rod([0.8 * x, y, 0.6 * z], [x, 0.62, z], 0.014, 6));
    }
    let cheek = rectangle(Vec2::new(-0.32, -0.28), Vec2::new(0.32, 0.25));
    hook.add_each(PAINT, &extrude(&cheek, &[], 0.04), [-0.2, 0.16].map(|z| at(0.0, y, z)));
    let mut sheaves = Assembly::framed(place * standing_on([0.0, y, -0.14], [0.0, y, 1.0]));
    sheaves.add_each(STEEL, &cylinder(0.25, 0.1, 20), [0.0, 0.16].map(|along| at(0.0, along, 0.0)));
    hook.merge(sheaves);
    hook.add(STEEL, &frustum([-0.1, y - 0.5, -0.1], [0.1, y - 0.25, 0.1], Vec2::splat(1.3)));
    let shank = [[0.0, -0.45, 0.0], [0.0, -0.72, 0.0], [0.2, -0.85, 0.0], [0.2, -1.12, 0.0]];
    let tip = [[-0.02, -1.25, 0.0], [-0.24, -1.12, 0.0], [-0.26, -0.95, 0.0]];
    let bent = fillet(&[&shank[..], &tip].concat(), 0.14, 20.0);
    hook.add_at(STEEL, &pipe(&bent, 0.06, 10), at(0.0, y, 0.0));
    hook
}

fn walkway(crane: &mut Assembly, half: f32) {
    let z = -GAUGE - 0.25;
    let across = Vec3::X * (2.0 * half);
    let mut floor = grating(STEEL, Vec3::new(-half, 0.74, z), Vec3::NEG_Z * 0.75, across, 0.06);
    let edge = Vec3::new(0.0, 0.74, z - 0.75);
    floor.merge(railing(STEEL, &[edge - Vec3::X * half, edge + Vec3::X * half]));
    crane.place(&floor, Affine3A::IDENTITY);
    for k in 0..10 {
        let x = -half + 2.0 * half * k as f32 / 9.0;
        crane.add(PAINT, &block([x - 0.03, 0.62, z - 0.74], [x + 0.03, 0.7, z + 0.1]));
    }
}

/// Driver's cab under the near girder.
fn cab(place: Affine3A) -> Assembly {
    let mut cab = Assembly::framed(place);
    let (half, low, high) = (0.75, -2.3, -0.3);
    let face = rectangle(Vec2::new(-half, low), Vec2::new(half, high));
    let pane = rectangle(Vec2::new(-half + 0.09, low + 0.85), Vec2::new(half - 0.09, high - 0.12));
    let wall = extrude(&face, &[pane], 0.05);
    for turn in 0..4 {
        let mut side =
            Assembly::framed(place * turned(90.0 * turn as f32, Vec3::ZERO) * at(0.0, 0.0, half - 0.05));
        let inset = if turn % 2 == 0 { 0.0 } else { 0.05 };
        side.add_at(PAINT, &wall, Affine3A::from_scale(Vec3::new(1.0 - inset / half, 1.0, 1.0)));
        cab.merge(side);
    }
    for y in [low - 0.04, high - 0.01] {
        cab.add(PAINT, &beveled_box([-0.8, y, -0.8], [0.8, y + 0.08, 0.8], 0.02));
    }
    for (x, z) in [(-0.5, -0.3), (0.5, -0.3), (-0.5, 0.15), (0.5, 0.15)] {
        cab.add(PAINT, &block([x - 0.05, high, z - 0.05], [x + 0.05, 0.02, z + 0.05]));
    }
    cab
}
