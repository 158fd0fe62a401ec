//! Whole pictures at the limits of the number formats: scene sizes over twelve decades, scenes far from their
//! origin, films of odd shapes, radiances twenty orders apart.

use crate::kit::*;
use crate::oracle::{assert_rms_below, mean_luminance};
use glam::Vec3;
use lightsplat::film::{Image, Window};
use lightsplat::math::Rgb;
use lightsplat::method::{LightPassSettings, path, vpl};
use std::path::Path;

fn by_path(world: &WorldAndView, spp: u32) -> Image {
    image(world, &path::Settings { spp, ..path::Settings::default() })
}

fn by_lightcuts(world: &WorldAndView) -> Image {
    let light = LightPassSettings { direct: 256, indirect: 2000, ..LightPassSettings::default() };
    image(world, &vpl::Settings { spp: 1, light, ..vpl::Settings::lightcuts() })
}

/// A lit room with a ball in it, everything times `scale`.
fn room_at(scale: f32) -> WorldAndView {
    let view = camera(Vec3::new(0.1, 0.2, 0.9) * scale, Vec3::new(0.0, -0.4, 0.0) * scale, 0.8);
    let mut scene = scene(view, [24, 16]);
    let wall = add_material(&mut scene, diffuse(Rgb::splat(0.6)));
    for mesh in room(Vec3::splat(-scale), Vec3::splat(scale), wall) {
        scene.meshes.push(mesh);
    }
    scene.meshes.push(sphere(Vec3::new(0.1, -0.6, -0.2) * scale, 0.4 * scale, 24, wall));
    let lamp = quad(Vec3::new(-0.3, 0.98, -0.3) * scale, Vec3::X * 0.6 * scale, Vec3::Z * 0.6 * scale, wall);
    scene.meshes.push(emitting(lamp, Rgb::splat(10.0)));
    world(scene)
}

#[test]
fn the_picture_does_not_depend_on_the_unit_of_length() {
    let metres = room_at(1.0);
    let (path, cuts) = (by_path(&metres, 64), by_lightcuts(&metres));
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let world = room_at(scale);
        // Rounding leads to another path or cluster now and then: the scale is no power of two.
        assert_rms_below(0.05, &by_path(&world, 64), &path, &format!("path at {scale}"));
        assert_rms_below(0.05, &by_lightcuts(&world), &cuts, &format!("lightcuts at {scale}"));
    }
}

/// Writes a room as TOML with every coordinate moved by `offset`, and loads it.
fn room_moved_by(offset: f64, folder: &Path) -> WorldAndView {
    let at = |x: f64, y: f64, z: f64| format!("[{:?}, {:?}, {:?}]", x + offset, y + offset, z + offset);
    let wall = |turn: &str| {
        format!(
            "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"wall\"\ntransform = [{{ translate = [0, 0, -1] }}, {turn}{{ translate = {} }}]\n",
            at(0.0, 0.0, 0.0)
        )
    };
    let turns = [
        "".to_owned(),
        "{ rotate = { axis = [0, 1, 0], angle = 90 } }, ".to_owned(),
        "{ rotate = { axis = [0, 1, 0], angle = -90 } }, ".to_owned(),
        "{ rotate = { axis = [1, 0, 0], angle = 90 } }, ".to_owned(),
        "{ rotate = { axis = [1, 0, 0], angle = -90 } }, ".to_owned(),
        "{ rotate = { axis = [0, 1, 0], angle = 180 } }, ".to_owned(),
    ];
    let mut text = format!(
        "name = \"room\"\nresolution = [24, 16]\n[camera]\norigin = {}\ntarget = {}\nfov = 75.0\n\
         [[material]]\nname = \"wall\"\nkind = \"diffuse\"\nreflectance = [0.6, 0.6, 0.6]\n\
         [[light]]\nkind = \"point\"\nposition = {}\nintensity = [3.0, 3.0, 3.0]\n",
        at(0.1, 0.2, 0.9),
        at(0.0, -0.4, 0.0),
        at(0.2, 0.5, 0.1)
    );
    for turn in &turns {
        text += &wall(turn);
    }
    let file = folder.join(format!("room{offset}.toml"));
    std::fs::write(&file, text).expect("the scene is written");
    world(load_scene(&file, None))
}

#[test]
fn a_scene_a_million_units_away_is_the_same_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let (near, far) = (room_moved_by(0.0, folder.path()), room_moved_by(1e6, folder.path()));
    let reference = by_path(&near, 64);
    assert!(mean_luminance(&reference) > 0.1);
    assert_rms_below(0.01, &by_path(&far, 64), &reference, "path");
    assert_rms_below(0.02, &by_lightcuts(&far), &by_lightcuts(&near), "lightcuts");
}

#[test]
fn films_may_be_a_pixel_wide_or_very_long() {
    let mut scene = staged(room_at(1.0));
    for resolution in [[1, 1], [1, 37], [16_384, 1]] {
        scene.view.window = Window::whole(resolution);
        let world = world(scene.clone());
        let image = by_path(&world, 1);
        assert_eq!([image.width, image.height], resolution);
        assert!(mean_luminance(&image) > 0.0);
        if resolution[0] < 100 {
            assert!(mean_luminance(&by_lightcuts(&world)) > 0.0);
        }
    }
}

#[test]
fn crops_of_very_large_films_show_what_is_there_by_every_method() {
    let mut scene = staged(toml(&room_file(1.0)));
    for offset in [[0, 0], [9000, 12_000], [16_376, 16_376]] {
        scene.view.window = Window { offset, width: 8, height: 8, ..Window::whole([16_384, 16_384]) };
        let world = world(scene.clone());
        let by_path = mean_luminance(&by_path(&world, 512));
        for (name, method) in small_methods() {
            let ratio = mean_luminance(&image(&world, method.renderer())) / by_path;
            assert!((0.9..1.1).contains(&ratio), "{name} at {offset:?}: {ratio}");
        }
    }
}

#[test]
fn lights_twenty_orders_apart_share_a_scene() {
    let mut scene = staged(room_at(1.0));
    let material = scene.meshes[0].material;
    let faint = quad(Vec3::new(-0.9, -0.9, -0.9), Vec3::X * 0.1, Vec3::Y * 0.1, material);
    scene.meshes.push(emitting(faint, Rgb::splat(1e-10)));
    let bright = quad(Vec3::new(0.5, 0.97, 0.5), Vec3::X * 0.2, Vec3::Z * 0.2, material);
    scene.meshes.push(emitting(bright, Rgb::splat(1e10)));
    let world = world(scene);
    let ratio = mean_luminance(&by_lightcuts(&world)) / mean_luminance(&by_path(&world, 256));
    assert!((0.8..1.2).contains(&ratio), "{ratio}");
}

#[test]
fn white_walls_in_a_closed_room_end() {
    let mut scene = staged(room_at(1.0));
    scene.materials[0] = diffuse(Rgb::ONE);
    // Nothing is absorbed, so that paths end by their limit alone, and more edges bring more light.
    let mut before = 0.0;
    for max_depth in [2, 8, 32] {
        scene.max_depth = Some(max_depth);
        let world = world(scene.clone());
        for image in [by_path(&world, 64), by_lightcuts(&world)] {
            let mean = mean_luminance(&image);
            assert!(mean > 1.5 * before, "{max_depth}: {mean} {before}");
        }
        before = mean_luminance(&by_path(&world, 64));
    }
}
