//! Sixteen uniform materials at once give the same values as each by itself.

use super::*;
use ::base::math::{LANES, Lane, Vec3x16, f32x16};

#[test]
fn lanes_respond_and_are_bounded_as_single_materials_are() {
    for material in smooth_materials() {
        let mut random = Random(21);
        with_bsdf(&material, |bsdf| {
            for round in 0..500 {
                let wo: [Vec3; LANES] = std::array::from_fn(|_| random.hemisphere());
                let alike = AlikeBsdfs16::new(|lane| (bsdf, wo[lane])).unwrap();
                let mut wi = Vec3x16::default();
                for (lane, wo) in wo.iter().enumerate() {
                    // Some at the tip of the lobe, some below the horizon.
                    let mirror = Vec3::new(-wo.x, -wo.y, wo.z);
                    let any = random.hemisphere();
                    wi.set(
                        lane,
                        if (round + lane) % 3 == 0 { (mirror + 0.02 * any).normalize() } else { any },
                    );
                    if (round + lane) % 7 == 0 {
                        wi.z[lane] *= -1.0;
                    }
                }
                let response = alike.response(wi.load());
                let mut cosines = || f32x16::from_fn(|_| 2.0 * random.next() - 1.0);
                let bounds =
                    DirectionBound { cos_i_max: cosines(), cos_i_min: cosines(), cos_mirror_max: cosines() };
                let most = alike.bound(&bounds);
                for (lane, &wo) in wo.iter().enumerate() {
                    let wi = wi.get(lane);
                    let single = bsdf.eval(wo, wi) * wi.z.max(0.0);
                    let difference = (response.lane(lane) - single).abs();
                    // Rounding of the directions, of which the sharpest lobe makes the most.
                    let name = &material.name;
                    assert!(difference.cmple(single * 1e-4 + 1e-6).all(), "{name} {wo} {wi}: {single}");
                    let single = bsdf.bound(
                        wo,
                        &DirectionBound {
                            cos_i_max: bounds.cos_i_max.lane(lane),
                            cos_i_min: bounds.cos_i_min.lane(lane),
                            cos_mirror_max: bounds.cos_mirror_max.lane(lane),
                        },
                    );
                    let difference = (most.lane(lane) - single).abs();
                    assert!(difference.cmple(single * 1e-5).all(), "{name} {wo} {bounds:?}: {single}");
                }
            }
        });
    }
}

#[test]
fn other_lobes_and_coats_are_not_alike() {
    let scene = scene(vec![
        rough_plastic(Distribution::Ggx, 0.3, false),
        rough_plastic(Distribution::Ggx, 0.3, true),
        rough_plastic(Distribution::Ggx, 0.2, false),
        rough_plastic(Distribution::Beckmann, 0.3, false),
        glossy(PAINT, 0.1, 0.3),
        glass(1.5),
        layered(),
    ]);
    let materials = Materials::new(&scene);
    let alike = |other: u32| {
        let at = |id: u32| materials.at(MaterialId(id), Vec2::ZERO);
        AlikeBsdfs16::new(|lane| (at(if lane == 9 { other } else { 0 }), Vec3::Z)).is_some()
    };
    assert_eq!([0, 1, 2, 3, 4, 5, 6].map(alike), [true, true, false, false, false, false, false]);
}
