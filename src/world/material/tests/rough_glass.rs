//! Rough glass and the principled material's: both sides of the surface.

use super::*;
use std::f32::consts::{PI, TAU};

fn materials() -> Vec<Material> {
    let mut all = vec![principled_glass()];
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for alpha in [0.15, 0.4, 0.8] {
            all.push(rough_glass(distribution, alpha, 1.5));
            all.push(rough_glass(distribution, alpha, 0.75));
        }
    }
    all
}

/// Samples the sphere uniformly.
fn anywhere(random: &mut Random) -> Vec3 {
    direction((1.0 - 2.0 * random.next()).acos(), random.next() * TAU)
}

#[test]
fn samples_follow_the_density_on_both_sides() {
    // Means of functions of direction: over samples, and over the sphere by the density.
    let functions = [
        |_: Vec3| 1.0,
        |d: Vec3| f32::from(d.z > 0.0),
        |d: Vec3| d.z * d.z,
        |d: Vec3| d.x,
        |d: Vec3| f32::from(d.y > 0.2),
    ];
    const N: usize = 100_000;
    for material in materials() {
        with_bsdf(&material, |bsdf| {
            for theta in [0.3, 1.2, 1.9, 2.9] {
                let (wo, mut random) = (direction(theta, 0.7), Random(5));
                let (mut sampled, mut by_density) = ([0.0f64; 5], [0.0f64; 5]);
                let mut squares = [0.0f64; 5];
                for _ in 0..N {
                    if let Some(s) = bsdf.sample(wo, random.next(), random.next_2d()) {
                        (0..5).for_each(|k| sampled[k] += f64::from(functions[k](s.wi)) / N as f64);
                        let again = bsdf.eval_pdf(wo, s.wi);
                        let tolerance = 2e-3 + 4e-6 / (wo.z * s.wi.z).abs();
                        let expected = again.0 * (s.wi.z.abs() / again.1);
                        assert!(
                            (s.pdf / again.1 - 1.0).abs() < tolerance,
                            "{} {s:?} {again:?}",
                            material.name
                        );
                        assert!(
                            (s.weight - expected).abs().max_element() < tolerance * 3.0,
                            "{s:?} {expected}"
                        );
                        let crosses = (s.wi.z > 0.0) != (wo.z > 0.0);
                        assert_eq!(s.eta != 1.0, crosses);
                    }
                    let wi = anywhere(&mut random);
                    let pdf = bsdf.pdf(wo, wi) * 4.0 * PI;
                    for k in 0..5 {
                        let value = f64::from(functions[k](wi) * pdf);
                        by_density[k] += value / N as f64;
                        squares[k] += value * value / N as f64;
                    }
                }
                for k in 0..5 {
                    let noise = ((squares[k] - by_density[k].powi(2) + 1.0) / N as f64).sqrt();
                    let difference = (sampled[k] - by_density[k]).abs();
                    let name = &material.name;
                    assert!(
                        difference < 4.5 * noise,
                        "{name} {theta} {k}: {sampled:?} {by_density:?} ± {noise}"
                    );
                }
            }
        });
    }
}

#[test]
fn light_may_go_either_way_but_for_the_squares_of_the_indices() {
    for material in materials() {
        let (mut random, mut crossed) = (Random(6), 0);
        let eta = match (&material.principled, &material.lobes[..]) {
            (Some(principled), _) => principled.eta,
            (None, [Lobe::RoughDielectric { eta, .. }]) => *eta,
            _ => panic!("{}", material.name),
        };
        with_bsdf(&material, |bsdf| {
            for _ in 0..5000 {
                let (a, b) = (anywhere(&mut random), anywhere(&mut random));
                let index = |v: Vec3| if v.z > 0.0 { 1.0 } else { eta };
                let there = bsdf.eval(a, b) / (index(a) * index(a));
                let back = bsdf.eval(b, a) / (index(b) * index(b));
                crossed += u32::from(a.z * b.z < 0.0 && there.x > 0.0);
                let error = ((there - back) / (there + 1e-3)).abs().max_element();
                assert!(error < 5e-3, "{} {a} {b}: {there} {back}", material.name);
            }
        });
        assert!(crossed > 100, "{}: {crossed}", material.name);
    }
}

#[test]
fn nothing_is_gained_and_little_lost() {
    for material in materials() {
        with_bsdf(&material, |bsdf| {
            for theta in [0.2, 0.9, 1.4, 1.8, 2.2, 2.9] {
                let (wo, mut random, mut sum) = (direction(theta, 0.1), Random(7), Rgb::ZERO);
                const N: usize = 60_000;
                for _ in 0..N {
                    if let Some(s) = bsdf.sample(wo, random.next(), random.next_2d()) {
                        sum += s.weight * (s.eta * s.eta / N as f32);
                        assert!(s.weight.is_finite() && s.pdf > 0.0);
                    }
                }
                let albedo = sum.max_element();
                assert!(albedo < 1.015, "{} {theta}: {albedo}", material.name);
                let grazing = (theta - 0.5 * PI).abs() < 0.5;
                let smooth = material.lobes.iter().any(|lobe| {
                    matches!(lobe, Lobe::RoughDielectric { alpha: Roughness::Constant(alpha), .. } if *alpha < 0.2)
                });
                assert!(albedo > 0.93 || grazing || !smooth, "{} {theta}: {albedo}", material.name);
            }
        });
    }
}
