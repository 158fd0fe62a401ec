//! First hits shaded in groups, against the same hits shaded one by one.

use super::super::{Batch, ChainEnd, Estimand, LightSamples, PathPolicy, PathStart, RayCounts, start};
use base::math::{Rgb, luminance};
use base::sampling::hash;
use glam::{Vec2, Vec3};
use world::testkit::*;

/// Samples per pixel.
const SPP: u32 = 64;

/// Policy that shades first hits in groups or one by one.
#[derive(Default)]
struct Grouped {
    spacing: Option<f32>,
    light_samples: u32,
    ends: u32,
    weight: f32,
}

impl<'w> PathPolicy<'w> for Grouped {
    const STOPS_AT_DIFFUSE: bool = true;

    fn group_spacing(&self) -> Option<f32> {
        self.spacing
    }

    fn light_samples(&self) -> LightSamples {
        LightSamples { count: self.light_samples, first: 0 }
    }

    fn end(&mut self, end: &ChainEnd<'w>) {
        self.ends += u32::from(end.depth == 1);
        self.weight += if end.depth == 1 { end.throughput.x } else { 0.0 };
    }
}

/// Paths of a small film.
struct Traced {
    radiance: Vec<Rgb>,
    ends: u32,
    weight: f32,
}

impl Traced {
    fn new(world: &WorldAndView, in_groups: bool, light_samples: u32, seed: u32) -> Traced {
        let [width, height] = world.view.window.film;
        let starts = (0..width * height * SPP).map(|i| {
            let pixel = [i / SPP % width, i / SPP / width];
            PathStart { pixel, sample: i % SPP, seed }
        });
        let spacing = in_groups.then(|| 0.5 * world.view.pixel_angle());
        let (mut batch, mut policy) =
            (Batch::default(), Grouped { spacing, light_samples, ..Default::default() });
        start(&mut batch, starts, world, &world.view, Estimand::Pixels, SPP);
        let radiance = batch.trace(world, 8, &mut policy, &mut RayCounts::default()).collect();
        Traced { radiance, ends: policy.ends, weight: policy.weight }
    }

    fn pixels(&self) -> Vec<f64> {
        let mean = |paths: &[Rgb]| f64::from(luminance(paths.iter().sum())) / f64::from(SPP);
        self.radiance.chunks(SPP as usize).map(mean).collect()
    }

    fn mean(&self) -> f64 {
        let pixels = self.pixels();
        pixels.iter().sum::<f64>() / pixels.len() as f64
    }
}

#[test]
fn groups_on_flat_even_surfaces_have_the_light_of_every_path() {
    let world = room_with_ball(None);
    for light_samples in [1, 3] {
        let [single, grouped] =
            [false, true].map(|in_groups| Traced::new(&world, in_groups, light_samples, 1));
        for (a, b) in single.radiance.iter().zip(&grouped.radiance) {
            assert!((*a - *b).abs().max_element() <= 1e-4 * a.max_element().max(1e-3), "{a} {b}");
        }
        assert!(grouped.ends * 8 < single.ends, "{} {}", grouped.ends, single.ends);
        assert_eq!(grouped.weight, single.weight);
    }
}

#[test]
fn groups_on_curved_textured_and_glossy_surfaces_have_the_same_mean_and_noise() {
    let mut mixed = rough_metal(0.05, 0.4);
    mixed.two_sided = true;
    for (what, ball) in [
        ("a diffuse ball", None),
        ("a sharp lobe", Some(rough_metal(0.05, 0.7))),
        ("a broad lobe", Some(rough_metal(0.4, 0.7))),
        ("a mirror", Some(mirror())),
        ("glass", Some(glass(1.5))),
        ("two sides", Some(mixed)),
    ] {
        let world = room_with_ball(Some(ball.unwrap_or_else(|| diffuse(Rgb::splat(0.6)))));
        let [single, again] = [1, 2].map(|seed| Traced::new(&world, false, 1, seed));
        let grouped = Traced::new(&world, true, 1, 1);
        assert!(
            (grouped.mean() / single.mean() - 1.0).abs() < 2e-3,
            "{what}: {} {}",
            grouped.mean(),
            single.mean()
        );
        let distance = |a: &Traced, b: &Traced| -> f64 {
            a.pixels().iter().zip(b.pixels()).map(|(a, b)| (a - b).powi(2)).sum()
        };
        // Noise has the variance of half the squared distance.
        let (noise, bias) = (0.5 * distance(&single, &again), distance(&single, &grouped));
        assert!(bias < 0.5 * noise, "{what}: {bias} of {noise}");
        assert!(grouped.ends < single.ends && (grouped.weight / single.weight - 1.0).abs() < 1e-3, "{what}");
    }
}

#[test]
fn groups_reflect_the_mean_of_their_texels() {
    let mut scene = scene(camera(Vec3::Z * 2.0, Vec3::ZERO, 0.4), [8, 8]);
    let texels = (0..64 * 64).map(|i| Rgb::splat(0.1 + 0.8 * (hash(i, 3) % 2) as f32));
    let checker = checkered(&mut scene, 64, texels.collect());
    let checker = add_material(&mut scene, checker);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene
        .meshes
        .push(textured(quad(Vec3::new(-2.0, -2.0, 0.0), Vec3::X * 4.0, Vec3::Y * 4.0, checker), Vec2::ONE));
    let lamp = quad(Vec3::new(-1.0, -1.0, 3.0), Vec3::Y * 2.0, Vec3::X * 2.0, grey);
    scene.meshes.push(emitting(lamp, Rgb::ONE));
    let world = world(scene);
    let [single, grouped] = [false, true].map(|in_groups| Traced::new(&world, in_groups, 1, 1));
    for (a, b) in single.pixels().iter().zip(grouped.pixels()) {
        assert!((a / b - 1.0).abs() < 0.06, "{a} {b}");
    }
    assert!((grouped.mean() / single.mean() - 1.0).abs() < 8e-3, "{} {}", grouped.mean(), single.mean());
}
