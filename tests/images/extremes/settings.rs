//! Settings at the ends of their ranges, and beyond.

use crate::kit::{image, room_file, small_methods, toml};
use crate::oracle::mean_luminance;
use lightsplat::method::Method;

/// One of [`small_methods`] with a setting changed.
fn with(index: usize, key: &str, value: &str) -> Method {
    let (name, mut method) = small_methods()[index];
    assert_eq!(method.set(key, value), Ok(true), "{name} {key} {value}");
    method
}

#[test]
fn footprints_of_any_accuracy_and_shape_make_an_image() {
    let world = toml(&room_file(1.0));
    let expected = mean_luminance(&image(&world, small_methods()[1].1.renderer()));
    for shape in ["isotropic", "anisotropic", "occlusion"] {
        for accuracy in ["1e-20,1e-20", "1e20,1e20"] {
            for index in [1, 4] {
                let mut method = with(index, "footprints", shape);
                assert_eq!(method.set("accuracy", accuracy), Ok(true));
                let found = mean_luminance(&image(&world, method.renderer()));
                assert!((found / expected - 1.0).abs() < 0.2, "{shape} {accuracy}: {found} {expected}");
            }
        }
    }
}

#[test]
fn reaches_in_the_wrong_order_and_clamps_that_compensation_cannot_follow_are_refused() {
    let (_, mut method) = small_methods()[1];
    for (key, value) in [("reach", "5,1"), ("clamp", "1e-4"), ("clamp", "-1"), ("clamp", "2")] {
        assert!(method.set(key, value).is_err(), "{key} {value}");
    }
}

#[test]
fn the_least_clamp_keeps_the_light() {
    let world = toml(&room_file(1.0));
    for index in [0, 2, 3] {
        let expected = mean_luminance(&image(&world, with(index, "clamp", "0.02").renderer()));
        let found = mean_luminance(&image(&world, with(index, "clamp", "0.001").renderer()));
        assert!((found / expected - 1.0).abs() < 0.03, "{}: {found} {expected}", small_methods()[index].0);
    }
}
