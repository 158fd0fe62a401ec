//! Pictures by lightcuts against closed forms and the path tracer.

use crate::kit::*;
use crate::oracle::{assert_crop_repeats, assert_means_within, mean, on_threads};
use glam::Vec3;
use lightsplat::film::{Image, Window};
use lightsplat::math::Rgb;
use lightsplat::method::LightPassSettings;
use lightsplat::method::vpl::Settings;
use lightsplat::method::{path, render};
use lightsplat::progress::Control;
use lightsplat::scene::{DeltaLight, Environment, Lobe, Material, Scene};
use lightsplat::view::View;

/// Settings with few lights: `indirect` virtual ones, and 512 points on emitters.
fn small(indirect: u32) -> Settings {
    Settings { light: LightPassSettings { direct: 512, indirect, seed: 0 }, ..Settings::lightcuts() }
}

/// The image by `spp` paths per pixel.
fn reference(world: &WorldAndView, spp: u32) -> Image {
    image(world, &path::Settings { spp, ..path::Settings::default() })
}

/// A floor seen from above under one light.
fn floor_under(light: impl FnOnce(&mut Scene)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 3.0, 0.1), Vec3::ZERO, 0.3), [8, 8]);
    let floor = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.push(quad(Vec3::new(-9.0, 0.0, -9.0), Vec3::Z * 18.0, Vec3::X * 18.0, floor));
    light(&mut scene);
    world(scene)
}

#[test]
fn lights_without_a_surface_are_exact() {
    let lights = [
        DeltaLight::Point { position: Vec3::new(0.5, 1.0, 0.0), intensity: Rgb::new(1.0, 2.0, 3.0) },
        DeltaLight::Spot {
            position: Vec3::new(0.0, 2.0, 0.5),
            direction: Vec3::new(0.0, -1.0, -0.25).normalize(),
            intensity: Rgb::new(3.0, 2.0, 1.0),
            inner_angle: 0.1,
            outer_angle: 0.5,
            image: None,
        },
        DeltaLight::Directional {
            direction: Vec3::new(1.0, -1.0, 0.0).normalize(),
            irradiance: Rgb::new(1.0, 0.5, 0.2),
        },
    ];
    for light in lights {
        let world = floor_under(|scene| scene.lights.push(light));
        let (a, b) = (image(&world, &Settings { spp: 64, ..Settings::lightcuts() }), reference(&world, 64));
        for (a, b) in a.pixels.iter().zip(&b.pixels) {
            // Both average over the same positions of a pixel.
            assert!((*a - *b).abs().max_element() <= 0.01 * b.max_element() + 1e-6, "{light:?}: {a} {b}");
        }
    }
}

#[test]
fn a_floor_under_a_uniform_sky_reflects_its_albedo() {
    let world = floor_under(|scene| scene.environment = Some(Environment::Constant(Rgb::new(1.0, 2.0, 0.5))));
    for pixel in &image(&world, &Settings::lightcuts()).pixels {
        let error = (*pixel / (0.5 * Rgb::new(1.0, 2.0, 0.5)) - Rgb::ONE).abs().max_element();
        assert!(error < 0.03, "{pixel}");
    }
}

#[test]
fn pictures_agree_with_path_tracing() {
    let glossy = Material {
        lobes: vec![Lobe::Rough {
            distribution: lightsplat::scene::Distribution::Ggx,
            alpha: 0.4.into(),
            fresnel: lightsplat::scene::Fresnel::One,
            scale: lightsplat::scene::Reflectance::Constant(Rgb::splat(0.3)),
        }],
        ..diffuse(Rgb::splat(0.3))
    };
    for ball in [None, Some(diffuse(Rgb::splat(0.5))), Some(glossy)] {
        let name = format!("{ball:?}");
        let world = room_with_ball(ball);
        let light = LightPassSettings { direct: 2048, indirect: 60_000, seed: 0 };
        let image = image(&world, &Settings { spp: 4, light, ..Settings::lightcuts() });
        let ratio = mean(&image) / mean(&reference(&world, 256));
        // Clamping in the creases may lose a little; nothing may be gained.
        assert!(ratio.min_element() > 0.96 && ratio.max_element() < 1.02, "{name}: {ratio}");
    }
}

#[test]
fn the_eye_sees_through_mirrors() {
    let sky = Rgb::new(1.0, 2.0, 0.5);
    let world = floor_under(|scene| scene.environment = Some(Environment::Constant(sky)));
    let mut scene = staged(world);
    scene.materials[0] = mirror();
    let world = crate::kit::world(scene);
    for pixel in &image(&world, &Settings::lightcuts()).pixels {
        assert!((*pixel - sky).abs().max_element() < 1e-5, "{pixel}");
    }
}

#[test]
fn a_room_of_any_size_looks_the_same() {
    let at_scale = |s: f32| {
        let mut scene = staged(room_with_ball(Some(diffuse(Rgb::splat(0.5)))));
        scene.meshes.iter_mut().flat_map(|m| &mut m.positions).for_each(|p| *p *= s);
        scene.view.camera.origin *= s;
        image(&crate::kit::world(scene), &small(20_000))
    };
    let unit = at_scale(1.0);
    for s in [1e-6, 1e-3, 1e3, 1e6] {
        let image = at_scale(s);
        assert_means_within(0.005, mean(&image), mean(&unit), &format!("scale {s}"));
    }
    assert_eq!(at_scale(1024.0), unit, "powers of two change nothing");
}

#[test]
fn the_picture_is_the_same_for_any_number_of_threads() {
    let world = room_with_ball(Some(mirror()));
    let with = |threads| on_threads(threads, || rendered(&world, &small(30_000)));
    let one = with(1);
    for threads in [2, 4] {
        let other = with(threads);
        assert!(one.color == other.color && one.extra == other.extra, "{threads} threads");
        assert!(one.stats.counters().eq(other.stats.counters()), "{threads} threads");
    }
}

#[test]
fn a_crop_repeats_the_whole_pictures_pixels() {
    let world = room_with_ball(None);
    let whole = image(&world, &small(5000));
    let window = Window { film: [32, 32], offset: [5, 9], width: 7, height: 4 };
    let crop = rendered_view(&world, &View { window, ..world.view }, &small(5000)).color;
    assert_crop_repeats(&whole, &crop, &window, "crop");
}

#[test]
fn nothing_to_see_and_nothing_that_shines_is_black() {
    let void = world(scene(camera(Vec3::ZERO, Vec3::Z, 1.0), [3, 1]));
    let is_black = |world| image(world, &Settings::lightcuts()).pixels.iter().all(|p| *p == Rgb::ZERO);
    assert!(is_black(&void) && is_black(&floor_under(|_| ())));
    let only_light = {
        let mut s = scene(camera(Vec3::ZERO, Vec3::Z, 1.0), [3, 1]);
        s.lights.push(DeltaLight::Point { position: Vec3::X, intensity: Rgb::ONE });
        world(s)
    };
    rendered(&only_light, &Settings::lightcuts());
}

#[test]
fn a_cancelled_picture_says_so() {
    let world = room_with_ball(None);
    let control = Control::new();
    control.cancel();
    let output = render(&world, &world.view, &Settings::lightcuts(), &control);
    assert!(!output.complete);
    assert_eq!(output.color.pixels.len(), 32 * 32);
}

#[test]
fn polished_metal_is_followed_from_the_eye() {
    let facets = |alpha| Lobe::Rough {
        distribution: lightsplat::scene::Distribution::Ggx,
        alpha: lightsplat::scene::Roughness::Constant(alpha),
        fresnel: lightsplat::scene::Fresnel::One,
        scale: lightsplat::scene::Reflectance::Constant(Rgb::splat(0.8)),
    };
    let ball = |alpha| Material { lobes: vec![facets(alpha)], ..diffuse(Rgb::ZERO) };
    for alpha in [0.06, 0.1] {
        let mut scene = staged(room_with_ball(Some(ball(alpha))));
        scene.lights.push(DeltaLight::Point { position: Vec3::new(0.5, 0.5, 0.7), intensity: Rgb::ONE });
        let world = world(scene);
        let expected = mean(&reference(&world, 256));
        let found = mean(&image(&world, &Settings { spp: 16, ..Settings::lightcuts() }));
        assert_means_within(0.03, found, expected, &format!("α {alpha}"));
    }
}

#[test]
fn very_many_eye_rays_are_averaged_in_parts() {
    let world = floor_under(|scene| {
        let intensity = Rgb::new(1.0, 2.0, 3.0);
        scene.lights.push(DeltaLight::Point { position: Vec3::new(0.5, 1.0, 0.0), intensity });
    });
    let [few, many] =
        [1024, 1500].map(|spp| mean(&image(&world, &Settings { spp, ..Settings::lightcuts() })));
    assert_means_within(1e-3, few, many, "1024 and 1500 samples");
}
