//! Light that reaches visible surfaces over polished ones: all methods against path tracing, place by place.

use crate::kit::*;
use crate::oracle::regions;
use crate::presets::with_lights_over;
use glam::Vec3;
use lightsplat::film::Image;
use lightsplat::math::{Rgb, luminance};
use lightsplat::method::{Renderer, path, vpl};
use lightsplat::scene::{Distribution, Fresnel, Lobe, Material, Reflectance};

/// A wall that a lamp lights by a plate of brushed metal alone: the lamp shines away from the wall.
fn brushed_plate(alpha: f32) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 1.0, 2.0), Vec3::new(0.0, 1.0, -1.0), 0.5), [24, 24]);
    let grey = add_material(&mut scene, diffuse(Rgb::new(0.6, 0.5, 0.4)));
    let black = add_material(&mut scene, diffuse(Rgb::ZERO));
    let lobe = Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: alpha.into(),
        fresnel: Fresnel::One,
        scale: Reflectance::Constant(Rgb::new(0.9, 0.8, 0.7)),
    };
    let metal = add_material(&mut scene, Material { lobes: vec![lobe], ..diffuse(Rgb::ZERO) });
    scene.meshes.push(quad(Vec3::new(-2.0, 0.0, -1.0), Vec3::X * 4.0, Vec3::Y * 2.5, grey));
    scene.meshes.push(quad(Vec3::new(-1.0, 0.0, -0.8), Vec3::Z * 1.6, Vec3::X * 2.0, metal));
    let lamp = quad(Vec3::new(-0.2, 1.2, 1.2), Vec3::new(0.0, -0.3, -0.3), Vec3::X * 0.4, black);
    scene.meshes.push(emitting(lamp, Rgb::splat(20.0)));
    world(scene)
}

/// Luminances of squares of eight by eight pixels.
fn squares(image: &Image) -> Vec<f32> {
    regions(image, 8).into_iter().map(luminance).collect()
}

/// Asserts that the squares of an image are those of the paths within `most` of the brightest one.
#[track_caller]
fn assert_as_by_paths(exact: &[f32], image: &Image, most: f32, what: &str) {
    let found = squares(image);
    let brightest = exact.iter().copied().fold(0.0, f32::max);
    let worst = found.iter().zip(exact).map(|(a, b)| (a - b).abs() / brightest).fold(0.0, f32::max);
    assert!(worst < most, "{what}: {worst}, {found:?} {exact:?}");
}

#[test]
fn brushed_metal_lights_a_wall_where_paths_have_it() {
    for alpha in [0.08, 0.15] {
        let world = brushed_plate(alpha);
        let exact = squares(&image(&world, &path::Settings { spp: 1024, ..Default::default() }));
        // The light falls on a part of the wall.
        let mean = exact.iter().sum::<f32>() / exact.len() as f32;
        assert!(exact.iter().copied().fold(0.0, f32::max) > 1.5 * mean, "{exact:?}");
        let agrees = |settings: &dyn Renderer, most, what| {
            assert_as_by_paths(&exact, &image(&world, settings), most, what)
        };
        let few = |settings| with_lights_over(10, settings);
        agrees(&vpl::Settings { spp: 128, ..few(vpl::Settings::cache()) }, 0.01, "cache");
        agrees(&few(vpl::Settings::lightcuts()), 0.03, "lightcuts");
        agrees(&few(vpl::Settings::reconstruction()), 0.03, "reconstruction");
        agrees(&few(vpl::Settings::photon_cache()), 0.03, "photon-cache");
    }
}
