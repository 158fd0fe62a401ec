//! The occluder cache changes the time of a picture, and none of its pixels.

use crate::kit::*;
use crate::oracle::{count, on_threads};
use crate::presets::by_records;
use glam::Vec3;
use lightsplat::math::Rgb;
use lightsplat::method::{LightPassSettings, OccluderCacheSettings, Output, ShadowSettings, vpl};

const LIGHT: LightPassSettings = LightPassSettings { direct: 512, indirect: 10_000, seed: 0 };

/// Off and on; a small one too, in which lights displace each other.
fn uses() -> Vec<ShadowSettings> {
    let with = |cached, slots, ways| ShadowSettings {
        cached: Some(cached),
        cache: OccluderCacheSettings { slots, ways },
    };
    vec![with(false, 1, 1), with(true, 4096, 4), with(true, 64, 2)]
}

/// Number of shadow rays that the occluder cache answered.
fn saved(output: &Output) -> u64 {
    count(&output.stats, "Shadow/single: saved by the cache").unwrap_or(0)
}

/// A hall of columns under a lamp.
fn hall() -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(-0.9, 0.2, 0.9), Vec3::ZERO, 0.8), [48, 40]);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, grey));
    let lamp = quad(Vec3::new(-0.2, 0.99, -0.8), Vec3::X * 0.4, Vec3::Z * 1.6, grey);
    scene.meshes.push(emitting(lamp, Rgb::splat(8.0)));
    for [x, z] in [[-0.4, -0.4], [0.4, -0.4], [-0.4, 0.4], [0.4, 0.4]] {
        scene.meshes.extend(room(Vec3::new(x - 0.1, -1.0, z - 0.1), Vec3::new(x + 0.1, 0.7, z + 0.1), grey));
    }
    world(scene)
}

#[test]
fn lightcuts_give_the_same_bits_with_it_and_without_on_any_number_of_threads() {
    let world = hall();
    for share in [true, false] {
        let mut first: Option<Output> = None;
        for shadows in uses() {
            let settings = vpl::Settings { light: LIGHT, share, shadows, ..vpl::Settings::lightcuts() };
            let [one, three] = [1, 3].map(|threads| on_threads(threads, || rendered(&world, &settings)));
            assert!(one.color == three.color && one.stats.counters().eq(three.stats.counters()));
            // Where cuts are shared, few rays are single.
            let asks = !share && shadows.cached == Some(true);
            assert!(!asks || saved(&one) > 10_000, "share {share}: {shadows:?} saved {}", saved(&one));
            assert!(shadows.cached == Some(true) || saved(&one) == 0);
            let first = first.get_or_insert(one);
            assert!(first.color == three.color, "share {share}: {shadows:?}");
        }
    }
}

#[test]
fn the_radiance_cache_gives_the_same_bits_with_it_and_without_on_any_number_of_threads() {
    let world = hall();
    for share in [true, false] {
        let mut first = None;
        for shadows in uses() {
            let mut settings = vpl::Settings { light: LIGHT, ..by_records(LIGHT.indirect) };
            (settings.share, settings.shadows) = (share, shadows);
            let [one, three] = [1, 3].map(|threads| on_threads(threads, || rendered(&world, &settings)));
            assert!(one.color == three.color && one.stats.counters().eq(three.stats.counters()));
            let asks = !share && shadows.cached == Some(true);
            assert!(!asks || saved(&one) > 1000, "share {share}: {shadows:?} saved {}", saved(&one));
            let first = first.get_or_insert(one);
            assert!(first.color == three.color, "share {share}: {shadows:?}");
        }
    }
}

#[test]
fn it_is_asked_only_where_it_pays_unless_told_otherwise() {
    let by_default = ShadowSettings::default();
    assert_eq!([true, false].map(|share| by_default.for_samples(share)), [false, true]);
    let told = ShadowSettings { cached: Some(true), ..by_default };
    assert!(told.for_samples(true) && told.for_samples(false));
}
