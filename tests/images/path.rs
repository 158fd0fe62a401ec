//! The path tracer against scenes with solutions in closed form.

use crate::kit::*;
use crate::oracle::{assert_crop_repeats, assert_means_within, mean, on_threads};
use glam::{DVec3, Vec3};
use lightsplat::film::{Image, Window};
use lightsplat::math::Rgb;
use lightsplat::method::Output;
use lightsplat::method::path::Settings;
use lightsplat::method::render;
use lightsplat::progress::Control;
use lightsplat::scene::{DeltaLight, Environment, Scene};
use lightsplat::view::View;

/// Asserts that every pixel is within `sigmas` of its own standard error (plus rounding) of `expected`, and
/// the mean closer still.
fn assert_all_near(output: &Output, expected: Rgb, sigmas: f32) {
    let variance = output.variance.as_ref().expect("more than one sample");
    for (value, variance) in output.color.pixels.iter().zip(&variance.pixels) {
        for c in 0..3 {
            let allowed = sigmas * variance[c].sqrt() + 1e-4 * expected[c];
            assert!((value[c] - expected[c]).abs() <= allowed, "{value} against {expected}, {variance}");
        }
    }
}

/// A closed room of albedo ρ whose walls all emit L: radiance L/(1-ρ) everywhere.
fn furnace(albedo: Rgb, inside: impl FnOnce(&mut SceneAndView)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.3, 0.2, 0.8), Vec3::ZERO, 0.7), [8, 8]);
    let wall = add_material(&mut scene, diffuse(albedo));
    for mesh in room(Vec3::splat(-1.0), Vec3::ONE, wall) {
        scene.meshes.push(emitting(mesh, Rgb::new(1.0, 0.5, 2.0)));
    }
    inside(&mut scene);
    world(scene)
}

#[test]
fn furnace_has_the_radiance_of_the_geometric_series() {
    let albedo = Rgb::new(0.5, 0.8, 0.2);
    let world = furnace(albedo, |_| {});
    let output = rendered(&world, &Settings { spp: 1024, ..Settings::default() });
    let expected = Rgb::new(1.0, 0.5, 2.0) / (Rgb::ONE - albedo);
    assert_all_near(&output, expected, 5.0);
    assert_means_within(0.005, mean(&output.color), expected.as_dvec3(), "furnace");
}

#[test]
fn glass_and_mirrors_vanish_in_a_furnace() {
    let albedo = Rgb::splat(0.5);
    let world = furnace(albedo, |scene| {
        let clear = add_material(scene, glass(1.5));
        let silver = add_material(scene, mirror());
        scene.meshes.push(sphere(Vec3::new(0.0, 0.0, -0.1), 0.3, 24, clear));
        scene.meshes.push(sphere(Vec3::new(0.5, 0.3, -0.3), 0.2, 24, silver));
    });
    let image = image(&world, &Settings { spp: 1024, ..Settings::default() });
    let expected = Rgb::new(1.0, 0.5, 2.0) / (Rgb::ONE - albedo);
    assert_means_within(0.01, mean(&image), expected.as_dvec3(), "glass and mirrors");
}

#[test]
fn paths_end_at_the_given_depth() {
    let albedo = Rgb::splat(0.5);
    let emitted = Rgb::new(1.0, 0.5, 2.0);
    let world = furnace(albedo, |_| {});
    for (depth, sum) in [(1, 1.0), (2, 1.5), (3, 1.75)] {
        let settings = Settings { spp: 256, max_depth: Some(depth), ..Settings::default() };
        let expected = (emitted * sum).as_dvec3();
        assert_means_within(0.01, mean(&image(&world, &settings)), expected, &format!("depth {depth}"));
    }
}

/// A floor of albedo ρ seen from above, one light over it.
fn floor_under(light: impl FnOnce(&mut Scene)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 1.0, 0.0), Vec3::ZERO, 1e-3), [4, 4]);
    let floor = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
    scene.meshes.push(quad(Vec3::new(-5.0, 0.0, -5.0), Vec3::Z * 10.0, Vec3::X * 10.0, floor));
    light(&mut scene);
    world(scene)
}

fn expect_floor(world: &WorldAndView, irradiance: f32) {
    let image = image(world, &Settings { spp: 4096, max_depth: Some(2), ..Settings::default() });
    let expected = DVec3::splat(0.6 / std::f64::consts::PI * f64::from(irradiance));
    assert_means_within(0.003, mean(&image), expected, "floor");
}

#[test]
fn point_spot_and_directional_lights_give_the_irradiance_of_their_definition() {
    let position = Vec3::new(0.0, 2.0, 1.5);
    let (dist_sq, cos) = (6.25, 2.0 / 2.5);
    let intensity = Rgb::splat(10.0);
    let world = floor_under(|s| s.lights.push(DeltaLight::Point { position, intensity }));
    expect_floor(&world, 10.0 * cos / dist_sq);

    let aim = -position.normalize();
    let spot = |direction: Vec3| DeltaLight::Spot {
        position,
        direction,
        intensity,
        inner_angle: 0.2,
        outer_angle: 0.4,
        image: None,
    };
    expect_floor(&floor_under(|s| s.lights.push(spot(aim))), 10.0 * cos / dist_sq);
    // Aimed 0.3 rad aside, half-way through the falloff.
    let aside = glam::Quat::from_rotation_x(0.3) * aim;
    expect_floor(&floor_under(|s| s.lights.push(spot(aside))), 5.0 * cos / dist_sq);

    let sun = DeltaLight::Directional { direction: aim, irradiance: Rgb::splat(3.0) };
    expect_floor(&floor_under(|s| s.lights.push(sun)), 3.0 * cos);
}

#[test]
fn area_lights_and_the_sky_give_the_irradiance_of_their_solid_angle() {
    // A square of half-width h at height d, parallel: E = 4 L h²-form factor (Howell C-11 applied to four corners).
    let (h, d) = (0.5f32, 2.0f32);
    let world = floor_under(|s| {
        let black = add_material(s, diffuse(Rgb::ZERO));
        let lamp = quad(Vec3::new(-h, d, -h), Vec3::X * 2.0 * h, Vec3::Z * 2.0 * h, black);
        s.meshes.push(emitting(lamp, Rgb::splat(7.0)));
    });
    let a = h / d;
    let quarter = 2.0 * a / (1.0 + a * a).sqrt() * (a / (1.0 + a * a).sqrt()).atan();
    expect_floor(&world, 7.0 * 4.0 * 0.5 * quarter);

    let world = floor_under(|s| s.environment = Some(Environment::Constant(Rgb::splat(0.8))));
    expect_floor(&world, 0.8 * std::f32::consts::PI);
}

#[test]
fn one_sided_lights_shine_only_forward() {
    let world = floor_under(|s| {
        let black = add_material(s, diffuse(Rgb::ZERO));
        let lamp = quad(Vec3::new(-0.5, 2.0, -0.5), Vec3::Z, Vec3::X, black);
        s.meshes.push(emitting(lamp, Rgb::splat(7.0)));
    });
    assert_eq!(mean(&image(&world, &Settings { spp: 64, ..Settings::default() })), DVec3::ZERO);
}

#[test]
fn empty_scenes_and_the_void_are_black() {
    let empty = world(scene(camera(Vec3::ZERO, Vec3::X, 1.0), [3, 2]));
    assert_eq!(image(&empty, &Settings { spp: 2, ..Settings::default() }), Image::new(3, 2));
}

#[test]
fn bits_do_not_depend_on_threads_and_crops_repeat_the_picture() {
    let world = furnace(Rgb::new(0.5, 0.8, 0.2), |scene| {
        let clear = add_material(scene, glass(1.5));
        scene.view.window = Window::whole([37, 21]);
        scene.meshes.push(sphere(Vec3::new(0.0, 0.0, -0.1), 0.3, 24, clear));
    });
    let settings = Settings { spp: 20, ..Settings::default() };
    let run = |threads: usize, view: &View| on_threads(threads, || rendered_view(&world, view, &settings));
    let one = run(1, &world.view);
    for threads in [2, 4] {
        let many = run(threads, &world.view);
        assert_eq!(one.color, many.color);
        assert_eq!(one.variance, many.variance);
    }
    let window = Window { offset: [5, 3], width: 19, height: 2, ..world.view.window };
    let crop = run(2, &View { window, ..world.view });
    assert_crop_repeats(&one.color, &crop.color, &window, "crop");
}

#[test]
fn a_cancelled_render_says_so() {
    let world = furnace(Rgb::splat(0.5), |_| {});
    let control = Control::new();
    control.cancel();
    let output = render(&world, &world.view, &Settings::default(), &control);
    assert!(!output.complete);
    assert_eq!(output.color, Image::new(8, 8));
}
