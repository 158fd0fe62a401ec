//! Measures that compare pixels. All sums are in f64, in the order of the pixels.

use super::super::{Image, tone};
use crate::math::Rgb;
use glam::DVec3;

/// Fraction of the reference's squared mean that is added to the denominator, so that dark pixels do not dominate the
/// relative error.
pub const REL_MSE_FLOOR: f64 = 0.01;

/// Returns the root mean square difference over pixels and channels.
pub fn rmse(test: &Image, reference: &Image) -> f64 {
    mean(pairs(test, reference).map(|(t, r)| (t - r).length_squared() / 3.0)).sqrt()
}

/// Returns the mean over pixels and channels of `(t - r)² / (r² + 0.01 m²)`; m is the reference's mean over pixels and
/// channels.
///
/// The worst pixels are left out; `trim` is their fraction.
pub fn rel_mse(test: &Image, reference: &Image, trim: f64) -> f64 {
    let mut errors = relative_squared(test, reference);
    let kept = (errors.len() as f64 * (1.0 - trim)) as usize;
    if kept < errors.len() {
        errors.sort_by(f64::total_cmp);
        errors.truncate(kept);
    }
    mean(errors.into_iter())
}

/// Returns the root of the mean variance over pixels and channels: the standard error of a typical pixel.
pub fn standard_error(variance: &Image) -> f64 {
    let sum: f64 = variance.pixels.iter().map(|p| p.as_dvec3().element_sum() / 3.0).sum();
    (sum / variance.pixels.len().max(1) as f64).sqrt()
}

/// Returns the expected relative mean square error of an image whose only error is noise of the given `variance` of
/// pixel means.
pub fn rel_mse_of_variance(variance: &Image, reference: &Image) -> f64 {
    let floor = floor(reference);
    mean(pairs(variance, reference).map(|(v, r)| finite_ratio(v, r * r + floor)))
}

/// Returns the relative error of each pixel: the square root of its contribution to [`rel_mse`].
pub fn relative_error_map(test: &Image, reference: &Image) -> Vec<f32> {
    relative_squared(test, reference).into_iter().map(|e| e.sqrt() as f32).collect()
}

/// Returns the peak signal-to-noise ratio of the displayed images in dB, for a peak of 1; `None` if they are identical.
pub fn psnr(test: &Image, reference: &Image, exposure_factor: f32) -> Option<f64> {
    let shown = |p: Rgb| tone::display(p, exposure_factor).as_dvec3();
    let pixels = test.pixels.iter().zip(&reference.pixels);
    let mse = mean(pixels.map(|(&t, &r)| (shown(t) - shown(r)).length_squared() / 3.0));
    (mse > 0.0).then(|| -10.0 * mse.log10())
}

/// Returns the mean of `test` over the mean of `reference`, per channel; `None` if the latter is 0.
pub(super) fn mean_ratio(test: &Image, reference: &Image) -> [Option<f64>; 3] {
    let (test, reference) = (channel_means(test).to_array(), channel_means(reference).to_array());
    std::array::from_fn(|c| (reference[c] != 0.0).then(|| test[c] / reference[c]))
}

/// Returns the standard error of [`mean_ratio`] to first order, from the variances of the pixel means.
pub(super) fn mean_ratio_std_error(
    test: &Image,
    reference: &Image,
    test_variance: &Image,
    reference_variance: &Image,
) -> [Option<f64>; 3] {
    let n = reference.pixels.len().max(1) as f64;
    let means = [test, reference].map(|i| channel_means(i).to_array());
    // The variance of the image's mean is the mean variance over the number of independent pixels.
    let variances = [test_variance, reference_variance].map(|i| (channel_means(i) / n).to_array());
    std::array::from_fn(|c| {
        let ([t, r], [vt, vr]) = (means.map(|m| m[c]), variances.map(|v| v[c]));
        (r != 0.0).then(|| ((vt + vr * (t / r).powi(2)) / (r * r)).sqrt())
    })
}

fn relative_squared(test: &Image, reference: &Image) -> Vec<f64> {
    let floor = floor(reference);
    pairs(test, reference).map(|(t, r)| finite_ratio((t - r) * (t - r), r * r + floor)).collect()
}

/// Returns the mean over the channels of numerator / denominator; 0 / 0 is 0 (black against black).
fn finite_ratio(numerator: DVec3, denominator: DVec3) -> f64 {
    let ratio = |n: f64, d: f64| if n == 0.0 { 0.0 } else { n / d };
    let [n, d] = [numerator.to_array(), denominator.to_array()];
    (ratio(n[0], d[0]) + ratio(n[1], d[1]) + ratio(n[2], d[2])) / 3.0
}

fn floor(reference: &Image) -> f64 {
    let mean = channel_means(reference).element_sum() / 3.0;
    REL_MSE_FLOOR * mean * mean
}

fn channel_means(image: &Image) -> DVec3 {
    image.pixels.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / image.pixels.len().max(1) as f64
}

fn pairs<'a>(a: &'a Image, b: &'a Image) -> impl ExactSizeIterator<Item = (DVec3, DVec3)> + 'a {
    a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a.as_dvec3(), b.as_dvec3()))
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len().max(1) as f64;
    values.sum::<f64>() / n
}
