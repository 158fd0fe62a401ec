//! Light lost by clamping and recovered by short rays.

use crate::kit::*;
use crate::oracle::{mean, mean_square, sum};
use crate::presets::by_records;
use glam::{DVec3, Vec2, Vec3};
use lightsplat::film::Image;
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::{FoundBy, Output, path, vpl};

/// Side of the film in pixels.
const SIZE: u32 = 64;

/// Images by all methods of indirect light, with compensation or without it.
fn outputs(world: &WorldAndView, vpls: u32, compensation: bool) -> Vec<(&'static str, Output)> {
    let records = vpl::Settings { spp: 4, compensation, ..by_records(vpls) };
    let mut shared = records;
    shared.cache.indirect = FoundBy::Cuts;
    let mut alone = shared;
    alone.share = false;
    let mut cuts = vpl::Settings { compensation, ..vpl::Settings::lightcuts() };
    cuts.light.indirect = vpls;
    vec![
        ("shared", rendered(world, &shared)),
        ("records", rendered(world, &records)),
        ("alone", rendered(world, &alone)),
        ("lightcuts", rendered(world, &cuts)),
    ]
}

/// Tests that radiance is emitted / (1 - albedo) everywhere, in creases too.
#[test]
fn the_furnace_is_white_although_close_lights_are_clamped() {
    // The light is even, so that few pixels are enough.
    let world = own("furnace", SIZE / 2);
    let error = |output: &Output| (mean(&output.color) / 0.8 - DVec3::ONE).abs().max_element();
    for ((name, with), (_, without)) in
        outputs(&world, 10_000, true).iter().zip(&outputs(&world, 10_000, false))
    {
        let (with, without) = (error(with), error(without));
        assert!(with < 0.01 && with < without, "{name}: {with}, without {without}");
    }
}

/// Compares the surfaces along the creases of a room with path tracing.
#[test]
fn creases_are_as_bright_as_paths_make_them() {
    let (scene, _) = lit_room(camera(Vec3::new(0.0, 0.2, 0.98), Vec3::new(0.0, -0.8, -0.2), 0.8), SIZE);
    let world = world(scene);
    let in_crease = |i: u32| {
        let ray = world.view.primary_ray([i % SIZE, i / SIZE], Vec2::splat(0.5));
        let p = world.intersect(&ray).expect("the room is closed").position.abs();
        p.min_element().max(p.x.min(p.z)).max(p.y.min(p.x.max(p.z))) > 0.95
    };
    let crease: Vec<bool> = (0..SIZE * SIZE).map(in_crease).collect();
    let count = crease.iter().filter(|crease| **crease).count();
    assert!(count > 150, "{count}");
    let of = |image: &Image| {
        let pixels = image.pixels.iter().zip(&crease).filter(|(_, crease)| **crease);
        pixels.map(|(p, _)| luminance(*p)).sum::<f32>() / count as f32
    };
    // Few virtual lights: much is clamped.
    let paths = path::Settings { spp: 256, ..Default::default() };
    let truth = of(&image(&world, &paths));
    for ((name, with), (_, without)) in outputs(&world, 3000, true).iter().zip(&outputs(&world, 3000, false))
    {
        let (ratio, lacking) = (of(&with.color) / truth, of(&without.color) / truth);
        assert!((ratio - 1.0).abs() < 0.03 && lacking < 0.9, "{name}: {ratio}, without {lacking}");
        if *name != "records" {
            let percent = |what: &str| sum(&with.stats, &format!("Lightcut/{what} [%]")).expect("a share");
            let (lost, found) =
                (percent("light lost to clamping"), percent("light found again by short rays"));
            assert!(lost > 1.0 && (found / lost - 1.0).abs() < 0.3, "{name}: {lost} % lost, {found} % found");
        }
    }
}

/// Compares surfaces so close to a lamp that one virtual light would outshine all others with path tracing.
#[test]
fn surfaces_beside_lamps_are_as_bright_as_paths_make_them() {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.0, 0.0, -0.9), 1.0), [96, 96]);
    let wall = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    // A window that meets four walls.
    let window = quad(Vec3::new(-1.0, -1.0, -0.99), Vec3::X * 2.0, Vec3::Y * 2.0, wall);
    scene.meshes.push(emitting(window, Rgb::ONE));
    let world = world(scene);
    let paths = path::Settings { spp: 64, ..Default::default() }; // noise: .02
    let truth = image(&world, &paths);
    let brightest = |image: &Image| image.pixels.iter().map(|p| p.max_element()).fold(0.0, f32::max);
    let error = |compensation: bool| {
        let mut settings = vpl::Settings { compensation, ..vpl::Settings::reconstruction() };
        settings.light.direct = 256;
        settings.light.indirect = 10_000;
        let image = image(&world, &settings);
        (mean_square(&image, &truth).sqrt(), brightest(&image))
    };
    let ((with, most), (without, _)) = (error(true), error(false));
    assert!(with < 0.03 && with < 0.5 * without && most < 1.5, "{with}, without {without}; brightest {most}");
}
