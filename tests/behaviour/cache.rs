//! The radiance cache against lightcuts per pixel over the same virtual lights, and its invariants.

use crate::common::*;
use glam::Vec3;
use lightsplat::film::Image;
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::render;
use lightsplat::method::{DirectBy, Footprints, FoundBy};
use lightsplat::method::{Output, cache, reconstruction};
use lightsplat::progress::Control;
use lightsplat::scene::{Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Scene};
use lightsplat::stats::{Counter, Stage};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

fn settings(direct: DirectBy, footprints: Footprints) -> cache::Settings {
    let mut settings = cache::Settings { spp: 4, ..Default::default() };
    settings.light.indirect = 20_000;
    settings.spp = 1;
    // Compensation is noisier than the differences tested here; it has tests of its own.
    settings.compensation = false;
    settings.cache.direct = direct;
    settings.cache.indirect = FoundBy::Records;
    settings.cache.cut.epsilon = 0.01; // the paper's
    // Records even for small cells: in small pictures cuts would be used instead.
    settings.cache.least_cell = 8;
    settings.cache.accuracy[1] = 0.3;
    settings.cache.footprints = footprints;
    settings
}

fn count(output: &Output, name: &str) -> Option<u64> {
    match output.stats.get(name)? {
        Counter::Count(n) => Some(n),
        Counter::Sum(_) | Counter::Distribution(_) => None,
    }
}

/// Root mean square difference of luminance relative to the mean luminance of `b`.
fn rms(a: &Image, b: &Image) -> f32 {
    let n = a.pixels.len() as f32;
    let mean = b.pixels.iter().map(|p| luminance(*p)).sum::<f32>() / n;
    let squares = a.pixels.iter().zip(&b.pixels).map(|(a, b)| luminance(*a - *b).powi(2));
    (squares.sum::<f32>() / n).sqrt() / mean
}

#[test]
fn cancelling_ends_the_lighting_before_all_is_lit() {
    let world = lit_room();
    let settings = reconstruction::Settings { spp: 64, ..Default::default() };
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
    let [lit, all] = ["Lightcut/cuts", "Shading/tasks by cuts"].map(|name| count(&output, name).unwrap());
    assert!(lit > 0 && lit < all / 2, "{lit} of {all}");
}

/// Grey room lit by a square under its ceiling, with a ball in it.
fn lit_room() -> WorldAndView {
    room_with_ball(|_, wall| [wall; 2])
}

/// The same with a floor of rough plastic and a ball of rough metal, which has no base.
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

/// The room; `materials` chooses those of floor and ball, given the walls'.
fn room_with_ball(materials: impl FnOnce(&mut Scene, MaterialId) -> [MaterialId; 2]) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.95), Vec3::new(0.0, -0.3, 0.0), 0.9), [96, 96]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    let [floor, ball] = materials(&mut scene, wall);
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes[0].material = floor;
    let lamp = quad(Vec3::new(-0.3, 0.99, -0.3), Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.2), 0.4, 32, ball));
    world(scene)
}

/// The lit room by lightcuts per pixel with the light of [`settings`], rendered once.
fn lit_reference() -> &'static Image {
    static REFERENCE: OnceLock<Image> = OnceLock::new();
    REFERENCE.get_or_init(|| per_pixel(&lit_room(), &settings(DirectBy::Cuts, Footprints::Isotropic)))
}

/// The same of the glossy room.
fn glossy_reference() -> &'static Image {
    static REFERENCE: OnceLock<Image> = OnceLock::new();
    REFERENCE.get_or_init(|| per_pixel(&glossy_room(), &settings(DirectBy::Cuts, Footprints::Isotropic)))
}

#[test]
fn records_agree_with_lightcuts_per_pixel_in_every_mode() {
    let world = lit_room();
    for (direct, limit) in [(DirectBy::Cuts, 0.02), (DirectBy::Records, 0.06)] {
        for footprints in [Footprints::Isotropic, Footprints::Anisotropic, Footprints::Occlusion] {
            let mut settings = settings(direct, footprints);
            if direct == DirectBy::Records {
                // Penumbrae are steep: at the default accuracy they need the other mode.
                (settings.cache.accuracy[0], settings.cache.reach[0]) = (0.1, [0.7, 5.0]);
            }
            let error = rms(&rendered(&world, &settings).color, lit_reference());
            assert!(error < limit, "{direct:?} {footprints:?}: {error}");
        }
    }
}

#[test]
fn glossy_surfaces_are_lit_by_series_as_by_lightcuts_per_pixel() {
    let world = glossy_room();
    for (direct, limit) in [(DirectBy::Cuts, 0.03), (DirectBy::Records, 0.08)] {
        let mut settings = settings(direct, Footprints::Anisotropic);
        (settings.cache.accuracy[0], settings.cache.reach[0]) = (0.1, [0.7, 5.0]);
        let output = rendered(&world, &settings);
        assert!(count(&output, "Cache/records with series").is_some_and(|n| n > 0));
        // No second cut for the lobe: a sample has one cut at most, of its direct light.
        let own = count(&output, "Shading/tasks by cuts");
        assert!(own.is_some_and(|own| own <= 96 * 96), "{own:?}");
        let exact = glossy_reference();
        let error = rms(&output.color, exact);
        assert!(error < limit, "{direct:?}: {error}");
        let mean = |image: &Image| image.pixels.iter().map(|p| luminance(*p)).sum::<f32>();
        let bias = mean(&output.color) / mean(exact);
        assert!((bias - 1.0).abs() < 0.01, "{direct:?}: {bias}");
    }
}

#[test]
fn reconstruction_cuts_agree_with_lightcuts_per_pixel() {
    // Clusters' representatives alone change the mean of a picture by .16 %.
    const SEEDS: u32 = 4;
    for world in [lit_room(), glossy_room()] {
        let mut settings = settings(DirectBy::Cuts, Footprints::Occlusion);
        settings.spp = 4;
        settings.cache.indirect = FoundBy::Cuts;
        settings.cut.epsilon = 0.01;
        let mean = |image: &Image| image.pixels.iter().map(|p| luminance(*p)).sum::<f32>();
        let mut bias = 0.0;
        for seed in 0..SEEDS {
            settings.seed = seed;
            let output = rendered(&world, &settings);
            let (records, own) = ("Cache/records, indirect", "Shading/tasks by cuts");
            assert_eq!(count(&output, records).unwrap_or(0), 0);
            assert!(count(&output, own).is_some_and(|own| own > 3 * 96 * 96));
            let exact = per_pixel(&world, &settings);
            let error = rms(&output.color, &exact);
            assert!(error < 0.02, "{error}");
            bias += (mean(&output.color) / mean(&exact) - 1.0) / SEEDS as f32;
        }
        assert!(bias.abs() < 0.003, "{bias}");
    }
}

#[test]
fn layers_by_records_and_by_samples_add_up_in_every_combination() {
    let world = glossy_room();
    for direct in [DirectBy::Cuts, DirectBy::Records] {
        for indirect in [FoundBy::Cuts, FoundBy::Records] {
            let mut settings = settings(direct, Footprints::Anisotropic);
            settings.cache.indirect = indirect;
            (settings.cache.accuracy[0], settings.cache.reach[0]) = (0.1, [0.7, 5.0]);
            let picture = rendered(&world, &settings).color;
            let error = rms(&picture, glossy_reference());
            assert!(error < 0.08, "{direct:?} {indirect:?}: {error}");
        }
    }
}

#[test]
fn surfaces_without_lobes_make_no_series() {
    let output = rendered(&lit_room(), &settings(DirectBy::Cuts, Footprints::Anisotropic));
    assert_eq!(count(&output, "Cache/records with series"), None);
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let records = settings(DirectBy::Records, Footprints::Occlusion);
    let mut lent = records;
    (lent.cache.direct, lent.cache.indirect) = (DirectBy::Cuts, FoundBy::Cuts);
    for (world, settings) in [(lit_room(), records), (glossy_room(), records), (glossy_room(), lent)] {
        let pictures = [1, 2, 4].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| rendered(&world, &settings).color.pixels)
        });
        assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
    }
}

#[test]
fn far_fewer_records_than_eye_samples_and_growing_slower() {
    let world = lit_room();
    let records = |spp| {
        let mut settings = settings(DirectBy::Cuts, Footprints::Anisotropic);
        settings.spp = spp;
        count(&rendered(&world, &settings), "Cache/records, indirect").unwrap() as f64
    };
    let (one, sixteen) = (records(1), records(16));
    assert!(one < 0.2 * 96.0 * 96.0, "{one} records");
    assert!(sixteen < 5.0 * one, "{one} records at 1 sample a pixel, {sixteen} at 16");
}
