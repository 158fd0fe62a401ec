//! The filter on small pictures; left out, saying so, where there is no library.

use oidn::{Device, Error, Picture, Quality};

/// The device, or `None` and a note where there is no library.
fn device(threads: usize) -> Option<Device> {
    match Device::load(threads) {
        Ok(device) => Some(device),
        Err(Error::NotFound { tried }) => {
            eprintln!("skipped: no Open Image Denoise ({tried})");
            None
        }
        Err(other) => panic!("{other}"),
    }
}

/// Noise in [0, 1) by pixel and channel.
fn noise(pixel: u32, channel: u32) -> f32 {
    let mut x = pixel.wrapping_mul(0x9e37_79b9) ^ channel.wrapping_mul(0x85eb_ca6b);
    for _ in 0..3 {
        x ^= x >> 15;
        x = x.wrapping_mul(0x2c1b_3c6d);
    }
    (x >> 8) as f32 / (1 << 24) as f32
}

/// A picture of value `mean` on the left half and a tenth of it on the right, with noise as large.
fn noisy(width: usize, height: usize, mean: f32) -> Vec<[f32; 3]> {
    let value = |x: usize| if x < width / 2 { mean } else { 0.1 * mean };
    (0..width * height)
        .map(|i| std::array::from_fn(|c| 2.0 * value(i % width) * noise(i as u32, c as u32)))
        .collect()
}

fn plain(width: usize, height: usize, color: &[[f32; 3]]) -> Picture<'_> {
    Picture {
        size: [width, height],
        color,
        albedo: None,
        normal: None,
        clean_guides: false,
        quality: Quality::High,
    }
}

#[test]
fn noise_goes_and_the_edge_stays() {
    let Some(device) = device(2) else { return };
    let (width, height) = (64, 48);
    for mean in [1e-3, 1.0, 1e4] {
        let color = noisy(width, height, mean);
        let albedo: Vec<[f32; 3]> =
            (0..width * height).map(|i| [if i % width < width / 2 { 1.0 } else { 0.1 }; 3]).collect();
        let normal = vec![[0.0, 0.0, 1.0]; width * height];
        let guided = Picture {
            albedo: Some(&albedo),
            normal: Some(&normal),
            clean_guides: true,
            ..plain(width, height, &color)
        };
        let albedo_alone =
            Picture { albedo: Some(&albedo), clean_guides: true, ..plain(width, height, &color) };
        let lower = [Quality::Fast, Quality::Balanced].map(|quality| Picture { quality, ..guided });
        for picture in [plain(width, height, &color), guided, albedo_alone].into_iter().chain(lower) {
            let clean = device.denoise(&picture).unwrap();
            let error = |image: &[[f32; 3]]| -> f32 {
                let relative =
                    |i: usize, v: f32| v / mean / if i % width < width / 2 { 1.0 } else { 0.1 } - 1.0;
                image.iter().enumerate().flat_map(|(i, p)| p.map(|v| relative(i, v).powi(2))).sum()
            };
            assert!(error(&clean) < 0.1 * error(&color), "{mean}: {} {}", error(&clean), error(&color));
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (width, height) = (300, 200);
    let color = noisy(width, height, 1.0);
    let albedo = noisy(width, height, 0.4);
    let normal = noisy(width, height, 0.5);
    let picture = Picture {
        albedo: Some(&albedo),
        normal: Some(&normal),
        clean_guides: true,
        ..plain(width, height, &color)
    };
    let results: Vec<_> = [1, 2, 4]
        .into_iter()
        .filter_map(|threads| Some(device(threads)?.denoise(&picture).unwrap()))
        .collect();
    assert!(results.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn tiny_black_and_bright_pictures_are_no_error() {
    let Some(device) = device(2) else { return };
    for (width, height) in [(1, 1), (1, 7), (16, 1), (3, 2), (17, 33)] {
        for value in [0.0, 1.0, 1e30] {
            let clean = device.denoise(&plain(width, height, &vec![[value; 3]; width * height])).unwrap();
            assert_eq!(clean.len(), width * height);
            assert!(clean.as_flattened().iter().all(|v| v.is_finite()), "{width}x{height} of {value}");
        }
    }
}

#[test]
fn images_of_another_size_are_refused() {
    let Some(device) = device(1) else { return };
    let (color, albedo) = (vec![[0.5; 3]; 12], vec![[0.5; 3]; 11]);
    let picture = Picture { albedo: Some(&albedo), ..plain(4, 3, &color) };
    assert!(matches!(device.denoise(&picture), Err(Error::Size { image: "albedo", size: [11, 1], .. })));
    assert!(matches!(device.denoise(&plain(5, 3, &color)), Err(Error::Size { image: "color", .. })));
    assert!(device.denoise(&plain(0, 0, &[])).is_ok_and(|clean| clean.is_empty()));
}

#[test]
fn qualities_differ_where_both_guides_are_free_of_noise() {
    let Some(device) = device(2) else { return };
    let (width, height) = (96, 64);
    let (color, albedo) = (noisy(width, height, 1.0), vec![[0.5; 3]; width * height]);
    let normal = vec![[0.0, 0.0, 1.0]; width * height];
    let [fast, balanced, high] = [Quality::Fast, Quality::Balanced, Quality::High].map(|quality| {
        let plain = plain(width, height, &color);
        let (albedo, normal) = (Some(&albedo[..]), Some(&normal[..]));
        device.denoise(&Picture { albedo, normal, clean_guides: true, quality, ..plain }).unwrap()
    });
    assert!(fast != balanced && balanced != high && fast != high);
}
