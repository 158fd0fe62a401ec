//! Tests of the measures against values worked out by hand, and of properties that hold for any images.

use super::*;
use crate::math::Rgb;
use proptest::prelude::*;

fn image(width: u32, height: u32, f: impl Fn(u32, u32) -> Rgb) -> Image {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| f(x, y)).collect();
    Image { width, height, pixels }
}

fn grey(values: &[f32]) -> Image {
    image(values.len() as u32, 1, |x, _| Rgb::splat(values[x as usize]))
}

/// Returns independent standard normal variables from a fixed stream (splitmix64 and Box-Muller).
fn normals(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_add(0x9e3779b97f4a7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58476d1ce4e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d049bb133111eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    move || {
        let (u, v) = (1.0 - uniform(), uniform());
        ((-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()) as f32
    }
}

#[test]
fn relative_error_by_hand() {
    // m = 2, floor 0.04: (1)²/(1.04) and (0.5)²/(9.04), averaged.
    let (reference, test) = (grey(&[1.0, 3.0]), grey(&[2.0, 2.5]));
    let expected = (1.0 / 1.04 + 0.25 / 9.04) / 2.0;
    assert!((rel_mse(&test, &reference, 0.0) - expected).abs() < 1e-12);
    assert!((rel_mse(&test, &reference, 0.5) - 0.25 / 9.04).abs() < 1e-12);
    assert!((rmse(&test, &reference) - (1.25f64 / 2.0).sqrt()).abs() < 1e-12);
    let map = relative_error_map(&test, &reference);
    assert!((map[0] as f64 - (1.0f64 / 1.04).sqrt()).abs() < 1e-6);
}

#[test]
fn channels_count_alike() {
    let reference = image(1, 1, |_, _| Rgb::new(1.0, 2.0, 3.0));
    let test = image(1, 1, |_, _| Rgb::new(1.0, 2.0, 4.0));
    assert!((rel_mse(&test, &reference, 0.0) - 1.0 / 9.04 / 3.0).abs() < 1e-12);
    assert_eq!(pixelwise::mean_ratio(&test, &reference), [Some(1.0), Some(1.0), Some(4.0 / 3.0)]);
}

#[test]
fn psnr_by_hand() {
    // sRGB(0.5) = 0.735357, sRGB(0.18) = 0.461356: their difference squared is 0.075077.
    let (reference, test) = (grey(&[0.5, 0.5]), grey(&[0.18, 0.5]));
    let expected = -10.0 * (0.274001f64.powi(2) / 2.0).log10();
    assert!((psnr(&test, &reference, 1.0).unwrap() - expected).abs() < 1e-3);
    assert_eq!(psnr(&reference, &reference, 1.0), None);
    // Values clipped on both sides are displayed alike.
    assert_eq!(psnr(&grey(&[2.0]), &grey(&[9.0]), 1.0), None);
}

#[test]
fn identical_images_have_no_error_by_any_measure() {
    let a = image(24, 17, |x, y| Rgb::new(x as f32, y as f32, (x * y) as f32) * 0.01);
    let zero = Image::new(24, 17);
    let variances = Variances { test: Some(&zero), reference: Some(&zero) };
    let c = compare(&a, &a, variances).unwrap();
    assert_eq!((c.rel_mse, c.rmse, c.psnr, c.flip), (0.0, 0.0, None, 0.0));
    assert_eq!(c.mean_ratio, [Some(1.0); 3]);
    assert!(c.z_test.unwrap().passed);
}

#[test]
fn black_images_compare_without_nan() {
    let black = Image::new(5, 4);
    let c = compare(&black, &black, Variances::default()).unwrap();
    assert_eq!((c.rel_mse, c.rmse, c.psnr, c.flip, c.mean_ratio), (0.0, 0.0, None, 0.0, [None; 3]));
    let lit = grey(&[1.0]);
    assert_eq!(compare(&lit, &Image::new(1, 1), Variances::default()).unwrap().rel_mse, f64::INFINITY);
}

#[test]
fn unlike_sizes_are_an_error_that_names_them() {
    let error = compare(&Image::new(4, 2), &Image::new(2, 4), Variances::default()).unwrap_err();
    assert!(error.to_string().contains("4x2 and 2x4"), "{error}");
    let (a, v) = (Image::new(4, 2), Image::new(1, 1));
    assert!(compare(&a, &a, Variances { test: Some(&v), reference: None }).is_err());
}

#[test]
fn flip_grows_with_the_difference_and_knows_the_extremes() {
    let grey_field = |v: f32| image(64, 64, move |_, _| Rgb::splat(v));
    let mean = |a: &Image, b: &Image| {
        let map = flip_map(a, b, 1.0);
        map.iter().sum::<f32>() / map.len() as f32
    };
    let (small, large) =
        (mean(&grey_field(0.5), &grey_field(0.52)), mean(&grey_field(0.5), &grey_field(0.9)));
    assert!(0.0 < small && small < large && large < 1.0, "{small} {large}");
    // Black against white is 0.9694 in the authors' evaluator; only pairs such as yellow and blue reach 1.
    assert!((mean(&grey_field(0.0), &grey_field(1.0)) - 0.97).abs() < 0.01);
}

#[test]
fn flip_points_at_the_pixel_that_differs() {
    let a = Image::new(40, 30);
    let mut b = a.clone();
    b.pixels[20 * 40 + 11] = Rgb::ONE;
    let map = flip_map(&b, &a, 1.0);
    let worst = (0..map.len()).max_by(|&i, &j| map[i].total_cmp(&map[j])).unwrap();
    assert_eq!(worst, 20 * 40 + 11);
    assert_eq!(map[0], 0.0);
}

#[test]
fn extreme_shapes_are_measured() {
    for (width, height) in [(1, 1), (1, 300), (300, 1), (16_384, 2)] {
        let a = image(width, height, |x, y| Rgb::splat(0.1 + (x % 7 + y % 5) as f32));
        let c = compare(&a, &a, Variances::default()).unwrap();
        assert_eq!((c.flip, c.rel_mse), (0.0, 0.0), "{width}x{height}");
    }
}

#[test]
fn the_z_test_accepts_noise_of_the_stated_variance_and_rejects_more_or_bias() {
    let (mut first, mut second) = (normals(1), normals(2));
    let noisy = |sigma: f32, next: &mut dyn FnMut() -> f32| {
        let mut a = Image::new(100, 60);
        a.pixels.iter_mut().for_each(|p| *p = Rgb::splat(1.0) + sigma * Rgb::new(next(), next(), next()));
        a
    };
    let (a, b) = (noisy(0.1, &mut first), noisy(0.2, &mut second));
    let constant = |v: f32| image(100, 60, move |_, _| Rgb::splat(v));
    let (va, vb) = (constant(0.01), constant(0.04));
    let honest = z_test(&a, &b, &va, &vb);
    assert!(honest.passed && honest.share_passed > 0.9999, "{honest:?}");
    // 18000 draws of a chi-square of one degree: standard error 0.0105.
    assert!((honest.mean_z_squared - 1.0).abs() < 0.05, "{honest:?}");
    let understated = z_test(&a, &b, &constant(0.0005), &constant(0.002));
    assert!(!understated.passed, "{understated:?}");
    let mut biased = a.clone();
    biased.pixels.iter_mut().for_each(|p| p.y += 1.5);
    assert!(!z_test(&biased, &b, &va, &vb).passed);
    // A bias too small for single pixels is detected by blocks.
    assert!(z_test_blocks(&a, &b, &va, &vb).passed);
    biased.pixels.iter_mut().for_each(|p| p.y -= 1.2);
    assert!(z_test(&biased, &b, &va, &vb).passed && !z_test_blocks(&biased, &b, &va, &vb).passed);
}

#[test]
fn the_z_level_is_sidaks() {
    let n = 512 * 512;
    let a = Image::new(512, 512);
    let expected = 1.0 - 0.99f64.powf(1.0 / n as f64);
    assert!((z_test(&a, &a, &a, &a).level / expected - 1.0).abs() < 1e-6);
}

#[test]
fn where_nothing_varies_values_must_agree() {
    let (a, zero) = (grey(&[1.0, 2.0]), Image::new(2, 1));
    assert_eq!(z_test(&a, &a, &zero, &zero).share_passed, 1.0);
    assert_eq!(z_test(&grey(&[1.0, 2.5]), &a, &zero, &zero).share_passed, 0.5);
}

#[test]
fn the_standard_error_of_the_mean_ratio_is_that_of_repeated_noise() {
    let reference = image(16, 16, |_, _| Rgb::splat(2.0));
    let (zero, variance) = (Image::new(16, 16), image(16, 16, |_, _| Rgb::splat(0.25)));
    // 256 pixels of sigma 0.5 around 2: 0.5 / 16 / 2.
    let error = pixelwise::mean_ratio_std_error(&reference, &reference, &variance, &zero);
    assert!((error[0].unwrap() - 0.5 / 16.0 / 2.0).abs() < 1e-12);
    // The noise of the reference counts equally, and both add in squares.
    let both = pixelwise::mean_ratio_std_error(&reference, &reference, &variance, &variance);
    assert!((both[1].unwrap() - 2f64.sqrt() * 0.5 / 16.0 / 2.0).abs() < 1e-12);
}

#[test]
fn noise_of_the_reference_explains_the_error_of_a_perfect_picture() {
    let truth = image(64, 64, |x, _| Rgb::splat(1.0 + x as f32 * 0.01));
    let mut next = normals(3);
    let mut reference = truth.clone();
    reference.pixels.iter_mut().for_each(|p| *p += 0.1 * Rgb::new(next(), next(), next()));
    let variance = image(64, 64, |_, _| Rgb::splat(0.01));
    let explained = rel_mse_of_variance(&variance, &reference);
    assert!((rel_mse(&truth, &reference, 0.0) / explained - 1.0).abs() < 0.05);
}

proptest! {
    #[test]
    fn measures_are_finite_and_symmetric_where_they_must_be(
        a in proptest::collection::vec(0.0f32..1e6, 12), b in proptest::collection::vec(1e-6f32..1e6, 12),
    ) {
        let to_image = |v: &[f32]| image(2, 2, |x, y| Rgb::from_slice(&v[(3 * (x + 2 * y)) as usize..]));
        let (a, b) = (to_image(&a), to_image(&b));
        prop_assert_eq!(rmse(&a, &b), rmse(&b, &a));
        prop_assert_eq!(psnr(&a, &b, 0.5), psnr(&b, &a, 0.5));
        let c = compare(&a, &b, Variances::default()).unwrap();
        prop_assert!(c.rel_mse.is_finite() && (0.0..=1.0).contains(&c.flip));
    }
}
