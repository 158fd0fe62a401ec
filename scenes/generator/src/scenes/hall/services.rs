//! What runs along the walls: a rack of pipes, a ventilation duct with outlets, cable trays and cabinets.

use super::pipework::{flange, hanger, joint, valve};
use super::plan::{BAY, BAYS, COLUMN, END, line_z};
use super::steel::{bar, i_section};
use crate::shapes::Part;
use crate::shapes::{Rng, at, beveled_box, block, fillet, lathe, pipe, rod, standing_on};
use glam::{Vec2, Vec3};

/// What services are made of.
#[derive(Default)]
pub struct Parts {
    /// Painted or lagged pipes.
    pub pipes: Part,
    /// Copper or bright pipes.
    pub bright: Part,
    /// Galvanised duct.
    pub duct: Part,
    /// Brackets and trays.
    pub brackets: Part,
    /// Cables.
    pub cables: Part,
    /// Electrical cabinets.
    pub cabinets: Part,
    /// Handwheels.
    pub red: Part,
}

/// Appends all services.
pub fn build(parts: &mut Parts) {
    rack(parts);
    duct(parts);
    cables(parts);
    for (k, z) in [-3.2, -4.25, -5.3, -6.35].into_iter().enumerate() {
        cabinet(parts, Vec3::new(11.42, -0.01, z), k);
    }
}

/// Pipes along the east wall on brackets from the columns, with drops to the floor.
fn rack(parts: &mut Parts) {
    let beam = i_section(0.14, 0.1, 0.01, 0.007);
    for line in 1..BAYS {
        for y in [3.4, 4.6] {
            let z = line_z(line) + 0.24;
            parts.brackets.add(&bar(&beam, Vec3::new(11.7, y, z), Vec3::new(9.9, y, z), Vec3::Y));
            parts.brackets.add(&rod(Vec3::new(10.1, y - 0.05, z), Vec3::new(11.3, y - 0.9, z), 0.025, 6));
        }
    }
    let rack = [
        (10.15, 3.4, 0.1),
        (10.45, 3.4, 0.08),
        (10.75, 3.4, 0.12),
        (10.2, 4.6, 0.16),
        (10.65, 4.6, 0.13),
        (10.95, 4.6, 0.06),
    ];
    for (k, (x, y, r)) in rack.into_iter().enumerate() {
        let y = y + 0.07 + r;
        let (near, far) = (-2.6 - 0.35 * k as f32, END + 1.4 + 0.3 * k as f32);
        let path = [
            Vec3::new(x, -0.05, near),
            Vec3::new(x, y, near),
            Vec3::new(x, y, far),
            Vec3::new(x, -0.05, far),
        ];
        let part = if k % 3 == 1 { &mut parts.bright } else { &mut parts.pipes };
        part.add(&pipe(&fillet(&path, 3.0 * r, 18.0), r, 12));
        for bay in [2, 5] {
            joint(part, Vec3::new(x, y, line_z(bay) - 1.3 - 0.25 * k as f32), Vec3::Z, r);
        }
        flange(part, Vec3::new(x, 0.02, near), Vec3::Y, r);
        valve(
            part,
            &mut parts.red,
            Vec3::new(x, 1.15 + 0.12 * (k % 2) as f32, near),
            Vec3::Y,
            Vec3::new(-0.4, 0.0, 1.0).normalize(),
            r,
        );
        // A drop in some bays, with a valve at hand height.
        for bay in [2, 4, 6] {
            let z = line_z(bay) - 1.0 - 0.5 * k as f32;
            let drop = [Vec3::new(x, y, z), Vec3::new(x - 0.55, y, z), Vec3::new(x - 0.55, -0.05, z)];
            if (bay + k) % 3 == 0 {
                part.add(&pipe(&fillet(&drop, 0.2, 18.0), 0.6 * r, 14));
                valve(part, &mut parts.red, Vec3::new(x - 0.55, 1.3, z), Vec3::Y, Vec3::NEG_X, 0.6 * r);
            }
        }
    }
}

/// A round duct under the crane girder of the west side, with seams, elbows and outlets.
fn duct(parts: &mut Parts) {
    let (x, y, r) = (-9.6, 5.9, 0.42);
    let (near, far) = (-1.5, END + 2.2);
    let path =
        [Vec3::new(x - 1.7, y, near), Vec3::new(x, y, near), Vec3::new(x, y, far), Vec3::new(x, 9.2, far)];
    parts.duct.add(&pipe(&fillet(&path, 0.9, 12.0), r, 24));
    let seam = [(r - 0.01, -0.03), (r + 0.02, -0.012), (r + 0.02, 0.012), (r - 0.01, 0.03)];
    let seam = lathe(&seam.map(|(x, y)| Vec2::new(x, y)), 24);
    let mut z = near - 1.1;
    while z > far + 1.2 {
        parts.duct.add_at(&seam, &standing_on(Vec3::new(x, y, z), Vec3::new(x, y, z - 1.0)));
        z -= 1.1;
    }
    for bay in 0..BAYS {
        let z = line_z(bay) - 0.5 * BAY;
        hanger(&mut parts.brackets, Vec3::new(x, y, z), Vec3::Z, r, 9.5);
        let outlet: Vec<Vec2> =
            [(0.16, 0.0), (0.16, 0.3), (0.3, 0.5), (0.31, 0.5), (0.17, 0.29), (0.15, 0.0)]
                .map(|(x, y)| Vec2::new(x, y))
                .to_vec();
        let down = Vec3::new(0.8, -0.6, 0.0);
        let foot = Vec3::new(x, y, z + 0.9) + down * (r - 0.06);
        parts.duct.add_at(&lathe(&outlet, 20), &standing_on(foot, foot + down));
    }
}

/// A tray along the east columns with a bundle of cables that sag a little between its rungs.
fn cables(parts: &mut Parts) {
    let (x, y) = (COLUMN - 0.75, 5.9);
    for side in [-0.2, 0.2] {
        let low = Vec3::new(x + side - 0.008, y, END + 0.5);
        parts.brackets.add(&block(low, Vec3::new(x + side + 0.008, y + 0.1, -0.6)));
    }
    for k in 0..130 {
        let z = -0.8 - 0.3 * k as f32;
        parts
            .brackets
            .add(&block(Vec3::new(x - 0.195, y + 0.01, z - 0.02), Vec3::new(x + 0.195, y + 0.03, z + 0.02)));
    }
    for line in 0..=BAYS {
        let z = line_z(line).clamp(END + 0.6, -0.7);
        parts
            .brackets
            .add(&block(Vec3::new(x - 0.3, y - 0.07, z - 0.04), Vec3::new(COLUMN, y + 0.005, z + 0.04)));
    }
    let mut rng = Rng::new(5);
    for k in 0..6 {
        let offset = -0.15 + 0.06 * k as f32;
        let radius = rng.range(0.016, 0.027);
        let path: Vec<Vec3> = (0..44)
            .map(|j| {
                Vec3::new(
                    x + offset + rng.jitter(0.008),
                    y + 0.03 + radius + rng.range(0.0, 0.01),
                    -0.7 - 0.9 * j as f32,
                )
            })
            .collect();
        parts.cables.add(&pipe(&path, radius, 6));
    }
}

/// A control cabinet against the wall, its doors towards -x.
fn cabinet(parts: &mut Parts, foot: Vec3, variant: usize) {
    let place = at(foot.x, foot.y, foot.z);
    parts.cabinets.add_at(&beveled_box(Vec3::new(-0.5, 0.1, -0.5), Vec3::new(0.1, 2.05, 0.5), 0.015), &place);
    parts.brackets.add_at(&block(Vec3::new(-0.47, 0.0, -0.48), Vec3::new(0.1, 0.11, 0.48)), &place);
    for (low, high) in [(-0.48, -0.005), (0.005, 0.48)] {
        let door = beveled_box(Vec3::new(-0.525, 0.16, low), Vec3::new(-0.49, 2.0, high), 0.01);
        parts.cabinets.add_at(&door, &place);
        for k in 0..6 {
            let y = 0.3 + 0.05 * k as f32;
            parts.brackets.add_at(
                &block(Vec3::new(-0.532, y, low + 0.1), Vec3::new(-0.52, y + 0.02, high - 0.1)),
                &place,
            );
        }
    }
    parts.brackets.add_at(&block(Vec3::new(-0.56, 1.0, -0.06), Vec3::new(-0.52, 1.18, -0.035)), &place);
    let dial: Vec<Vec2> = [(0.0, 0.0), (0.06, 0.0), (0.065, 0.02), (0.05, 0.03), (0.0, 0.026)]
        .map(|(x, y)| Vec2::new(x, y))
        .to_vec();
    for k in 0..3 + variant % 2 {
        let centre = Vec3::new(-0.52, 1.72, -0.36 + 0.19 * k as f32);
        parts.brackets.add_at(&lathe(&dial, 14), &(place * standing_on(centre, centre - Vec3::X)));
    }
    // A conduit up to the tray.
    parts.brackets.add_at(&rod(Vec3::new(-0.2, 2.0, 0.0), Vec3::new(-0.2, 5.92, 0.0), 0.03, 8), &place);
}
