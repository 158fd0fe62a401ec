//! Directions that were sampled beforehand, against integrals over the sphere.

use super::*;
use base::sampling::owen_sobol_2d;
use glam::{DVec3, Mat3};
use scene::EnvironmentMap;

/// Number of steps of an integral along each edge of a cell.
const STEPS: usize = 8;

/// Returns a sky of varying texels with a horizon and three texels that are a thousand times as bright.
fn contrasts() -> EnvironmentMap {
    let (width, height) = (128, 64);
    let mut radiance: Vec<Rgb> = (0..width * height)
        .map(|i| match i / width {
            y if y < height / 2 => Rgb::new(0.5, 0.7, 1.0) * (0.5 + (i * 37 % 11) as f32 * 0.1),
            _ => Rgb::splat(0.05 + (i * 53 % 7) as f32 * 0.02),
        })
        .collect();
    for (x, y) in [(20, 12), (21, 12), (90, 25)] {
        radiance[y * width + x] = Rgb::splat(1000.0);
    }
    EnvironmentMap { width, height, radiance, to_local: Mat3::from_rotation_y(0.7) }
}

fn sun(half_angle: f32, radiance: f32) -> DistantDisc {
    DistantDisc { direction: Vec3::new(0.48, 0.6, 0.64), half_angle, radiance: Rgb::splat(radiance) }
}

/// Returns the presamples of a tile: directions, luminances and densities within the tile.
fn of_tile(light: &EnvironmentLight, tile: usize) -> Vec<(Vec3, f64, f64)> {
    let density = f64::from(light.tiles.all()[tile].density);
    let samples = light.presamples.of_tile(tile).iter();
    let found =
        samples.map(|s| (s.direction, f64::from(luminance(s.radiance)), f64::from(s.density) * density));
    found.collect()
}

/// Integrates luminance times some weights over the directions of a tile of a map.
fn integrate<const N: usize>(
    light: &EnvironmentLight,
    tile: usize,
    weights: impl Fn(DVec3) -> [f64; N],
) -> [f64; N] {
    let SkySource::Map(map) = &light.source else { panic!() };
    let rows = 63;
    let height = |y: usize| (std::f64::consts::PI * y as f64 / (rows * STEPS) as f64).cos();
    let [columns, lines] = light.tiles.all()[tile].cells.clone();
    let mut sums = [0.0; N];
    for y in lines.start * STEPS..lines.end * STEPS {
        let (top, bottom) = (height(y), height(y + 1));
        for x in columns.start * STEPS..columns.end * STEPS {
            let d = map.direction_at((0.5 * (top + bottom)) as f32, (x as f32 + 0.5) / STEPS as f32);
            let solid_angle = (top - bottom) * std::f64::consts::TAU / (128 * STEPS) as f64;
            let flux = f64::from(luminance(light.radiance(d))) * solid_angle;
            for (sum, weight) in sums.iter_mut().zip(weights(d.as_dvec3())) {
                *sum += flux * weight;
            }
        }
    }
    sums
}

#[test]
fn means_over_the_directions_are_the_integrals_over_tiles_and_irradiances_over_the_sphere() {
    let light = EnvironmentLight::new(Some(&Environment::Map(contrasts())), &[]).unwrap();
    let normals: [DVec3; 12] = std::array::from_fn(|i| uniform_sphere(owen_sobol_2d(i as u32, 4)).as_dvec3());
    let weights = |d: DVec3| -> [f64; 13] {
        std::array::from_fn(|i| if i == 12 { 1.0 } else { normals[i].dot(d).max(0.0) })
    };
    let (mut sums, mut exact, mut worst) = ([0.0; 13], [0.0; 13], 0.0f64);
    for tile in 0..light.tile_count() {
        let samples = of_tile(&light, tile);
        let mut here = [0.0; 13];
        for (direction, luminance, density) in &samples {
            for (sum, weight) in here.iter_mut().zip(weights(direction.as_dvec3())) {
                *sum += luminance * weight / density / samples.len() as f64;
            }
        }
        let there = integrate(&light, tile, weights);
        worst = worst.max((here[12] / there[12] - 1.0).abs());
        for i in 0..13 {
            sums[i] += here[i];
            exact[i] += there[i];
        }
    }
    let errors: Vec<f64> = sums.iter().zip(exact).map(|(sum, exact)| sum / exact - 1.0).collect();
    eprintln!("worst tile {worst:.5}, irradiances {errors:.5?}");
    assert!(worst < 0.02, "{worst}");
    assert!(errors.iter().all(|error| error.abs() < 0.002), "{errors:?}");
}

#[test]
fn every_cell_has_a_direction_and_bright_tiles_have_more_of_them() {
    for discs in [vec![], vec![sun(0.0047, 1e5)]] {
        let light = EnvironmentLight::new(Some(&Environment::Map(contrasts())), &discs).unwrap();
        let mut sizes: Vec<(f32, usize)> = Vec::new();
        for tile in 0..light.tile_count() {
            let samples = of_tile(&light, tile);
            assert!(samples.iter().all(|(_, _, density)| *density > 0.0 && density.is_finite()));
            sizes.push((light.flux_of_tile(tile), samples.len()));
        }
        sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(sizes.is_sorted_by_key(|(_, count)| *count));
        assert!(sizes[sizes.len() - 1].1 > sizes[0].1);
    }
}

#[test]
fn densities_and_radiances_are_those_of_the_directions_also_on_discs() {
    let environments =
        [None, Some(Environment::Constant(Rgb::splat(0.5))), Some(Environment::Map(contrasts()))];
    for (environment, disc) in
        environments.iter().flat_map(|e| [(e, None), (e, Some(sun(0.0047, 2e4))), (e, Some(sun(0.4, 3.0)))])
    {
        let discs: Vec<DistantDisc> = disc.into_iter().collect();
        let Some(light) = EnvironmentLight::new(environment.as_ref(), &discs) else { continue };
        let (n, mut mean, mut strays) = (1 << 16, 0.0, 0);
        for first in (0..n).step_by(LANES) {
            let mut u = Vec2x16::default();
            (0..LANES).for_each(|i| u.set(i, owen_sobol_2d(first + i as u32, 3)));
            let samples = light.sample16(&u, u16::MAX, None);
            let known = light.radiance_pdf16(&samples.direction, u16::MAX, None);
            for i in 0..LANES {
                let (radiance, pdf) = (samples.radiance.get(i), samples.pdf[i]);
                mean += f64::from(luminance(radiance) / pdf) / f64::from(n);
                let same = (known[i].0 - radiance).length() < 1e-2 * radiance.length();
                strays += u32::from(!same || (known[i].1 / pdf - 1.0).abs() > 1e-2);
            }
        }
        assert!(strays < n / 500, "{strays}");
        let expected = f64::from(light.mean_luminance()) * 4.0 * std::f64::consts::PI;
        assert!((mean / expected - 1.0).abs() < 5e-3, "{mean} {expected}");
    }
}

#[test]
fn lanes_that_are_not_wanted_have_no_sample() {
    let light = EnvironmentLight::new(Some(&Environment::Map(contrasts())), &[sun(0.4, 3.0)]).unwrap();
    let samples = light.sample16(&Vec2x16 { x: [0.3; LANES], y: [0.6; LANES] }, 0b1010, None);
    for i in 0..LANES {
        assert_eq!(samples.pdf[i] > 0.0, i == 1 || i == 3);
    }
}
