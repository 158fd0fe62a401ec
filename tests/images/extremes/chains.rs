//! Chains through mirrors and glass that lose no light: they end.

use crate::kit::{image, room_file, small_methods, toml};
use crate::oracle::mean_luminance;

/// A cube of a material around the camera, with `light`.
fn inside(kind: &str, light: &str) -> String {
    format!(
        "resolution = [8, 8]\n[camera]\norigin = [0.1, 0.2, 0.3]\ntarget = [1, 1, 1]\nfov = 60\n{light}\n\
         [[material]]\nname = \"m\"\nkind = \"{kind}\"\n[[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\n"
    )
}

#[test]
fn a_camera_in_a_block_of_glass_sees_the_sky_by_every_method() {
    let world = toml(&inside("glass", "[environment]\nradiance = [1, 1, 1]"));
    let means =
        small_methods().map(|(name, method)| (name, mean_luminance(&image(&world, method.renderer()))));
    let (_, path) = means[means.len() - 1];
    for (name, mean) in means {
        assert!((mean / path - 1.0).abs() < 0.15, "{name}: {mean}, by paths {path}");
    }
}

#[test]
fn a_room_of_mirrors_without_light_is_black_by_every_method() {
    let world = toml(&inside("mirror", ""));
    for (name, method) in small_methods() {
        assert_eq!(mean_luminance(&image(&world, method.renderer())), 0.0, "{name}");
    }
}

#[test]
fn a_lamp_in_a_room_of_mirrors_is_seen_by_every_method() {
    let lamp = "[[material]]\nname = \"lamp\"\nkind = \"diffuse\"\nreflectance = 0.2\n\
        [[mesh]]\nshape = \"sphere\"\nmaterial = \"lamp\"\nemission = [1, 1, 1]\n\
        transform = [{ scale = 0.55 }, { translate = [-0.4, -0.4, -0.4] }]";
    let world = toml(&inside("mirror", lamp));
    // Every ray meets the lamp in the end, and sees what it sends and reflects.
    for (name, method) in small_methods() {
        let mean = mean_luminance(&image(&world, method.renderer()));
        assert!((1.0..1.35).contains(&mean), "{name}: {mean}");
    }
}

#[test]
fn a_camera_in_a_block_of_glass_in_a_lit_room_sees_it_by_every_method() {
    let block = "[[material]]\nname = \"block\"\nkind = \"glass\"\n[[mesh]]\nshape = \"cube\"\nmaterial = \"block\"\n\
        transform = [{ scale = 0.2 }, { translate = [0.3, 0.4, 2.1] }]\n";
    let world = toml(&(room_file(1.0) + block));
    for (name, method) in small_methods() {
        let mean = mean_luminance(&image(&world, method.renderer()));
        assert!(mean > 0.05 && mean < 20.0, "{name}: {mean}");
    }
}
