//! Judges of images: means, differences, estimates with their variances, counters.

use glam::DVec3;
use lightsplat::film::metrics::z_test;
use lightsplat::film::{Image, Window};
use lightsplat::math::{Rgb, luminance};
use lightsplat::stats::{Counter, Stats};

/// Mean colour of an image.
pub fn mean(image: &Image) -> DVec3 {
    image.pixels.iter().map(|pixel| pixel.as_dvec3()).sum::<DVec3>() / image.pixels.len() as f64
}

/// Mean luminance of an image.
pub fn mean_luminance(image: &Image) -> f32 {
    image.pixels.iter().map(|pixel| luminance(*pixel)).sum::<f32>() / image.pixels.len() as f32
}

/// Luminance of the brightest pixel.
pub fn brightest(image: &Image) -> f32 {
    image.pixels.iter().map(|pixel| luminance(*pixel)).fold(0.0, f32::max)
}

/// Mean square of the differences of luminance between two images.
pub fn mean_square(test: &Image, reference: &Image) -> f32 {
    let squares = test.pixels.iter().zip(&reference.pixels).map(|(a, b)| luminance(*a - *b).powi(2));
    squares.sum::<f32>() / reference.pixels.len() as f32
}

/// Root of the mean square difference of luminance, relative to the mean luminance of the reference.
pub fn relative_rms(test: &Image, reference: &Image) -> f32 {
    mean_square(test, reference).sqrt() / mean_luminance(reference)
}

/// Ratio of the mean luminances, and [`relative_rms`].
pub fn against(test: &Image, reference: &Image) -> (f32, f32) {
    (mean_luminance(test) / mean_luminance(reference), relative_rms(test, reference))
}

/// Asserts a limit of [`relative_rms`].
#[track_caller]
pub fn assert_rms_below(limit: f32, test: &Image, reference: &Image, what: &str) {
    let error = relative_rms(test, reference);
    assert!(error < limit, "{what}: relative RMS {error}, allowed {limit}");
}

/// Asserts that the ratio of two means is 1 within a limit, in every channel.
#[track_caller]
pub fn assert_means_within(limit: f64, test: DVec3, exact: DVec3, what: &str) {
    let ratio = test / exact;
    assert!((ratio - 1.0).abs().max_element() < limit, "{what}: ratio {ratio}, allowed 1 ± {limit}");
}

/// Asserts that the image of a part of the film repeats the pixels of the image of the whole film.
#[track_caller]
pub fn assert_crop_repeats(whole: &Image, crop: &Image, window: &Window, what: &str) {
    for (i, pixel) in (0..).zip(&crop.pixels) {
        let [x, y] = window.film_pixel([i % window.width, i / window.width]);
        assert_eq!(*pixel, whole.pixels[(y * whole.width + x) as usize], "{what}: pixel {x}, {y}");
    }
}

/// An image with the variance of each of its pixels.
pub struct Estimate {
    pub mean: Image,
    pub variance: Image,
}

/// Mean of the images of several seeds, and the variance of that mean. The variance includes that of rounding.
pub fn over_seeds(seeds: u32, render: impl Fn(u32) -> Image) -> Estimate {
    let mut sums: Vec<[DVec3; 2]> = Vec::new();
    let (mut width, mut height) = (0, 0);
    for seed in 0..seeds {
        let image = render(seed);
        (width, height) = (image.width, image.height);
        sums.resize(image.pixels.len(), [DVec3::ZERO; 2]);
        for ([sum, squares], pixel) in sums.iter_mut().zip(image.pixels) {
            *sum += pixel.as_dvec3();
            *squares += pixel.as_dvec3().powf(2.0);
        }
    }
    let n = f64::from(seeds);
    let image = |of: &dyn Fn(&[DVec3; 2]) -> DVec3| {
        let pixels = sums.iter().map(|sums| of(sums).as_vec3()).collect();
        Image { width, height, pixels }
    };
    let mean = |[sum, _]: &[DVec3; 2]| *sum / n;
    let variance = |sums: &[DVec3; 2]| {
        let (mean, [_, squares]) = (mean(sums), *sums);
        ((squares / n - mean * mean) / (n - 1.0)).max(DVec3::ZERO) + (1e-6 * mean).powf(2.0)
    };
    Estimate { mean: image(&mean), variance: image(&variance) }
}

/// Asserts that two estimates are of the same quantity, by pixel and as a whole, and that they are precise enough to
/// tell 4 % of the whole.
#[track_caller]
pub fn assert_same_mean(test: &Estimate, exact: &Estimate, what: &str) {
    let z = z_test(&test.mean, &exact.mean, &test.variance, &exact.variance);
    // Rare bright paths leave the variance uncertain. Stratified samples vary less than their variance states.
    assert!(z.share_passed > 0.99 && z.mean_z_squared < 1.3, "{what}: {z:?}");
    let sum = |image: &Image| image.pixels.iter().map(|p| p.as_dvec3()).sum::<DVec3>();
    let deviation = (sum(&test.variance) + sum(&exact.variance)).map(f64::sqrt);
    let z = (sum(&test.mean) - sum(&exact.mean)) / deviation;
    let precision = deviation / sum(&exact.mean);
    assert!(z.abs().max_element() < 4.0 && precision.max_element() < 0.01, "{what}: {z} {precision}");
}

/// Means over squares of `size` pixels, in rows.
pub fn regions(image: &Image, size: u32) -> Vec<Rgb> {
    let columns = image.width / size;
    let mut sums = vec![Rgb::ZERO; (columns * (image.height / size)) as usize];
    for (i, pixel) in (0..).zip(&image.pixels) {
        let (x, y) = (i % image.width / size, i / image.width / size);
        sums[(y * columns + x) as usize] += *pixel / (size * size) as f32;
    }
    sums
}

/// Maximum difference of the luminance of a region of `size` by `size` pixels, relative to the reference.
pub fn worst_region(test: &Image, reference: &Image, size: u32) -> f32 {
    let pairs = regions(test, size).into_iter().zip(regions(reference, size));
    pairs.map(|(a, b)| (luminance(a) / luminance(b) - 1.0).abs()).fold(0.0, f32::max)
}

/// Value of a counter of integers; `None` if nothing was counted by that name.
pub fn count(stats: &Stats, name: &str) -> Option<u64> {
    match stats.get(name)? {
        Counter::Count(n) => Some(n),
        other => panic!("{name} is no count: {other:?}"),
    }
}

/// Value of a counter of real numbers; `None` if nothing was counted by that name.
pub fn sum(stats: &Stats, name: &str) -> Option<f64> {
    match stats.get(name)? {
        Counter::Sum(sum) => Some(sum),
        other => panic!("{name} is no sum: {other:?}"),
    }
}

/// Runs `work` on a pool of `threads` threads.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool").install(work)
}
