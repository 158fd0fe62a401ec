//! Thresholds against images with known contrasts.

use super::*;
use crate::eye::FeatureSettings;
use crate::paths::Estimand;
use base::progress::Control;
use scene::Camera;
use world::testkit::*;

const SIZE: u32 = 48;

/// A floor at y = 0 with a plate over it.
fn floor() -> WorldAndView {
    let mut scene = scene(seen_from(0.0), [SIZE, SIZE]);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.push(quad(Vec3::new(-9.0, 0.0, 9.0), Vec3::X * 18.0, Vec3::Z * -18.0, grey));
    scene.meshes.push(quad(Vec3::new(-0.4, 0.8, -0.5), Vec3::X * 0.8, Vec3::Z * -0.8, grey));
    world(scene)
}

fn seen_from(x: f32) -> Camera {
    camera(Vec3::new(x, 2.0, 2.0), Vec3::new(x, 0.0, -1.0), 0.5)
}

/// Stripes of 4 pixels along both axes in the left half, plain on the right; the mean is the same.
fn half_striped() -> Image {
    let color = |pixel: u32| {
        let [x, y] = [pixel % SIZE, pixel / SIZE];
        let stripes = (x / 4 % 2 + y / 4 % 2) as f32;
        Rgb::splat(if x < SIZE / 2 { 0.4 + 0.6 * stripes } else { 1.0 })
    };
    Image { width: SIZE, height: SIZE, pixels: (0..SIZE * SIZE).map(color).collect() }
}

/// Returns the thresholds of the half striped image of the floor.
fn thresholds(world: &WorldAndView) -> Thresholds {
    let view = View::whole(seen_from(0.0), [SIZE, SIZE]);
    let settings = FeatureSettings { estimand: Estimand::Pixels, spp: 16, seed: 5 };
    let seen = SeenPixels::new(world, &view, &settings, &Control::new());
    let mut thresholds = Thresholds::default();
    thresholds.replace(4.0, &view, &seen, Some(&half_striped()));
    thresholds
}

#[test]
fn plain_parts_have_about_two_per_cent_and_contrasts_hide_more() {
    for exposure in [1e-6, 1.0, 1e6] {
        let mut picture = half_striped();
        picture.pixels.iter_mut().for_each(|pixel| *pixel *= exposure);
        let found = visible_differences(&picture, 4.0);
        for (pixel, difference) in found.iter().enumerate() {
            let relative = difference / luminance(picture.pixels[pixel]);
            let is_plain = pixel as u32 % SIZE >= SIZE / 2;
            assert!(
                if is_plain { (0.01..0.03).contains(&relative) } else { relative > 0.03 },
                "{pixel} {relative}"
            );
        }
    }
    // Whose sides are no multiples of eight, and which is black.
    let black = Image { width: 13, height: 3, pixels: vec![Rgb::ZERO; 39] };
    assert!(
        visible_differences(&black, 4.0).iter().all(|difference| difference.is_finite() && *difference > 0.0)
    );
}

#[test]
fn points_have_the_threshold_of_the_place_where_they_were_seen_and_hidden_ones_none() {
    let world = floor();
    let thresholds = thresholds(&world);
    let (striped, plain) = (Vec3::new(-0.7, 0.0, -1.0), Vec3::new(0.7, 0.0, -1.0));
    let [hidden, plate] = [Vec3::new(0.0, 0.0, -1.9), Vec3::new(0.0, 0.8, -0.9)];
    assert!(thresholds.at(striped).unwrap() > thresholds.at(plain).unwrap());
    assert!(thresholds.at(plate).is_some());
    for unseen in [hidden, Vec3::new(7.0, 0.0, -1.0), Vec3::new(0.0, 2.0, 3.0), plain + Vec3::Y * 0.3] {
        assert_eq!(thresholds.at(unseen), None, "{unseen}");
    }
    assert_eq!(Thresholds::default().at(plain), None);
}

#[test]
fn thresholds_restored_are_those_saved_and_damaged_ones_are_refused() {
    let saved = postcard::to_stdvec(&thresholds(&floor())).unwrap();
    let restored = || postcard::from_bytes::<Thresholds>(&saved).unwrap();
    assert!(restored().is_sound() && Thresholds::default().is_sound());
    let damaged = |damage: &dyn Fn(&mut Vec<Visible>)| {
        let mut thresholds = restored();
        damage(&mut thresholds.map.as_mut().unwrap().pixels);
        !thresholds.is_sound()
    };
    assert!(damaged(&|pixels| pixels.truncate(7)));
    assert!(damaged(&|pixels| pixels[3].difference = f32::NAN));
    assert!(damaged(&|pixels| pixels[3].depth = -1.0));
}
