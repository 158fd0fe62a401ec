//! Ends of chains: their path classes, and the textures there.

mod groups;

use super::{Batch, ChainEnd, Estimand, LightSamples, PathPolicy, PathStart, RayCounts, start};
use base::math::{Rgb, luminance};
use base::sampling::hash;
use glam::{Vec2, Vec3};
use scene::Camera;
use std::collections::BTreeSet;
use world::testkit::*;

/// Ends of chains: the mesh that they lie on, depth and path class.
#[derive(Default)]
struct ChainEnds(Vec<(u32, u32, u32)>);

impl<'w> PathPolicy<'w> for ChainEnds {
    const STOPS_AT_DIFFUSE: bool = true;

    fn end(&mut self, end: &ChainEnd<'w>) {
        self.0.push((end.surface.mesh, end.depth, end.path_class));
    }
}

#[test]
fn ways_tell_mirrors_apart_and_nothing_else() {
    let mut scene = scene(Camera { tan_half_x: 0.5, ..Camera::default() }, [8, 8]);
    let mirror = add_material(&mut scene, mirror());
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    // Two mirrors in the upper half of the view, which show the wall behind, and a wall in the lower half.
    for x in [-5.0, 0.0] {
        scene.meshes.push(quad(Vec3::new(x, 0.0, -1.0), Vec3::X * 5.0, Vec3::Y * 5.0, mirror));
    }
    scene.meshes.push(quad(Vec3::new(-50.0, -50.0, 2.0), Vec3::Y * 100.0, Vec3::X * 100.0, grey));
    scene.meshes.push(quad(Vec3::new(-50.0, -50.0, -2.0), Vec3::X * 100.0, Vec3::Y * 100.0, grey));
    let world = world(scene);
    let pixels = (0..64).map(|i| PathStart::new([i % 8, i / 8], 0, 0));
    let (mut batch, mut ends) = (Batch::default(), ChainEnds::default());
    start(&mut batch, pixels, &world, &world.view, Estimand::EyeSamples { spp: 1, seed: 0 }, 1);
    batch.trace(&world, 8, &mut ends, &mut RayCounts::default());
    assert_eq!(ends.0.len(), 64);
    let of = |mesh| -> BTreeSet<(u32, u32)> {
        ends.0.iter().filter(|end| end.0 == mesh).map(|end| (end.1, end.2)).collect()
    };
    assert_eq!(of(3), BTreeSet::from([(1, 0)]), "straight from the eye");
    let mirrored: Vec<(u32, u32)> = of(2).into_iter().collect();
    assert_eq!(mirrored.iter().map(|end| end.0).collect::<Vec<_>>(), [2, 2], "one way by each mirror");
    assert!(mirrored.iter().all(|end| end.1 != 0));
}

/// Albedos of ends, by depth.
#[derive(Default)]
struct Albedos(Vec<(u32, f32)>);

impl<'w> PathPolicy<'w> for Albedos {
    const STOPS_AT_DIFFUSE: bool = true;

    fn end(&mut self, end: &ChainEnd<'w>) {
        self.0.push((end.depth, end.bsdf.base_brdf().x * std::f32::consts::PI));
    }
}

#[test]
fn textures_are_averaged_over_what_a_sample_stands_for_seen_in_mirrors_too() {
    // A mirror for a floor, and walls and a ceiling of black and white texels, thousands to a pixel.
    let mut scene = scene(Camera { tan_half_x: 0.3, ..Camera::default() }, [8, 8]);
    let texels = (0..64 * 64).map(|i| Rgb::splat((hash(i, 3) % 2) as f32));
    let noise = checkered(&mut scene, 64, texels.collect());
    let noise = add_material(&mut scene, noise);
    let mirror = add_material(&mut scene, mirror());
    let fine = |wall| textured(wall, Vec2::splat(400.0));
    scene.meshes.push(quad(Vec3::new(-50.0, -1.0, 50.0), Vec3::X * 100.0, Vec3::NEG_Z * 100.0, mirror));
    scene.meshes.push(fine(quad(Vec3::new(-20.0, -1.0, -20.0), Vec3::X * 40.0, Vec3::Y * 40.0, noise)));
    let world = world(scene);
    let albedos = |samples: u32| {
        let pixels = (0..64).map(|i| PathStart::new([i % 8, i / 8], i, 0));
        let (mut batch, mut albedos) = (Batch::default(), Albedos::default());
        start(&mut batch, pixels, &world, &world.view, Estimand::Pixels, samples);
        batch.trace(&world, 8, &mut albedos, &mut RayCounts::default());
        assert!([1, 2].iter().all(|depth| albedos.0.iter().any(|end| end.0 == *depth)));
        albedos.0
    };
    assert!(albedos(4).iter().all(|(_, albedo)| (albedo - 0.5).abs() < 0.1), "{:?}", albedos(4));
    assert!(albedos(1 << 30).iter().all(|(_, albedo)| *albedo < 1e-6 || (albedo - 1.0).abs() < 1e-6));
}

/// Ends with light samples.
struct Lit(LightSamples);

impl PathPolicy<'_> for Lit {
    const STOPS_AT_DIFFUSE: bool = true;

    fn light_samples(&self) -> LightSamples {
        self.0
    }
}

#[test]
fn light_has_the_same_mean_by_any_number_of_light_samples_and_less_noise_by_more() {
    // The ball's lobe scatters to where light samples fall, too.
    let world = room_with_ball(Some(rough_metal(0.3, 0.7)));
    let pixels = |count: u32, first: u32, seed: u32| -> Vec<f64> {
        let starts = (0..1 << 16).map(|i| PathStart::new([i / 64 % 32, i / 64 / 32], i % 64, seed));
        let (mut batch, mut lit) = (Batch::default(), Lit(LightSamples { count, first }));
        start(&mut batch, starts, &world, &world.view, Estimand::Pixels, 64);
        let found: Vec<Rgb> = batch.trace(&world, 8, &mut lit, &mut RayCounts::default()).collect();
        found.chunks(64).map(|pixel| f64::from(luminance(pixel.iter().sum())) / 64.0).collect()
    };
    let mean = |pixels: &[f64]| pixels.iter().sum::<f64>() / pixels.len() as f64;
    let variance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let [[one, again], [four, anew]] = [1, 4].map(|count| [1, 2].map(|seed| pixels(count, 0, seed)));
    for other in [&four, &pixels(3, 7, 1), &pixels(1, 1 << 20, 1)] {
        assert!((mean(other) / mean(&one) - 1.0).abs() < 0.004, "{} {}", mean(other), mean(&one));
        assert_ne!(other, &one);
    }
    let (one, four) = (variance(&one, &again), variance(&four, &anew));
    assert!(four < 0.6 * one, "{four} {one}");
}
