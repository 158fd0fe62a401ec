//! Photons against what carries no noise: their flux from learned beginnings, and the light of many on a plane.

use super::aims::{Aims, CellYield};
use super::levels::levels;
use super::photons::{CausticPhoton, CausticTracer};
use super::*;
use base::sampling::{Sampler, owen_sobol_2d};
use scene::{Camera, DeltaLight};
use world::testkit::*;

#[test]
fn learned_beginnings_carry_the_flux_of_even_ones() {
    let mut scene = scene(Camera::default(), [1, 1]);
    let grey = add_material(&mut scene, diffuse(Rgb::ONE));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, grey));
    let lamp = quad(Vec3::new(-0.2, 0.9, -0.2), Vec3::X * 0.4, Vec3::Z * 0.4, grey);
    scene.meshes.push(emitting(lamp, Rgb::ONE));
    scene.lights.push(DeltaLight::Point { position: Vec3::new(0.5, 0.5, 0.5), intensity: Rgb::splat(0.1) });
    scene.lights.push(DeltaLight::Directional { direction: Vec3::NEG_Y, irradiance: Rgb::splat(0.1) });
    let world = world(scene);
    let emitter = PhotonEmitter::new(&world).expect("there are lamps");
    let even = Aims::even(&emitter);
    let wild = |cell: usize| CellYield { aimed: (cell % 7) as f32, photons: (cell % 3) as f32 };
    let learned = even.learned(&(0..even.cells()).map(wild).collect::<Vec<_>>(), 100.0);
    // Flux downwards, and all of it.
    let flux = |aims: &Aims| {
        let (mut down, mut all) = (0.0, 0.0);
        for path in 0..200_000 {
            let Some(aimed) = aims.sample(&mut Sampler::new(1, path)) else { continue };
            let flux = f64::from(luminance(aimed.emission.flux)) / 200_000.0;
            all += flux;
            down += if aimed.emission.ray.direction.y < -0.9 { flux } else { 0.0 };
        }
        (down, all)
    };
    let (expected, found) = (flux(&even), flux(&learned));
    assert!((found.0 / expected.0 - 1.0).abs() < 0.02, "{found:?} {expected:?}");
    assert!((found.1 / expected.1 - 1.0).abs() < 0.01, "{found:?} {expected:?}");
    assert!((expected.1 / f64::from(emitter.power()) - 1.0).abs() < 0.01, "{expected:?}");
}

/// Photons on the plane z = 0: `count` in the unit square, of flux 1 together, with discs of a radius.
fn on_plane(count: u32, radius: impl Fn(u32) -> f32) -> Vec<CausticPhoton> {
    let photon = |i| CausticPhoton {
        position: owen_sobol_2d(i, 1).extend(0.0),
        towards_light: Vec3::Z,
        flux: Rgb::splat(1.0 / count as f32),
        radiance: f32::INFINITY,
        edges: 2,
        radius: radius(i),
    };
    (0..count).map(photon).collect()
}

#[test]
fn discs_of_all_sizes_give_the_irradiance_of_their_photons() {
    // Some of them want discs smaller than any, and are thinned; some, larger ones.
    let photons = on_plane(20_000, |i| [0.005, 0.02, 0.05, 0.2, 0.3][i as usize % 5]);
    let levels = levels(&photons, |_| 0.16);
    assert!(levels.len() >= 4);
    let mut mean = 0.0;
    let visit = |point: Vec3, normal| {
        let mut sum = 0.0;
        levels.iter().for_each(|l| l.visit(point, normal, 0.16, |p, kernel| sum += p.flux.x * kernel));
        sum
    };
    for i in 0..500 {
        mean +=
            visit((Vec3::splat(0.35) + 0.3 * owen_sobol_2d(i, 2).extend(0.0)).with_z(0.0), Vec3::Z) / 500.0;
    }
    assert!((mean - 1.0).abs() < 0.03, "{mean}");
    // Walls across the plane, and places above it, have none but those near.
    assert_eq!(visit(Vec3::new(0.5, 0.5, 0.2), Vec3::Z), 0.0);
    assert!(visit(Vec3::new(0.5, 0.5, 0.0), Vec3::X) < 0.9);
}

#[test]
fn photons_come_by_mirrors_and_glass_alone_and_scenes_without_have_none() {
    let lamp_room = |ball| {
        let mut scene = scene(Camera::default(), [1, 1]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, grey));
        let ball = add_material(&mut scene, ball);
        scene.meshes.push(sphere(Vec3::ZERO, 0.3, 96, ball));
        scene.lights.push(DeltaLight::Point { position: Vec3::new(0.0, 0.8, 0.0), intensity: Rgb::ONE });
        world(scene)
    };
    let control = Control::new();
    let none = PilotPaths::new(&lamp_room(diffuse(Rgb::ONE)), 16, 0, u32::MAX, &control);
    assert_eq!(none.paths(), 0);
    let world = lamp_room(glass(1.5));
    let emitter = PhotonEmitter::new(&world).expect("there is a lamp");
    let tracer = |max_edges| CausticTracer::new(&world, &emitter, 0, max_edges, &control);
    let pilot = tracer(u32::MAX).pilot(256);
    let photons = |factor: f32, max_edges: u32| tracer(max_edges).photons(&pilot, factor);
    let traced = photons(1.0, u32::MAX);
    // All light on the ball leaves it in the end.
    let cos = (1.0f32 - (0.3f32 / 0.8).powi(2)).sqrt();
    let expected = 2.0 * PI * (1.0 - cos);
    let flux: f32 = traced.photons.iter().map(|photon| luminance(photon.flux)).sum();
    assert!((flux / expected - 1.0).abs() < 0.02, "{flux} {expected}");
    let on_wall = |photon: &CausticPhoton| (photon.position.abs().max_element() - 1.0).abs() < 1e-4;
    assert!(traced.photons.iter().all(|photon| on_wall(photon) && photon.edges >= 2));
    assert!(traced.photons.iter().any(|photon| photon.edges == 2), "the ball reflects");
    assert!(traced.photons.iter().any(|photon| photon.edges == 3), "the ball refracts");
    let short = photons(1.0, 2);
    assert!(!short.photons.is_empty() && short.photons.iter().all(|photon| photon.edges == 2));
    // Fewer are the first of them, and of the same flux.
    let few = photons(0.25, u32::MAX);
    let flux_of_few: f32 = few.photons.iter().map(|photon| luminance(photon.flux)).sum();
    assert!((flux_of_few / flux - 1.0).abs() < 0.03, "{flux_of_few} {flux}");
    let places = |photons: &[CausticPhoton]| photons.iter().map(|photon| photon.position).collect::<Vec<_>>();
    assert!(3 * few.photons.len() < traced.photons.len());
    assert_eq!(places(&few.photons), places(&traced.photons[..few.photons.len()]));
}

#[test]
fn pilot_paths_follow_the_size_of_the_film_up_to_256x256() {
    let tasks = [1, 24, 128, 256, 16_384].map(|side: u64| pilot_tasks(side * side));
    assert_eq!(tasks, [16, 16, 64, 256, 256]);
}
