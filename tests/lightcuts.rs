//! Lightcuts and light pass against closed forms, the full sum, and the path tracer.

mod common;

use common::*;
use glam::{Vec2, Vec3};
use lightsplat::film::Image;
use lightsplat::film::Window;
use lightsplat::light_tree::{Family, LightTrees};
use lightsplat::lightcut::{
    CutSettings, Lightcut, PacketLightcut, Receiver, ReceiverPacket, Transfer, gather_all,
};
use lightsplat::math::{Frame, Rgb, luminance};
use lightsplat::method::lightcuts::{Settings, render};
use lightsplat::method::{Output, path};
use lightsplat::progress::Control;
use lightsplat::scene::{DeltaLight, Environment, Lobe, Material, Scene};
use lightsplat::view::View;
use lightsplat::vpl::{LightPassSettings, Origin, light_pass};
use std::f32::consts::PI;

fn mean(image: &Image) -> Rgb {
    image.pixels.iter().copied().sum::<Rgb>() / image.pixels.len() as f32
}

fn lightcuts(world: &WorldAndView, settings: &Settings) -> Output {
    render(world, &world.view, settings, &Control::new())
}

fn reference(world: &WorldAndView, spp: u32) -> Output {
    let settings = path::Settings { spp, ..path::Settings::default() };
    path::render(world, &world.view, &settings, &Control::new())
}

/// Grey room lit by a square under its ceiling, with a ball in it.
fn lit_room(ball: Option<Material>) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.95), Vec3::new(0.0, -0.3, 0.0), 0.9), [32, 32]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    let corner = Vec3::new(-0.3, 0.99, -0.3);
    let lamp = quad(corner, Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    if let Some(material) = ball {
        let material = add_material(&mut scene, material);
        scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.2), 0.4, 32, material));
    }
    world(scene)
}

#[test]
fn vpls_of_a_furnace_give_the_irradiance_of_the_geometric_series() {
    let albedo = Rgb::new(0.5, 0.8, 0.2);
    let emitted = Rgb::new(1.0, 0.5, 2.0);
    let mut scene = scene(camera(Vec3::ZERO, Vec3::Z, 1.0), [1, 1]);
    let wall = add_material(&mut scene, diffuse(albedo));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall).into_iter().map(|m| emitting(m, emitted)));
    let world = world(scene);
    let settings = LightPassSettings { direct: 6000, indirect: 40_000, seed: 3 };
    let lights = light_pass(&world, &settings, u32::MAX, &Control::new());
    let trees = LightTrees::build(&lights.sets, lights.spots, world.diagonal, Family::Divisive);
    let transfer = Transfer::new(&trees, world.diagonal);
    let expected = PI * emitted / (Rgb::ONE - albedo);
    for normal in [Vec3::Y, -Vec3::X, Vec3::new(1.0, 1.0, 1.0).normalize()] {
        let receiver =
            Receiver::irradiance(Vec3::new(0.1, -0.2, 0.15), Vec3::ZERO, &Frame::from_normal(normal));
        let all = gather_all(&transfer, &*world, &receiver);
        let error = (all / expected - Rgb::ONE).abs().max_element();
        assert!(error < 0.02, "all VPLs: {all} against {expected}");
        let cut = CutSettings { clamp: None, ..CutSettings::default() };
        let approximate = Lightcut::new().gather(&transfer, &*world, &receiver, &cut).radiance;
        let error = (luminance(approximate) / luminance(expected) - 1.0).abs();
        assert!(error < 0.06, "cut: {approximate} against {expected}");
    }
}

#[test]
fn indirect_flux_is_what_the_surfaces_reflect() {
    // In a closed room each watt emitted is reflected ρ + ρ² + ... = ρ/(1-ρ) times.
    let world = lit_room(None);
    let settings = LightPassSettings { indirect: 50_000, ..LightPassSettings::default() };
    let lights = light_pass(&world, &settings, u32::MAX, &Control::new());
    let of = |origin| {
        let sets = lights.sets.iter().filter(|s| s.origin == origin);
        sets.flat_map(|s| &s.intensities).copied().sum::<Rgb>() * PI
    };
    let emitted = Rgb::new(10.0, 9.0, 8.0) * (PI * 0.36);
    let direct = of(Origin::Direct);
    assert!((direct / emitted - Rgb::ONE).abs().max_element() < 1e-3, "{direct} {emitted}");
    let albedo = Rgb::new(0.7, 0.5, 0.6);
    let expected = emitted * albedo / (Rgb::ONE - albedo);
    let indirect = of(Origin::Indirect);
    assert!((indirect / expected - Rgb::ONE).abs().max_element() < 0.02, "{indirect} {expected}");
}

#[test]
fn a_direct_only_depth_makes_no_indirect_vpls() {
    let world = lit_room(None);
    let lights = light_pass(&world, &LightPassSettings::default(), 2, &Control::new());
    assert!(lights.sets.iter().all(|s| s.origin == Origin::Direct || s.is_empty()));
    assert_eq!(lights.photons.rays, 0);
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
        },
        DeltaLight::Directional {
            direction: Vec3::new(1.0, -1.0, 0.0).normalize(),
            irradiance: Rgb::new(1.0, 0.5, 0.2),
        },
    ];
    for light in lights {
        let world = floor_under(|scene| scene.lights.push(light));
        let (a, b) = (lightcuts(&world, &Settings { spp: 64, ..Settings::default() }), reference(&world, 64));
        for (a, b) in a.color.pixels.iter().zip(&b.color.pixels) {
            // Both average the same eye samples' positions over a pixel.
            assert!((*a - *b).abs().max_element() <= 0.01 * b.max_element() + 1e-6, "{light:?}: {a} {b}");
        }
    }
}

#[test]
fn a_floor_under_a_uniform_sky_reflects_its_albedo() {
    let world = floor_under(|scene| scene.environment = Some(Environment::Constant(Rgb::new(1.0, 2.0, 0.5))));
    let output = lightcuts(&world, &Settings::default());
    for pixel in &output.color.pixels {
        let error = (*pixel / (0.5 * Rgb::new(1.0, 2.0, 0.5)) - Rgb::ONE).abs().max_element();
        assert!(error < 0.03, "{pixel}");
    }
}

#[test]
fn pictures_agree_with_path_tracing() {
    let glossy = Material {
        lobe: Lobe::Rough {
            distribution: lightsplat::scene::Distribution::Ggx,
            alpha: 0.4,
            fresnel: lightsplat::scene::Fresnel::One,
            scale: lightsplat::scene::Reflectance::Constant(Rgb::splat(0.3)),
        },
        ..diffuse(Rgb::splat(0.3))
    };
    for ball in [None, Some(diffuse(Rgb::splat(0.5))), Some(glossy)] {
        let name = format!("{ball:?}");
        let world = lit_room(ball);
        let light = LightPassSettings { direct: 2048, indirect: 60_000, seed: 0 };
        let output = lightcuts(&world, &Settings { spp: 4, light, ..Settings::default() });
        assert_eq!(output.nonfinite, 0);
        assert!(output.complete);
        let expected = mean(&reference(&world, 256).color);
        let ratio = mean(&output.color) / expected;
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
    let world = common::world(scene);
    for pixel in &lightcuts(&world, &Settings::default()).color.pixels {
        assert!((*pixel - sky).abs().max_element() < 1e-5, "{pixel}");
    }
}

#[test]
fn cuts_in_a_scene_with_shadows_are_within_their_error() {
    let world = lit_room(Some(diffuse(Rgb::splat(0.5))));
    let settings = LightPassSettings { direct: 1024, indirect: 19_000, seed: 1 };
    let lights = light_pass(&world, &settings, u32::MAX, &Control::new());
    for family in [Family::Divisive, Family::Agglomerative] {
        let trees = LightTrees::build(&lights.sets, lights.spots.clone(), world.diagonal, family);
        let transfer = Transfer::new(&trees, world.diagonal);
        let settings = CutSettings { clamp: None, max_cut: usize::MAX, ..CutSettings::default() };
        let mut cut = Lightcut::new();
        let (mut squares, mut n) = (0.0, 0);
        for y in (1..32).step_by(2) {
            for x in (1..32).step_by(2) {
                let ray = world.view.primary_ray([x, y], Vec2::splat(0.5));
                let Some(s) = world.intersect(&ray) else { panic!("the room is closed") };
                let out = -ray.direction;
                let receiver = Receiver::new(s.position, s.normal, &s.frame, world.bsdf(&s), out);
                let exact = luminance(gather_all(&transfer, &*world, &receiver));
                if exact > 0.0 {
                    let estimate = luminance(cut.gather(&transfer, &*world, &receiver, &settings).radiance);
                    squares += (estimate / exact - 1.0).powi(2);
                    n += 1;
                }
            }
        }
        let rms = (squares / n as f32).sqrt();
        assert!(n > 200 && rms <= 0.035, "{family:?}: relative RMS error {rms} over {n} points");
    }
}

/// Relative errors, against the full sum over the same 20,000 VPLs, of single and shared cuts for blocks of
/// eye samples all over the film.
///
/// All points of a picture share the representatives, and with them much of their error. So eight light
/// passes, each with representatives of its own, use two points each in sixteen blocks: one pass alone varies
/// by a tenth or more.
fn errors_in(scene: &str, family: Family) -> (Vec<f32>, Vec<f32>) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let path = path.with_extension("toml");
    let world = common::world(load_scene(&path, Some([256, 256])));
    let settings = CutSettings { clamp: None, max_cut: usize::MAX, ..CutSettings::default() };
    let (mut single, mut shared) = (Lightcut::new(), PacketLightcut::new());
    let mut points = ReceiverPacket::new();
    let (mut single_errors, mut shared_errors) = (Vec::new(), Vec::new());
    for seed in 0..8 {
        let light = LightPassSettings { direct: 1000, indirect: 19_000, seed };
        let lights = light_pass(&world, &light, u32::MAX, &Control::new());
        let trees = LightTrees::build(&lights.sets, lights.spots, world.diagonal, family);
        let transfer = Transfer::new(&trees, world.diagonal);
        let shift = [seed % 4 * 16, seed / 4 * 32];
        for block in 0..16 {
            let corner = [block % 4 * 64 + shift[0] + 6, block / 4 * 64 + shift[1] + 14];
            let eye = (0..16u32).filter_map(|i| {
                let pixel = [corner[0] + i % 4, corner[1] + i / 4];
                let ray = world.view.primary_ray(pixel, Vec2::splat(0.5));
                let s = world.intersect(&ray)?;
                let bsdf = world.bsdf(&s);
                let smooth = bsdf.has_smooth();
                smooth.then(|| Receiver::new(s.position, s.normal, &s.frame, bsdf, -ray.direction))
            });
            points.set(eye);
            let radiance = shared.gather(&transfer, &*world, &points, &settings).sum.radiance;
            for (lane, radiance) in radiance.iter().enumerate().take(points.len()).step_by(9) {
                let exact = luminance(gather_all(&transfer, &*world, points.get(lane)));
                if exact > 0.0 {
                    let alone = single.gather(&transfer, &*world, points.get(lane), &settings).radiance;
                    single_errors.push(luminance(alone) / exact - 1.0);
                    shared_errors.push(luminance(*radiance) / exact - 1.0);
                }
            }
        }
    }
    (single_errors, shared_errors)
}

#[test]
fn cuts_of_real_scenes_are_within_their_error() {
    let rms = |e: &[f32]| (e.iter().map(|e| e * e).sum::<f32>() / e.len() as f32).sqrt();
    for scene in ["apartment", "cornell", "furnace", "hall", "kitchen", "knot", "nave"] {
        for family in [Family::Divisive, Family::Agglomerative] {
            let (single, shared) = errors_in(scene, family);
            assert!(single.len() > 100, "{scene}: {} points", single.len());
            println!("{scene} {family:?}: {} {}", rms(&single), rms(&shared));
            assert!(rms(&single) <= 0.035, "{scene} {family:?}: single {}", rms(&single));
            assert!(rms(&shared) <= 0.035, "{scene} {family:?}: shared {}", rms(&shared));
        }
    }
}

#[test]
fn a_room_of_any_size_looks_the_same() {
    let light = LightPassSettings { direct: 512, indirect: 20_000, seed: 0 };
    let settings = Settings { light, ..Settings::default() };
    let at_scale = |s: f32| {
        let mut scene = staged(lit_room(Some(diffuse(Rgb::splat(0.5)))));
        scene.meshes.iter_mut().flat_map(|m| &mut m.positions).for_each(|p| *p *= s);
        scene.view.camera.origin *= s;
        lightcuts(&common::world(scene), &settings).color
    };
    let unit = at_scale(1.0);
    for s in [1e-6, 1e-3, 1e3, 1e6] {
        let image = at_scale(s);
        let ratio = mean(&image) / mean(&unit);
        assert!((ratio - Rgb::ONE).abs().max_element() < 0.005, "scale {s}: {ratio}");
    }
    assert_eq!(at_scale(1024.0), unit, "powers of two change nothing");
}

#[test]
fn the_picture_is_the_same_for_any_number_of_threads() {
    let world = lit_room(Some(mirror()));
    let light = LightPassSettings { direct: 512, indirect: 30_000, seed: 0 };
    let settings = Settings { light, ..Settings::default() };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| lightcuts(&world, &settings))
    };
    let one = with(1);
    for threads in [2, 4] {
        let other = with(threads);
        assert!(one.color == other.color && one.extra == other.extra, "{threads} threads");
        assert!(one.stats.counters().eq(other.stats.counters()), "{threads} threads");
    }
}

#[test]
fn a_crop_repeats_the_whole_pictures_pixels() {
    let world = lit_room(None);
    let light = LightPassSettings { direct: 512, indirect: 5000, seed: 0 };
    let settings = Settings { light, ..Settings::default() };
    let whole = lightcuts(&world, &settings).color;
    let window = Window { film: [32, 32], offset: [5, 9], width: 7, height: 4 };
    let crop = render(&world, &View { window, ..world.view }, &settings, &Control::new()).color;
    for y in 0..4 {
        for x in 0..7 {
            assert_eq!(crop.pixels[y * 7 + x], whole.pixels[(y + 9) * 32 + x + 5]);
        }
    }
}

#[test]
fn nothing_to_see_and_nothing_that_shines_is_black() {
    let void = world(scene(camera(Vec3::ZERO, Vec3::Z, 1.0), [3, 1]));
    let output = lightcuts(&void, &Settings::default());
    assert!(output.complete && output.color.pixels.iter().all(|p| *p == Rgb::ZERO));
    let dark = floor_under(|_| ());
    assert!(lightcuts(&dark, &Settings::default()).color.pixels.iter().all(|p| *p == Rgb::ZERO));
    let only_light = {
        let mut s = scene(camera(Vec3::ZERO, Vec3::Z, 1.0), [3, 1]);
        s.lights.push(DeltaLight::Point { position: Vec3::X, intensity: Rgb::ONE });
        world(s)
    };
    assert!(lightcuts(&only_light, &Settings::default()).complete);
}

#[test]
fn a_cancelled_picture_says_so() {
    let world = lit_room(None);
    let control = Control::new();
    control.cancel();
    let output = render(&world, &world.view, &Settings::default(), &control);
    assert!(!output.complete);
    assert_eq!(output.color.pixels.len(), 32 * 32);
}

#[test]
fn polished_metal_is_followed_from_the_eye() {
    let facets = |alpha| Lobe::Rough {
        distribution: lightsplat::scene::Distribution::Ggx,
        alpha,
        fresnel: lightsplat::scene::Fresnel::One,
        scale: lightsplat::scene::Reflectance::Constant(Rgb::splat(0.8)),
    };
    let ball = |alpha| Material { lobe: facets(alpha), ..diffuse(Rgb::ZERO) };
    for alpha in [0.06, 0.1] {
        let mut scene = staged(lit_room(Some(ball(alpha))));
        scene.lights.push(DeltaLight::Point { position: Vec3::new(0.5, 0.5, 0.7), intensity: Rgb::ONE });
        let world = world(scene);
        let expected = mean(&reference(&world, 256).color);
        let found = mean(&lightcuts(&world, &Settings { spp: 16, ..Settings::default() }).color);
        let error = (found / expected - Rgb::ONE).abs().max_element();
        assert!(error < 0.03, "α {alpha}: {found} against {expected}");
    }
}
