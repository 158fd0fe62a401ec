//! Principled materials: all methods against path tracing.

use crate::glass::{NOISE, by_default, by_so_many_paths, mean_by};
use crate::kit::*;
use crate::oracle::assert_means_within;
use lightsplat::math::Rgb;
use lightsplat::method::vpl;
use lightsplat::scene::{Material, Principled, Reflectance};

/// Number of paths of a reference. Its standard error is a quarter of the noise that is allowed.
const PATHS: u32 = 1 << 17;

/// A room with a ball of varnished paint, of metal, of frosted glass, and of leaves, on walls that are
/// principled, too, but for the leaves.
fn rooms() -> Vec<(WorldAndView, &'static str)> {
    let colour = |r, g, b| Reflectance::Constant(Rgb::new(r, g, b));
    let material = |parameters| Material { principled: Some(Box::new(parameters)), ..diffuse(Rgb::ZERO) };
    let paint = Principled {
        base_color: colour(0.7, 0.2, 0.1),
        roughness: 0.6.into(),
        clearcoat: 1.0.into(),
        sheen: 0.3.into(),
        ..Principled::default()
    };
    let metal = Principled {
        base_color: colour(0.9, 0.6, 0.3),
        metallic: 1.0.into(),
        roughness: 0.45.into(),
        ..Principled::default()
    };
    let glass = Principled { spec_trans: 1.0.into(), roughness: 0.4.into(), ..metal.clone() };
    let glass = Principled { metallic: 0.0.into(), ..glass };
    let room = |parameters| {
        let mut scene = staged(room_with_ball(Some(material(parameters))));
        let wall =
            Principled { base_color: colour(0.7, 0.6, 0.5), roughness: 0.8.into(), ..Principled::default() };
        scene.materials[0] = Material { two_sided: true, ..material(wall) };
        world(scene)
    };
    let leaf = Principled {
        base_color: colour(0.5, 0.8, 0.3),
        thin: Some(0.6.into()),
        spec_trans: 0.3.into(),
        ..Principled::default()
    };
    let leaf = Material { two_sided: true, ..material(leaf) };
    vec![
        (room(paint), "varnished paint"),
        (room(metal), "metal"),
        (room(glass), "frosted glass"),
        (room_with_ball(Some(leaf)), "a leaf"),
    ]
}

#[test]
fn the_default_agrees_with_paths() {
    for (world, what) in rooms() {
        assert_means_within(NOISE, by_default(&world), by_so_many_paths(&world, PATHS), what);
    }
}

#[test]
#[ignore = "a study: cuts and photons in rooms of principled materials"]
fn cuts_and_photons_agree_with_paths() {
    for (world, what) in rooms() {
        let exact = by_so_many_paths(&world, PATHS);
        let cuts = vpl::Settings { spp: 64, ..vpl::Settings::lightcuts() };
        assert_means_within(0.03, mean_by(&world, &cuts), exact, &format!("{what}, lightcuts"));
        let photons = vpl::Settings { spp: 64, ..vpl::Settings::photon_cache() };
        assert_means_within(0.03, mean_by(&world, &photons), exact, &format!("{what}, photon-cache"));
    }
}

#[test]
fn cuts_and_photons_agree_with_paths_in_a_painted_room() {
    let (world, what) = rooms().swap_remove(0);
    let exact = by_so_many_paths(&world, PATHS);
    let cuts = vpl::Settings { spp: 4, ..vpl::Settings::lightcuts() };
    assert_means_within(0.03, mean_by(&world, &cuts), exact, &format!("{what}, lightcuts"));
    let photons = vpl::Settings { spp: 4, ..vpl::Settings::photon_cache() };
    assert_means_within(0.03, mean_by(&world, &photons), exact, &format!("{what}, photon-cache"));
}
