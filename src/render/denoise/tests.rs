//! Denoising of small images. The tests print a note and pass if there is no library.

use super::*;
use base::sampling::hash;

fn denoiser() -> Option<Denoiser> {
    match Denoiser::load() {
        Ok(denoiser) => Some(denoiser),
        Err(error) => {
            eprintln!("skipped: {error}");
            None
        }
    }
}

/// Creates an image of mean `mean` with noise of the same size.
fn noisy(width: u32, height: u32, mean: f32) -> Image {
    let noise = |i: u32, c: u32| 2.0 * hash(i, c) as f32 / u32::MAX as f32;
    let pixels = (0..width * height).map(|i| mean * Rgb::from([0, 1, 2].map(|c| noise(i, c)))).collect();
    Image { width, height, pixels }
}

fn mean(image: &Image) -> f32 {
    image.pixels.iter().map(|p| p.element_sum() / 3.0).sum::<f32>() / image.pixels.len() as f32
}

#[test]
fn small_images_keep_their_brightness() {
    let Some(denoiser) = denoiser() else { return };
    for (width, height) in [(1, 1), (1, 9), (5, 3), (16, 16), (40, 7), (64, 64), (200, 3), (65, 90)] {
        let color = noisy(width, height, 1.0).map(|p| 0.5 + 0.5 * *p);
        let clean = denoiser.denoise(&color, &Guides::default(), Quality::High).unwrap();
        assert_eq!((clean.width, clean.height), (width, height));
        let ratio = mean(&clean) / mean(&color);
        // 0.18 without the extension of a single pixel.
        assert!((ratio - 1.0).abs() < 0.1, "{width}x{height}: {ratio}");
    }
}

#[test]
fn nothing_that_is_not_finite_or_is_negative_comes_out() {
    let Some(denoiser) = denoiser() else { return };
    let mut color = noisy(70, 66, 1.0);
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0, f32::MAX, 1e30].into_iter().enumerate()
    {
        color.pixels[97 * i] = Rgb::new(bad, 1.0, bad);
    }
    let mut albedo = noisy(70, 66, 0.5);
    (albedo.pixels[5], albedo.pixels[6]) = (Rgb::NAN, Rgb::INFINITY);
    let normal = albedo.map(|p| 2.0 * *p - 1.0);
    for guides in [
        Guides::default(),
        Guides { albedo: Some(&albedo), ..Guides::default() },
        Guides { albedo: None, normal: Some(&normal), noise_free: true, ..Guides::default() },
        Guides { albedo: Some(&albedo), normal: Some(&normal), noise_free: true, ..Guides::default() },
    ] {
        let clean = denoiser.denoise(&color, &guides, Quality::High).unwrap();
        assert!(clean.pixels.iter().all(|p| p.is_finite() && p.min_element() >= 0.0));
    }
}

#[test]
fn black_stays_black_and_guides_of_another_size_are_refused() {
    let Some(denoiser) = denoiser() else { return };
    let black = Image::new(20, 30);
    assert_eq!(denoiser.denoise(&black, &Guides::default(), Quality::High).unwrap(), black);
    let (color, albedo) = (noisy(6, 4, 1.0), noisy(4, 6, 1.0));
    let guides = Guides { albedo: Some(&albedo), ..Guides::default() };
    let refused = denoiser.denoise(&color, &guides, Quality::High).unwrap_err().to_string();
    assert_eq!(refused, "the albedo has 4x6 pixels, and the image 6x4");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let color = noisy(150, 130, 1.0);
    let normal = noisy(150, 130, 0.5);
    let guides =
        Guides { albedo: Some(&color), normal: Some(&normal), noise_free: true, ..Guides::default() };
    let clean = [1, 2, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Some(denoiser()?.denoise(&color, &guides, Quality::High).unwrap()))
    });
    assert!(clean[0] == clean[1] && clean[0] == clean[2]);
}

#[test]
fn faint_and_bright_images_are_denoised_as_others() {
    let Some(denoiser) = denoiser() else { return };
    let ordinary = denoiser.denoise(&noisy(70, 66, 1.0), &Guides::default(), Quality::High).unwrap();
    for exponent in [-120, -60, -20, -9, 19, 60, 120] {
        let factor = 2f32.powi(exponent);
        let clean = denoiser.denoise(&noisy(70, 66, factor), &Guides::default(), Quality::High).unwrap();
        for (p, q) in clean.pixels.iter().zip(&ordinary.pixels) {
            assert!((*p / factor - *q).abs().max_element() < 0.01, "{p} {q} {factor}");
        }
    }
}

#[test]
fn pixels_without_a_surface_keep_their_value() {
    let Ok(denoiser) = Denoiser::load() else { return };
    let (width, height) = (70, 66);
    let seen = |i: usize| i % width > 20 && i / width > 30;
    let image = |value: &dyn Fn(usize) -> Rgb| Image {
        width: width as u32,
        height: height as u32,
        pixels: (0..width * height).map(value).collect(),
    };
    let noise = |i: usize| (i * 7919 % 101) as f32 / 50.0;
    let color = image(&|i| if seen(i) { Rgb::splat(0.3 * noise(i)) } else { Rgb::ONE });
    let [albedo, normal] =
        [Rgb::splat(0.5), Rgb::Z].map(|value| image(&|i| if seen(i) { value } else { Rgb::ZERO }));
    let guides =
        Guides { albedo: Some(&albedo), normal: Some(&normal), noise_free: true, keeps_background: true };
    let clean = denoiser.denoise(&color, &guides, Quality::Fast).unwrap();
    for (i, pixel) in clean.pixels.iter().enumerate() {
        assert!(if seen(i) { *pixel != color.pixels[i] } else { *pixel == Rgb::ONE }, "{i}: {pixel}");
    }
}
