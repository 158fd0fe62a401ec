//! Known failures of radiance caches: light that leaks through thin walls and sheets, lost contact shadows,
//! rings and seams.

use crate::kit::*;
use crate::oracle::count;
use crate::presets::{noiseless_records, per_pixel};
use glam::{Vec2, Vec3};
use lightsplat::film::{Image, Layer};
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::vpl;
use lightsplat::method::{DirectBy, Footprints, FoundBy};
use lightsplat::scene::MaterialId;
use lightsplat::world::Surface;
use std::sync::OnceLock;

/// Side of the film in pixels.
const SIZE: u32 = 128;

/// Indirect light by records without compensation: the reference clamps as the cache does.
fn settings(footprints: Footprints) -> vpl::Settings {
    let mut settings = noiseless_records(30_000);
    settings.cache.footprints = footprints;
    settings.cache.accuracy[1] = 0.3;
    settings
}

/// A closed axis-aligned block, fronts outward.
fn block(low: Vec3, high: Vec3, material: MaterialId) -> Vec<lightsplat::scene::Mesh> {
    let mut faces = room(low, high, material);
    faces.iter_mut().flat_map(|m| &mut m.triangles).for_each(|t| t.swap(1, 2));
    faces
}

/// Half of the room, behind a thin wall that leaves a gap towards the eye, is lit by reflection from the
/// other half. A block stands on the floor of the lit half, a sheet floats in either.
fn divided_room() -> WorldAndView {
    let (mut scene, wall) =
        lit_room(camera(Vec3::new(0.0, 0.3, 0.98), Vec3::new(0.0, -0.25, 0.0), 1.0), SIZE);
    scene.meshes.extend(block(Vec3::new(-0.01, -1.0, -1.0), Vec3::new(0.01, 1.0, 0.4), wall));
    scene.meshes.extend(block(Vec3::new(-0.7, -1.0, -0.6), Vec3::new(-0.4, -0.7, -0.3), wall));
    for x in [-0.6, 0.3] {
        scene.meshes.push(quad(Vec3::new(x, -0.2, -0.8), Vec3::X * 0.3, Vec3::new(0.0, -0.1, 0.4), wall));
    }
    world(scene)
}

/// [`divided_room`] by lightcuts per pixel, rendered once. It does not depend on footprints.
fn divided_reference() -> &'static Image {
    static REFERENCE: OnceLock<Image> = OnceLock::new();
    REFERENCE.get_or_init(|| image(&divided_room(), &per_pixel(&settings(Footprints::Isotropic))))
}

/// Surface at each pixel's centre.
fn seen(world: &WorldAndView) -> Vec<Surface> {
    let look = |i: u32| {
        let pixel = [i % SIZE, i / SIZE];
        let ray = world.view.primary_ray(pixel, Vec2::splat(0.5));
        world.intersect(&ray).expect("the room is closed")
    };
    (0..SIZE * SIZE).map(look).collect()
}

/// Differences of luminance relative to the reference, of the pixels that `wanted` selects.
fn errors(test: &Image, reference: &Image, seen: &[Surface], wanted: impl Fn(&Surface) -> bool) -> Vec<f32> {
    let pixels = test.pixels.iter().zip(&reference.pixels).zip(seen);
    let wanted = pixels.filter(|(_, s)| wanted(s));
    let errors: Vec<f32> = wanted.map(|((a, b), _)| luminance(*a) / luminance(*b) - 1.0).collect();
    assert!(errors.len() > 50, "{} pixels", errors.len());
    errors
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

fn quantile(values: &[f32], q: f32) -> f32 {
    let mut sorted: Vec<f32> = values.iter().map(|v| v.abs()).collect();
    sorted.sort_by(f32::total_cmp);
    sorted[((sorted.len() - 1) as f32 * q) as usize]
}

/// Names of the regions whose error exceeds 2 % on average or 12 % in one pixel of twenty.
///
/// Light that leaks from the lit half would be several times as bright as the dark half. The limits lie a little above
/// the errors of today. They are not derived.
fn bad_regions(settings: &vpl::Settings) -> Vec<&'static str> {
    let world = divided_room();
    let seen = seen(&world);
    let reference = divided_reference();
    let picture = rendered(&world, settings).color;
    let of = |wanted: &dyn Fn(&Surface) -> bool| errors(&picture, reference, &seen, wanted);
    let dark = |s: &Surface| s.position.x > 0.0 && s.position.z < 0.3;
    let beside_block = |s: &Surface| {
        let p = s.position;
        p.y < -0.999 && (-0.8..-0.3).contains(&p.x) && (-0.7..-0.2).contains(&p.z)
    };
    let regions: [(&str, Vec<f32>); 5] = [
        ("dark half", of(&dark)),
        ("beside the wall", of(&|s| dark(s) && s.position.x < 0.12)),
        ("around the block", of(&beside_block)),
        ("sheets", of(&|s| (-0.31..-0.19).contains(&s.position.y) && s.normal.y.abs() > 0.5)),
        ("everything", of(&|_| true)),
    ];
    let bad = regions.into_iter().filter(|(name, errors)| {
        let (bias, most) = (mean(errors), quantile(errors, 0.95));
        println!("{:?} {name}: mean {bias}, 95 % within {most}", settings.cache.footprints);
        !(bias.abs() < 0.02 && most < 0.12)
    });
    bad.map(|(name, _)| name).collect()
}

#[test]
fn no_leaks_and_no_lost_contact_shadows() {
    assert_eq!(bad_regions(&settings(Footprints::Anisotropic)), [""; 0]);
}

#[test]
fn reconstruction_cuts_neither_leak_nor_lose_contact_shadows() {
    let mut settings = settings(Footprints::Occlusion);
    settings.cache.indirect = FoundBy::Cuts;
    assert_eq!(bad_regions(&settings), [""; 0]);
}

/// An open defect: circles blur the contact shadow of the block, by 3 % on average and up to 29 % in nineteen
/// pixels of twenty. They do not leak.
#[test]
fn circles_lose_contact_shadows_alone() {
    assert_eq!(bad_regions(&settings(Footprints::Isotropic)), ["around the block"]);
}

/// On a floor without a shadow on it, the error hardly changes from pixel to pixel: there are no rings at the
/// edges of footprints and no seams between patches. The limits lie a little above the values of today.
#[test]
fn smooth_light_stays_smooth() {
    let mut scene = scene(camera(Vec3::new(0.0, 0.2, 0.98), Vec3::new(0.0, -0.8, -0.2), 0.8), [SIZE, SIZE]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.6, 0.5)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    let lamp = quad(Vec3::new(-0.7, 0.98, -0.3), Vec3::X * 0.4, Vec3::Z * 0.4, wall);
    scene.meshes.push(emitting(lamp, Rgb::splat(20.0)));
    let world = world(scene);
    let seen = seen(&world);
    let mut by = settings(Footprints::Isotropic);
    let reference = image(&world, &per_pixel(&by));
    for (direct, indirect, footprints) in [
        (DirectBy::Cuts, FoundBy::Cuts, Footprints::Isotropic),
        (DirectBy::Cuts, FoundBy::Records, Footprints::Isotropic),
        (DirectBy::Records, FoundBy::Records, Footprints::Isotropic),
        (DirectBy::Records, FoundBy::Records, Footprints::Anisotropic),
        (DirectBy::Records, FoundBy::Records, Footprints::Occlusion),
    ] {
        (by.cache.direct, by.cache.indirect, by.cache.footprints) = (direct, indirect, footprints);
        let picture = rendered(&world, &by).color;
        let ratio = |i: usize| luminance(picture.pixels[i]) / luminance(reference.pixels[i]);
        // In creases clamping differs, too.
        let open = |i: usize| seen[i].position.x.abs().max(seen[i].position.z.abs()) < 0.9;
        let floor = |i: usize| seen[i].normal.y > 0.5 && open(i);
        let right_of = (0..seen.len() - 1).filter(|i| (i + 1) % SIZE as usize != 0).map(|i| (i, i + 1));
        let below = (0..seen.len() - SIZE as usize).map(|i| (i, i + SIZE as usize));
        let pairs = right_of.chain(below).filter(|&(i, j)| floor(i) && floor(j));
        let jumps: Vec<f32> = pairs.map(|(i, j)| ratio(i) - ratio(j)).collect();
        assert!(jumps.len() > 1000, "{}", jumps.len());
        let (most, worst) = (quantile(&jumps, 0.99), quantile(&jumps, 1.0));
        assert!(most < 0.02 && worst < 0.05, "{direct:?} {indirect:?} {footprints:?}: {most} {worst}");
    }
}

#[test]
fn inspection_changes_nothing_and_its_layers_add_up() {
    let world = divided_room();
    let mut settings = settings(Footprints::Anisotropic);
    let plain = rendered(&world, &settings);
    settings.inspect = true;
    let inspected = rendered(&world, &settings);
    assert!(plain.extra.is_empty() && plain.color == inspected.color);
    let layer = |name: &str| {
        let found = inspected.extra.iter().find(|layer| layer.name == name);
        found.and_then(Layer::triples).unwrap_or_else(|| panic!("no layer {name}"))
    };
    for (i, whole) in inspected.color.pixels.iter().enumerate() {
        let pixel = [i as u32 % SIZE, i as u32 / SIZE];
        let ray = world.view.primary_ray(pixel, Vec2::splat(0.5));
        let emitted = world.intersect(&ray).map_or(Rgb::ZERO, |s| world.emitted(&s, -ray.direction));
        let parts = ["direct", "indirect", "both"].map(|name| layer(name).pixels[i]);
        let sum = emitted + parts[0] + parts[1] + parts[2];
        assert!((sum - *whole).abs().max_element() <= 1e-5 * whole.max_element(), "{sum} {whole}");
    }
    let placed: f32 = layer("records").pixels.iter().map(|p| p.y).sum();
    assert_eq!(Some(placed as u64), count(&inspected.stats, "Cache/records, indirect"));
    assert!(layer("footprint").pixels.iter().all(|p| p.x == 0.0 || p.x >= 1.0));
    assert!(layer("weights").pixels.iter().any(|p| p.y > 0.0));
}
