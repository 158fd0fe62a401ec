//! Motor-driven pumps, and a compressor with a flywheel.

use super::super::pipework::{flange, gauge, run, valve};
use super::{Parts, profile};
use crate::shapes::{
    at, beveled_box, block, cylinder, ellipsoid, lathe, profile_lathe, rod, standing_on, torus, tube, turned,
};
use glam::{Affine3A, Vec3};

/// Appends a pump with its motor about `place`, the shaft along x; the suction from +x, the delivery upwards.
pub fn pump(parts: &mut Parts, place: &Affine3A) {
    parts.concrete.add_at(&beveled_box(Vec3::new(-1.25, -0.1, -0.5), Vec3::new(1.0, 0.25, 0.5), 0.03), place);
    parts
        .casing
        .add_at(&beveled_box(Vec3::new(-1.15, 0.24, -0.38), Vec3::new(0.6, 0.34, 0.38), 0.015), place);
    let axis = *place * standing_on(Vec3::new(-1.1, 0.75, 0.0), Vec3::new(1.0, 0.75, 0.0));
    // Motor with fins and fan cowl.
    parts.gloss.add_at(
        &lathe(
            &profile(&[
                (0.0, 0.0),
                (0.2, 0.0),
                (0.29, 0.06),
                (0.3, 0.18),
                (0.26, 0.18),
                (0.26, 0.85),
                (0.22, 0.9),
                (0.1, 0.93),
            ]),
            28,
        ),
        &axis,
    );
    for k in 0..24 {
        let turn = turned(15.0 * k as f32, Vec3::ZERO);
        parts
            .gloss
            .add_at(&block(Vec3::new(0.255, 0.2, -0.006), Vec3::new(0.31, 0.84, 0.006)), &(axis * turn));
    }
    parts.gloss.add_at(&beveled_box(Vec3::new(-0.85, 1.0, -0.12), Vec3::new(-0.5, 1.18, 0.12), 0.02), place);
    for x in [-0.9, -0.35] {
        parts.gloss.add_at(&block(Vec3::new(x - 0.06, 0.33, -0.24), Vec3::new(x + 0.06, 0.56, 0.24)), place);
    }
    // Coupling and its guard, bearing bracket, volute.
    parts.bare.add_at(
        &lathe(
            &profile(&[(0.05, 0.9), (0.05, 1.0), (0.12, 1.0), (0.12, 1.14), (0.05, 1.14), (0.05, 1.25)]),
            16,
        ),
        &axis,
    );
    parts.red.add_at(&tube(0.17, 0.18, 0.26, 20), &(axis * at(0.0, 0.95, 0.0)));
    parts.casing.add_at(
        &lathe(
            &profile(&[
                (0.05, 1.2),
                (0.16, 1.22),
                (0.16, 1.42),
                (0.3, 1.5),
                (0.34, 1.55),
                (0.34, 1.78),
                (0.28, 1.84),
                (0.16, 1.9),
                (0.14, 2.05),
            ]),
            28,
        ),
        &axis,
    );
    parts.casing.add_at(&torus(0.3, 0.13, 28, 10), &(axis * at(0.0, 1.66, 0.0)));
    flange(
        &mut parts.casing,
        place.transform_point3(Vec3::new(1.0, 0.75, 0.0)),
        place.transform_vector3(Vec3::NEG_X),
        0.14,
    );
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    run(&mut parts.pipes, &[v(0.56, 0.85, 0.25), v(0.56, 1.45, 0.25), v(0.56, 3.2, 0.25)], 0.11, 14);
    valve(
        &mut parts.pipes,
        &mut parts.red,
        v(0.56, 1.95, 0.25),
        Vec3::Y,
        place.transform_vector3(Vec3::X),
        0.11,
    );
    run(&mut parts.pipes, &[v(1.0, 0.75, 0.0), v(1.9, 0.75, 0.0), v(1.9, -0.1, 0.0)], 0.14, 14);
    gauge(&mut parts.bare, v(0.56, 1.2, 0.36), 90.0);
}

/// Appends a compressor with a spoked flywheel about `place`; the wheel turns about x.
pub fn compressor(parts: &mut Parts, place: &Affine3A) {
    parts.concrete.add_at(&beveled_box(Vec3::new(-1.6, -0.1, -2.6), Vec3::new(1.6, 0.35, 2.2), 0.05), place);
    let axis = *place * standing_on(Vec3::new(0.75, 1.5, 0.0), Vec3::new(2.0, 1.5, 0.0));
    parts.red.add_at(
        &profile_lathe(
            &profile(&[
                (1.02, 0.0),
                (1.25, 0.0),
                (1.28, 0.03),
                (1.28, 0.27),
                (1.25, 0.3),
                (1.02, 0.3),
                (1.0, 0.25),
                (1.0, 0.05),
            ]),
            56,
        ),
        &axis,
    );
    parts.bare.add_at(
        &lathe(
            &profile(&[
                (0.1, -1.8),
                (0.1, -0.05),
                (0.22, -0.05),
                (0.22, 0.36),
                (0.12, 0.36),
                (0.12, 0.5),
                (0.0, 0.5),
            ]),
            24,
        ),
        &axis,
    );
    for k in 0..6 {
        let turn = turned(60.0 * k as f32, Vec3::ZERO);
        parts
            .red
            .add_at(&rod(Vec3::new(0.18, 0.15, 0.0), Vec3::new(1.03, 0.15, 0.0), 0.06, 10), &(axis * turn));
    }
    parts.casing.add_at(&beveled_box(Vec3::new(-1.0, 0.3, -0.7), Vec3::new(0.55, 1.9, 0.7), 0.08), place);
    parts.casing.add_at(&ellipsoid(Vec3::new(0.75, 0.45, 0.6), 28, 14), &(*place * at(-0.22, 1.88, 0.0)));
    for z in [-1.0, -1.6] {
        let barrel = standing_on(Vec3::new(-0.2, 1.3, z + 0.4), Vec3::new(-0.2, 1.3, z - 1.0));
        let shape = profile(&[
            (0.3, 0.0),
            (0.42, 0.05),
            (0.42, 0.1),
            (0.34, 0.12),
            (0.34, 0.6),
            (0.42, 0.62),
            (0.42, 0.72),
            (0.0, 0.72),
        ]);
        parts.casing.add_at(&lathe(&shape, 28), &(*place * barrel));
    }
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    run(
        &mut parts.pipes,
        &[v(-0.2, 1.5, -1.7), v(-0.2, 2.7, -1.7), v(-1.3, 2.7, -1.7), v(-1.3, -0.1, -1.7)],
        0.1,
        16,
    );
    run(
        &mut parts.pipes,
        &[v(-0.6, 1.9, 0.3), v(-0.6, 3.4, 0.3), v(-0.6, 3.4, -2.9), v(-0.6, -0.1, -2.9)],
        0.08,
        16,
    );
    parts.bare.add_at(&cylinder(0.12, 0.25, 12), &(*place * at(0.2, 2.2, 0.2)));
}
