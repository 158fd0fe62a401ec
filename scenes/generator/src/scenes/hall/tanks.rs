//! Vessels: standing tanks with dished heads on legs, a lying tank on saddles, with manholes and pipes.

use super::access::ladder;
use super::pipework::{flange, gauge, run, valve};
use super::steel::bolt;
use crate::shapes::Part;
use crate::shapes::{at, beveled_box, block, extrude, lathe, mirror_z, ring, rod, standing_on, turned};
use glam::{Affine3A, Vec2, Vec3};

/// What vessels are made of.
#[derive(Default)]
pub struct Parts {
    /// Polished shells.
    pub shells: Part,
    /// Legs, saddles, ladders.
    pub frames: Part,
    /// Pipes.
    pub pipes: Part,
    /// Handwheels.
    pub red: Part,
}

/// A dished head of `radius`, as profile points from the rim (at 0) to the crown, `rise` high.
fn head(radius: f32, rise: f32, steps: usize) -> Vec<Vec2> {
    (0..=steps)
        .map(|k| {
            let t = std::f32::consts::FRAC_PI_2 * k as f32 / steps as f32;
            Vec2::new(if k == steps { 0.0 } else { radius * t.cos().powf(0.7) }, rise * t.sin())
        })
        .collect()
}

/// The profile of a vessel from its bottom crown to its top one; the shell's lower seam is at 0.
fn vessel(radius: f32, height: f32, rise: f32) -> Vec<Vec2> {
    let dish = head(radius, rise, 7);
    let mut profile: Vec<Vec2> = dish.iter().rev().map(|p| Vec2::new(p.x, -p.y)).collect();
    profile.extend(dish.iter().map(|p| Vec2::new(p.x, p.y + height)));
    profile
}

/// Appends a standing tank about `place` with its feet on the floor.
pub fn standing(parts: &mut Parts, place: &Affine3A, radius: f32, height: f32) {
    let bottom = 1.25;
    let body = *place * at(0.0, bottom, 0.0);
    parts.shells.add_at(&lathe(&vessel(radius, height, 0.34 * radius), 40), &body);
    for y in [0.02, 0.5 * height, height - 0.05] {
        parts.shells.add_at(&ring(radius - 0.01, radius + 0.035, y - 0.04, y + 0.04, 40), &body);
    }
    for k in 0..4 {
        let leg = *place * turned(90.0 * k as f32 + 45.0, Vec3::ZERO);
        let x = radius - 0.06;
        parts.frames.add_at(&rod(Vec3::new(x, -0.02, 0.0), Vec3::new(x, bottom + 0.35, 0.0), 0.09, 12), &leg);
        parts.frames.add_at(&block(Vec3::new(x - 0.2, -0.02, -0.2), Vec3::new(x + 0.2, 0.03, 0.2)), &leg);
        for (dx, dz) in [(-0.14, -0.14), (0.14, -0.14), (-0.14, 0.14), (0.14, 0.14)] {
            parts.frames.add_at(&bolt(Vec3::new(x + dx, 0.03, dz), Vec3::Y, 0.05), &leg);
        }
    }
    manhole(
        parts,
        &(*place
            * turned(20.0, Vec3::ZERO)
            * standing_on(Vec3::new(0.0, bottom + 0.8, radius - 0.05), Vec3::new(0.0, bottom + 0.8, 9.0))),
    );
    ladder(
        &mut parts.frames,
        &(*place * turned(-60.0, Vec3::ZERO) * at(0.0, 0.0, radius + 0.22)),
        bottom + height - 0.5,
    );
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    let top = bottom + height + 0.3 * radius;
    run(
        &mut parts.pipes,
        &[
            v(0.3, top - 0.1, 0.0),
            v(0.3, top + 0.6, 0.0),
            v(radius + 0.8, top + 0.6, 0.0),
            v(radius + 0.8, -0.1, 0.0),
        ],
        0.09,
        14,
    );
    run(
        &mut parts.pipes,
        &[v(0.0, 1.0, 0.0), v(0.0, 0.45, 0.0), v(-radius - 0.6, 0.45, 0.0), v(-radius - 0.6, -0.1, 0.0)],
        0.11,
        14,
    );
    valve(
        &mut parts.pipes,
        &mut parts.red,
        v(-0.75, 0.45, 0.0),
        place.transform_vector3(Vec3::X),
        Vec3::Y,
        0.11,
    );
    gauge(&mut parts.pipes, v(-0.3, top - 0.12, 0.3), 0.0);
}

/// A bolted cover on a short neck, the neck along y.
fn manhole(parts: &mut Parts, place: &Affine3A) {
    let neck: Vec<Vec2> = [(0.3, -0.1), (0.3, 0.16), (0.4, 0.16), (0.4, 0.25), (0.3, 0.27), (0.0, 0.29)]
        .map(|(x, y)| Vec2::new(x, y))
        .to_vec();
    parts.shells.add_at(&lathe(&neck, 28), place);
    for k in 0..16 {
        let turn = *place * turned(22.5 * k as f32, Vec3::ZERO);
        parts.frames.add_at(&bolt(Vec3::new(0.36, 0.25, 0.0), Vec3::Y, 0.045), &turn);
    }
}

/// Appends a lying tank about `place`, its axis along x at the height of its saddles.
pub fn lying(parts: &mut Parts, place: &Affine3A, radius: f32, length: f32) {
    let height = radius + 0.55;
    let axis = *place * standing_on(Vec3::new(-0.5 * length, height, 0.0), Vec3::new(1.0, height, 0.0));
    parts.shells.add_at(&lathe(&vessel(radius, length, 0.4 * radius), 40), &axis);
    for k in 0..4 {
        let y = 0.02 + (length - 0.04) * k as f32 / 3.0;
        parts.shells.add_at(&ring(radius - 0.01, radius + 0.03, y - 0.05, y + 0.05, 40), &axis);
    }
    for x in [-0.3 * length, 0.3 * length] {
        let mut outline = vec![Vec2::new(-0.85 * radius, -0.02), Vec2::new(0.85 * radius, -0.02)];
        outline.extend(crate::shapes::arc(Vec2::new(0.0, height), radius + 0.02, -32.0, -148.0, 12));
        // The outline is in (z, y); its depth becomes x.
        let saddle = extrude(&outline, &[], 0.22).mapped(|p| Vec3::new(p.z + x - 0.11, p.y, p.x)).flipped();
        parts.frames.add_at(&saddle, place);
        parts.frames.add_at(
            &beveled_box(
                Vec3::new(x - 0.3, -0.05, -0.95 * radius),
                Vec3::new(x + 0.3, 0.1, 0.95 * radius),
                0.02,
            ),
            place,
        );
    }
    manhole(parts, &(*place * at(0.0, height + radius - 0.05, 0.0)));
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    flange(
        &mut parts.pipes,
        v(-0.5 * length - 0.55 * radius, height, 0.0),
        place.transform_vector3(Vec3::X),
        0.16,
    );
    for x in [-0.35 * length, 0.35 * length] {
        let top = height + radius;
        run(
            &mut parts.pipes,
            &[
                v(x, top - 0.1, 0.0),
                v(x, top + 0.9, 0.0),
                v(x, top + 0.9, -radius - 0.5),
                v(x, -0.1, -radius - 0.5),
            ],
            0.08,
            12,
        );
        valve(
            &mut parts.pipes,
            &mut parts.red,
            v(x, top + 0.45, 0.0),
            Vec3::Y,
            place.transform_vector3(Vec3::Z),
            0.08,
        );
    }
    ladder(
        &mut parts.frames,
        &(*place * mirror_z(0.0) * at(0.15 * length, 0.0, -radius - 0.2)),
        height + 0.4,
    );
}
