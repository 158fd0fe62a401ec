//! Compressors with a spoked flywheel.

use super::pipework::run;
use super::{BARE, CASING, CONCRETE, PIPES, RED};
use crate::shapes::*;
use glam::Affine3A;

/// Half sections along the shaft, and of a cylinder along its own axis.
#[rustfmt::skip]
mod section {
    pub const RIM: [[f32; 2]; 8] = [[1.02, 0.0], [1.25, 0.0], [1.28, 0.03], [1.28, 0.27], [1.25, 0.3], [1.02, 0.3],
        [1.0, 0.25], [1.0, 0.05]];
    pub const SHAFT: [[f32; 2]; 7] = [[0.1, -1.8], [0.1, -0.05], [0.22, -0.05], [0.22, 0.36], [0.12, 0.36],
        [0.12, 0.5], [0.0, 0.5]];
    pub const CYLINDER: [[f32; 2]; 8] = [[0.3, 0.0], [0.42, 0.05], [0.42, 0.1], [0.34, 0.12], [0.34, 0.6],
        [0.42, 0.62], [0.42, 0.72], [0.0, 0.72]];
}

/// Compressor in the frame `place`; the wheel turns about x.
pub fn compressor(place: Affine3A) -> Assembly {
    let mut compressor = Assembly::framed(place);
    compressor.add(CONCRETE, &beveled_box([-1.6, -0.1, -2.6], [1.6, 0.35, 2.2], 0.05));
    let mut wheel = Assembly::framed(place * standing_on([0.75, 1.5, 0.0], [2.0, 1.5, 0.0]));
    wheel.add(RED, &profile_lathe(&section::RIM, 56));
    wheel.add(BARE, &lathe(&section::SHAFT, 24));
    wheel.add_each(RED, &rod([0.18, 0.15, 0.0], [1.03, 0.15, 0.0], 0.06, 10), turns(6));
    compressor.merge(wheel);
    compressor.add(CASING, &beveled_box([-1.0, 0.3, -0.7], [0.55, 1.9, 0.7], 0.08));
    compressor.add_at(CASING, &ellipsoid([0.75, 0.45, 0.6], 28, 14), at(-0.22, 1.88, 0.0));
    for z in [-1.0, -1.6] {
        let barrel = standing_on([-0.2, 1.3, z + 0.4], [-0.2, 1.3, z - 1.0]);
        compressor.add_at(CASING, &lathe(&section::CYLINDER, 28), barrel);
    }
    let suction = [[-0.2, 1.5, -1.7], [-0.2, 2.7, -1.7], [-1.3, 2.7, -1.7], [-1.3, -0.1, -1.7]];
    compressor.merge(run(PIPES, &moved(&suction, place), 0.1, 16));
    let delivery = [[-0.6, 1.9, 0.3], [-0.6, 3.4, 0.3], [-0.6, 3.4, -2.9], [-0.6, -0.1, -2.9]];
    compressor.merge(run(PIPES, &moved(&delivery, place), 0.08, 16));
    compressor.add_at(BARE, &cylinder(0.12, 0.25, 12), at(0.2, 2.2, 0.2));
    compressor
}
