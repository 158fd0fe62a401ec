//! Photon mapping with radiance caching against path tracing, and its invariants.

use crate::kit::*;
use crate::oracle::{assert_means_within, count, mean, on_threads};
use glam::{DVec3, Vec3};
use lightsplat::film::Image;
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::path;
use lightsplat::method::vpl::{GatheringSettings, Settings};

const SIZE: u32 = 64;

fn small() -> Settings {
    with(30_000, 500)
}

/// Settings with so many photons, and so many rays per record.
fn with(photons: u32, rays: u32) -> Settings {
    let gathering = GatheringSettings { photons, rays, own_rays: 64, ..Default::default() };
    Settings { gathering, ..Settings::photon_cache() }
}

/// A room with a box on its floor.
fn boxed_room() -> WorldAndView {
    let mut scene = scene(room_camera(), [SIZE; 2]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    for mut side in room(Vec3::new(-0.6, -1.0, -0.5), Vec3::new(0.0, -0.4, 0.1), wall) {
        side.triangles.iter_mut().for_each(|t| t.reverse());
        scene.meshes.push(side);
    }
    let lamp = quad(Vec3::new(-0.1, 0.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    world(scene)
}

/// Luminance of blocks of 4 x 4 pixels, whose edges both methods resolve equally.
fn blocks(image: &Image) -> Vec<f64> {
    let n = SIZE as usize / 4;
    let block = |i: usize| {
        let pixel = |j: usize| (i / n * 4 + j / 4) * SIZE as usize + i % n * 4 + j % 4;
        (0..16).map(|j| f64::from(luminance(image.pixels[pixel(j)]))).sum::<f64>() / 16.0
    };
    (0..n * n).map(block).collect()
}

#[test]
fn it_converges_to_the_path_tracer_as_photons_and_rays_grow() {
    let world = boxed_room();
    let reference = blocks(&image(&world, &path::Settings { spp: 1024, ..Default::default() }));
    let mean = reference.iter().sum::<f64>() / reference.len() as f64;
    let errors = [(3_000, 100), (100_000, 2000)].map(|(photons, rays)| {
        let found = blocks(&image(&world, &Settings { spp: 4, ..with(photons, rays) }));
        let bias = found.iter().sum::<f64>() / reference.len() as f64 / mean - 1.0;
        let squares = found.iter().zip(&reference).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        ((squares / reference.len() as f64).sqrt() / mean, bias)
    });
    let [(coarse, _), (fine, bias)] = errors;
    assert!(bias.abs() < 0.01 && fine < 0.02 && fine < 0.5 * coarse, "{errors:?}");
}

/// Tests that radiance is emitted / (1 - albedo) everywhere.
#[test]
fn the_furnace_is_white() {
    let image = image(&own("furnace", SIZE), &with(100_000, 500));
    assert_means_within(0.01, mean(&image), DVec3::splat(0.8), "furnace");
    let mut errors: Vec<f32> =
        image.pixels.iter().map(|p| (*p / 0.8 - Rgb::ONE).abs().max_element()).collect();
    errors.sort_by(f32::total_cmp);
    let large = errors[errors.len() * 99 / 100];
    assert!(large < 0.1, "{large}");
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let world = boxed_room();
    let images = [1, 2, 3].map(|threads| on_threads(threads, || image(&world, &small())));
    assert!(images[0] == images[1] && images[0] == images[2]);
}

#[test]
fn scenes_without_light_or_without_surfaces_are_black() {
    let mut dark = staged(boxed_room());
    dark.meshes.iter_mut().for_each(|mesh| mesh.emission = None);
    let mut empty = dark.clone();
    empty.meshes.clear();
    for scene in [dark, empty] {
        assert!(image(&world(scene), &small()).pixels.iter().all(|p| *p == Rgb::ZERO));
    }
}

#[test]
fn what_it_took_is_counted() {
    let world = boxed_room();
    let output = rendered(&world, &small());
    let [photons, records, of_records, of_samples, samples] = [
        "Photons/total",
        "Cache/records, indirect",
        "Gathering/rays of records",
        "Gathering/rays of samples",
        "Shading/tasks by gathering",
    ]
    .map(|name| count(&output.stats, name).unwrap_or_else(|| panic!("{name}")) as f64);
    assert!((0.8..1.25).contains(&(photons / 30_000.0)), "{photons} photons");
    assert!(
        (0.8..1.25).contains(&(of_records / (500.0 * records))),
        "{of_records} rays of {records} records"
    );
    assert_eq!(of_samples, 64.0 * samples);
}
