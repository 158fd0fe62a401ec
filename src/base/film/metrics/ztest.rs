//! Test whether two noisy renderings of a scene agree within their noise.
//!
//! The hypothesis for each pixel and channel is that both pixel means estimate one radiance. The level (Šidák) keeps
//! the probability of any false alarm among all pixels at 1 %. Because of heavy tails and inaccurate variances, the
//! image passes if 99.75 % of the tests do.
//!
//! Paper: Subr & Arvo, *Statistical Hypothesis Testing for Assessing Monte Carlo Estimators*, 2007.

use super::super::Image;
use glam::DVec3;
use serde::Serialize;

/// Probability of any false alarm among all pixels.
pub const SIGNIFICANCE: f64 = 0.01;
/// Fraction of the tests that have to pass.
pub const SHARE_REQUIRED: f64 = 0.9975;

/// Outcome over all pixels and channels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ZTest {
    /// Level of each test: `1 - (1 - 0.01)^(1 / pixels)`.
    pub level: f64,
    /// Fraction of the tests (pixels times channels) whose two-sided p-value is above the level.
    pub share_passed: f64,
    /// True if that is at least [`SHARE_REQUIRED`].
    pub passed: bool,
    /// Mean of z² over the tests with a variance; 1 if the differences are noise.
    pub mean_z_squared: f64,
}

/// Tests `test` against `reference`, given the variances of their pixel means. All four must have one size.
///
/// If both variances are 0, the two values must be equal.
pub fn z_test(test: &Image, reference: &Image, test_variance: &Image, reference_variance: &Image) -> ZTest {
    let pixels = reference.pixels.len().max(1) as f64;
    // 1 - (1 - s)^(1/n), without losing digits for large n.
    let level = -((1.0 - SIGNIFICANCE).ln() / pixels).exp_m1();
    let (mut passed, mut tests, mut with_variance, mut sum_z_squared) = (0u64, 0u64, 0u64, 0.0);
    let values = test.pixels.iter().zip(&reference.pixels);
    let variances = test_variance.pixels.iter().zip(&reference_variance.pixels);
    for ((t, r), (vt, vr)) in values.zip(variances) {
        let difference = t.as_dvec3() - r.as_dvec3();
        let variance = vt.as_dvec3() + vr.as_dvec3();
        for (d, v) in difference.to_array().into_iter().zip(variance.to_array()) {
            tests += 1;
            if v > 0.0 {
                with_variance += 1;
                sum_z_squared += d * d / v;
                passed += u64::from(two_sided_p_value(d.abs() / v.sqrt()) > level);
            } else {
                passed += u64::from(d == 0.0);
            }
        }
    }
    let share_passed = passed as f64 / tests.max(1) as f64;
    ZTest {
        level,
        share_passed,
        passed: share_passed >= SHARE_REQUIRED,
        mean_z_squared: sum_z_squared / with_variance.max(1) as f64,
    }
}

/// Side in pixels of the blocks of [`z_test_blocks`].
pub const BLOCK: u32 = 8;

/// Tests means of 8x8 pixels as [`z_test`] tests pixels.
///
/// With few samples per pixel, means are heavy-tailed and variances inaccurate, so correct images fail the test of
/// single pixels. Means over blocks are closer to normal, and eight times as sensitive to bias.
pub fn z_test_blocks(
    test: &Image,
    reference: &Image,
    test_variance: &Image,
    reference_variance: &Image,
) -> ZTest {
    let [test, reference] = [test, reference].map(|image| block_means(image, false));
    let [test_variance, reference_variance] =
        [test_variance, reference_variance].map(|image| block_means(image, true));
    z_test(&test, &reference, &test_variance, &reference_variance)
}

/// Returns means over blocks, smaller ones at the right and bottom edge; or the variances of such means, from variances
/// of independent values.
fn block_means(image: &Image, variances: bool) -> Image {
    let mut blocks = Image::new(image.width.div_ceil(BLOCK), image.height.div_ceil(BLOCK));
    let columns = blocks.width;
    for (i, block) in blocks.pixels.iter_mut().enumerate() {
        let (x, y) = (i as u32 % columns * BLOCK, i as u32 / columns * BLOCK);
        let (right, bottom) = ((x + BLOCK).min(image.width), (y + BLOCK).min(image.height));
        let rows = (y..bottom).map(|y| (y as usize * image.width as usize, x as usize, right as usize));
        let pixels = rows.flat_map(|(row, x, right)| &image.pixels[row + x..row + right]);
        let sum: DVec3 = pixels.map(|p| p.as_dvec3()).sum();
        let n = f64::from((right - x) * (bottom - y));
        *block = (sum / if variances { n * n } else { n }).as_vec3();
    }
    blocks
}

/// Returns the probability that a standard normal variable is at least `z` away from 0.
fn two_sided_p_value(z: f64) -> f64 {
    libm::erfc(z / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;

    #[test]
    fn blocks_average_whole_and_cut_ones() {
        let mut image = Image::new(10, 9);
        image.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = Rgb::splat((i % 10) as f32));
        let means = block_means(&image, false);
        assert_eq!((means.width, means.height), (2, 2));
        assert_eq!(means.pixels.iter().map(|p| p.x).collect::<Vec<_>>(), [3.5, 8.5, 3.5, 8.5]);
        image.pixels.fill(Rgb::splat(6.4));
        let variances: Vec<f32> = block_means(&image, true).pixels.iter().map(|p| p.y).collect();
        for (variance, n) in variances.into_iter().zip([64.0, 16.0, 8.0, 2.0]) {
            assert!((variance - 6.4 / n).abs() < 1e-6);
        }
    }

    #[test]
    fn p_values_match_the_normal_table() {
        for (z, p) in [(0.0, 1.0), (1.0, 0.317310508), (1.959963985, 0.05), (5.0, 5.733031e-7)] {
            assert!((two_sided_p_value(z) / p - 1.0).abs() < 1e-6, "{z}");
        }
    }
}
