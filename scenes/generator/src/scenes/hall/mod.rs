//! `hall`: an industrial hall with a sawtooth roof, a travelling crane, a turbine set, pumps, tanks, pipework
//! and a catwalk. Most of the light comes from bowls that are aimed at the roof, so that it reaches the
//! machines only indirectly; about a tenth of the area is glossy.
//!
//! Units: metres; 40 m long, 24 m wide, 13 m to the ridges.

mod catwalk;
mod envelope;
mod plan;
mod services;
mod stores;
mod structure;

use crate::props::industry::{
    compressor, crane, lying_tank, pump, standing_tank, turbine_set, uplight, work_light,
};
use crate::shapes::*;
use plan::{BAYS, EAVES, RAIL, line_z};

/// Height of the crane's hook block.
const HOOK: f32 = 4.9;
/// Lamps over the work places.
#[rustfmt::skip]
const WORK_LIGHTS: [[f32; 3]; 6] = [[6.6, 3.1, -1.9], [-8.0, 3.0, -14.2], [9.9, 3.2, -8.8], [5.6, 3.6, -27.2],
    [-9.6, 3.1, -20.5], [-9.6, 3.1, -27.5]];

/// Parts of the scene.
pub fn parts() -> Vec<Part> {
    let mut scene = Assembly::new();
    structure::add(&mut scene);
    envelope::add(&mut scene);
    catwalk::add(&mut scene);
    scene.merge(crane(at(0.0, RAIL[1], -17.0), RAIL[0], HOOK - (RAIL[1] + 0.83)));
    scene.merge(turbine_set(at(-4.3, 0.0, -8.5)));
    for k in 0..4 {
        scene.merge(pump(turned(90.0, [-10.0, 0.0, -15.5 - 2.6 * k as f32])));
    }
    for position in [[3.6, 0.0, -31.0], [-1.2, 0.0, -32.5]] {
        scene.merge(compressor(turned(-20.0, position)));
    }
    for (k, z) in [-13.2, -17.6, -22.0].into_iter().enumerate() {
        scene.merge(standing_tank(turned(-12.0 + 9.0 * k as f32, [7.0, 0.0, z]), 1.45, 3.4));
    }
    scene.merge(lying_tank(at(7.4, 0.0, -34.6), 1.2, 4.6));
    services::add(&mut scene);
    stores::add(&mut scene);
    for line in 1..BAYS {
        for x in [-6.9, 0.0, 6.9] {
            scene.merge(uplight(at(x, EAVES - 0.55, line_z(line))));
        }
    }
    for [x, y, z] in WORK_LIGHTS {
        scene.merge(work_light(at(x, y, z), 2.4));
    }
    scene.into_parts()
}
