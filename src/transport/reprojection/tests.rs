//! Light of one image at the surfaces of another, against a function of the position.

use super::*;
use crate::eye::FeatureSettings;
use crate::paths::Estimand;
use base::progress::Control;
use glam::Vec3;
use scene::{Camera, Material, MaterialId};
use world::testkit::*;

const SIZE: u32 = 48;

/// A floor at y = 0 with a plate over it.
fn floor(material: Material) -> WorldAndView {
    let mut scene = scene(seen_from(0.0), [SIZE, SIZE]);
    let material: MaterialId = add_material(&mut scene, material);
    scene.meshes.push(quad(Vec3::new(-9.0, 0.0, 9.0), Vec3::X * 18.0, Vec3::Z * -18.0, material));
    scene.meshes.push(quad(Vec3::new(-0.4, 0.8, -0.5), Vec3::X * 0.8, Vec3::Z * -0.8, material));
    world(scene)
}

fn seen_from(x: f32) -> Camera {
    camera(Vec3::new(x, 2.0, 2.0), Vec3::new(x, 0.0, -1.0), 0.5)
}

fn view(camera: Camera) -> View {
    View::whole(camera, [SIZE, SIZE])
}

fn look(world: &WorldAndView, view: &View) -> SeenPixels {
    let settings = FeatureSettings { estimand: Estimand::Pixels, spp: 16, seed: 5 };
    SeenPixels::new(world, view, &settings, &Control::new())
}

/// Light that changes little from pixel to pixel.
fn light(position: Vec3) -> Rgb {
    Rgb::new(2.0 + 0.3 * (2.0 * position.x).sin(), 1.5 + 0.1 * position.z, 1.0)
}

/// Returns the image of surfaces with `light`; black elsewhere.
fn picture(seen: &SeenPixels) -> Image {
    let color = |pixel| {
        let surface = seen.even_surface(pixel);
        surface.map_or(Rgb::ZERO, |surface| light(surface.position) * albedo(seen, pixel))
    };
    Image { width: SIZE, height: SIZE, pixels: (0..(SIZE * SIZE) as usize).map(color).collect() }
}

/// Returns the previous image, and its light at the surfaces that a second camera sees.
fn carried(world: &WorldAndView, from: Camera, to: Camera) -> (PreviousImage, SeenPixels, Reprojected) {
    let (from, to) = (view(from), view(to));
    let mut last = PreviousImage::default();
    let seen = look(world, &from);
    last.replace(&from, &seen, Some(&picture(&seen)));
    let seen = look(world, &to);
    let reprojected = last.reproject(&to, &seen);
    (last, seen, reprojected)
}

fn settled(reprojected: &Reprojected) -> usize {
    reprojected.light.iter().flatten().count()
}

#[test]
fn light_is_carried_to_where_its_surface_is_seen() {
    let world = floor(diffuse(Rgb::new(0.5, 0.4, 0.3)));
    for to in [seen_from(0.0), seen_from(0.13), camera(Vec3::new(0.1, 1.9, 1.8), Vec3::NEG_Z, 0.5)] {
        let (_, seen, reprojected) = carried(&world, seen_from(0.0), to);
        assert!(settled(&reprojected) * 2 > (SIZE * SIZE) as usize, "{}", settled(&reprojected));
        let mut errors = 0.0;
        for (pixel, found) in reprojected.light.iter().enumerate() {
            let Some(found) = found else { continue };
            let expected = light(seen.even_surface(pixel).unwrap().position);
            let error = (*found - expected).abs().max_element();
            // At edges it is that of a neighbour.
            assert!(error < 0.06, "{pixel}: {found} {expected}");
            errors += error;
        }
        assert!(errors < 0.003 * settled(&reprojected) as f32, "{errors}");
        // Light mixed into a different image has its weight.
        let mut color = picture(&seen);
        color.pixels.iter_mut().for_each(|color| *color *= 2.0);
        let twice = color.clone();
        reprojected.mix_into(&mut color, &seen);
        for ((pixel, mixed), twice) in color.pixels.iter().enumerate().zip(&twice.pixels) {
            let share = if reprojected.settled().contains(pixel) { (1.0 + NEW_WEIGHT) / 2.0 } else { 1.0 };
            assert!((*mixed - *twice * share).abs().max_element() < 0.06, "{pixel}");
        }
    }
}

#[test]
fn what_was_hidden_or_out_of_the_picture_is_not_settled() {
    let world = floor(diffuse(Rgb::splat(0.5)));
    let (from, to) = (view(seen_from(0.0)), view(seen_from(0.7)));
    let (_, seen, reprojected) = carried(&world, from.camera, to.camera);
    let (mut hidden, mut outside) = (0, 0);
    for pixel in 0..(SIZE * SIZE) as usize {
        let Some(surface) = seen.even_surface(pixel) else {
            assert_eq!(reprojected.light[pixel], None);
            continue;
        };
        let to_surface = surface.position - from.camera.origin;
        let depth = to_surface.dot(from.camera.forward);
        let places = [from.camera.right, from.camera.up].map(|axis| to_surface.dot(axis) / depth / 0.5);
        // The point at the plate's height on the line from the first camera.
        let above = from.camera.origin + to_surface * (1.2 / 2.0);
        let behind = surface.position.y < 0.1 && above.x.abs() < 0.38 && (-1.28..-0.52).contains(&above.z);
        if places.iter().any(|place| place.abs() > 1.0 + 2.0 / SIZE as f32) {
            outside += 1;
            assert_eq!(reprojected.light[pixel], None, "outside: {pixel}");
        } else if behind {
            hidden += 1;
            assert_eq!(reprojected.light[pixel], None, "hidden: {pixel}");
        }
    }
    assert!(hidden > 10 && outside > 50, "{hidden} {outside}");
}

#[test]
fn edges_of_light_and_surfaces_that_reflect_images_are_not_settled() {
    let world = floor(diffuse(Rgb::splat(0.5)));
    let view = view(seen_from(0.0));
    let seen = look(&world, &view);
    let mut color = picture(&seen);
    let lit = |pixel: usize| pixel as u32 % SIZE < 20;
    (0..color.pixels.len()).filter(|pixel| !lit(*pixel)).for_each(|pixel| color.pixels[pixel] *= 0.7);
    let mut last = PreviousImage::default();
    last.replace(&view, &seen, Some(&color));
    let reprojected = last.reproject(&view, &seen);
    for (pixel, light) in reprojected.light.iter().enumerate() {
        let is_seen = |pixel| seen.even_surface(pixel).is_some();
        let is_at_edge =
            (19..=20).contains(&(pixel as u32 % SIZE)) && is_seen(pixel - 1) && is_seen(pixel + 1);
        assert!(!is_at_edge || light.is_none(), "{pixel}");
    }
    assert!(settled(&reprojected) > 900);
    let (_, _, reprojected) = carried(&floor(mirror()), view.camera, view.camera);
    assert_eq!(settled(&reprojected), 0);
}

#[test]
fn a_picture_restored_is_that_saved_and_damaged_ones_are_refused() {
    let world = floor(diffuse(Rgb::splat(0.5)));
    let (last, seen, reprojected) = carried(&world, seen_from(0.0), seen_from(0.1));
    let saved = postcard::to_stdvec(&last).unwrap();
    let restored: PreviousImage = postcard::from_bytes(&saved).unwrap();
    assert!(restored.is_sound());
    let again = restored.reproject(&view(seen_from(0.1)), &seen);
    assert_eq!((again.turn, again.light), (reprojected.turn, reprojected.light));
    let damaged = |damage: &dyn Fn(&mut ReusableImage)| {
        let mut last: PreviousImage = postcard::from_bytes(&saved).unwrap();
        damage(last.image.as_mut().unwrap());
        !last.is_sound()
    };
    assert!(damaged(&|picture| picture.pixels.push(None)));
    assert!(damaged(&|picture| picture.pixels.truncate(7)));
    assert!(damaged(&|picture| picture.pixels.iter_mut().flatten().next().unwrap().light.x = f32::NAN));
    assert!(damaged(&|picture| picture.pixels.iter_mut().flatten().next().unwrap().light.x = -1.0));
}
