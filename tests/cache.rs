//! The radiance cache against lightcuts per pixel over the same virtual lights, and its invariants.

mod common;

use common::*;
use glam::Vec3;
use lightsplat::cache::{DirectLight, Footprints, LayerSettings};
use lightsplat::eye::Window;
use lightsplat::image::Image;
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::{Control, Output, cache, lightcuts};
use lightsplat::world::World;

fn settings(direct: DirectLight, footprints: Footprints) -> cache::Settings {
    let mut settings = cache::Settings::default();
    settings.light.indirect = 20_000;
    settings.cache.direct = direct;
    settings.cache.footprints = footprints;
    settings
}

fn render(world: &World, settings: &cache::Settings) -> Output {
    let output = cache::render(world, &Window::whole(world.scene.resolution), settings, &Control::new());
    assert!(output.complete && output.nonfinite == 0);
    output
}

/// Root mean square difference of luminance relative to the mean luminance of `b`.
fn rms(a: &Image, b: &Image) -> f32 {
    let n = a.pixels.len() as f32;
    let mean = b.pixels.iter().map(|p| luminance(*p)).sum::<f32>() / n;
    let squares = a.pixels.iter().zip(&b.pixels).map(|(a, b)| luminance(*a - *b).powi(2));
    (squares.sum::<f32>() / n).sqrt() / mean
}

/// Grey room lit by a square under its ceiling, with a ball in it.
fn lit_room() -> World {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.95), Vec3::new(0.0, -0.3, 0.0), 0.9), [96, 96]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    let lamp = quad(Vec3::new(-0.3, 0.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.2), 0.4, 32, wall));
    world(scene)
}

fn per_pixel(world: &World, like: &cache::Settings) -> Image {
    let mut settings = lightcuts::Settings { light: like.light, ..lightcuts::Settings::default() };
    settings.cut.epsilon = 0.005;
    lightcuts::render(world, &Window::whole(world.scene.resolution), &settings, &Control::new()).color
}

#[test]
fn records_agree_with_lightcuts_per_pixel_in_every_mode() {
    let world = lit_room();
    for (direct, limit) in [(DirectLight::PerSample, 0.02), (DirectLight::Records, 0.06)] {
        for footprints in [Footprints::Isotropic, Footprints::Anisotropic, Footprints::Occlusion] {
            let mut settings = settings(direct, footprints);
            if direct == DirectLight::Records {
                // Penumbrae are steep: at the default accuracy they are what the other mode is for.
                settings.cache.layers[0] = LayerSettings { accuracy: 0.1, reach: [0.7, 5.0] };
            }
            let error = rms(&render(&world, &settings).color, &per_pixel(&world, &settings));
            assert!(error < limit, "{direct:?} {footprints:?}: {error}");
        }
    }
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let world = lit_room();
    let settings = settings(DirectLight::Records, Footprints::Occlusion);
    let pictures = [1, 2, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&world, &settings).color.pixels)
    });
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
}

#[test]
fn far_fewer_records_than_eye_samples_and_growing_slower() {
    let world = lit_room();
    let records = |spp| {
        let mut settings = settings(DirectLight::PerSample, Footprints::Anisotropic);
        settings.spp = spp;
        match render(&world, &settings).stats.get("Cache/records, indirect") {
            Some(lightsplat::stats::Counter::Count(n)) => n as f64,
            other => panic!("{other:?}"),
        }
    };
    let (one, sixteen) = (records(1), records(16));
    assert!(one < 0.2 * 96.0 * 96.0, "{one} records");
    assert!(sixteen < 5.0 * one, "{one} records at 1 sample a pixel, {sixteen} at 16");
}
