//! Scenes in units of length from far below to far above their own.

use crate::all_methods::{all, mean, picture, room, toml};

#[test]
fn a_room_looks_the_same_in_any_unit_by_every_method() {
    let metres = toml(&room(1.0));
    let scaled = [1e-16, 1e-12, 1e-8, 1e-4, 1e4, 1e8, 1e12, 1e16].map(|scale| (scale, toml(&room(scale))));
    for (name, method) in all() {
        let expected = mean(&picture(&metres, &method));
        for (scale, world) in &scaled {
            let found = mean(&picture(world, &method));
            // Other rounding, now and then another path or cluster.
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
    for (name, method) in all() {
        assert!((mean(&picture(&world, &method)) - 0.5).abs() < 1e-5, "{name}");
    }
}

#[test]
fn point_lights_lenses_and_layers_keep_the_files_unit() {
    let text = |scale: f64| {
        let intensity = 3.0 * scale * scale;
        room(scale).replace(
            "fov = 70",
            &format!("fov = 70\naperture_radius = {:e}\nfocus_distance = {:e}", 0.1 * scale, 2.0 * scale),
        ) + &format!("[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = [{intensity:e}, 0, 0]\n")
    };
    let (one, small) = (toml(&text(1.0)), toml(&text(1e-9)));
    let (_, path) = all()[5];
    let (a, b) = (picture(&one, &path), picture(&small, &path));
    assert!((mean(&b) / mean(&a) - 1.0).abs() < 0.02, "{} {}", mean(&a), mean(&b));
    assert!((small.world.scene.unit().log2() - (1e-9f64).log2()).abs() < 5.0);
    assert_eq!(one.world.scene.unit(), 1.0);
}
