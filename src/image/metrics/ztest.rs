//! Are two noisy renderings of a scene the same within their noise?
//!
//! Each pixel and channel is tested against the hypothesis that both pixel means estimate the same radiance,
//! at a level (Šidák) that keeps the chance of even one false alarm among all pixels at 1 %. As heavy tails and
//! badly known variances must be expected, the picture passes if 99.75 % of the tests do.
//!
//! Paper: Subr & Arvo, *Statistical Hypothesis Testing for Assessing Monte Carlo Estimators*, 2007.

use super::super::Image;
use serde::Serialize;

/// Chance of any false alarm among all pixels.
pub const SIGNIFICANCE: f64 = 0.01;
/// Share of the tests that has to pass.
pub const SHARE_REQUIRED: f64 = 0.9975;

/// The outcome over all pixels and channels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ZTest {
    /// Level of each test: `1 - (1 - 0.01)^(1 / pixels)`.
    pub level: f64,
    /// Share of the tests (pixels times channels) whose two-sided p-value is above the level.
    pub share_passed: f64,
    /// Whether that is at least 99.75 %.
    pub passed: bool,
    /// Mean of z² over the tests that have a variance; 1 if the differences are just the noise.
    pub mean_z_squared: f64,
}

/// Tests `test` against `reference`, given the variances of their pixel means. All four of the same size.
///
/// Where both variances are 0 the two values must be equal.
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

/// Chance that a standard normal variable is at least `z` away from 0.
fn two_sided_p_value(z: f64) -> f64 {
    libm::erfc(z / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn p_values_match_the_normal_table() {
        for (z, p) in [(0.0, 1.0), (1.0, 0.317310508), (1.959963985, 0.05), (5.0, 5.733031e-7)] {
            assert!((two_sided_p_value(z) / p - 1.0).abs() < 1e-6, "{z}");
        }
    }
}
