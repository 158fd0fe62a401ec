//! Positions of drums, crates, gas cylinders, a cable drum and work benches.

use crate::props::industry::{bench, cable_drum, crate_box, drum, gas_cylinder, pallet};
use crate::shapes::*;
use glam::Vec3;

/// x, z, size and turn of crates on pallets.
#[rustfmt::skip]
const CRATES: [[f32; 4]; 7] = [[4.5, -6.5, 1.1, 8.0], [5.9, -5.9, 0.9, -5.0], [4.1, -8.2, 0.85, 15.0],
    [-1.9, -7.7, 1.0, -12.0], [4.9, -26.5, 1.2, 4.0], [6.4, -26.8, 1.0, -9.0], [5.6, -28.1, 1.1, 20.0]];

pub fn add(scene: &mut Assembly) {
    drums(scene);
    for [x, z, size, degrees] in CRATES {
        scene.merge(pallet(turned(degrees, [x, -0.005, z])));
        scene.merge(crate_box(turned(degrees, [x, 0.13, z]), Vec3::new(size, 0.8 * size, 0.9 * size)));
    }
    scene.merge(crate_box(turned(24.0, [4.55, 1.015, -6.5]), Vec3::new(0.7, 0.55, 0.6)));
    let row = (0..6).map(|k| at(-9.0 + 0.3 * k as f32, -0.005, -0.75));
    scene.add_each("gas_cylinders", &gas_cylinder(), row);
    scene.add("bench_steel", &rod([-9.3, 1.0, -0.55], [-7.2, 1.0, -0.55], 0.02, 8));
    scene.merge(cable_drum(turned(25.0, [4.9, 0.0, -10.6])));
    scene.merge(bench(at(6.6, 0.0, -1.9)));
    scene.merge(bench(at(-8.0, 0.0, -14.2) * turned(90.0, Vec3::ZERO)));
}

/// Three groups of standing drums, two drums on top of one, and a lying one.
fn drums(scene: &mut Assembly) {
    let mut rng = Rng::new(17);
    let [blue, rust] = ["drums_blue", "drums_rust"].map(drum);
    for (x0, z0, across, deep) in [(6.7, -7.2, 3, 3), (9.6, -25.6, 3, 4), (-5.2, -33.0, 4, 3)] {
        for i in 0..across {
            for j in 0..deep {
                let x = x0 + 0.64 * i as f32 + rng.jitter(0.02);
                let z = z0 - 0.64 * j as f32 + rng.jitter(0.02);
                let drum = if rng.unit() < 0.6 { &blue } else { &rust };
                scene.place(drum, turned(rng.range(0.0, 360.0), [x, -0.004, z]));
            }
        }
    }
    for x in [7.02, 7.66] {
        scene.place(&rust, turned(rng.range(0.0, 360.0), [x, 0.872, -7.5]));
    }
    scene.place(&blue, turned(35.0, [-1.5, 0.298, -5.9]) * standing_on(Vec3::ZERO, Vec3::X));
}
