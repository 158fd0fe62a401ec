//! A turbine with its generator on a common foundation.

use super::super::pipework::{gauge, joint, run, valve};
use super::super::steel::bolt;
use super::{Parts, profile};
use crate::shapes::Part;
use crate::shapes::{at, beveled_box, block, lathe, ring, standing_on, turned};
use glam::{Affine3A, Vec3};

/// Appends a turbine and its generator along -z from `foot`, the middle of the near end on the floor.
pub fn turbine_set(parts: &mut Parts, foot: Vec3) {
    let place = at(foot.x, foot.y, foot.z);
    parts
        .concrete
        .add_at(&beveled_box(Vec3::new(-2.0, -0.1, -13.4), Vec3::new(2.0, 0.55, 0.2), 0.05), &place);
    parts
        .concrete
        .add_at(&beveled_box(Vec3::new(-1.5, 0.5, -13.0), Vec3::new(1.5, 0.95, -0.2), 0.04), &place);
    // The axis of the machine: y of the lathe runs along -z.
    let axis = place * standing_on(Vec3::new(0.0, 2.15, 0.0), Vec3::new(0.0, 2.15, -1.0));
    // Exciter, generator with its ribs, coupling, low- and high-pressure casings.
    parts.gloss.add_at(
        &lathe(
            &profile(&[
                (0.0, 0.1),
                (0.25, 0.1),
                (0.55, 0.25),
                (0.62, 0.4),
                (0.62, 1.1),
                (0.55, 1.2),
                (0.3, 1.3),
            ]),
            32,
        ),
        &axis,
    );
    parts.gloss.add_at(
        &lathe(
            &profile(&[
                (0.3, 1.3),
                (0.5, 1.35),
                (1.0, 1.4),
                (1.15, 1.5),
                (1.18, 1.7),
                (1.18, 5.2),
                (1.15, 5.4),
                (1.0, 5.5),
                (0.5, 5.6),
                (0.28, 5.7),
            ]),
            48,
        ),
        &axis,
    );
    for k in 0..16 {
        let y = 1.85 + 0.2 * k as f32;
        parts.gloss.add_at(&ring(1.15, 1.26, y, y + 0.05, 40), &axis);
    }
    parts.bare.add_at(
        &lathe(
            &profile(&[
                (0.2, 5.6),
                (0.2, 5.9),
                (0.42, 5.9),
                (0.42, 6.06),
                (0.44, 6.06),
                (0.44, 6.14),
                (0.42, 6.14),
                (0.42, 6.3),
                (0.2, 6.3),
                (0.2, 6.6),
            ]),
            28,
        ),
        &axis,
    );
    let casing = [
        (0.3, 6.5),
        (0.7, 6.55),
        (0.75, 6.9),
        (1.3, 7.2),
        (1.62, 7.6),
        (1.7, 8.2),
        (1.62, 8.8),
        (1.25, 9.3),
        (1.05, 9.5),
        (1.05, 9.8),
        (0.95, 10.0),
        (0.95, 10.9),
        (0.8, 11.1),
        (0.8, 11.7),
        (0.6, 11.9),
        (0.45, 12.0),
        (0.45, 12.4),
        (0.3, 12.5),
        (0.0, 12.5),
    ];
    parts.casing.add_at(&lathe(&profile(&casing), 40), &axis);
    // Bands with bolts where the casing is split across, and the horizontal joint.
    for (radius, y) in [(1.05, 9.65), (0.95, 10.5), (0.8, 11.4)] {
        parts.casing.add_at(&ring(radius - 0.02, radius + 0.14, y - 0.06, y + 0.06, 40), &axis);
        for k in 0..28 {
            let turn = turned(360.0 / 28.0 * k as f32, Vec3::ZERO);
            let head = bolt(Vec3::new(radius + 0.07, y + 0.06, 0.0), Vec3::Y, 0.07);
            parts.bare.add_at(&head, &(axis * turn));
        }
    }
    for x in [-1.0, 1.0] {
        let lip = |near: f32, far: f32, reach: f32| {
            block(Vec3::new(x * reach - 0.13, 2.09, -far), Vec3::new(x * reach + 0.13, 2.21, -near))
        };
        for (near, far, reach) in [(7.5, 8.9, 1.68), (9.5, 11.0, 1.06), (11.1, 11.8, 0.86)] {
            parts.casing.add_at(&lip(near, far, reach), &place);
            let count = ((far - near) / 0.16) as usize;
            for k in 0..=count {
                let z = -near - 0.06 - 0.155 * k as f32;
                parts.bare.add_at(&bolt(Vec3::new(x * (reach + 0.05), 2.21, z), Vec3::Y, 0.075), &place);
            }
        }
    }
    pedestals(parts, &place);
    turbine_pipes(parts, &place);
}

fn pedestals(parts: &mut Parts, place: &Affine3A) {
    for (z, half, width) in [(-0.75, 0.3, 0.7), (-6.1, 0.45, 0.6), (-12.2, 0.35, 0.5)] {
        let body = beveled_box(Vec3::new(-width, 0.9, z - half), Vec3::new(width, 2.0, z + half), 0.05);
        parts.casing.add_at(&body, place);
    }
    // Generator feet along its whole length, with ribs.
    for x in [-1.05, 1.05] {
        parts.gloss.add_at(
            &beveled_box(Vec3::new(x - 0.35, 0.9, -5.3), Vec3::new(x + 0.35, 1.1, -1.6), 0.03),
            place,
        );
        for k in 0..6 {
            let z = -1.8 - 0.65 * k as f32;
            parts.gloss.add_at(
                &block(Vec3::new(x - 0.12, 1.05, z - 0.03), Vec3::new(x + 0.12, 1.75, z + 0.03)),
                place,
            );
        }
        for z in [-7.75, -8.65] {
            parts.casing.add_at(
                &beveled_box(
                    Vec3::new(1.1 * x - 0.35, 0.9, z - 0.15),
                    Vec3::new(1.1 * x + 0.35, 2.0, z + 0.15),
                    0.03,
                ),
                place,
            );
        }
    }
    // A cooler on top of the generator.
    parts.gloss.add_at(&beveled_box(Vec3::new(-0.7, 3.2, -4.9), Vec3::new(0.7, 3.75, -2.1), 0.06), place);
    for k in 0..20 {
        let z = -2.2 - 0.13 * k as f32;
        parts.gloss.add_at(&block(Vec3::new(-0.6, 3.7, z - 0.05), Vec3::new(0.6, 3.83, z)), place);
    }
}

fn turbine_pipes(parts: &mut Parts, place: &Affine3A) {
    let mut pipes = Part::default();
    let v = Vec3::new;
    // The crossover over the top, live steam from the west, and lubrication along the plinth.
    run(&mut pipes, &[v(0.0, 3.7, -8.2), v(0.0, 4.6, -8.2), v(0.0, 4.6, -10.4), v(0.0, 3.0, -10.4)], 0.3, 18);
    run(
        &mut pipes,
        &[
            v(0.35, 2.85, -11.4),
            v(1.2, 3.6, -11.4),
            v(1.2, 6.4, -11.4),
            v(1.2, 6.4, -15.0),
            v(1.2, -0.1, -15.0),
        ],
        0.16,
        14,
    );
    run(
        &mut pipes,
        &[
            v(-0.35, 2.85, -11.4),
            v(-1.2, 3.6, -11.4),
            v(-1.2, 6.4, -11.4),
            v(-1.2, 6.4, -15.0),
            v(-1.2, -0.1, -15.0),
        ],
        0.16,
        14,
    );
    for (x, r) in [(1.7, 0.05), (1.82, 0.035), (-1.7, 0.05)] {
        run(&mut pipes, &[v(x, 0.72, -0.5), v(x, 0.72, -12.8), v(x, 0.2, -12.8), v(x, 0.2, -14.6)], r, 10);
    }
    for z in [-1.5, -4.5, -7.0, -10.0] {
        run(&mut pipes, &[v(1.7, 0.72, z), v(1.7, 1.5, z), v(0.9, 1.5, z)], 0.04, 10);
    }
    parts.pipes.append(&pipes, place);
    let world = |p: Vec3| place.transform_point3(p);
    for x in [-1.2, 1.2] {
        valve(&mut parts.pipes, &mut parts.red, world(v(x, 5.0, -11.4)), Vec3::Y, Vec3::Z, 0.16);
        gauge(&mut parts.bare, world(v(x, 3.4, -0.35 - 11.0)), 0.0);
    }
    joint(&mut parts.pipes, world(v(0.0, 4.6, -9.3)), Vec3::Z, 0.3);
    for k in 0..4 {
        gauge(&mut parts.bare, world(v(-0.45 + 0.3 * k as f32, 2.0, -0.5)), 0.0);
    }
}
