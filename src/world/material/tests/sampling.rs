//! Samples are distributed by the density, and their weights agree with the BSDF.

use super::*;
use crate::material::lobe::BsdfSample;
use ::base::math::gauss_legendre;
use std::f32::consts::{PI, TAU};

const COS_BINS: usize = 10;
const PHI_BINS: usize = 20;
const INCLINATIONS: [f32; 4] = [0.0, 0.6, 1.2, 1.5];

/// Computes the probability of each bin of the upper hemisphere by quadrature of the density.
fn expected(bsdf: &Bsdf, wo: Vec3) -> Vec<f64> {
    let rule: Vec<_> = gauss_legendre(40).iter().map(|&(x, w)| (x as f32, w as f32)).collect();
    let bin = |i: usize| {
        let (row, column) = (i / PHI_BINS, i % PHI_BINS);
        let mut sum = 0.0;
        for &(u, weight_u) in &rule {
            let cos = (row as f32 + u) / COS_BINS as f32;
            for &(v, weight_v) in &rule {
                let wi = direction(cos.acos(), (column as f32 + v) / PHI_BINS as f32 * TAU);
                sum += f64::from(bsdf.pdf(wo, wi) * weight_u * weight_v);
            }
        }
        sum * f64::from(TAU) / (COS_BINS * PHI_BINS) as f64
    };
    (0..COS_BINS * PHI_BINS).map(bin).collect()
}

/// Returns the chi-square against the expected counts (bins below 5 are pooled) as a standard normal deviate
/// (Wilson and Hilferty).
fn deviate(observed: &[f64], expected: &[f64]) -> f64 {
    let (mut chi_square, mut cells, mut pool) = (0.0, 0.0f64, (0.0, 0.0));
    for (&o, &e) in observed.iter().zip(expected) {
        if e < 5.0 {
            pool = (pool.0 + o, pool.1 + e);
        } else {
            chi_square += (o - e) * (o - e) / e;
            cells += 1.0;
        }
    }
    if pool.1 > 1.0 {
        chi_square += (pool.0 - pool.1) * (pool.0 - pool.1) / pool.1;
        cells += 1.0;
    } else {
        assert!(pool.0 < 10.0, "{} samples where {} were expected", pool.0, pool.1);
    }
    let k = 2.0 / (9.0 * (cells - 1.0));
    ((chi_square / (cells - 1.0)).cbrt() - (1.0 - k)) / k.sqrt()
}

#[test]
fn sampling_follows_the_density() {
    const SAMPLES: usize = 100_000;
    // One-sided 1 % in all, over about a hundred cases: 1e-4 each.
    const CRITICAL: f64 = 3.72;
    let mut random = Random(1);
    for material in smooth_materials() {
        with_bsdf(&material, |bsdf| {
            for theta in INCLINATIONS {
                if theta > 1.3 && min_alpha(&material) < 0.2 {
                    continue; // the reflection is narrower than the quadrature's nodes are apart
                }
                let wo = direction(theta, 0.5);
                let mut expected = expected(&bsdf, wo);
                let total: f64 = expected.iter().sum();
                assert!(total < 1.0 + 1e-4, "{} at {theta}: density integrates to {total}", material.name);
                // The remainder are delta lobes and facets that send light inwards.
                expected.push((1.0 - total).max(0.0));
                expected.iter_mut().for_each(|e| *e *= SAMPLES as f64);
                let mut observed = vec![0.0; expected.len()];
                for _ in 0..SAMPLES {
                    let bin = match bsdf.sample(wo, random.next(), random.next_2d()) {
                        Some(s) if !s.delta => {
                            let row = ((s.wi.z * COS_BINS as f32) as usize).min(COS_BINS - 1);
                            let phi = s.wi.y.atan2(s.wi.x).rem_euclid(TAU) / TAU;
                            row * PHI_BINS + ((phi * PHI_BINS as f32) as usize).min(PHI_BINS - 1)
                        }
                        _ => COS_BINS * PHI_BINS,
                    };
                    observed[bin] += 1.0;
                }
                let z = deviate(&observed, &expected);
                assert!(z < CRITICAL, "{} at {theta}: deviate {z:.2}", material.name);
            }
        });
    }
}

#[test]
fn a_wrong_density_would_be_noticed() {
    let expected = vec![1000.0; 200];
    let mut observed = expected.clone();
    for (i, o) in observed.iter_mut().enumerate() {
        *o *= if i % 2 == 0 { 1.08 } else { 0.92 };
    }
    assert!(deviate(&observed, &expected) > 6.0);
}

#[test]
fn weights_are_value_times_cosine_over_density() {
    let mut random = Random(2);
    for material in smooth_materials() {
        with_bsdf(&material, |bsdf| {
            for _ in 0..2000 {
                let wo = random.hemisphere();
                let Some(s) = bsdf.sample(wo, random.next(), random.next_2d()) else { continue };
                if s.delta {
                    continue;
                }
                let (value, pdf) = bsdf.eval_pdf(wo, s.wi);
                assert_eq!((value, pdf), (bsdf.eval(wo, s.wi), bsdf.pdf(wo, s.wi)));
                let weight = value * s.wi.z / pdf;
                let name = &material.name;
                // Near the horizon the half-way vector is recovered from two directions with less precision.
                let tolerance = 1e-3 + 2e-6 / (wo.z * s.wi.z);
                assert!((s.pdf / pdf - 1.0).abs() < tolerance, "{name} {wo} {}: {} {pdf}", s.wi, s.pdf);
                let error = ((s.weight - weight) / (weight + 1e-4)).abs().max_element();
                assert!(error < tolerance, "{name} {wo} {}: {} {weight}", s.wi, s.weight);
                assert!((s.wi.length() - 1.0).abs() < 1e-4);
            }
        });
    }
}

#[test]
fn thin_sheets_pass_light_straight_after_all_reflections_between_their_sides() {
    let one = constant(Rgb::ONE);
    let sheet = Lobe::Dielectric { eta: 1.5, thin: true, reflectance: one, transmittance: one };
    let sheet = material("sheet", Rgb::ZERO, None, sheet);
    for theta in [0.0, 0.7, 1.5, 2.0, 3.0] {
        let wo = direction(theta, 0.4);
        let r = with_bsdf(&glass(1.5), |b| {
            let outside = Vec3::new(wo.x, wo.y, wo.z.abs());
            b.delta_lobes(outside).reflection.expect("reflection").weight.x
        });
        // Light that leaves after any number of reflections inside, by either side.
        let (mut reflected, mut passed, mut inside) = (r, 0.0, 1.0 - r);
        for _ in 0..50 {
            passed += inside * (1.0 - r);
            inside *= r;
            reflected += inside * (1.0 - r);
            inside *= r;
        }
        with_bsdf(&sheet, |b| {
            let lobes = b.delta_lobes(wo);
            let (reflection, passage) = (lobes.reflection.expect("one"), lobes.refraction.expect("other"));
            assert!((reflection.weight - reflected).abs().max_element() < 1e-5, "{theta} {reflection:?}");
            assert!((passage.weight - passed).abs().max_element() < 1e-5, "{theta} {passage:?}");
            assert!(passage.wi == -wo && passage.straight && !reflection.straight && passage.eta == 1.0);
            assert_eq!(b.straight_transmittance(wo.z), passage.weight);
        });
    }
}

#[test]
fn delta_lobes_are_sampled_for_what_they_carry() {
    let mut random = Random(3);
    let scale = |material: Material, reflectance: Rgb, transmittance: Rgb| {
        let (r, t) = (constant(reflectance), constant(transmittance));
        let lobe = match material.lobes[..] {
            [Lobe::Dielectric { eta, thin, .. }] => {
                Lobe::Dielectric { eta, thin, reflectance: r, transmittance: t }
            }
            [Lobe::Mirror { fresnel, .. }] => Lobe::Mirror { fresnel, scale: r },
            _ => panic!("{}", material.name),
        };
        Material { lobes: vec![lobe], ..material }
    };
    for material in [
        mirror(GOLD),
        plastic(false),
        scale(plastic(true), Rgb::new(0.1, 0.5, 1.0), Rgb::ONE),
        glass(1.5),
        glass(1.0 / 1.33),
        scale(glass(1.5), Rgb::new(0.2, 0.3, 0.4), Rgb::new(0.9, 0.2, 0.1)),
        scale(glass(1.5), Rgb::ZERO, Rgb::ONE),
        scale(glass(1.5), Rgb::ZERO, Rgb::ZERO),
        layered(),
    ] {
        with_bsdf(&material, |bsdf| {
            for theta in [0.0, 0.7, 1.5, 1.7, 2.5] {
                let wo = direction(theta, 1.0);
                let all = bsdf.delta_lobes(wo);
                const N: usize = 40_000;
                let (mut reflected, mut refracted) = (Rgb::ZERO, Rgb::ZERO);
                for _ in 0..N {
                    let Some(s) = bsdf.sample(wo, random.next(), random.next_2d()) else { continue };
                    match s.delta {
                        true if s.wi.z * wo.z > 0.0 => reflected += s.weight / N as f32,
                        true => refracted += s.weight / N as f32,
                        false => {}
                    }
                }
                let want = |lobe: Option<BsdfSample>| lobe.map_or(Rgb::ZERO, |s| s.weight);
                let error = (reflected - want(all.reflection)).abs().max_element();
                assert!(error < 0.02, "{} {theta}: {reflected} {all:?}", material.name);
                let error = (refracted - want(all.refraction)).abs().max_element();
                assert!(error < 0.03, "{} {theta}: {refracted} {all:?}", material.name);
            }
        });
    }
}

#[test]
fn cosine_samples_stay_off_the_horizon() {
    with_bsdf(&lambert(Rgb::ONE), |bsdf| {
        for u in [Vec2::ZERO, Vec2::ONE, Vec2::new(0.5, 1.0), Vec2::splat(0.5), Vec2::new(0.999_999_9, 0.5)] {
            let s = bsdf.sample(Vec3::Z, 0.5, u).unwrap();
            assert!(s.wi.z > 0.0 && s.pdf > 0.0 && (s.pdf - s.wi.z / PI).abs() < 1e-7, "{s:?}");
        }
    });
}
