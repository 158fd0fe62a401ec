//! Motor-driven pumps.

use super::pipework::{flange, gauge, run, valve};
use super::{BARE, CASING, CONCRETE, GLOSS, PIPES, RED};
use crate::shapes::*;
use glam::{Affine3A, Vec3};

/// Half sections along the shaft.
#[rustfmt::skip]
mod section {
    pub const MOTOR: [[f32; 2]; 8] = [[0.0, 0.0], [0.2, 0.0], [0.29, 0.06], [0.3, 0.18], [0.26, 0.18], [0.26, 0.85],
        [0.22, 0.9], [0.1, 0.93]];
    pub const COUPLING: [[f32; 2]; 6] = [[0.05, 0.9], [0.05, 1.0], [0.12, 1.0], [0.12, 1.14], [0.05, 1.14],
        [0.05, 1.25]];
    pub const VOLUTE: [[f32; 2]; 9] = [[0.05, 1.2], [0.16, 1.22], [0.16, 1.42], [0.3, 1.5], [0.34, 1.55],
        [0.34, 1.78], [0.28, 1.84], [0.16, 1.9], [0.14, 2.05]];
}

/// Pump with its motor in the frame `place`, the shaft along x; the suction from +x, the delivery upwards.
pub fn pump(place: Affine3A) -> Assembly {
    let mut pump = Assembly::framed(place);
    pump.add(CONCRETE, &beveled_box([-1.25, -0.1, -0.5], [1.0, 0.25, 0.5], 0.03));
    pump.add(CASING, &beveled_box([-1.15, 0.24, -0.38], [0.6, 0.34, 0.38], 0.015));
    // Motor with fins, terminal box and feet; coupling with its guard; volute.
    let mut shaft = Assembly::framed(place * standing_on([-1.1, 0.75, 0.0], [1.0, 0.75, 0.0]));
    shaft.add(GLOSS, &lathe(&section::MOTOR, 28));
    shaft.add_each(GLOSS, &block([0.255, 0.2, -0.006], [0.31, 0.84, 0.006]), turns(24));
    shaft.add(BARE, &lathe(&section::COUPLING, 16));
    shaft.add_at(RED, &ring(0.17, 0.18, 0.0, 0.26, 20), at(0.0, 0.95, 0.0));
    shaft.add(CASING, &lathe(&section::VOLUTE, 28));
    shaft.add_at(CASING, &torus(0.3, 0.13, 28, 10), at(0.0, 1.66, 0.0));
    pump.merge(shaft);
    pump.add(GLOSS, &beveled_box([-0.85, 1.0, -0.12], [-0.5, 1.18, 0.12], 0.02));
    for x in [-0.9, -0.35] {
        pump.add(GLOSS, &block([x - 0.06, 0.33, -0.24], [x + 0.06, 0.56, 0.24]));
    }
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    let along = place.transform_vector3(Vec3::X);
    pump.merge(flange(CASING, v(1.0, 0.75, 0.0), place.transform_vector3(Vec3::NEG_X), 0.14));
    let delivery = [[0.56, 0.85, 0.25], [0.56, 1.45, 0.25], [0.56, 3.2, 0.25]];
    pump.merge(run(PIPES, &moved(&delivery, place), 0.11, 14));
    pump.merge(valve(PIPES, RED, v(0.56, 1.95, 0.25), Vec3::Y, along, 0.11));
    let suction = [[1.0, 0.75, 0.0], [1.9, 0.75, 0.0], [1.9, -0.1, 0.0]];
    pump.merge(run(PIPES, &moved(&suction, place), 0.14, 14));
    pump.merge(gauge(BARE, v(0.56, 1.2, 0.36), 90.0));
    pump
}
