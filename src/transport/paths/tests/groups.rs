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
            PathStart::new(pixel, i % SPP, seed)
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

/// Images of pixels by seeds of their own.
struct Images(Vec<Vec<f64>>);

impl Images {
    /// Number of images.
    const SEEDS: u32 = 12;

    fn new(world: &WorldAndView, in_groups: bool, first_seed: u32) -> Images {
        let seeds = first_seed..first_seed + Images::SEEDS;
        Images(seeds.map(|seed| Traced::new(world, in_groups, 1, seed).pixels()).collect())
    }

    fn means(&self) -> Vec<f64> {
        let n = self.0.len() as f64;
        (0..self.0[0].len()).map(|i| self.0.iter().map(|image| image[i]).sum::<f64>() / n).collect()
    }

    /// Returns the variance of the mean of all images, summed over pixels.
    fn variance(&self) -> f64 {
        let (means, n) = (self.means(), self.0.len() as f64);
        let squares = self.0.iter().flat_map(|image| image.iter().zip(&means).map(|(v, m)| (v - m).powi(2)));
        squares.sum::<f64>() / (n * (n - 1.0))
    }

    /// Returns the mean over all images and pixels.
    fn mean(&self) -> f64 {
        self.means().iter().sum::<f64>() / self.0[0].len() as f64
    }

    /// Returns the squared distance between the means of pixels.
    fn distance(&self, other: &Images) -> f64 {
        self.means().iter().zip(other.means()).map(|(a, b)| (a - b).powi(2)).sum()
    }
}

/// Asserts that groups have the mean of single hits, no more noise, and a small bias of pixels.
///
/// Single hits with the seeds of the groups tell how far independent images are apart. Rare bright paths make any such
/// distance uncertain by itself.
fn assert_alike(world: &WorldAndView, what: &str) {
    let [first, single, grouped] =
        [(false, 1), (false, 101), (true, 101)].map(|(in_groups, seed)| Images::new(world, in_groups, seed));
    let (theirs, mine) = (single.mean(), grouped.mean());
    assert!((mine / theirs - 1.0).abs() < 1e-3, "{what}: {mine} {theirs}");
    let noise = grouped.variance() / single.variance();
    assert!(noise < 1.1, "{what}: {noise}");
    // A pixel of this film shows about a sixth of the ball's radius. The bias there is to be less than half of the
    // noise of 64 samples.
    let square_of_bias = grouped.distance(&first) - single.distance(&first);
    let square_of_noise = single.variance() * f64::from(Images::SEEDS);
    assert!(square_of_bias < 0.25 * square_of_noise, "{what}: {square_of_bias} {square_of_noise}");
}

#[test]
fn groups_on_curved_and_glossy_surfaces_have_little_bias_and_no_more_noise_than_single_hits() {
    let mut mixed = rough_metal(0.05, 0.4);
    mixed.two_sided = true;
    for (what, ball) in [
        ("a diffuse ball", diffuse(Rgb::splat(0.6))),
        ("a sharp lobe", rough_metal(0.05, 0.7)),
        ("a broad lobe", rough_metal(0.4, 0.7)),
        ("a mirror", mirror()),
        ("glass", glass(1.5)),
        ("two sides", mixed),
    ] {
        let world = room_with_ball(Some(ball));
        assert_alike(&world, what);
        let [single, grouped] = [false, true].map(|in_groups| Traced::new(&world, in_groups, 1, 1));
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
    let wall = quad(Vec3::new(-2.0, -2.0, 0.0), Vec3::X * 4.0, Vec3::Y * 4.0, checker);
    scene.meshes.push(textured(wall, Vec2::ONE));
    let lamp = quad(Vec3::new(-1.0, -1.0, 3.0), Vec3::Y * 2.0, Vec3::X * 2.0, grey);
    scene.meshes.push(emitting(lamp, Rgb::ONE));
    let world = world(scene);
    assert_alike(&world, "a checker");
}
