//! The environment: densities are those of the directions drawn, by flux and as learned.

use super::*;
use crate::light::observed::LightRays;
use base::sampling::{owen_sobol_2d, uniform_sphere};
use glam::Mat3;
use scene::EnvironmentMap;
use std::f32::consts::TAU;

fn map() -> EnvironmentMap {
    let (width, height) = (16, 8);
    let mut radiance: Vec<Rgb> =
        (0..width * height).map(|i| Rgb::splat(0.1 + (i * 37 % 11) as f32 * 0.05)).collect();
    radiance[3 * width + 15] = Rgb::new(500.0, 400.0, 300.0);
    EnvironmentMap { width, height, radiance, to_local: Mat3::from_rotation_y(0.7) }
}

/// Returns a map with a constant part and a part of varying texels.
fn two_parts() -> EnvironmentMap {
    let (width, height) = (256, 160);
    let texel = |i: usize| if i % width < 80 { 1.0 } else { 0.1 + (i * 37 % 11) as f32 * 0.3 };
    let radiance = (0..width * height).map(|i| Rgb::splat(texel(i))).collect();
    EnvironmentMap { width, height, radiance, to_local: Mat3::from_rotation_y(0.7) }
}

/// Returns a map with a gradient that is about constant over blocks but not over tiles, and a part of varying texels.
fn gradient() -> EnvironmentMap {
    let (width, height) = (700, 300);
    let texel = |i: usize| match (i % width, i / width) {
        (400..420, 100..110) => 20.0 + (i * 37 % 11) as f32,
        (x, y) => 0.02 + (x as f32 / 700.0).powi(4) * (1.0 + y as f32 / 300.0),
    };
    let radiance = (0..width * height).map(|i| Rgb::splat(texel(i))).collect();
    EnvironmentMap { width, height, radiance, to_local: Mat3::from_rotation_y(0.7) }
}

/// Returns the number of even tiles, and the share of the others' cells that lie in even blocks.
fn even_parts(light: &EnvironmentLight) -> (usize, f64) {
    let tiles = light.tiles.all();
    let uneven = || tiles.iter().filter(|tile| tile.rows.is_some()).map(|tile| &tile.cells);
    let cells = || {
        uneven().flat_map(|[columns, rows]| rows.clone().flat_map(|y| columns.clone().map(move |x| (x, y))))
    };
    let even = cells().filter(|(x, y)| light.tiles.density(*x, *y) > 0.0).count();
    (tiles.len() - uneven().count(), even as f64 / cells().count().max(1) as f64)
}

#[test]
fn density_integrates_to_one_and_estimates_the_mean() {
    let light = EnvironmentLight::new(Some(&Environment::Map(map())), &[]).unwrap();
    let n = 1 << 18;
    let (mut mass, mut uniform_mean, mut sampled_mean) = (0.0f64, 0.0f64, 0.0f64);
    for i in 0..n {
        let u = owen_sobol_2d(i, 3);
        let d = uniform_sphere(u);
        mass += light.radiance_pdf(d).1 as f64 * 4.0 * std::f64::consts::PI;
        uniform_mean += luminance(light.radiance(d)) as f64;
        let s = light.sample(u).unwrap();
        assert!((light.radiance(s.direction) - s.radiance).length() < 1e-2 * s.radiance.length());
        sampled_mean += (luminance(s.radiance) / s.pdf) as f64 / (4.0 * std::f64::consts::PI);
    }
    let n = n as f64;
    assert!((mass / n - 1.0).abs() < 0.01, "{}", mass / n);
    assert!((uniform_mean / sampled_mean - 1.0).abs() < 0.01);
    // The weight of the mean in closed form uses cell means, not the sine inside a cell.
    assert!((sampled_mean / n / light.mean_luminance() as f64 - 1.0).abs() < 0.02);
}

#[test]
fn directions_are_drawn_with_the_densities_told_even_in_tiles_and_uneven_ones() {
    for (environment, even_tiles, even_blocks) in [
        (Environment::Map(two_parts()), 40..60, 0.0..0.2),
        (Environment::Map(gradient()), 200..250, 0.9..1.0),
        (Environment::Constant(Rgb::ONE), 256..257, 0.0..0.1),
    ] {
        let light = EnvironmentLight::new(Some(&environment), &[]).unwrap();
        let (tiles, share_of_blocks) = even_parts(&light);
        assert!(even_tiles.contains(&tiles), "{tiles}");
        assert!(even_blocks.contains(&share_of_blocks), "{share_of_blocks}");
        let (n, mut counts, mut expected) = (1 << 19, [[0.0f64; 8]; 8], [[0.0f64; 8]; 8]);
        let bin = |d: Vec3| {
            let at = |x: f32| ((x * 8.0) as usize).min(7);
            (at(0.5 + 0.5 * d.z), at(0.5 + d.y.atan2(d.x) / TAU))
        };
        let mut strays = 0;
        for i in 0..n {
            let u = owen_sobol_2d(i, 3);
            let s = light.sample(u).unwrap();
            let (radiance, pdf) = light.radiance_pdf(s.direction);
            // Rounding moves directions across the edges of cells and tiles.
            let same = (radiance - s.radiance).length() < 1e-2 * radiance.length();
            strays += u32::from(!same || (pdf / s.pdf - 1.0).abs() > 1e-2);
            let (a, b) = bin(s.direction);
            counts[a][b] += 1.0;
            let d = uniform_sphere(u);
            let (a, b) = bin(d);
            expected[a][b] += f64::from(light.radiance_pdf(d).1 * 2.0 * TAU);
        }
        assert!(strays < n / 1000, "{strays}");
        for (a, b) in counts.iter().flatten().zip(expected.iter().flatten()) {
            assert!((a / b - 1.0).abs() < 0.02, "{a} {b}");
        }
    }
}

#[test]
fn what_is_learned_of_a_window_is_where_most_samples_go_and_all_directions_keep_some() {
    const PACKETS: usize = 64;
    let light = EnvironmentLight::new(Some(&Environment::Map(two_parts())), &[]).unwrap();
    let open = |d: Vec3| d.x > 0.5;
    // Two places: light from one side at the one, none at the other.
    let (mut observers, mut rays) = (Vec::new(), LightRays::default());
    for i in 0..128u32 {
        observers.push(Vec3::new(if i < 64 { 0.0 } else { 10.0 }, i as f32 * 1e-3, 0.0));
        for packet in 0..PACKETS {
            let tiles =
                std::array::from_fn(|lane| (i as usize * PACKETS + packet + 16 * lane) % light.tile_count());
            let mut u = Vec2x16::default();
            (0..LANES).for_each(|lane| {
                u.set(lane, owen_sobol_2d((i * PACKETS as u32 + packet as u32) * 16 + lane as u32, 9))
            });
            let directions = light.directions_of_tiles(&tiles, &u);
            rays.sky.extend(
                tiles
                    .iter()
                    .zip(directions)
                    .map(|(tile, d)| (*tile as u16, if i < 64 && d.is_some_and(open) { 1.0 } else { 0.0 })),
            );
        }
    }
    let mut observed = Observed::new(&observers, 16);
    observed.add(rays);
    let learned = light.learn(&observed);
    let share = |x: f32| {
        let at = Vec3x16::splat(Vec3::new(x, 0.06, 0.0));
        let known = Some(learned.at(&observed.regions.find(&at)));
        let (n, mut found, mut inverse) = (1 << 14, 0, 0.0f64);
        for i in 0..n {
            let u = owen_sobol_2d(i, 5);
            let u = Vec2x16 { x: [u.x; LANES], y: [u.y; LANES] };
            let s = light.sample16(&u, 1, known);
            found += u32::from(open(s.direction.get(0)));
            inverse += 1.0 / f64::from(s.pdf[0]);
            let (_, pdf) = light.radiance_pdf16(&s.direction, 1, known)[0];
            assert!((pdf / s.pdf[0] - 1.0).abs() < 0.05, "{pdf} {}", s.pdf[0]);
        }
        // Every direction is drawn, as often as told.
        let sphere = inverse / f64::from(n) / (4.0 * std::f64::consts::PI);
        assert!((sphere - 1.0).abs() < 0.03, "{sphere}");
        found as f32 / n as f32
    };
    let unlearned =
        (0..1 << 14).filter(|i| open(light.sample(owen_sobol_2d(*i, 5)).unwrap().direction)).count();
    let unlearned = unlearned as f32 / (1 << 14) as f32;
    assert!(share(0.0) > 0.7 && unlearned < 0.25, "{} {unlearned}", share(0.0));
    // A place without any light of the sky has the mean of all places.
    assert!(share(10.0) > 0.65);
}

#[test]
fn a_one_texel_sun_costs_little_variance() {
    let light = EnvironmentLight::new(Some(&Environment::Map(map())), &[]).unwrap();
    let weights: Vec<f64> = (0..4096)
        .filter_map(|i| light.sample(owen_sobol_2d(i, 5)))
        .map(|s| (luminance(s.radiance) / s.pdf) as f64)
        .collect();
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    let worst = weights.iter().fold(0.0f64, |m, w| m.max(*w));
    assert!(worst < 2.0 * mean, "worst weight {worst}, mean {mean}");
}

#[test]
fn one_pixel_map_is_constant() {
    let map = EnvironmentMap {
        width: 1,
        height: 1,
        radiance: vec![Rgb::new(1.0, 2.0, 3.0)],
        to_local: Mat3::IDENTITY,
    };
    let light = EnvironmentLight::new(Some(&Environment::Map(map)), &[]).unwrap();
    for i in 0..64 {
        let s = light.sample(owen_sobol_2d(i, 1)).unwrap();
        assert!((s.radiance - Rgb::new(1.0, 2.0, 3.0)).length() < 1e-5);
    }
}

#[test]
fn discs_are_drawn_by_their_flux_and_add_to_what_is_behind_them() {
    let sun = |radiance: f32, half_angle: f32| DistantDisc {
        direction: Vec3::new(0.48, 0.6, 0.64),
        half_angle,
        radiance: Rgb::splat(radiance),
    };
    let sun_angle = 0.2679f32.to_radians();
    // In f64, since the cosine of such an angle is 1 in f32.
    let solid_angle = |half: f32| std::f64::consts::TAU * (1.0 - f64::from(half).cos());
    let environments =
        [None, Some(Environment::Constant(Rgb::splat(0.5))), Some(Environment::Map(two_parts()))];
    for (environment, disc) in
        environments.iter().flat_map(|e| [(e, sun(2e4, sun_angle)), (e, sun(3.0, 0.4))])
    {
        let plain = EnvironmentLight::new(environment.as_ref(), &[]);
        let light = EnvironmentLight::new(environment.as_ref(), &[disc]).unwrap();
        let behind = |d: Vec3| plain.as_ref().map_or(Rgb::ZERO, |light| light.radiance(d));
        assert_eq!(light.tile_count(), plain.as_ref().map_or(256, |light| light.tile_count()) + 1);
        let mean = f64::from(plain.as_ref().map_or(0.0, |light| light.mean_luminance()));
        let flux = solid_angle(disc.half_angle) * f64::from(disc.radiance.x) / (4.0 * std::f64::consts::PI);
        assert!((f64::from(light.mean_luminance()) / (mean + flux) - 1.0).abs() < 1e-3);
        let (n, mut on_disc, mut sampled_mean, mut strays) = (1 << 17, 0.0f64, 0.0f64, 0);
        for i in 0..n {
            let Some(s) = light.sample(owen_sobol_2d(i, 3)) else { panic!("{i}") };
            let (radiance, pdf) = light.radiance_pdf(s.direction);
            strays += u32::from(
                (radiance - s.radiance).length() > 1e-2 * radiance.length()
                    || (pdf / s.pdf - 1.0).abs() > 1e-2,
            );
            let within = s.direction.angle_between(disc.direction) <= 1.001 * disc.half_angle + 4e-4;
            assert!(within || (s.radiance - behind(s.direction)).length() <= 1e-2 * s.radiance.length());
            on_disc += f64::from(u8::from(within));
            sampled_mean += f64::from(luminance(s.radiance) / s.pdf) / (4.0 * std::f64::consts::PI);
        }
        assert!(strays < n / 500, "{strays}");
        let n = f64::from(n);
        assert!(
            (sampled_mean / n / (mean + flux) - 1.0).abs() < 0.02,
            "{}",
            sampled_mean / n / (mean + flux)
        );
        assert!(on_disc / n >= 0.98 * flux / (mean + flux), "{}", on_disc / n);
        let centre = light.radiance(disc.direction);
        assert!((centre - behind(disc.direction) - disc.radiance).length() < 1e-3 * centre.length());
    }
}
