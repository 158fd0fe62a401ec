//! The radiance cache against lightcuts per pixel over the same virtual lights, and its invariants.

use crate::kit::*;
use crate::oracle::{assert_means_within, assert_rms_below, count, mean, on_threads};
use crate::presets::{noiseless_records, per_pixel};
use glam::{DVec3, Vec3};
use lightsplat::film::Image;
use lightsplat::math::Rgb;
use lightsplat::method::render;
use lightsplat::method::vpl;
use lightsplat::method::{DirectBy, Footprints, FoundBy};
use lightsplat::progress::Control;
use lightsplat::scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Scene};
use lightsplat::stats::Stage;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Side of the film in pixels.
const SIZE: u32 = 96;

/// Records with an error bound as in the paper.
fn settings(direct: DirectBy, footprints: Footprints) -> vpl::Settings {
    let mut settings = noiseless_records(20_000);
    settings.cache.direct = direct;
    settings.cache.epsilon = 0.01;
    settings.cache.accuracy[1] = 0.3;
    settings.cache.footprints = footprints;
    settings
}

/// [`settings`] with direct light by records of a higher accuracy: penumbrae are too steep for the default one.
fn fine_settings(direct: DirectBy, footprints: Footprints) -> vpl::Settings {
    let mut settings = settings(direct, footprints);
    (settings.cache.accuracy[0], settings.cache.reach[0]) = (0.1, [0.7, 5.0]);
    settings
}

#[test]
fn cancelling_ends_the_lighting_before_all_is_lit() {
    let world = lit_room();
    let settings = vpl::Settings { spp: 64, ..vpl::Settings::reconstruction() };
    let (control, done) = (Control::new(), AtomicBool::new(false));
    let output = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                match control.progress() {
                    Some(p) if p.stage == Stage::Render && p.done > 0 => return control.cancel(),
                    _ => std::thread::yield_now(),
                }
            }
        });
        let output = render(&world, &world.view, &settings, &control);
        done.store(true, Ordering::Relaxed);
        output
    });
    assert!(!output.complete);
    let [lit, all] =
        ["Lightcut/cuts", "Shading/tasks by cuts"].map(|name| count(&output.stats, name).unwrap());
    assert!(lit > 0 && lit < all / 2, "{lit} of {all}");
}

/// Grey room lit by a square under its ceiling, with a ball in it.
fn lit_room() -> WorldAndView {
    room_with_ball(|_, wall| [wall; 2])
}

/// The room of [`lit_room`] with a floor of rough plastic and a ball of rough metal, which has no base.
fn glossy_room() -> WorldAndView {
    room_with_ball(|scene, _| {
        let rough = |fresnel, base, coat| {
            let scale = Reflectance::Constant(Rgb::splat(0.9));
            let lobe = Lobe::Rough { distribution: Distribution::Ggx, alpha: 0.5.into(), fresnel, scale };
            Material { lobes: vec![lobe], coat, ..diffuse(Rgb::splat(base)) }
        };
        let plastic = rough(Fresnel::Dielectric(1.5), 0.4, Some(Coat { eta: 1.5, nonlinear: false }));
        [plastic, rough(Fresnel::One, 0.0, None)].map(|material| add_material(scene, material))
    })
}

/// A room with a ball and a lamp. `materials` returns the materials of floor and ball, given that of the walls.
fn room_with_ball(materials: impl FnOnce(&mut Scene, MaterialId) -> [MaterialId; 2]) -> WorldAndView {
    let mut scene = scene(room_camera(), [SIZE; 2]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    let [floor, ball] = materials(&mut scene, wall);
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes[0].material = floor;
    let lamp = quad(Vec3::new(-0.3, 0.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.2), 0.4, 32, ball));
    world(scene)
}

/// [`lit_room`] by lightcuts per pixel with the light of [`settings`], rendered once.
fn lit_reference() -> &'static Image {
    static REFERENCE: OnceLock<Image> = OnceLock::new();
    REFERENCE.get_or_init(|| reference(&lit_room()))
}

/// [`glossy_room`] by lightcuts per pixel, rendered once.
fn glossy_reference() -> &'static Image {
    static REFERENCE: OnceLock<Image> = OnceLock::new();
    REFERENCE.get_or_init(|| reference(&glossy_room()))
}

fn reference(world: &WorldAndView) -> Image {
    image(world, &per_pixel(&settings(DirectBy::Cuts, Footprints::Isotropic)))
}

#[test]
fn records_agree_with_lightcuts_per_pixel_in_every_mode() {
    let world = lit_room();
    for (direct, limit) in [(DirectBy::Cuts, 0.02), (DirectBy::Records, 0.06)] {
        for footprints in [Footprints::Isotropic, Footprints::Anisotropic, Footprints::Occlusion] {
            let image = image(&world, &fine_settings(direct, footprints));
            assert_rms_below(limit, &image, lit_reference(), &format!("{direct:?} {footprints:?}"));
        }
    }
}

#[test]
fn glossy_surfaces_are_lit_by_series_as_by_lightcuts_per_pixel() {
    let world = glossy_room();
    for (direct, limit) in [(DirectBy::Cuts, 0.03), (DirectBy::Records, 0.08)] {
        let output = rendered(&world, &fine_settings(direct, Footprints::Anisotropic));
        assert!(count(&output.stats, "Cache/records with series").is_some_and(|n| n > 0));
        // The lobe has no cut: a sample has one cut at most, of its direct light.
        let cuts = count(&output.stats, "Shading/tasks by cuts");
        assert!(cuts.is_some_and(|cuts| cuts <= u64::from(SIZE * SIZE)), "{cuts:?}");
        let exact = glossy_reference();
        assert_rms_below(limit, &output.color, exact, &format!("{direct:?}"));
        assert_means_within(0.01, mean(&output.color), mean(exact), &format!("{direct:?}"));
    }
}

/// Asserts that images by reconstruction cuts agree with lightcuts per pixel, each by itself and over all seeds.
///
/// Representatives of clusters alone change the mean of an image by 0.16 %, whatever its size.
fn assert_reconstruction_agrees(world: &WorldAndView, seeds: u32, spp: u32) {
    let mut settings = settings(DirectBy::Cuts, Footprints::Occlusion);
    settings.spp = spp;
    settings.cache.indirect = FoundBy::Cuts;
    settings.cut.epsilon = 0.01;
    let pixels = world.view.window.pixel_count();
    let mut ratio = DVec3::ZERO;
    for seed in 0..seeds {
        settings.seed = seed;
        let output = rendered(world, &settings);
        assert_eq!(count(&output.stats, "Cache/records, indirect").unwrap_or(0), 0);
        let cuts = count(&output.stats, "Shading/tasks by cuts");
        assert!(cuts.is_some_and(|cuts| 4 * cuts > 3 * u64::from(spp) * pixels), "{cuts:?}");
        let exact = image(world, &per_pixel(&settings));
        assert_rms_below(0.02, &output.color, &exact, &format!("seed {seed}"));
        ratio += mean(&output.color) / mean(&exact) / f64::from(seeds);
    }
    assert_means_within(0.003, ratio, DVec3::ONE, "the mean over the seeds");
}

#[test]
fn reconstruction_cuts_agree_with_lightcuts_per_pixel() {
    for world in [lit_room(), glossy_room()] {
        assert_reconstruction_agrees(&world, 4, 1);
    }
}

#[test]
#[ignore = "a study: reconstruction cuts over several samples and seeds"]
fn reconstruction_cuts_agree_with_lightcuts_per_pixel_over_samples_and_seeds() {
    for world in [lit_room(), glossy_room()] {
        assert_reconstruction_agrees(&world, 4, 4);
    }
}

#[test]
fn layers_by_records_and_by_samples_add_up_in_every_combination() {
    let world = glossy_room();
    for direct in [DirectBy::Cuts, DirectBy::Records] {
        for indirect in [FoundBy::Cuts, FoundBy::Records] {
            let mut settings = fine_settings(direct, Footprints::Anisotropic);
            settings.cache.indirect = indirect;
            let image = image(&world, &settings);
            assert_rms_below(0.08, &image, glossy_reference(), &format!("{direct:?} {indirect:?}"));
        }
    }
}

#[test]
fn surfaces_without_lobes_make_no_series() {
    let output = rendered(&lit_room(), &settings(DirectBy::Cuts, Footprints::Anisotropic));
    assert_eq!(count(&output.stats, "Cache/records with series"), None);
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let records = settings(DirectBy::Records, Footprints::Occlusion);
    let mut cuts = records;
    (cuts.cache.direct, cuts.cache.indirect) = (DirectBy::Cuts, FoundBy::Cuts);
    for (world, settings) in [(lit_room(), records), (glossy_room(), records), (glossy_room(), cuts)] {
        let images = [1, 2, 4].map(|threads| on_threads(threads, || image(&world, &settings)));
        assert!(images[0] == images[1] && images[0] == images[2]);
    }
}

#[test]
fn far_fewer_records_than_eye_samples_and_growing_slower() {
    let world = lit_room();
    let records = |spp| {
        let mut settings = settings(DirectBy::Cuts, Footprints::Anisotropic);
        settings.spp = spp;
        count(&rendered(&world, &settings).stats, "Cache/records, indirect").unwrap() as f64
    };
    let (one, sixteen) = (records(1), records(16));
    assert!(one < 0.2 * f64::from(SIZE * SIZE), "{one} records");
    assert!(sixteen < 5.0 * one, "{one} records at 1 sample per pixel, {sixteen} at 16");
}
