//! Noise of direct light by many lamps.

use crate::kit::*;
use crate::oracle::{mean_luminance, mean_square};
use crate::presets::direct_only;
use glam::Vec3;
use lightsplat::math::Rgb;
use lightsplat::method::path::Settings;
use lightsplat::method::vpl;
use lightsplat::scene::{DeltaLight, Environment};

/// Number of rooms along each side of the building.
const ROOMS: usize = 3;

/// A building of rooms without doors or roof, from above, with `count` lamps under its eaves: rectangles that face
/// down, point and spot lights, of powers over an order of magnitude, a watt together.
fn building(count: usize, size: u32) -> WorldAndView {
    let side = ROOMS as f32;
    let above =
        camera(Vec3::new(0.5 * side, 3.5 * side, 0.49 * side), Vec3::new(0.5 * side, 0.0, 0.5 * side), 0.2);
    let mut scene = scene(above, [size, size]);
    let wall = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
    scene.meshes.push(quad(Vec3::ZERO, Vec3::Z * side, Vec3::X * side, wall));
    for i in 0..=ROOMS {
        let i = i as f32;
        scene.meshes.push(quad(Vec3::X * i, Vec3::Y, Vec3::Z * side, wall));
        scene.meshes.push(quad(Vec3::Z * i, Vec3::Y, Vec3::X * side, wall));
    }
    // Numbers that fill the unit interval evenly.
    let number = |i: usize, step: f32| (i as f32 * step).fract();
    let powers: Vec<f32> = (0..count).map(|i| 10f32.powf(number(i, 0.618_034))).collect();
    let total: f32 = powers.iter().sum();
    for (i, power) in powers.iter().enumerate() {
        let power = power / total;
        let (x, z, size) = (number(i, 0.754_877_7), number(i, 0.569_840_3), number(i, 0.414_213_6));
        let size = 0.02 + 0.05 * size;
        // Every room has as many lamps, away from its walls.
        let room = Vec3::new((i % ROOMS) as f32, 0.0, (i / ROOMS % ROOMS) as f32);
        let corner = room + Vec3::new(0.2 + 0.55 * x, 0.9, 0.2 + 0.55 * z);
        match i / (ROOMS * ROOMS) % 3 {
            1 => scene.lights.push(DeltaLight::Point {
                position: corner,
                intensity: Rgb::splat(power / (4.0 * std::f32::consts::PI)),
            }),
            2 => scene.lights.push(DeltaLight::Spot {
                position: corner,
                direction: Vec3::NEG_Y,
                intensity: Rgb::splat(power),
                inner_angle: 0.4,
                outer_angle: 0.7,
                image: None,
            }),
            _ => {
                let radiance = power / (std::f32::consts::PI * size * size);
                let lamp = quad(corner, Vec3::X * size, Vec3::Z * size, wall);
                scene.meshes.push(emitting(lamp, Rgb::splat(radiance)));
            }
        }
    }
    world(scene)
}

/// Standard error of 64 samples per pixel, relative to the mean of the image.
fn relative_error(count: usize) -> f32 {
    let world = building(count, 24);
    let settings = Settings { spp: 64, max_depth: Some(2), ..Settings::default() };
    let output = rendered(&world, &settings);
    let variance = mean_luminance(output.variance.as_ref().expect("more than one sample"));
    variance.sqrt() / mean_luminance(&output.color)
}

#[test]
fn noise_hardly_grows_with_the_number_of_lamps() {
    let [one_a_room, ten_a_room, many] = [9, 90, 900].map(relative_error);
    // With one lamp a room nothing but its shape and shadow is noisy.
    assert!(many < 2.0 * one_a_room, "{one_a_room} with 9 lamps, {many} with 900");
    assert!(many < 1.2 * ten_a_room, "{ten_a_room} with 90 lamps, {many} with 900");
}

#[test]
fn lamps_of_other_rooms_are_hardly_sampled_once_learned() {
    let world = building(900, 96);
    let reference = image(&world, &Settings { spp: 512, max_depth: Some(2), ..Settings::default() });
    let mut by_cache = vpl::Settings { spp: 16, max_depth: Some(2), seed: 5, ..direct_only() };
    by_cache.cache.extra_samples = 0.0;
    let settings = Settings { spp: 16, max_depth: Some(2), seed: 5, ..Settings::default() };
    let [learned, plain] = [image(&world, &by_cache), image(&world, &settings)];
    let [mean, expected] = [&learned, &reference].map(mean_luminance);
    assert!((mean / expected - 1.0).abs() < 0.01, "{mean} {expected}");
    let [learned, plain] = [learned, plain].map(|image| mean_square(&image, &reference).sqrt());
    assert!(learned < 0.9 * plain, "{learned} {plain}");
}

#[test]
fn a_weak_lamp_lights_a_closed_room_under_a_bright_sky() {
    let room = |sky: f32| {
        let mut scene = scene(camera(Vec3::new(0.5, 0.5, 0.95), Vec3::new(0.5, 0.4, 0.0), 1.0), [16, 16]);
        let wall = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        let sides =
            [(Vec3::ZERO, Vec3::Z, Vec3::X), (Vec3::ZERO, Vec3::X, Vec3::Y), (Vec3::ZERO, Vec3::Y, Vec3::Z)];
        for (corner, u, v) in sides {
            scene.meshes.push(quad(corner, u, v, wall));
            scene.meshes.push(quad(Vec3::ONE, -u, -v, wall));
        }
        let lamp = quad(Vec3::new(0.4, 0.99, 0.4), Vec3::X * 0.2, Vec3::Z * 0.2, wall);
        scene.meshes.push(emitting(lamp, Rgb::splat(1e-4)));
        if sky > 0.0 {
            scene.environment = Some(Environment::Constant(Rgb::splat(sky)));
        }
        world(scene)
    };
    let [dark, bright] = [room(0.0), room(1.0)];
    for (name, method) in small_methods() {
        let [alone, beside] = [&dark, &bright].map(|world| mean_luminance(&image(world, method.renderer())));
        assert!((beside / alone - 1.0).abs() < 0.08, "{name}: {beside} beside a sky, {alone} without");
    }
}
