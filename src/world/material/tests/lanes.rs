//! Sixteen BSDFs have the values, densities and samples of the scalar functions in every lane.

use super::*;
use ::base::math::{F32x16, LANES, Vec2x16, Vec3x16, lanes_in};

/// Returns materials of every kind: smooth ones, delta lobes, gaps, both kinds of glass and thin sheets. All are
/// one-sided and two-sided.
fn all_materials() -> Vec<Material> {
    let mut all = smooth_materials();
    all.extend([mirror(GOLD), glass(1.5), principled_glass()]);
    all.extend([rough_glass(Distribution::Ggx, 0.3, 1.5), rough_glass(Distribution::Beckmann, 0.1, 0.7)]);
    all.extend(sheets());
    all.push(Material { name: "gaps in plastic".into(), ..masked(0.5, plastic(true)) });
    all.push(Material { name: "gaps in paint".into(), ..masked(0.3, lambert(PAINT)) });
    all.push(Material { name: "coat alone".into(), lobes: Vec::new(), ..plastic(false) });
    all.push(blend(0.4, rough_glass(Distribution::Ggx, 0.2, 1.5), lambert(PAINT)));
    let (reflectance, transmittance) = (constant(Rgb::ONE), constant(PAINT));
    let sheet = Lobe::Dielectric { eta: 1.5, thin: true, reflectance, transmittance };
    all.extend([lambert(Rgb::ZERO), material("sheet", Rgb::ZERO, None, sheet)]);
    let backs = all.clone().into_iter().map(|material| {
        let name = format!("{}, two-sided {}", material.name, !material.two_sided);
        Material { name, two_sided: !material.two_sided, ..material }
    });
    all.extend(backs.collect::<Vec<_>>());
    all
}

/// Lists directions on both sides: straight up, at the horizon and between.
fn outgoing(random: &mut Random) -> Vec<Vec3> {
    let heights: [f32; 8] = [1.0, 0.9999, 0.9, 0.6, 0.3, 0.05, 1e-3, 0.0];
    let mut all = vec![Vec3::Z, -Vec3::Z];
    for z in heights {
        for side in [1.0, -1.0] {
            all.push(direction(z.acos(), random.next() * 6.0) * Vec3::new(1.0, 1.0, side));
        }
    }
    all.extend((0..8).map(|_| random.hemisphere()));
    all
}

/// Returns directions of which some are the mirror direction of `wo` or near it, some graze, and some are behind.
fn incident(wo: Vec3, random: &mut Random) -> Vec3x16 {
    let mut all = Vec3x16::ZERO;
    for lane in 0..LANES {
        let any = random.hemisphere();
        let mirror = Vec3::new(-wo.x, -wo.y, wo.z);
        let grazing = direction(1e-3f32.acos(), random.next() * 6.0);
        let wi = match lane {
            0 => mirror,
            1 | 2 => (mirror + 0.02 * any).normalize(),
            3 | 4 => (mirror + 0.2 * any).normalize(),
            5 => grazing,
            6 => -grazing,
            7 => wo,
            8 => -wo,
            9 => Vec3::Z,
            10 | 11 => -any,
            _ => any,
        };
        all.set(lane, wi);
    }
    all
}

/// Returns the difference relative to `exact`, beyond which rounding to 0 is allowed; 0 if `exact` is not finite.
fn error(got: f32, exact: f32) -> f32 {
    if !exact.is_finite() || (got - exact).abs() < 1e-20 { 0.0 } else { ((got - exact) / exact).abs() }
}

/// Returns the largest difference of a channel, relative to that channel.
fn error_of(got: Rgb, exact: Rgb) -> f32 {
    error(got.x, exact.x).max(error(got.y, exact.y)).max(error(got.z, exact.z))
}

/// Relative difference that rounding of the facet's normal makes, at most where the clear coat's density divides by a
/// small difference. Most lobes keep to 1e-6, and Beckmann's to 1e-5, because of its exponents.
const TOLERANCE: f32 = 1e-4;

#[test]
fn lanes_have_the_scalar_values_and_densities() {
    for material in all_materials() {
        let mut random = Random(5);
        with_bsdf(&material, |bsdf| {
            for wo in outgoing(&mut random) {
                let packet = Bsdfs16::new(Vec3x16::splat(wo), |_| bsdf);
                for _ in 0..20 {
                    let wi = incident(wo, &mut random);
                    let (values, pdfs) = packet.eval_pdf(&wi, !0);
                    let sharp = packet.eval_lobes(&[bsdf.sharp_lobes(); LANES], &wi, !0);
                    let rough = packet.eval_lobes(&[bsdf.rough_lobes(); LANES], &wi, !0);
                    for lane in 0..LANES {
                        let wi = wi.get(lane);
                        let (value, pdf) = bsdf.eval_pdf(wo, wi);
                        let of_sharp = bsdf.eval_lobes(bsdf.sharp_lobes(), wo, wi);
                        let of_rough = bsdf.eval_lobes(bsdf.rough_lobes(), wo, wi);
                        let errors = [
                            error_of(values.get(lane), value),
                            error(pdfs[lane], pdf),
                            error_of(sharp.get(lane), of_sharp),
                            error_of(rough.get(lane), of_rough),
                        ];
                        let name = &material.name;
                        assert!(
                            errors.iter().all(|&e| e < TOLERANCE),
                            "{name} {wo} {wi}: {errors:?}, {value} {pdf}"
                        );
                    }
                }
            }
        });
    }
}

#[test]
fn lanes_are_sampled_as_single_directions_are() {
    for material in all_materials() {
        let mut random = Random(8);
        with_bsdf(&material, |bsdf| {
            for wo in outgoing(&mut random) {
                let packet = Bsdfs16::new(Vec3x16::splat(wo), |_| bsdf);
                for round in 0..20u16 {
                    let wanted = if round < 10 { !0 } else { round.wrapping_mul(12_345) };
                    let u_lobe: F32x16 = std::array::from_fn(|_| random.next());
                    let mut u = Vec2x16::default();
                    (0..LANES).for_each(|lane| u.set(lane, random.next_2d()));
                    let samples = packet.sample(&u_lobe, &u, wanted);
                    for lane in lanes_in(wanted) {
                        let exact = bsdf.sample(wo, u_lobe[lane], u.get(lane));
                        let name = &material.name;
                        assert_eq!(samples.goes_on[lane] != 0, exact.is_some(), "{name} {wo}: {exact:?}");
                        let Some(exact) = exact else { continue };
                        let flags = [samples.delta(), samples.straight()].map(|mask| mask >> lane & 1 != 0);
                        assert_eq!(flags, [exact.delta, exact.straight], "{name} {wo}: {exact:?}");
                        assert!(samples.eta[lane] == exact.eta, "{name} {wo}: {exact:?}");
                        assert!((samples.wi.get(lane) - exact.wi).length() < 1e-5, "{name} {wo}: {exact:?}");
                        let pdf = if exact.delta { exact.pdf } else { samples.pdf[lane] };
                        let weight = samples.weight.get(lane);
                        let errors = [error_of(weight, exact.weight), error(pdf, exact.pdf)];
                        // The rounding of a direction weighs most at the horizon.
                        let tolerance = TOLERANCE.max(2e-6 / exact.wi.z.abs());
                        assert!(errors.iter().all(|&e| e < tolerance), "{name} {wo}: {errors:?}, {exact:?}");
                    }
                }
            }
        });
    }
}

#[test]
fn a_mean_weighs_all_materials_alike() {
    let textured = Reflectance::Textured { texture: TextureId(0), scale: Rgb::ONE };
    let mut material = rough_conductor(Distribution::Ggx, 0.3, Rgb::ONE);
    material.diffuse = textured;
    if let [Lobe::Rough { scale, .. }] = &mut material.lobes[..] {
        *scale = textured;
    }
    let scene = scene(vec![material]);
    let materials = Materials::new(&scene);
    let [red, green] = [0.25, 0.75].map(|u| materials.at(MaterialId(0), Vec2::new(u, 0.5)));
    let mut mean = MeanBsdf::new(red);
    mean.add(&green);
    mean.add(&green);
    let (wo, wi) = (direction(0.4, 0.0), direction(0.5, 3.0));
    let expected = (red.eval(wo, wi) + 2.0 * green.eval(wo, wi)) / 3.0;
    assert!(expected.max_element() > 0.0);
    assert!((mean.mean().eval(wo, wi) - expected).abs().max_element() < 1e-6);
}
