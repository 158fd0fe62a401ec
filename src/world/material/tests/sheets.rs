//! Thin sheets that transmit light: both of their sides, energy, and samples.

use super::*;
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// Samples the sphere uniformly.
fn anywhere(random: &mut Random) -> Vec3 {
    direction((1.0 - 2.0 * random.next()).acos(), random.next() * TAU)
}

#[test]
fn both_sides_are_alike_and_light_may_go_either_way() {
    let back = |v: Vec3| Vec3::new(v.x, v.y, -v.z);
    for material in sheets() {
        let (mut random, mut crossed) = (Random(6), 0);
        with_bsdf(&material, |bsdf| {
            assert!(bsdf.scatters_across() && !bsdf.has_delta() && !bsdf.bends_light());
            for _ in 0..5000 {
                let (a, b) = (anywhere(&mut random), anywhere(&mut random));
                let (there, ago) = (bsdf.eval(a, b), bsdf.eval(b, a));
                assert_eq!(bsdf.eval_pdf(a, b), bsdf.eval_pdf(back(a), back(b)), "{}", material.name);
                // Facets that are seen from behind transmit nothing, which depends on the direction of the viewer.
                let (up, down) = if a.z > b.z { (a, b) } else { (b, a) };
                let half = (up + back(down)).normalize();
                if up.z * down.z < 0.0 && (down.dot(half) < 0.0) != (back(up).dot(half) < 0.0) {
                    continue;
                }
                crossed += u32::from(a.z * b.z < 0.0);
                let error = ((there - ago) / (there + 1e-3)).abs().max_element();
                assert!(error < 5e-3, "{} {a} {b}: {there} {ago}", material.name);
            }
        });
        assert!(crossed > 300, "{}: {crossed}", material.name);
    }
}

#[test]
fn samples_follow_the_density_on_both_sides() {
    let functions = [
        |_: Vec3| 1.0,
        |d: Vec3| f32::from(d.z > 0.0),
        |d: Vec3| d.z * d.z,
        |d: Vec3| d.x,
        |d: Vec3| f32::from(d.y > 0.2),
    ];
    const N: usize = 100_000;
    for material in sheets() {
        with_bsdf(&material, |bsdf| {
            for theta in [0.3, 1.2, 1.9, 2.9] {
                let (wo, mut random) = (direction(theta, 0.7), Random(5));
                let (mut sampled, mut by_density, mut squares) = ([0.0f64; 5], [0.0f64; 5], [0.0f64; 5]);
                for _ in 0..N {
                    if let Some(s) = bsdf.sample(wo, random.next(), random.next_2d()) {
                        (0..5).for_each(|k| sampled[k] += f64::from(functions[k](s.wi)) / N as f64);
                        let again = bsdf.eval_pdf(wo, s.wi);
                        let tolerance = 2e-3 + 4e-6 / (wo.z * s.wi.z).abs();
                        assert!(
                            (s.pdf / again.1 - 1.0).abs() < tolerance,
                            "{} {s:?} {again:?}",
                            material.name
                        );
                        assert!(s.eta == 1.0 && !s.straight && !s.delta);
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
                    assert!(
                        difference < 4.5 * noise,
                        "{} {theta} {k}: {sampled:?} {by_density:?}",
                        material.name
                    );
                }
            }
        });
    }
}

#[test]
fn white_sheets_create_no_light_and_lose_little() {
    for mut material in sheets() {
        if let Some(principled) = &mut material.principled {
            (principled.base_color, principled.sheen) = (constant(Rgb::ONE), 0.0.into());
        }
        with_bsdf(&material, |bsdf| {
            for theta in [0.2, 0.9, 1.3, 1.9, 2.8] {
                let (wo, mut random, mut sum) = (direction(theta, 0.1), Random(7), Rgb::ZERO);
                const N: usize = 60_000;
                for _ in 0..N {
                    if let Some(s) = bsdf.sample(wo, random.next(), random.next_2d()) {
                        sum += s.weight / N as f32;
                    }
                }
                let albedo = sum.max_element();
                assert!(albedo < 1.1 && albedo > 0.8, "{} {theta}: {albedo}", material.name);
            }
        });
    }
}

#[test]
fn diffuse_transmission_is_lambertian_and_not_stored_in_virtual_lights() {
    let [matte, ..] = &sheets()[..] else { panic!() };
    with_bsdf(matte, |bsdf| {
        for wi in [direction(2.0, 0.3), direction(3.0, 1.0)] {
            let expected = PAINT * (0.4 * FRAC_1_PI);
            assert!((bsdf.eval(direction(0.7, 0.0), wi) - expected).abs().max_element() < 1e-6);
        }
        // Virtual lights radiate to the side of the light alone. Paths carry the rest.
        let whole = PAINT * 0.6;
        let albedo = bsdf.diffuse_albedo(direction(0.2, 0.0));
        assert!((albedo / whole - 1.0).abs().max_element() < 0.25, "{albedo} {whole}");
        assert!(bsdf.glossy_part().is_some() && bsdf.stores_light());
    });
}
