//! Potted plants: parts "planter", "soil", "leaves" and "stems".

use crate::shapes::*;
use glam::{Quat, Vec3};
use std::f32::consts::PI;

const PLANTER: Vessel = Vessel::new(
    &[[0.11, 0.0], [0.12, 0.01], [0.15, 0.25], [0.158, 0.255], [0.158, 0.29], [0.15, 0.295]],
    0.012,
    20,
    1,
);
/// Turn from leaf to leaf, in degrees.
const GOLDEN_ANGLE: f32 = 137.507_77;

fn planter() -> Assembly {
    let mut planter = Assembly::new();
    planter.add("planter", &PLANTER.turned(1.0));
    planter.add_at("soil", &disc(0.14, 20), at(0.0, 0.26, 0.0));
    planter
}

/// Leaf that starts at the origin along +z, rises, arches over and folds a little along its rib.
fn leaf(length: f32, width: f32, rise: f32, droop: f32) -> Shell {
    patch(4, 6, |u, v| {
        let across = 2.0 * u - 1.0;
        let half = 0.5 * width * (PI * v.powf(0.8)).sin().max(0.0).powf(0.75) + 0.004 * (1.0 - v);
        let along = length * (v - 0.18 * v * v);
        let y = rise * length * v - droop * length * v * v;
        Vec3::new(-half * across, y + 0.25 * half * across * across, along)
    })
}

/// Long arching leaves from the middle of the pot.
pub fn potted_fern(leaves: usize, seed: u64) -> Assembly {
    let mut plant = planter();
    let mut rng = Rng::new(seed);
    for k in 0..leaves {
        let t = k as f32 / leaves as f32;
        let length = rng.range(0.33, 0.43) * (1.0 - 0.25 * t);
        let shape = leaf(length, 0.06, 0.6 + 1.6 * t, 0.75);
        let place =
            turned(GOLDEN_ANGLE * k as f32, [0.0, 0.262, 0.0]) * at(0.0, 0.0, 0.012 + 0.05 * (1.0 - t));
        plant.add_at("leaves", &shape, place);
    }
    plant
}

/// Stem of `height` with broad stalked leaves all the way up.
pub fn potted_rubber_tree(height: f32, leaves: usize, seed: u64) -> Assembly {
    let mut plant = planter();
    let mut rng = Rng::new(seed);
    plant.add("stems", &rod([0.0, 0.24, 0.0], [0.0, height, 0.0], 0.011, 10));
    for k in 0..leaves {
        let t = (k as f32 + 0.5) / leaves as f32;
        let y = 0.45 + (height - 0.46) * t;
        let length = rng.range(0.24, 0.3) * (1.0 - 0.3 * t);
        let turn = turned(GOLDEN_ANGLE * k as f32 + rng.jitter(15.0), [0.0, y, 0.0]);
        let stalk = Vec3::new(0.0, 0.03, 0.07);
        plant.add_at("stems", &rod(Vec3::ZERO, stalk, 0.004, 6), turn);
        let tilt = posed(Quat::from_rotation_x(rng.range(-0.3, 0.25)), stalk);
        plant.add_at("leaves", &leaf(length, 0.13, 0.35 + 0.6 * t, 0.5), turn * tilt);
    }
    plant
}
