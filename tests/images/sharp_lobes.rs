//! Reflection by sharp lobes of emitters that their sampled directions hardly ever hit.

use crate::kit::*;
use crate::oracle::{against, relative_rms};
use glam::{Vec2, Vec3};
use lightsplat::film::Image;
use lightsplat::math::Rgb;
use lightsplat::method::{path, vpl};
use lightsplat::scene::{Distribution, Environment, Fresnel, Lobe, Material, Reflectance};

/// Side of the film in pixels.
const SIZE: u32 = 48;

/// A rough mirror below two lamps, one small and one that fills much of the lobe, half hidden by a sheet.
fn below_lamps() -> SceneAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 1.0, 1.5), Vec3::ZERO, 0.4), [SIZE, SIZE]);
    let lobe = Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: 0.1.into(),
        fresnel: Fresnel::One,
        scale: Reflectance::Constant(Rgb::new(0.9, 0.7, 0.5)),
    };
    let rough = add_material(&mut scene, Material { lobes: vec![lobe], ..diffuse(Rgb::ZERO) });
    let black = add_material(&mut scene, diffuse(Rgb::ZERO));
    scene.meshes.push(quad(Vec3::new(-9.0, 0.0, -9.0), Vec3::Z * 18.0, Vec3::X * 18.0, rough));
    scene.meshes.push(quad(Vec3::new(-0.4, 1.1, -1.4), Vec3::X * 0.6, Vec3::Y * 0.3, black));
    let small = quad(Vec3::new(0.3, 1.3, -1.5), Vec3::Y * 0.05, Vec3::X * 0.05, black);
    scene.meshes.push(emitting(small, Rgb::splat(200.0)));
    let large = quad(Vec3::new(-1.5, 1.3, -2.0), Vec3::X * 1.5, Vec3::Y * 1.2, black);
    scene.meshes.push(emitting(large, Rgb::splat(1.0)));
    scene
}

fn by_paths(world: &WorldAndView, spp: u32) -> Image {
    image(world, &path::Settings { spp, ..Default::default() })
}

fn by_cuts(world: &WorldAndView) -> Image {
    image(world, &vpl::Settings { spp: 4, ..vpl::Settings::lightcuts() })
}

/// Asserts that the image is as bright as by path tracing, and that its noise is at most `most` times the noise of as
/// many paths.
fn assert_as_by_paths(scene: SceneAndView, most: f32) {
    let world = world(scene);
    let reference = by_paths(&world, 512);
    let (ratio, rms) = against(&by_cuts(&world), &reference);
    let noise = relative_rms(&by_paths(&world, 4), &reference);
    assert!((ratio - 1.0).abs() < 0.02 && rms < most * noise, "{ratio} {rms}, paths {noise}");
}

#[test]
fn lamps_show_in_sharp_lobes_as_paths_see_them() {
    assert_as_by_paths(below_lamps(), 0.75);
}

#[test]
fn the_environment_shows_in_sharp_lobes_as_paths_see_it() {
    let mut scene = below_lamps();
    scene.meshes.truncate(2);
    scene.environment = Some(Environment::Constant(Rgb::ONE));
    // Under a uniform sky the lobe's own directions are best; points sampled on it add noise in the lobe's
    // tail.
    assert_as_by_paths(scene, 1.5);
}

#[test]
fn lamps_show_in_brushed_metal_as_paths_see_them() {
    let brushed = |alpha| {
        let mut scene = below_lamps();
        let scale = Reflectance::Constant(Rgb::new(0.9, 0.7, 0.5));
        let (distribution, fresnel) = (Distribution::Ggx, Fresnel::One);
        scene.materials[0].lobes = vec![Lobe::Anisotropic { distribution, alpha, fresnel, scale }];
        let floor = scene.meshes[0].clone();
        scene.meshes[0] = textured(floor, Vec2::ONE);
        scene
    };
    let (along, across) = (brushed([0.5, 0.06].map(Into::into)), brushed([0.06, 0.5].map(Into::into)));
    let [of_along, of_across] = [&along, &across].map(|scene| by_cuts(&world(scene.clone())));
    let difference = relative_rms(&of_along, &of_across);
    assert!(difference > 0.5, "{difference}");
    assert_as_by_paths(along, 0.75);
    assert_as_by_paths(across, 0.75);
}
