//! What stands about: steel drums, crates on pallets, gas cylinders, a cable drum, work benches.

use crate::shapes::Part;
use crate::shapes::{Rng, at, beveled_box, block, cylinder, lathe, ring, rod, standing_on, torus, turned};
use glam::{Affine3A, Vec2, Vec3};

/// What stores are made of.
#[derive(Default)]
pub struct Parts {
    /// Crates, pallets, drum flanges.
    pub timber: Part,
    /// Drums of one colour.
    pub drums_blue: Part,
    /// Drums of another.
    pub drums_rust: Part,
    /// Gas cylinders.
    pub cylinders: Part,
    /// Benches, vices, racks.
    pub steel: Part,
    /// Cable on the drum.
    pub cable: Part,
}

/// Appends all stores.
pub fn build(parts: &mut Parts) {
    let mut rng = Rng::new(17);
    drums(parts, &mut rng);
    for (x, z, size, degrees) in [
        (4.5, -6.5, 1.1, 8.0),
        (5.9, -5.9, 0.9, -5.0),
        (4.1, -8.2, 0.85, 15.0),
        (-1.9, -7.7, 1.0, -12.0),
        (4.9, -26.5, 1.2, 4.0),
        (6.4, -26.8, 1.0, -9.0),
        (5.6, -28.1, 1.1, 20.0),
    ] {
        let place = turned(degrees, Vec3::new(x, 0.13, z));
        pallet(parts, &turned(degrees, Vec3::new(x, -0.005, z)));
        crate_box(&mut parts.timber, &place, Vec3::new(size, 0.8 * size, 0.9 * size));
    }
    crate_box(&mut parts.timber, &turned(24.0, Vec3::new(4.55, 1.015, -6.5)), Vec3::new(0.7, 0.55, 0.6));
    for k in 0..6 {
        gas_cylinder(parts, &at(-9.0 + 0.3 * k as f32, -0.005, -0.75));
    }
    parts.steel.add(&rod(Vec3::new(-9.3, 1.0, -0.55), Vec3::new(-7.2, 1.0, -0.55), 0.02, 8));
    cable_drum(parts, &turned(25.0, Vec3::new(4.9, 0.0, -10.6)));
    bench(parts, &at(6.6, 0.0, -1.9));
    bench(parts, &(at(-8.0, 0.0, -14.2) * turned(90.0, Vec3::ZERO)));
}

fn drums(parts: &mut Parts, rng: &mut Rng) {
    let profile: Vec<Vec2> = [
        (0.0, 0.03),
        (0.26, 0.03),
        (0.28, 0.0),
        (0.293, 0.02),
        (0.285, 0.27),
        (0.3, 0.3),
        (0.285, 0.33),
        (0.285, 0.57),
        (0.3, 0.6),
        (0.285, 0.63),
        (0.293, 0.86),
        (0.28, 0.88),
        (0.27, 0.85),
        (0.0, 0.85),
    ]
    .map(|(x, y)| Vec2::new(x, y))
    .to_vec();
    let mut drum = Part::default();
    drum.add(&lathe(&profile, 14));
    drum.add_at(&cylinder(0.035, 0.03, 10), &at(0.18, 0.845, 0.0));
    drum.add_at(&cylinder(0.02, 0.03, 10), &at(-0.18, 0.845, 0.05));
    let groups = [(6.7, -7.2, 3, 3), (9.6, -25.6, 3, 4), (-5.2, -33.0, 4, 3)];
    for (x0, z0, across, deep) in groups {
        for i in 0..across {
            for j in 0..deep {
                let x = x0 + 0.64 * i as f32 + rng.jitter(0.02);
                let z = z0 - 0.64 * j as f32 + rng.jitter(0.02);
                let part = if rng.unit() < 0.6 { &mut parts.drums_blue } else { &mut parts.drums_rust };
                part.append(&drum, &turned(rng.range(0.0, 360.0), Vec3::new(x, -0.004, z)));
            }
        }
    }
    for (x, z) in [(7.02, -7.5), (7.66, -7.5)] {
        parts.drums_rust.append(&drum, &turned(rng.range(0.0, 360.0), Vec3::new(x, 0.872, z)));
    }
    let lying = turned(35.0, Vec3::new(-1.5, 0.298, -5.9)) * standing_on(Vec3::ZERO, Vec3::X);
    parts.drums_blue.append(&drum, &lying);
}

fn pallet(parts: &mut Parts, place: &Affine3A) {
    for k in 0..7 {
        let x = -0.6 + 0.2 * k as f32;
        parts.timber.add_at(&block(Vec3::new(x - 0.07, 0.115, -0.5), Vec3::new(x + 0.07, 0.14, 0.5)), place);
    }
    for z in [-0.42, 0.0, 0.42] {
        parts
            .timber
            .add_at(&block(Vec3::new(-0.66, 0.09, z - 0.06), Vec3::new(0.66, 0.117, z + 0.06)), place);
        for x in [-0.58, 0.0, 0.58] {
            parts.timber.add_at(
                &block(Vec3::new(x - 0.07, 0.0, z - 0.055), Vec3::new(x + 0.07, 0.092, z + 0.055)),
                place,
            );
        }
    }
}

/// A crate of planks on battens, its bottom at y = 0 of `place`.
fn crate_box(timber: &mut Part, place: &Affine3A, size: Vec3) {
    let h = 0.5 * size;
    timber.add_at(
        &block(Vec3::new(0.02 - h.x, 0.012, 0.02 - h.z), Vec3::new(h.x - 0.02, size.y - 0.02, h.z - 0.02)),
        place,
    );
    let planks = 6;
    let pitch = size.y / planks as f32;
    for k in 0..planks {
        let (low, high) = (pitch * k as f32 + 0.004, pitch * (k + 1) as f32 - 0.004);
        for z in [-1.0, 1.0] {
            let (a, b) = (z * h.z, z * (h.z - 0.025));
            timber.add_at(&block(Vec3::new(-h.x, low, a.min(b)), Vec3::new(h.x, high, a.max(b))), place);
        }
        for x in [-1.0, 1.0] {
            let (a, b) = (x * h.x, x * (h.x - 0.025));
            timber.add_at(
                &block(
                    Vec3::new(a.min(b) + 0.001 * x, low, 0.03 - h.z),
                    Vec3::new(a.max(b) + 0.001 * x, high, h.z - 0.03),
                ),
                place,
            );
        }
    }
    for k in 0..5 {
        let x = -h.x + size.x * (k as f32 + 0.5) / 5.0;
        let half = 0.1 * size.x - 0.004;
        timber.add_at(
            &block(Vec3::new(x - half, size.y - 0.022, -h.z), Vec3::new(x + half, size.y + 0.003, h.z)),
            place,
        );
    }
    for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
        let corner = Vec3::new(x * (h.x - 0.04), 0.005, z * (h.z + 0.004));
        timber.add_at(
            &beveled_box(
                corner - Vec3::new(0.05, 0.0, 0.015),
                corner + Vec3::new(0.05, size.y - 0.004, 0.015),
                0.006,
            ),
            place,
        );
    }
    for z in [-1.0, 1.0] {
        let tilt = Affine3A::from_rotation_z((size.y / size.x).atan() * z);
        let brace = *place * at(0.0, 0.5 * size.y, z * (h.z + 0.01)) * tilt;
        let half = 0.5 * Vec2::new(size.x, size.y).length() - 0.14;
        timber.add_at(&block(Vec3::new(-half, -0.045, -0.011), Vec3::new(half, 0.045, 0.011)), &brace);
    }
}

fn gas_cylinder(parts: &mut Parts, place: &Affine3A) {
    let profile: Vec<Vec2> = [
        (0.0, 0.0),
        (0.11, 0.0),
        (0.115, 0.02),
        (0.115, 1.25),
        (0.105, 1.34),
        (0.07, 1.41),
        (0.035, 1.45),
        (0.035, 1.5),
        (0.05, 1.5),
        (0.05, 1.62),
        (0.03, 1.66),
        (0.0, 1.66),
    ]
    .map(|(x, y)| Vec2::new(x, y))
    .to_vec();
    parts.cylinders.add_at(&lathe(&profile, 18), place);
}

fn cable_drum(parts: &mut Parts, place: &Affine3A) {
    let radius = 0.85;
    let axis = *place * standing_on(Vec3::new(-0.5, radius, 0.0), Vec3::new(1.0, radius, 0.0));
    for y in [0.0, 0.94] {
        parts.timber.add_at(&ring(0.06, radius, y, y + 0.06, 36), &axis);
        let face = if y == 0.0 { -0.025 } else { 1.0 };
        for k in 0..8 {
            let plank = block(Vec3::new(0.12, face, -0.06), Vec3::new(radius - 0.05, face + 0.025, 0.06));
            parts.timber.add_at(&plank, &(axis * turned(45.0 * k as f32, Vec3::ZERO)));
        }
    }
    for k in 0..14 {
        let y = 0.09 + 0.063 * k as f32;
        parts.cable.add_at(&torus(0.55, 0.034, 24, 5), &(axis * at(0.0, y, 0.0)));
    }
}

/// A bench along x with a vice and a shelf.
fn bench(parts: &mut Parts, place: &Affine3A) {
    parts.timber.add_at(&beveled_box(Vec3::new(-1.1, 0.86, -0.4), Vec3::new(1.1, 0.93, 0.4), 0.01), place);
    for x in [-1.0, 1.0] {
        for z in [-0.33, 0.33] {
            parts.steel.add_at(
                &block(Vec3::new(x - 0.03, -0.01, z - 0.03), Vec3::new(x + 0.03, 0.87, z + 0.03)),
                place,
            );
        }
    }
    parts.steel.add_at(&block(Vec3::new(-1.02, 0.25, -0.36), Vec3::new(1.02, 0.28, 0.36)), place);
    parts
        .steel
        .add_at(&beveled_box(Vec3::new(-0.95, 0.27, -0.25), Vec3::new(-0.45, 0.55, 0.25), 0.02), place);
    // The vice.
    parts.steel.add_at(&cylinder(0.1, 0.1, 14), &(*place * at(0.7, 0.925, 0.2)));
    parts.steel.add_at(&beveled_box(Vec3::new(0.6, 1.01, 0.05), Vec3::new(0.8, 1.17, 0.25), 0.02), place);
    parts.steel.add_at(&beveled_box(Vec3::new(0.6, 1.05, 0.3), Vec3::new(0.8, 1.18, 0.38), 0.015), place);
    parts.steel.add_at(&rod(Vec3::new(0.7, 1.08, 0.0), Vec3::new(0.7, 1.08, 0.52), 0.02, 8), place);
    parts.steel.add_at(&rod(Vec3::new(0.58, 1.08, 0.5), Vec3::new(0.82, 1.08, 0.5), 0.01, 6), place);
}
