//! Surfaces so far away, or so large, that few bits are left for those around the camera.

use crate::kit::{image, room_file, small_methods, toml};
use crate::oracle::mean_luminance;

/// A square of two units at `distance` along all axes.
fn stray(distance: f64) -> String {
    format!(
        "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"wall\"\n\
         transform = [{{ translate = [{distance:e}, {distance:e}, {distance:e}] }}]\n"
    )
}

#[test]
fn a_square_far_away_changes_no_image() {
    let alone = toml(&room_file(1.0));
    let with = [1e4, 1e6, 1e9, 1e12].map(|distance| (distance, toml(&(room_file(1.0) + &stray(distance)))));
    for (name, method) in small_methods() {
        let expected = mean_luminance(&image(&alone, method.renderer()));
        for (distance, world) in &with {
            let found = mean_luminance(&image(world, method.renderer()));
            assert!((found / expected - 1.0).abs() < 0.05, "{name} at {distance}: {found}, alone {expected}");
        }
    }
}

#[test]
fn lamps_under_a_sky_are_as_easily_found_beside_a_square_far_away() {
    let open = room_file(1.0).split("[[mesh]]").take(4).collect::<Vec<_>>().join("[[mesh]]");
    let open = open + "[environment]\nradiance = [0.05, 0.05, 0.05]\n";
    let (alone, with) = (toml(&open), toml(&(open.clone() + &stray(1e7))));
    for (name, method) in small_methods() {
        let [expected, found] = [&alone, &with].map(|world| mean_luminance(&image(world, method.renderer())));
        assert!((found / expected - 1.0).abs() < 0.05, "{name}: {found}, alone {expected}");
    }
}

/// A ball on a floor that reaches so far to all sides, under an even sky and a lamp.
fn floor(reach: f64) -> String {
    format!(
        "resolution = [16, 16]\n[camera]\norigin = [0.1, 0.6, 2.5]\ntarget = [0, -0.7, 0]\nfov = 40\n\
         [environment]\nradiance = [0.3, 0.3, 0.3]\n\
         [[light]]\nkind = \"point\"\nposition = [0.2, 0.5, 0.1]\nintensity = [0.5, 0.5, 0.5]\n\
         [[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = [0.7, 0.7, 0.7]\n\
         [[mesh]]\nshape = \"sphere\"\nmaterial = \"m\"\n\
         transform = [{{ scale = 0.3 }}, {{ translate = [-0.2, -0.7, -0.3] }}]\n\
         [[mesh]]\nshape = \"rectangle\"\nmaterial = \"m\"\n\
         transform = [{{ scale = {reach:e} }}, {{ rotate = {{ axis = [1, 0, 0], angle = -90 }} }}, \
         {{ translate = [0, -1, 0] }}]\n"
    )
}

#[test]
fn a_ball_on_a_floor_looks_the_same_however_far_the_floor_reaches() {
    let small = toml(&floor(100.0));
    let large = [1e4, 1e6, 1e8].map(|reach| (reach, toml(&floor(reach))));
    for (name, method) in small_methods() {
        let expected = mean_luminance(&image(&small, method.renderer()));
        // Paths take the same ways; virtual lights are others.
        let tolerance = if name == "path" { 0.002 } else { 0.08 };
        for (reach, world) in &large {
            let found = mean_luminance(&image(world, method.renderer()));
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{name} to {reach}: {found}, to 100 {expected}"
            );
        }
    }
}
