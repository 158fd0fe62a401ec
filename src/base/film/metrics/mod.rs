//! Errors of an image against a reference of one scene.
//!
//! Relative error is measured on linear radiance, PSNR and FLIP on displayed values. Display means: exposed so that the
//! *reference's* 90th percentile of luminance is 0.8, clipped at 1, sRGB. A reference has noise, too. If its variance
//! is known, [`Comparison::reference_rel_mse`] is the part of the relative error due to it.

mod flip;
mod pixelwise;
mod ztest;

use super::{Image, ImageError, tone};
use serde::Serialize;

pub use flip::{PIXELS_PER_DEGREE, flip_map, magma};
pub use pixelwise::{
    REL_MSE_FLOOR, psnr, rel_mse, rel_mse_of_variance, relative_error_map, rmse, standard_error,
};
pub use ztest::{BLOCK, SHARE_REQUIRED, SIGNIFICANCE, ZTest, z_test, z_test_blocks};

/// All measures of one image against a reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Mean over pixels and channels of `(t - r)² / (r² + 0.01 m²)`, m the reference's mean.
    pub rel_mse: f64,
    /// Value of `rel_mse` without the worst 0.1 % of pixels, so that outliers do not dominate.
    pub rel_mse_trimmed: f64,
    /// Part of `rel_mse` due to the reference's noise, if its variance is known.
    pub reference_rel_mse: Option<f64>,
    /// Root mean square difference of radiance.
    pub rmse: f64,
    /// Peak signal-to-noise ratio of the displayed images in dB; `None` if they are identical.
    pub psnr: Option<f64>,
    /// Mean FLIP of the displayed images, 0 (identical) to 1.
    pub flip: f64,
    /// Mean of the image over mean of the reference, per channel; `None` if the reference is black.
    pub mean_ratio: [Option<f64>; 3],
    /// Standard error of `mean_ratio`, if both variances are known.
    pub mean_ratio_std_error: Option<[Option<f64>; 3]>,
    /// Test whether the differences agree with the variances, if both are known.
    pub z_test: Option<ZTest>,
    /// Test of means over 8x8 pixels, for images of few samples.
    pub z_test_blocks: Option<ZTest>,
    /// Factor on radiance before display.
    pub exposure: f64,
}

/// Variances of the pixel means of an image and its reference.
#[derive(Clone, Copy, Debug, Default)]
pub struct Variances<'a> {
    /// Variance of the image.
    pub test: Option<&'a Image>,
    /// Variance of the reference.
    pub reference: Option<&'a Image>,
}

/// Compares `test` with `reference`; every channel of all images must be finite.
///
/// # Errors
/// If the sizes of images differ.
pub fn compare(test: &Image, reference: &Image, variances: Variances) -> Result<Comparison, ImageError> {
    same_size("the two images differ in size", test, reference)?;
    for variance in [variances.test, variances.reference].into_iter().flatten() {
        same_size("a variance and its image differ in size", variance, reference)?;
    }
    let factor = tone::auto_factor(reference);
    let flip = flip_map(test, reference, factor);
    let both = variances.test.zip(variances.reference);
    Ok(Comparison {
        rel_mse: rel_mse(test, reference, 0.0),
        rel_mse_trimmed: rel_mse(test, reference, 0.001),
        reference_rel_mse: variances.reference.map(|variance| rel_mse_of_variance(variance, reference)),
        rmse: rmse(test, reference),
        psnr: psnr(test, reference, factor),
        flip: flip.iter().map(|&e| e as f64).sum::<f64>() / flip.len().max(1) as f64,
        mean_ratio: pixelwise::mean_ratio(test, reference),
        mean_ratio_std_error: both.map(|(t, r)| pixelwise::mean_ratio_std_error(test, reference, t, r)),
        z_test: both.map(|(t, r)| z_test(test, reference, t, r)),
        z_test_blocks: both.map(|(t, r)| z_test_blocks(test, reference, t, r)),
        exposure: factor as f64,
    })
}

fn same_size(what: &str, a: &Image, b: &Image) -> Result<(), ImageError> {
    let sizes = [[a.width, a.height], [b.width, b.height]];
    if sizes[0] == sizes[1] { Ok(()) } else { Err(ImageError::Size { what: what.to_owned(), sizes }) }
}

#[cfg(test)]
mod tests;
