//! A turbine with its generator on a common foundation.

use super::pipework::{gauge, joint, run, valve};
use super::steel::bolt;
use super::{BARE, CASING, CONCRETE, GLOSS, PIPES, RED};
use crate::shapes::*;
use glam::{Affine3A, Vec3};

/// Half sections along the shaft.
#[rustfmt::skip]
mod section {
    pub const EXCITER: [[f32; 2]; 7] = [[0.0, 0.1], [0.25, 0.1], [0.55, 0.25], [0.62, 0.4], [0.62, 1.1], [0.55, 1.2],
        [0.3, 1.3]];
    pub const GENERATOR: [[f32; 2]; 10] = [[0.3, 1.3], [0.5, 1.35], [1.0, 1.4], [1.15, 1.5], [1.18, 1.7], [1.18, 5.2],
        [1.15, 5.4], [1.0, 5.5], [0.5, 5.6], [0.28, 5.7]];
    pub const COUPLING: [[f32; 2]; 10] = [[0.2, 5.6], [0.2, 5.9], [0.42, 5.9], [0.42, 6.06], [0.44, 6.06],
        [0.44, 6.14], [0.42, 6.14], [0.42, 6.3], [0.2, 6.3], [0.2, 6.6]];
    /// Low-pressure casing, then the high-pressure one.
    pub const TURBINE: [[f32; 2]; 19] = [[0.3, 6.5], [0.7, 6.55], [0.75, 6.9], [1.3, 7.2], [1.62, 7.6], [1.7, 8.2],
        [1.62, 8.8], [1.25, 9.3], [1.05, 9.5], [1.05, 9.8], [0.95, 10.0], [0.95, 10.9], [0.8, 11.1], [0.8, 11.7],
        [0.6, 11.9], [0.45, 12.0], [0.45, 12.4], [0.3, 12.5], [0.0, 12.5]];
}

/// Turbine and generator along -z in the frame `place`, whose origin is the middle of the near end on the floor.
pub fn turbine_set(place: Affine3A) -> Assembly {
    let mut set = Assembly::framed(place);
    set.add(CONCRETE, &beveled_box([-2.0, -0.1, -13.4], [2.0, 0.55, 0.2], 0.05));
    set.add(CONCRETE, &beveled_box([-1.5, 0.5, -13.0], [1.5, 0.95, -0.2], 0.04));
    // The axis of the machine: y of the lathe runs along -z.
    set.merge(shaft(place * standing_on([0.0, 2.15, 0.0], [0.0, 2.15, -1.0])));
    for x in [-1.0, 1.0] {
        // The horizontal joint of the casing, with bolts.
        for (near, far, reach) in [(7.5, 8.9, 1.68), (9.5, 11.0, 1.06), (11.1, 11.8, 0.86_f32)] {
            set.add(CASING, &block([x * reach - 0.13, 2.09, -far], [x * reach + 0.13, 2.21, -near]));
            let count = ((far - near) / 0.16) as usize;
            for k in 0..=count {
                let z = -near - 0.06 - 0.155 * k as f32;
                set.add(BARE, &bolt([x * (reach + 0.05), 2.21, z], Vec3::Y, 0.075));
            }
        }
    }
    pedestals(&mut set);
    set.place(&steam_and_oil(), Affine3A::IDENTITY);
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    for x in [-1.2, 1.2] {
        set.merge(valve(PIPES, RED, v(x, 5.0, -11.4), Vec3::Y, Vec3::Z, 0.16));
        set.merge(gauge(BARE, v(x, 3.4, -0.35 - 11.0), 0.0));
    }
    set.merge(joint(PIPES, v(0.0, 4.6, -9.3), Vec3::Z, 0.3));
    for k in 0..4 {
        set.merge(gauge(BARE, v(-0.45 + 0.3 * k as f32, 2.0, -0.5), 0.0));
    }
    set
}

/// Everything turned about the shaft, the y axis of `axis`: exciter, generator with its ribs, coupling, casings with
/// bolted bands where they are split across.
fn shaft(axis: Affine3A) -> Assembly {
    let mut shaft = Assembly::framed(axis);
    shaft.add(GLOSS, &lathe(&section::EXCITER, 32));
    shaft.add(GLOSS, &lathe(&section::GENERATOR, 48));
    for k in 0..16 {
        let y = 1.85 + 0.2 * k as f32;
        shaft.add(GLOSS, &ring(1.15, 1.26, y, y + 0.05, 40));
    }
    shaft.add(BARE, &lathe(&section::COUPLING, 28));
    shaft.add(CASING, &lathe(&section::TURBINE, 40));
    for (radius, y) in [(1.05, 9.65), (0.95, 10.5), (0.8, 11.4)] {
        shaft.add(CASING, &ring(radius - 0.02, radius + 0.14, y - 0.06, y + 0.06, 40));
        shaft.add_each(BARE, &bolt([radius + 0.07, y + 0.06, 0.0], Vec3::Y, 0.07), turns(28));
    }
    shaft
}

fn pedestals(set: &mut Assembly) {
    for (z, half, width) in [(-0.75, 0.3, 0.7), (-6.1, 0.45, 0.6), (-12.2, 0.35, 0.5)] {
        set.add(CASING, &beveled_box([-width, 0.9, z - half], [width, 2.0, z + half], 0.05));
    }
    // Generator feet along its whole length, with ribs.
    for x in [-1.05, 1.05] {
        set.add(GLOSS, &beveled_box([x - 0.35, 0.9, -5.3], [x + 0.35, 1.1, -1.6], 0.03));
        for k in 0..6 {
            let z = -1.8 - 0.65 * k as f32;
            set.add(GLOSS, &block([x - 0.12, 1.05, z - 0.03], [x + 0.12, 1.75, z + 0.03]));
        }
        for z in [-7.75, -8.65] {
            let (low, high) = ([1.1 * x - 0.35, 0.9, z - 0.15], [1.1 * x + 0.35, 2.0, z + 0.15]);
            set.add(CASING, &beveled_box(low, high, 0.03));
        }
    }
    // A cooler on top of the generator.
    set.add(GLOSS, &beveled_box([-0.7, 3.2, -4.9], [0.7, 3.75, -2.1], 0.06));
    for k in 0..20 {
        let z = -2.2 - 0.13 * k as f32;
        set.add(GLOSS, &block([-0.6, 3.7, z - 0.05], [0.6, 3.83, z]));
    }
}

/// Crossover over the top, live steam from the far end, and lubrication along the plinth.
fn steam_and_oil() -> Assembly {
    let mut pipes = Assembly::new();
    let v = Vec3::new;
    let crossover = [v(0.0, 3.7, -8.2), v(0.0, 4.6, -8.2), v(0.0, 4.6, -10.4), v(0.0, 3.0, -10.4)];
    pipes.merge(run(PIPES, &crossover, 0.3, 18));
    for side in [1.0, -1.0] {
        let x = 1.2 * side;
        let riser = [v(0.35 * side, 2.85, -11.4), v(x, 3.6, -11.4), v(x, 6.4, -11.4)];
        let away = [v(x, 6.4, -15.0), v(x, -0.1, -15.0)];
        pipes.merge(run(PIPES, &[&riser[..], &away].concat(), 0.16, 14));
    }
    for (x, r) in [(1.7, 0.05), (1.82, 0.035), (-1.7, 0.05)] {
        let oil = [v(x, 0.72, -0.5), v(x, 0.72, -12.8), v(x, 0.2, -12.8), v(x, 0.2, -14.6)];
        pipes.merge(run(PIPES, &oil, r, 10));
    }
    for z in [-1.5, -4.5, -7.0, -10.0] {
        pipes.merge(run(PIPES, &[v(1.7, 0.72, z), v(1.7, 1.5, z), v(0.9, 1.5, z)], 0.04, 10));
    }
    pipes
}
