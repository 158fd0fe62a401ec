//! Light many orders of magnitude brighter or fainter than that of a room.

use crate::kit::{image, rendered, room_file, small_methods, toml};
use crate::oracle::mean_luminance;
use lightsplat::film::Image;

#[test]
fn pictures_are_in_proportion_to_light_by_every_method() {
    let lit = |power: f64| {
        let emission = format!("emission = [{:e}, {:e}, {:e}]", 8.0 * power, 7.0 * power, 6.0 * power);
        toml(&room_file(1.0).replace("emission = [8, 7, 6]", &emission))
    };
    let worlds = [1e-20, 1e20].map(|power| (power as f32, lit(power)));
    let one = lit(1.0);
    for (name, method) in small_methods() {
        let expected = mean_luminance(&image(&one, method.renderer()));
        for (power, world) in &worlds {
            let found = mean_luminance(&image(world, method.renderer())) / power;
            assert!((found / expected - 1.0).abs() < 0.02, "{name} times {power}: {found}, {expected} at 1");
        }
    }
}

#[test]
fn variances_beyond_f32_are_the_largest_it_has() {
    let world = toml(&room_file(1.0).replace("emission = [8, 7, 6]", "emission = [8e25, 7e25, 6e25]"));
    let (_, path) = small_methods()[5];
    let output = rendered(&world, path.renderer());
    let is_finite = |image: &Image| image.pixels.iter().all(|pixel| pixel.is_finite());
    assert!(is_finite(&output.color) && output.variance.as_ref().is_some_and(is_finite));
}

#[test]
fn a_lamp_described_twice_shines_once() {
    let once = room_file(1.0);
    let parts: Vec<&str> = once.split("[[mesh]]").collect();
    let twice = format!("{once}[[mesh]]{}", parts[1]);
    let (once, twice) = (toml(&once), toml(&twice));
    for (name, method) in small_methods() {
        assert_eq!(image(&once, method.renderer()), image(&twice, method.renderer()), "{name}");
    }
}
