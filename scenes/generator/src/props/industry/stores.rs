//! Stores: steel drums, crates and pallets, gas cylinders, a cable drum, work benches.

use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

const TIMBER: &str = "timber";
const STEEL: &str = "bench_steel";

#[rustfmt::skip]
mod section {
    pub const DRUM: [[f32; 2]; 14] = [[0.0, 0.03], [0.26, 0.03], [0.28, 0.0], [0.293, 0.02], [0.285, 0.27], [0.3, 0.3],
        [0.285, 0.33], [0.285, 0.57], [0.3, 0.6], [0.285, 0.63], [0.293, 0.86], [0.28, 0.88], [0.27, 0.85],
        [0.0, 0.85]];
    pub const GAS_CYLINDER: [[f32; 2]; 12] = [[0.0, 0.0], [0.11, 0.0], [0.115, 0.02], [0.115, 1.25], [0.105, 1.34],
        [0.07, 1.41], [0.035, 1.45], [0.035, 1.5], [0.05, 1.5], [0.05, 1.62], [0.03, 1.66], [0.0, 1.66]];
}

/// Steel drum with its bungs, 0.88 m high: one part.
pub fn drum(part: &str) -> Assembly {
    let mut drum = Assembly::new();
    drum.add(part, &lathe(&section::DRUM, 14));
    drum.add_at(part, &cylinder(0.035, 0.03, 10), at(0.18, 0.845, 0.0));
    drum.add_at(part, &cylinder(0.02, 0.03, 10), at(-0.18, 0.845, 0.05));
    drum
}

/// Pallet in the frame `place`: part "timber".
pub fn pallet(place: Affine3A) -> Assembly {
    let mut pallet = Assembly::framed(place);
    for k in 0..7 {
        let x = -0.6 + 0.2 * k as f32;
        pallet.add(TIMBER, &block([x - 0.07, 0.115, -0.5], [x + 0.07, 0.14, 0.5]));
    }
    for z in [-0.42, 0.0, 0.42] {
        pallet.add(TIMBER, &block([-0.66, 0.09, z - 0.06], [0.66, 0.117, z + 0.06]));
        for x in [-0.58, 0.0, 0.58] {
            pallet.add(TIMBER, &block([x - 0.07, 0.0, z - 0.055], [x + 0.07, 0.092, z + 0.055]));
        }
    }
    pallet
}

/// Crate of planks on battens, its bottom at y = 0 of `place`: part "timber".
pub fn crate_box(place: Affine3A, size: Vec3) -> Assembly {
    let mut crate_box = Assembly::framed(place);
    let mut add = |shell: &Shell| crate_box.add(TIMBER, shell);
    let h = 0.5 * size;
    add(&block([0.02 - h.x, 0.012, 0.02 - h.z], [h.x - 0.02, size.y - 0.02, h.z - 0.02]));
    let planks = 6;
    let pitch = size.y / planks as f32;
    for k in 0..planks {
        let (low, high) = (pitch * k as f32 + 0.004, pitch * (k + 1) as f32 - 0.004);
        for z in [-1.0, 1.0] {
            let (a, b) = (z * h.z, z * (h.z - 0.025));
            add(&block([-h.x, low, a.min(b)], [h.x, high, a.max(b)]));
        }
        for x in [-1.0, 1.0] {
            let (a, b) = (x * h.x, x * (h.x - 0.025));
            let (left, right) = (a.min(b) + 0.001 * x, a.max(b) + 0.001 * x);
            add(&block([left, low, 0.03 - h.z], [right, high, h.z - 0.03]));
        }
    }
    for k in 0..5 {
        let x = -h.x + size.x * (k as f32 + 0.5) / 5.0;
        let half = 0.1 * size.x - 0.004;
        add(&block([x - half, size.y - 0.022, -h.z], [x + half, size.y + 0.003, h.z]));
    }
    for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
        let corner = Vec3::new(x * (h.x - 0.04), 0.005, z * (h.z + 0.004));
        let (low, high) = (Vec3::new(0.05, 0.0, 0.015), Vec3::new(0.05, size.y - 0.004, 0.015));
        add(&beveled_box(corner - low, corner + high, 0.006));
    }
    let half = 0.5 * Vec2::new(size.x, size.y).length() - 0.14;
    for z in [-1.0, 1.0] {
        let tilt = Affine3A::from_rotation_z((size.y / size.x).atan() * z);
        let brace = block([-half, -0.045, -0.011], [half, 0.045, 0.011]);
        crate_box.add_at(TIMBER, &brace, at(0.0, 0.5 * size.y, z * (h.z + 0.01)) * tilt);
    }
    crate_box
}

/// Gas cylinder, 1.66 m high.
pub fn gas_cylinder() -> Shell {
    lathe(&section::GAS_CYLINDER, 18)
}

/// Cable drum on its rims in the frame `place`, its axis along x: parts "timber" and "drum_cable".
pub fn cable_drum(place: Affine3A) -> Assembly {
    let radius = 0.85;
    let mut drum = Assembly::framed(place * standing_on([-0.5, radius, 0.0], [1.0, radius, 0.0]));
    for (y, face) in [(0.0, -0.025), (0.94, 1.0)] {
        drum.add(TIMBER, &ring(0.06, radius, y, y + 0.06, 36));
        let plank = block([0.12, face, -0.06], [radius - 0.05, face + 0.025, 0.06]);
        drum.add_each(TIMBER, &plank, turns(8));
    }
    let coils = (0..14).map(|k| at(0.0, 0.09 + 0.063 * k as f32, 0.0));
    drum.add_each("drum_cable", &torus(0.55, 0.034, 24, 5), coils);
    drum
}

/// Bench along x with a vice and a shelf in the frame `place`: parts "timber" and "bench_steel".
pub fn bench(place: Affine3A) -> Assembly {
    let mut bench = Assembly::framed(place);
    bench.add(TIMBER, &beveled_box([-1.1, 0.86, -0.4], [1.1, 0.93, 0.4], 0.01));
    for x in [-1.0, 1.0] {
        for z in [-0.33, 0.33] {
            bench.add(STEEL, &block([x - 0.03, -0.01, z - 0.03], [x + 0.03, 0.87, z + 0.03]));
        }
    }
    bench.add(STEEL, &block([-1.02, 0.25, -0.36], [1.02, 0.28, 0.36]));
    bench.add(STEEL, &beveled_box([-0.95, 0.27, -0.25], [-0.45, 0.55, 0.25], 0.02));
    // The vice.
    bench.add_at(STEEL, &cylinder(0.1, 0.1, 14), at(0.7, 0.925, 0.2));
    bench.add(STEEL, &beveled_box([0.6, 1.01, 0.05], [0.8, 1.17, 0.25], 0.02));
    bench.add(STEEL, &beveled_box([0.6, 1.05, 0.3], [0.8, 1.18, 0.38], 0.015));
    bench.add(STEEL, &rod([0.7, 1.08, 0.0], [0.7, 1.08, 0.52], 0.02, 8));
    bench.add(STEEL, &rod([0.58, 1.08, 0.5], [0.82, 1.08, 0.5], 0.01, 6));
    bench
}
