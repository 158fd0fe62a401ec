//! Direct light drawn by the eye pass, and indirect light at points merged from its samples, against path tracing.

use crate::kit::*;
use crate::oracle::*;
use crate::presets::{direct_only, with_vpls};
use glam::{Vec2, Vec3};
use lightsplat::film::{Image, Layer, Window};
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::{Estimand, FoundBy, Method, Renderer, path, vpl};
use lightsplat::progress::Control;
use lightsplat::scene::{Coat, DeltaLight, Distribution, Environment, Fresnel, Lobe, Material, Reflectance};
use lightsplat::session::{Goal, Session};
use lightsplat::view::View;
use std::f32::consts::PI;

/// Number of images averaged.
const SEEDS: u32 = 64;

/// The mean of the cache's images over `seeds` seeds.
fn by_cache(world: &WorldAndView, settings: vpl::Settings, seeds: u32) -> Estimate {
    over_seeds(seeds, |seed| image(world, &vpl::Settings { seed, ..settings }))
}

/// The path tracer's estimate, with a seed that [`by_cache`] does not take.
fn paths(world: &WorldAndView, spp: u32, max_depth: Option<u32>) -> Estimate {
    by_paths(world, path::Settings { spp, seed: SEEDS, max_depth, ..Default::default() })
}

/// A room with a ball in it, without its wall behind the ball and without light, in `size` by `size` pixels.
fn dark_room(size: u32) -> SceneAndView {
    let mut scene = scene(camera(Vec3::new(0.1, 0.0, 0.95), Vec3::new(0.0, -0.2, 0.0), 0.8), [size, size]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.4)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes.remove(2);
    scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.3), 0.4, 24, wall));
    scene
}

/// A kind of light: its name, and how it is added to a scene.
type Light = (&'static str, fn(&mut SceneAndView));

const LIGHTS: [Light; 6] = [
    ("lamp", |scene| {
        let black = add_material(scene, diffuse(Rgb::ZERO));
        let lamp = quad(Vec3::new(-0.6, 0.9, -0.5), Vec3::X * 0.5, Vec3::Z * 0.4, black);
        scene.meshes.push(emitting(lamp, Rgb::new(9.0, 8.0, 6.0)));
    }),
    ("point", |scene| {
        let (position, intensity) = (Vec3::new(-0.4, 0.6, 0.2), Rgb::new(0.5, 0.7, 0.9));
        scene.lights.push(DeltaLight::Point { position, intensity });
    }),
    ("spot", |scene| {
        let position = Vec3::new(0.5, 0.8, 0.5);
        let (direction, intensity) = (-position.normalize(), Rgb::new(2.0, 1.5, 1.0));
        let (inner_angle, outer_angle) = (0.3, 0.7);
        scene.lights.push(DeltaLight::Spot {
            position,
            direction,
            intensity,
            inner_angle,
            outer_angle,
            image: None,
        });
    }),
    ("sun", |scene| {
        let direction = Vec3::new(0.2, -0.5, 1.0).normalize();
        scene.lights.push(DeltaLight::Directional { direction, irradiance: Rgb::new(3.0, 2.5, 2.0) });
    }),
    ("sky", |scene| scene.environment = Some(Environment::Constant(Rgb::new(0.6, 0.8, 1.2)))),
    ("all", |scene| LIGHTS[..5].iter().for_each(|(_, add)| add(scene))),
];

#[test]
fn direct_light_is_right_on_the_mean_for_every_kind_of_light() {
    for (name, add) in LIGHTS {
        // In larger pixels, it shows that samples of a pixel share a normal where the ball turns away from a light.
        let mut scene = dark_room(32);
        add(&mut scene);
        let world = world(scene);
        // The images to be tested take 256 and more samples per pixel, and most of the noise is theirs.
        let expected = paths(&world, 512, Some(2));
        // The whole budget may double the first samples.
        for (extra_samples, seeds) in [(0.9, SEEDS), (1.0, SEEDS / 2)] {
            let mut settings = vpl::Settings { spp: 4, max_depth: Some(2), ..direct_only() };
            settings.cache.extra_samples = extra_samples;
            assert_same_mean(&by_cache(&world, settings, seeds), &expected, name);
        }
    }
}

#[test]
fn a_floor_under_a_lamp_a_bulb_and_the_sky_has_their_irradiance() {
    let mut scene = scene(camera(Vec3::new(0.0, 0.5, 0.0), Vec3::ZERO, 1e-3), [4, 4]);
    let floor = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
    scene.meshes.push(quad(Vec3::new(-5.0, 0.0, -5.0), Vec3::Z * 10.0, Vec3::X * 10.0, floor));
    let (position, intensity) = (Vec3::new(0.0, 2.0, 1.5), Rgb::splat(10.0));
    scene.lights.push(DeltaLight::Point { position, intensity });
    scene.environment = Some(Environment::Constant(Rgb::splat(0.8)));
    // A square of half-width h at height d, parallel, before the sky (Howell C-11 applied to four corners).
    let (h, d) = (0.5f32, 1.0f32);
    let black = add_material(&mut scene, diffuse(Rgb::ZERO));
    let lamp = quad(Vec3::new(-h, d, -h), Vec3::X * 2.0 * h, Vec3::Z * 2.0 * h, black);
    scene.meshes.push(emitting(lamp, Rgb::splat(7.0)));
    let a = h / d;
    let quarter = 2.0 * a / (1.0 + a * a).sqrt() * (a / (1.0 + a * a).sqrt()).atan();
    let irradiance = 10.0 * 0.8 / 6.25 + (7.0 - 0.8) * 2.0 * quarter + 0.8 * PI;

    let settings = vpl::Settings { spp: 256, ..direct_only() };
    let Estimate { mean, variance } = by_cache(&world(scene), settings, SEEDS);
    let (mean, variance) = (regions(&mean, 4)[0], regions(&variance, 4)[0] / 16.0);
    let expected = 0.6 / PI * irradiance;
    assert!((mean.x - expected).abs() < 4.0 * variance.x.sqrt(), "{mean} {expected}, {variance}");
    assert!(variance.x.sqrt() < 0.002 * expected, "{variance}");
}

#[test]
fn a_single_sample_looks_through_the_centre_of_the_pixel() {
    let mut scene = dark_room(24);
    LIGHTS[1].1(&mut scene);
    let world = world(scene);
    let estimand = Estimand::EyeSamples { spp: 1, seed: 0 };
    let settings = path::Settings { spp: 1, max_depth: Some(2), estimand, ..Default::default() };
    let single = vpl::Settings { spp: 1, ..direct_only() };
    assert_eq!(single.estimand(), estimand);
    // One point light leaves nothing to chance.
    assert_eq!(image(&world, &single), image(&world, &settings));
}

fn rough(alpha: f32, base: f32, coat: Option<Coat>) -> Material {
    let (fresnel, scale) = match coat {
        Some(coat) => (Fresnel::Dielectric(coat.eta), Rgb::ONE),
        None => (Fresnel::One, Rgb::new(0.9, 0.8, 0.6)),
    };
    let (distribution, scale) = (Distribution::Ggx, Reflectance::Constant(scale));
    let lobe = Lobe::Rough { distribution, alpha: alpha.into(), fresnel, scale };
    Material { lobes: vec![lobe], coat, ..diffuse(Rgb::splat(base)) }
}

/// A smooth coat on a base.
fn plastic(base: f32) -> Material {
    let coat = Coat { eta: 1.5, nonlinear: false };
    let scale = Reflectance::Constant(Rgb::ONE);
    let lobe = Lobe::Mirror { fresnel: Fresnel::Dielectric(1.5), scale };
    Material { lobes: vec![lobe], coat: Some(coat), ..diffuse(Rgb::splat(base)) }
}

/// Small mirrors, glass and sharp lobes close to the eye before a far wall that has a base under coats: all light but
/// a ten-thousandth, which is scattered from the wall by way of the small things, reaches the eye directly or along
/// chains. The wall is no more than one plane, so that it does not light itself.
fn gallery() -> SceneAndView {
    let mut scene = scene(camera(Vec3::ZERO, -Vec3::Z, 0.8), [48, 48]);
    let coat = Some(Coat { eta: 1.5, nonlinear: false });
    let walls =
        [diffuse(Rgb::new(0.2, 0.5, 0.8)), plastic(0.4), rough(0.08, 0.6, coat), rough(0.1, 0.0, None)];
    for (i, material) in walls.into_iter().enumerate() {
        let material = add_material(&mut scene, material);
        let corner = Vec3::new(-20.0 + 10.0 * i as f32, -20.0, -10.0);
        scene.meshes.push(quad(corner, Vec3::X * 10.0, Vec3::Y * 40.0, material));
    }
    let small = [mirror(), glass(1.5), rough(0.1, 0.0, None), rough(0.02, 0.0, None)];
    for (i, material) in small.into_iter().enumerate() {
        let material = add_material(&mut scene, material);
        let (x, y) = (0.045 * (i % 2) as f32 - 0.0225, 0.045 * (i / 2) as f32 - 0.0225);
        scene.meshes.push(sphere(Vec3::new(x, y, -0.1), 0.02, 48, material));
    }
    let pane = add_material(&mut scene, glass(1.4));
    for z in [-0.2, -0.201] {
        let corner = Vec3::new(-0.15, 0.05, z);
        let (a, b) = if z == -0.2 { (Vec3::X, Vec3::Y) } else { (Vec3::Y, Vec3::X) };
        scene.meshes.push(quad(corner, a * 0.1, b * 0.1, pane));
    }
    scene
}

#[test]
fn mirrors_glass_coats_and_sharp_lobes_show_direct_light_as_paths_see_it() {
    let lamp = |scene: &mut SceneAndView| {
        let black = add_material(scene, diffuse(Rgb::ZERO));
        let lamp = quad(Vec3::new(-3.0, 8.0, -6.0), Vec3::X * 6.0, Vec3::Z * 4.0, black);
        scene.meshes.push(emitting(lamp, Rgb::new(9.0, 8.0, 6.0)));
    };
    let point = |scene: &mut SceneAndView| {
        let (position, intensity) = (Vec3::new(4.0, -6.0, -4.0), Rgb::new(80.0, 90.0, 99.0));
        scene.lights.push(DeltaLight::Point { position, intensity });
    };
    let sky = |scene: &mut SceneAndView| scene.environment = Some(Environment::Constant(Rgb::splat(0.7)));
    let lights: [Light; 3] = [("lamp", lamp), ("point", point), ("sky", sky)];
    for (name, add) in lights {
        let mut scene = gallery();
        add(&mut scene);
        let world = world(scene);
        // Each image takes the pilots and photons of glass, so that fewer and larger images tell as much.
        assert_same_mean(&by_cache(&world, direct_only(), SEEDS / 4), &paths(&world, 256, None), name);
    }
}

/// A lit room with a floor under a smooth coat, and a mirror, a glass and glossy balls so small that they do not change
/// its light; they fill much of the view.
fn room_of_balls() -> SceneAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::new(0.0, -0.25, 0.0), 0.8), [48, 48]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.6, 0.5, 0.4)));
    let floor = add_material(&mut scene, plastic(0.5));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes[0].material = floor;
    let lamp = quad(Vec3::new(-0.6, 0.99, -0.6), Vec3::X * 1.2, Vec3::Z * 1.2, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(3.0, 2.7, 2.4)));
    let small = [mirror(), glass(1.5), rough(0.1, 0.0, None), rough(0.02, 0.0, None)];
    for (i, material) in small.into_iter().enumerate() {
        let material = add_material(&mut scene, material);
        let (x, y) = (0.06 * (i % 2) as f32 - 0.03, 0.06 * (i / 2) as f32 - 0.055);
        scene.meshes.push(sphere(Vec3::new(x, y, 0.8), 0.022, 48, material));
    }
    scene
}

#[test]
fn light_from_records_and_cuts_shows_in_chains_as_paths_see_it() {
    let world = world(room_of_balls());
    let settings = vpl::Settings { max_depth: Some(8), ..with_vpls(50_000) };
    let Estimate { mean, .. } = by_cache(&world, settings, 4);
    let Estimate { mean: exact, .. } = paths(&world, 384, Some(8));
    let (worst, total) = (worst_region(&mean, &exact, 8), worst_region(&mean, &exact, 48));
    assert!(worst < 0.06 && total < 0.02, "{worst} {total}");
}

#[test]
fn fine_stripes_far_away_have_the_light_of_their_mean() {
    let stripes = [Rgb::new(0.9, 0.1, 0.3), Rgb::new(0.1, 0.7, 0.3)];
    let mean = (stripes[0] + stripes[1]) / 2.0;
    let picture = |striped: bool| {
        let (mut scene, _) = lit_room(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.5), 32);
        let material = if striped { checkered(&mut scene, 2, stripes.into()) } else { diffuse(mean) };
        let material = add_material(&mut scene, material);
        // The wall opposite, with several stripes to a pixel.
        let opposite =
            scene.meshes.iter().position(|m| m.positions.iter().all(|p| p.z == -1.0)).expect("a wall");
        let corner = Vec3::splat(-1.0);
        scene.meshes[opposite] =
            textured(quad(corner, Vec3::X * 2.0, Vec3::Y * 2.0, material), Vec2::new(91.3, 17.7));
        by_cache(&world(scene), with_vpls(30_000), 8)
    };
    let (striped, plain) = (picture(true), picture(false).mean);
    let worst = worst_region(&striped.mean, &plain, 8);
    // The noise of sixteen samples. The noise of a single sample is 0.8.
    let noise = (8.0 * regions(&striped.variance, 32)[0]).map(f32::sqrt) / regions(&plain, 32)[0];
    assert!(worst < 0.02 && noise.max_element() < 0.2, "{worst} {noise}");
}

/// Wires, a seventh of a pixel wide and some pixels apart, before a bright wall.
fn fence() -> SceneAndView {
    let mut scene = scene(camera(Vec3::ZERO, -Vec3::Z, 0.5), [48, 48]);
    let white = add_material(&mut scene, diffuse(Rgb::splat(0.8)));
    let dark = add_material(&mut scene, diffuse(Rgb::splat(0.02)));
    scene.meshes.push(quad(Vec3::new(-9.0, -9.0, -4.0), Vec3::X * 18.0, Vec3::Y * 18.0, white));
    // A pixel is 1/48 wide at a distance of 1.
    for wire in -10..=10 {
        let (x, width) = (5.3 / 48.0 * wire as f32, 0.15 / 48.0);
        let slanted = Vec3::new(0.1, 3.0, 0.0);
        scene.meshes.push(quad(Vec3::new(x, -1.5, -1.0), Vec3::X * width, slanted, dark));
    }
    scene.environment = Some(Environment::Constant(Rgb::ONE));
    scene
}

#[test]
fn extra_samples_go_to_edges_and_leave_the_mean_as_it_is() {
    let world = world(fence());
    let settings = |spp, extra_samples| {
        let mut settings = vpl::Settings { spp, max_depth: Some(2), ..direct_only() };
        settings.cache.extra_samples = extra_samples;
        settings
    };
    // Few samples, which miss most wires: were they to choose, pixels whose wires they miss would be brighter.
    let exact = paths(&world, 512, Some(2));
    assert_same_mean(&by_cache(&world, settings(4, 1.0), SEEDS), &exact, "a fence");

    // The edge of a dark wall before a bright one, in the light of a sun, which has no noise of its own.
    let mut scene = fence();
    scene.meshes.truncate(1);
    scene.environment = None;
    scene.lights.push(DeltaLight::Directional { direction: -Vec3::Z, irradiance: Rgb::splat(PI) });
    let black = add_material(&mut scene, diffuse(Rgb::splat(0.1)));
    scene.meshes.push(quad(Vec3::new(-2.0, -2.0, -3.0), Vec3::X * 2.0, Vec3::new(0.4, 4.0, 0.0), black));
    let world = crate::kit::world(scene);
    let exact = paths(&world, 1024, Some(2)).mean;
    let error = |settings| {
        let output = rendered(&world, &settings);
        let extra = count(&output.stats, "Eye/extra samples").unwrap_or(0);
        (mean_square(&output.color, &exact), extra as f32 / (48.0 * 48.0 * 16.0))
    };
    let ((plain, none), (better, some)) = (error(settings(16, 0.0)), error(settings(16, 0.2)));
    assert!(none == 0.0 && some > 0.05 && some < 0.4, "{none} {some}");
    assert!(better < 0.5 * plain, "{better} {plain}");
}

/// The denoised frame's picture; `None` where there is no library.
fn denoised(session: &Session, view: &View, settings: vpl::Settings) -> Option<Image> {
    let frame = frame(session, view, Method::Vpl(settings), true);
    (!lacks_denoiser(&frame)).then_some(frame.film.color)
}

#[test]
fn wires_thinner_than_a_pixel_are_not_lost() {
    let (session, view) = session(fence());
    let settings = with_vpls(20_000);
    let paths = Method::Path(path::Settings { spp: 384, seed: 9, ..Default::default() });
    let exact = frame(&session, &view, paths, false).film.color;
    let noisy = frame(&session, &view, Method::Vpl(settings), false).film.color;
    let denoised = denoised(&session, &view, settings);
    for picture in [Some(noisy), denoised].into_iter().flatten() {
        let worst = worst_region(&picture, &exact, 16);
        // Slope of the regression on the reference: 1 if the wires are as dark as they should be, 0 if they are lost.
        let mean = luminance(regions(&exact, 48)[0]);
        let values = picture
            .pixels
            .iter()
            .zip(&exact.pixels)
            .map(|(a, b)| (luminance(*a) - mean, luminance(*b) - mean));
        let (products, squares) = values.fold((0.0, 0.0), |sum, (a, b)| (sum.0 + a * b, sum.1 + b * b));
        let slope = products / squares;
        assert!(worst < 0.02 && (slope - 1.0).abs() < 0.1, "{worst} {slope}");
        let differences = picture.pixels.iter().zip(&exact.pixels).map(|(a, b)| luminance(*a - *b).powi(2));
        let noise = (differences.sum::<f32>() / squares).sqrt();
        assert!(noise < 0.9, "{noise}");
    }
}

#[test]
fn the_bits_of_the_default_do_not_depend_on_threads_denoised_or_not() {
    let settings = with_vpls(20_000);
    let run = |threads| {
        on_threads(threads, || {
            let (session, view) = session(room_of_balls());
            let method = Method::Vpl(settings);
            let goal = Goal { method, denoise: Some(true), keep_noisy: true, ..Goal::default() };
            let frame = session.frame(&view, &goal, &Control::new()).expect("a frame");
            let noisy = frame.film.layers.iter().find_map(Layer::triples).cloned();
            assert!(noisy.is_some() || lacks_denoiser(&frame));
            (noisy, frame.film.color)
        })
    };
    let one = run(1);
    for threads in [2, 4] {
        assert!(one == run(threads), "{threads} threads");
    }
}

#[test]
fn a_crop_repeats_the_whole_picture_s_direct_light() {
    let world = world(room_of_balls());
    for (spp, parts) in [
        (1, [[5, 30, 19, 3], [17, 13, 1, 1]]),
        (5, [[0, 0, 48, 20], [5, 30, 19, 3]]),
        (16, [[17, 13, 1, 1], [31, 7, 17, 41]]),
    ] {
        let settings = vpl::Settings { spp, seed: 3, ..direct_only() };
        let whole = image(&world, &settings);
        for [x, y, width, height] in parts {
            let window = Window { offset: [x, y], width, height, ..world.view.window };
            let view = View { window, ..world.view };
            let crop = rendered_view(&world, &view, &settings).color;
            assert_crop_repeats(&whole, &crop, &window, &format!("{spp} samples per pixel"));
        }
    }
}

#[test]
fn cuts_are_coarse_where_most_of_the_light_is_known() {
    // A room seen through glass that reflects a small panel behind the eye.
    let mean_cut = |panel_radiance: f32| {
        let (mut scene, _) = lit_room(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.3), 24);
        // A quarter is reflected, so that samples of every pixel see the panel.
        let glass = add_material(&mut scene, glass(3.0));
        let black = add_material(&mut scene, diffuse(Rgb::ZERO));
        scene.meshes.push(quad(Vec3::new(-0.1, -0.1, 0.85), Vec3::X * 0.2, Vec3::Y * 0.2, glass));
        let panel = quad(Vec3::new(-0.05, -0.05, 0.95), Vec3::Y * 0.1, Vec3::X * 0.1, black);
        scene.meshes.push(emitting(panel, Rgb::splat(panel_radiance)));
        let mut settings = with_vpls(30_000);
        settings.cache.indirect = FoundBy::Cuts;
        sum(&rendered(&world(scene), &settings).stats, "Lightcut/mean cut").expect("cuts")
    };
    let (unknown, known) = (mean_cut(0.01), mean_cut(100.0));
    assert!(known < 0.5 * unknown, "{known} {unknown}");
}
