//! Aimed photons against those that go anywhere.

use super::openings::Openings;
use super::plan::EmitterPlan;
use super::{PhotonCounts, PhotonEmitter, PhotonSettings, trace_photons};
use crate::lights::{LightPassSettings, light_pass};
use base::math::{Rgb, luminance};
use base::progress::Control;
use base::sampling::Sampler;
use embree::Ray;
use glam::Vec3;
use rayon::prelude::*;
use scene::{Camera, DeltaLight, DistantDisc, Environment, Mesh};
use std::f32::consts::PI;
use world::testkit::{SceneAndView, add_material, diffuse, quad, room, scene, world};
use world::{SurfacePoint, World};

/// A wide plain.
fn plain() -> SceneAndView {
    let mut scene = scene(Camera::default(), [8, 8]);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.push(quad(Vec3::new(-8.0, -8.0, -0.01), Vec3::X * 16.0, Vec3::Y * 16.0, grey));
    scene.environment = Some(Environment::Constant(Rgb::splat(0.5)));
    scene
}

/// A room of edge 1 on it, with a wide window in the wall at x = 0, under a sky with two suns.
fn room_with_window() -> World {
    let mut scene = plain();
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
    let wall = |z: f32, height: f32| quad(Vec3::Z * z, Vec3::Y, Vec3::Z * height, grey);
    let is_open = |mesh: &Mesh| mesh.positions.iter().all(|p| p.x == 0.0);
    scene.meshes.extend(room(Vec3::ZERO, Vec3::ONE, grey).into_iter().filter(|mesh| !is_open(mesh)));
    scene.meshes.extend([wall(0.0, 0.4), wall(0.9, 0.1)]);
    let direction = Vec3::new(-0.7, 0.1, 0.7).normalize();
    scene.discs.push(DistantDisc { direction, half_angle: 0.005, radiance: Rgb::splat(2e4) });
    let direction = Vec3::new(0.8, 0.3, -0.5).normalize();
    scene.lights.push(DeltaLight::Directional { direction, irradiance: Rgb::splat(0.5) });
    world(scene).world
}

/// Points of the floor, seen from above.
fn floor() -> Vec<SurfacePoint> {
    let point = |i: u32| SurfacePoint {
        position: Vec3::new((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5, 0.0) / 64.0,
        normal: Vec3::Z,
        geometric_normal: Vec3::Z,
    };
    (0..64 * 64).map(point).collect()
}

/// Flux of the photons on what the floor sees on each side of the middle of the room, and counts.
fn flux(world: &World, seen: &[SurfacePoint], seed: u32) -> ([f32; 2], PhotonCounts) {
    let settings = PhotonSettings { photons: 200_000, seen, max_edges: 4, seed };
    let (photons, counts) = trace_photons(world, &settings, &Control::new(), |hit| hit.photon);
    let mut sums = [0.0; 2];
    for photon in photons {
        let inside =
            photon.position.cmpge(Vec3::new(-1e-4, -1e-4, 1e-4)) & photon.position.cmple(Vec3::splat(1.0001));
        let faces_in = photon.normal.dot(Vec3::splat(0.5) - photon.position) > 0.0;
        if inside.all() && faces_in {
            sums[usize::from(photon.position.x > 0.5)] += luminance(photon.flux);
        }
    }
    (sums.map(|sum| sum / counts.paths as f32), counts)
}

#[test]
fn aimed_photons_carry_the_flux_of_others_and_vary_less() {
    const SEEDS: u32 = 32;
    let world = room_with_window();
    let floor = floor();
    let moments = |seen: &[SurfacePoint], side: usize| {
        let found: Vec<f32> = (0..SEEDS).map(|seed| flux(&world, seen, seed).0[side]).collect();
        let mean = found.iter().sum::<f32>() / SEEDS as f32;
        let variance = found.iter().map(|x| (x - mean).powi(2)).sum::<f32>() / (SEEDS - 1) as f32;
        (mean, variance)
    };
    let gain = flux(&world, &floor, 0).1.gain;
    assert!(gain > 2.0, "{gain}");
    for side in 0..2 {
        let ((even, even_variance), (aimed, aimed_variance)) = (moments(&[], side), moments(&floor, side));
        let error = ((even_variance + aimed_variance) / SEEDS as f32).sqrt();
        assert!((aimed - even).abs() < 4.0 * error, "{aimed} for {even} ± {error}");
        assert!(error < 0.04 * even, "{error} of {even}");
        assert!(aimed_variance < 0.7 * even_variance, "{aimed_variance} {even_variance}");
    }
}

/// Lines through a ball of radius r have the flux π r² (4π L + the irradiances of the suns), wherever it is.
#[test]
fn aimed_paths_have_the_flux_of_sky_and_suns() {
    const PATHS: u32 = 8_000_000;
    const CHUNKS: u32 = 64;
    let world = room_with_window();
    let emitter = PhotonEmitter::new(&world).expect("there is a sky");
    let aims = Openings::new(&world, &emitter.target, &floor(), 0);
    assert!(aims.is_some(), "there is a window");
    let plan = EmitterPlan::new(&emitter, aims);
    // The sun: half angle 0.005 rad, radiance 2e4.
    let disc = PI * 0.005 * 0.005 * 2e4;
    let irradiance = 4.0 * PI * 0.5 + disc + 0.5;
    for (centre, radius) in [(Vec3::splat(0.5), 0.5f32), (Vec3::X * -4.0, 2.0)] {
        let passes = |ray: &Ray| (centre - ray.origin).cross(ray.direction).length() < radius;
        let sums: Vec<[f64; 2]> = (0..CHUNKS)
            .into_par_iter()
            .map(|chunk| {
                (chunk * (PATHS / CHUNKS)..(chunk + 1) * (PATHS / CHUNKS))
                    .filter_map(|path| plan.sample(&emitter, &mut Sampler::new(5, path)))
                    .filter(|emission| passes(&emission.ray))
                    .map(|emission| f64::from(luminance(emission.flux)))
                    .fold([0.0; 2], |[sum, squares], flux| [sum + flux, squares + flux * flux])
            })
            .collect();
        let [mean, squares] = [0, 1].map(|i| sums.iter().map(|s| s[i]).sum::<f64>() / f64::from(PATHS));
        let error = ((squares - mean * mean) / f64::from(PATHS)).sqrt();
        let expected = f64::from(PI * radius * radius * irradiance);
        assert!((mean - expected).abs() < 4.0 * error, "{mean} ± {error} for {expected} around {centre}");
        assert!(error < 0.015 * expected, "{error} of {expected}");
    }
}

#[test]
fn photons_are_not_aimed_where_they_come_anyway() {
    let settings = LightPassSettings { indirect: 20_000, ..LightPassSettings::default() };
    let mut lamp = scene(Camera::default(), [8, 8]);
    let grey = add_material(&mut lamp, diffuse(Rgb::splat(0.5)));
    lamp.meshes.extend(room(Vec3::ZERO, Vec3::ONE, grey));
    lamp.lights.push(DeltaLight::Point { position: Vec3::splat(0.5), intensity: Rgb::ONE });
    for scene in [plain(), lamp] {
        let world = world(scene).world;
        let lights = |seen: &[SurfacePoint]| light_pass(&world, &settings, seen, 8, &Control::new());
        let (aimed, even) = (lights(&floor()), lights(&[]));
        assert_eq!(aimed.photons.gain, 0.0);
        assert_eq!(aimed.photons.paths, even.photons.paths);
        for (a, b) in aimed.sets.iter().zip(&even.sets) {
            assert!(a.vpls == b.vpls && a.intensities == b.intensities);
        }
    }
}
