//! Scenes in units of length from far below to far above their own.

use crate::kit::{image, room_file, small_methods, toml};
use crate::oracle::mean_luminance;

#[test]
fn a_room_looks_the_same_in_any_unit_by_every_method() {
    let metres = toml(&room_file(1.0));
    let scaled =
        [1e-16, 1e-12, 1e-8, 1e-4, 1e4, 1e8, 1e12, 1e16].map(|scale| (scale, toml(&room_file(scale))));
    for (name, method) in small_methods() {
        let expected = mean_luminance(&image(&metres, method.renderer()));
        for (scale, world) in &scaled {
            let found = mean_luminance(&image(world, method.renderer()));
            // Rounding leads to another path or cluster now and then.
            assert!(
                (found / expected - 1.0).abs() < 0.03,
                "{name} times {scale}: {found}, {expected} in metres"
            );
        }
    }
}

#[test]
fn a_scene_without_extent_is_its_sky() {
    let world = toml(
        "resolution = [8, 8]\n[camera]\norigin = [0, 0, 3]\ntarget = [0, 0, 0]\n\
         [environment]\nradiance = [0.5, 0.5, 0.5]\n\
         [[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n\
         [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\ntransform = [{ scale = 1e-200 }]\n",
    );
    for (name, method) in small_methods() {
        assert!((mean_luminance(&image(&world, method.renderer())) - 0.5).abs() < 1e-5, "{name}");
    }
}

#[test]
fn point_lights_lenses_and_layers_keep_the_files_unit() {
    let text = |scale: f64| {
        let intensity = 3.0 * scale * scale;
        room_file(scale).replace(
            "fov = 70",
            &format!("fov = 70\naperture_radius = {:e}\nfocus_distance = {:e}", 0.1 * scale, 2.0 * scale),
        ) + &format!("[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = [{intensity:e}, 0, 0]\n")
    };
    let (one, small) = (toml(&text(1.0)), toml(&text(1e-9)));
    let (_, path) = small_methods()[5];
    let [a, b] = [&one, &small].map(|world| mean_luminance(&image(world, path.renderer())));
    assert!((b / a - 1.0).abs() < 0.02, "{a} {b}");
    assert!((small.world.scene.unit().log2() - (1e-9f64).log2()).abs() < 5.0);
    assert_eq!(one.world.scene.unit(), 1.0);
}
