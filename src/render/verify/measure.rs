//! The error of an image, from noisy values of some of its pixels.
//!
//! K independent means of path-traced radiance estimate the truth of a pixel. The relative square error of a channel is
//! `(t - r)² / (r² + 0.01 m²)`, as in [`base::film::metrics::rel_mse`]. Noise of r biases it upwards, by its variance
//! and by the non-linear quotient. The jackknife over the K means removes both to first order, and entirely if the
//! denominator does not matter.
//!
//! The 95th percentile is biased upwards as well. Omitting every other mean doubles the variance of the noise. The
//! square of the percentile at one and at two parts of noise is extrapolated linearly to zero noise. If noise
//! dominates, the extrapolation is ill-conditioned (it may be negative), and the bootstrap does not reveal it. The
//! percentile counts as unresolved then. Its interval reaches from 0 to the upper end of the percentile with the noise,
//! since noise spreads errors.
//!
//! Papers: Quenouille 1956 (jackknife); Cook and Stefanski, *Simulation-Extrapolation Estimation*, 1994.
//! Deviations: the line is exact for errors that are all noise or all constant, and approximate in between. Intervals
//! treat picks as independent, though they are stratified, and so are rather too wide. A pick of probability 1 varies
//! by the noise of its means only, others by a mixture according to their probability. For the percentile all vary as
//! if they were picked at random.

use super::interval::{Estimate, RESAMPLES, acceleration, bca, resample};
use base::film::metrics::REL_MSE_FLOOR;
use base::sampling::hash;
use glam::DVec3;
use rayon::prelude::*;

/// Number of independent means at each pixel.
pub const MEANS: usize = 16;

/// Share of the pixels whose error is at most the percentile reported.
const PERCENTILE: f64 = 0.95;

/// Maximum share of noise in the percentile's square for the extrapolation to zero noise to be trusted.
const RESOLVED: f64 = 0.5;

/// A pixel whose error is measured.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Value of the pixel in the image.
    pub value: DVec3,
    /// Independent unbiased estimates of its true value.
    pub means: [DVec3; MEANS],
    /// Number of pixels it represents.
    pub weight: f64,
}

/// Estimates of the errors of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Mean of the image over mean of the truth, minus 1.
    pub bias: Estimate,
    /// Root of the mean relative square error.
    pub rms: Estimate,
    /// Relative error not exceeded by 95 % of the pixels.
    pub percentile_95: Estimate,
    /// True if errors dominate the percentile. If noise does, the interval begins at 0.
    pub percentile_resolved: bool,
    /// Root of the mean relative variance of the truth's estimates.
    pub noise: f64,
}

/// Estimates by a resample of the pixels.
struct Resampled {
    difference: f64,
    square: f64,
    /// Square of the percentile with noise.
    noisy: f64,
    /// Square of the percentile, extrapolated to zero noise.
    clean: f64,
}

/// Computes the errors of an image whose mean over pixels and channels is `mean`.
pub fn errors(pixels: &[Measured], mean: f64, seed: u32) -> Errors {
    let differences: Vec<(f64, f64)> = pixels.iter().map(Measured::difference).collect();
    let difference = mean_of(pixels, &differences);
    let floor = REL_MSE_FLOOR * (mean - difference) * (mean - difference);
    let squares: Vec<(f64, f64)> = pixels.iter().map(|p| p.relative_square(floor)).collect();
    let variances: Vec<(f64, f64)> = pixels.iter().map(|p| (p.relative_variance(floor), 0.0)).collect();
    let noise = mean_of(pixels, &variances).sqrt();

    let ranked = [0, 1, 2].map(|part| Ranked::new(pixels, floor, part));
    // Squares of the percentile with noise, and extrapolated to zero noise.
    let percentile = |times: Option<&[u16]>| {
        let [all, even, odd] = [0, 1, 2].map(|part| ranked[part].percentile(pixels, times));
        (all, 2.0 * all - 0.5 * (even + odd))
    };
    let again: Vec<Resampled> = (0..RESAMPLES)
        .into_par_iter()
        .map_init(Vec::new, |times, r| {
            resample(times, pixels.len(), seed, r);
            let seed = hash(seed, r);
            let [difference, square] =
                [&differences, &squares].map(|values| resampled(pixels, values, times, seed));
            let (noisy, clean) = percentile(Some(times));
            Resampled { difference, square, noisy, clean }
        })
        .collect();
    let all = |value: fn(&Resampled) -> f64| again.iter().map(value).collect::<Vec<f64>>();
    let interval = |values: &[(f64, f64)], again| {
        let value = mean_of(pixels, values);
        let weights: f64 = pixels.iter().map(|p| p.weight).sum();
        let influences =
            pixels.iter().zip(values).map(|(p, v)| p.chance() * p.weight / weights * (v.0 - value));
        bca(value, again, acceleration(influences))
    };
    let bias = interval(&differences, all(|again| again.difference)).map(|d| ratio(d, mean - d));
    let rms = interval(&squares, all(|again| again.square)).map(|square| square.max(0.0).sqrt());
    let (noisy, clean) = percentile(None);
    let percentile_resolved = noisy - clean <= RESOLVED * noisy;
    let mut square = bca(clean, all(|again| again.clean), 0.0);
    if !percentile_resolved {
        (square.low, square.high) = (0.0, bca(noisy, all(|again| again.noisy), 0.0).high.max(clean));
    }
    let percentile_95 = square.map(|square| square.max(0.0).sqrt());
    Errors { bias, rms, percentile_95, percentile_resolved, noise }
}

/// Estimates the mean over the image from values at the picks.
fn mean_of(pixels: &[Measured], values: &[(f64, f64)]) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (p, (value, _)) in pixels.iter().zip(values) {
        sum += p.weight * value;
        total += p.weight;
    }
    if total > 0.0 { sum / total } else { 0.0 }
}

/// Estimates the mean over the image for other random picks and noise.
fn resampled(pixels: &[Measured], values: &[(f64, f64)], times: &[u16], seed: u32) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (i, (p, (value, deviation))) in pixels.iter().zip(values).enumerate() {
        let chance = p.chance();
        let weight = p.weight * (1.0 + (f64::from(times[i]) - 1.0) * chance);
        // Uniform, of variance 1.
        let deviate = (f64::from(hash(i as u32, seed)) / 4294967296.0 - 0.5) * 12f64.sqrt();
        sum += weight * value + p.weight * (1.0 - chance * chance).sqrt() * deviation * deviate;
        total += weight;
    }
    if total > 0.0 { sum / total } else { 0.0 }
}

impl Measured {
    /// Returns the root of the probability that the pixel would not have been picked.
    fn chance(&self) -> f64 {
        (1.0 - 1.0 / self.weight.max(1.0)).sqrt()
    }

    /// Returns image minus truth, mean over channels, and the standard error.
    fn difference(&self) -> (f64, f64) {
        let of = |truth: DVec3| (self.value - truth).element_sum() / 3.0;
        self.jackknife(of)
    }

    /// Estimates a function of the truth without the bias due to its noise, and its standard error.
    fn jackknife(&self, of: impl Fn(DVec3) -> f64) -> (f64, f64) {
        let truth = self.truth();
        let (n, less) = (MEANS as f64, (MEANS - 1) as f64);
        let all = of(truth);
        let pseudo = self.means.map(|m| n * all - less * of((truth * n - m) / less));
        let mean = pseudo.iter().sum::<f64>() / n;
        let squares: f64 = pseudo.iter().map(|p| (p - mean) * (p - mean)).sum();
        (mean, (squares / (n * less)).sqrt())
    }

    /// Returns the best estimate of the pixel's true value.
    pub fn truth(&self) -> DVec3 {
        self.means.iter().sum::<DVec3>() / MEANS as f64
    }

    /// Returns the variance of [`Measured::truth`].
    pub fn variance(&self) -> DVec3 {
        let truth = self.truth();
        let squares: DVec3 = self.means.iter().map(|m| (m - truth) * (m - truth)).sum();
        squares / (MEANS * (MEANS - 1)) as f64
    }

    /// Returns the variance of [`Measured::truth`] over its square, mean over channels.
    pub fn relative_variance(&self, floor: f64) -> f64 {
        let truth = self.truth();
        quotient(self.variance(), truth * truth + floor)
    }

    /// Returns the relative square error without the part of the noise (may be negative), and its standard error.
    fn relative_square(&self, floor: f64) -> (f64, f64) {
        self.jackknife(|truth| {
            let difference = self.value - truth;
            quotient(difference * difference, truth * truth + floor)
        })
    }

    /// Returns the relative square error with noise, by all means (part 0) or by every other one (parts 1 and 2).
    fn noisy_square(&self, floor: f64, part: usize) -> f64 {
        let truth = self.truth();
        let estimate = match part {
            0 => truth,
            _ => self.means[part - 1..].iter().step_by(2).sum::<DVec3>() / (MEANS / 2) as f64,
        };
        let difference = self.value - estimate;
        quotient(difference * difference, truth * truth + floor)
    }
}

/// Pixels sorted by their errors.
struct Ranked(Vec<(f64, usize)>);

impl Ranked {
    fn new(pixels: &[Measured], floor: f64, part: usize) -> Ranked {
        let mut ranked: Vec<(f64, usize)> =
            pixels.iter().enumerate().map(|(i, p)| (p.noisy_square(floor, part), i)).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ranked(ranked)
    }

    fn percentile(&self, pixels: &[Measured], times: Option<&[u16]>) -> f64 {
        let weight = |i: usize| pixels[i].weight * times.map_or(1.0, |times| f64::from(times[i]));
        let total: f64 = (0..pixels.len()).map(weight).sum();
        let mut above = (1.0 - PERCENTILE) * total;
        for &(error, i) in self.0.iter().rev() {
            above -= weight(i);
            if above < 0.0 {
                return error;
            }
        }
        0.0
    }
}

/// Returns the mean over the channels of numerator / denominator; 0 / 0 is 0, for black pixels that are correct.
fn quotient(numerator: DVec3, denominator: DVec3) -> f64 {
    (0..3).map(|c| ratio(numerator[c], denominator[c])).sum::<f64>() / 3.0
}

fn ratio(numerator: f64, denominator: f64) -> f64 {
    if numerator == 0.0 { 0.0 } else { numerator / denominator }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(a: u32, b: u32) -> f64 {
        (f64::from(hash(a, b)) + 0.5) / 4294967296.0
    }

    /// Creates pixels of truth 0.2 to 2 with the given errors, measured with relative noise `noise`.
    fn pixels(n: u32, noise: f64, error: impl Fn(u32) -> f64) -> Vec<Measured> {
        let pixel = |i: u32| {
            let truth = DVec3::new(1.0, 0.5, 0.8) * (0.2 + 1.8 * uniform(i, 90));
            // The sum of four uniform numbers is nearly normal; its variance is a third.
            let deviate = |k: u32| (0..4).map(|j| uniform(i, 4 * k + j) - 0.5).sum::<f64>() * 3f64.sqrt();
            let scale = noise * (MEANS as f64).sqrt();
            let means = std::array::from_fn(|k| truth * (1.0 + scale * deviate(k as u32)));
            // Picked from an image of very many pixels.
            Measured { value: truth * (1.0 + error(i)), means, weight: 1e6 }
        };
        (0..n).map(pixel).collect()
    }

    fn mean(pixels: &[Measured]) -> f64 {
        pixels.iter().map(|p| p.value.element_sum() / 3.0).sum::<f64>() / pixels.len() as f64
    }

    #[test]
    fn known_errors_are_found_through_noise_as_large() {
        // Half of the pixels 2 % too bright, a tenth 8 % too dark.
        let error = |i: u32| match i % 10 {
            0..5 => 0.02,
            5 => -0.08,
            _ => 0.0,
        };
        let expected = (0.5 * 0.02f64.powi(2) + 0.1 * 0.08f64.powi(2)).sqrt() / (1.0f64 + 0.01).sqrt();
        for noise in [0.0, 0.005, 0.02] {
            let pixels = pixels(4000, noise, error);
            let found = errors(&pixels, mean(&pixels), 1);
            assert!(found.rms.covers(expected) && found.rms.high < 1.15 * expected, "{noise} {found:?}");
            assert!(found.bias.covers(0.002) && found.bias.high < 0.0045, "{noise} {found:?}");
            assert!((found.noise - noise).abs() < 0.05 * noise + 1e-9, "{noise} {found:?}");
        }
        let clean = pixels(4000, 0.0, error);
        let found = errors(&clean, mean(&clean), 1).percentile_95;
        assert!((found.value - 0.08).abs() < 0.002, "{found:?}");
    }

    #[test]
    fn percentiles_lose_the_noise() {
        let noisy = pixels(4000, 0.01, |_| 0.0);
        let found = errors(&noisy, mean(&noisy), 2);
        // Unresolved, and no larger than if all noise were error: 1.96 times its deviation, and a tenth for the
        // interval.
        assert!(!found.percentile_resolved && found.percentile_95.low == 0.0, "{found:?}");
        assert!(found.percentile_95.high < 1.1 * 1.96 * 0.01, "{found:?}");
        assert!(found.rms.low == 0.0 && found.rms.high < 0.003 && found.bias.covers(0.0), "{found:?}");
        // Errors are uniform between -10 % and 10 %: 95 % of them are below 9.5 %, and a little less with the floor.
        let spread = |i: u32| 0.2 * uniform(i, 77) - 0.1;
        let noisy = pixels(4000, 0.02, spread);
        let found = errors(&noisy, mean(&noisy), 3).percentile_95;
        let clean = pixels(4000, 0.0, spread);
        let truth = errors(&clean, mean(&clean), 3).percentile_95.value;
        assert!((truth - 0.0945).abs() < 0.002, "{truth}");
        // The extrapolation is approximate here.
        assert!((found.value / truth - 1.0).abs() < 0.06 && found.high - found.low < 0.02, "{found:?}");
    }

    #[test]
    fn a_percentile_lost_in_noise_is_called_unknown_and_covered() {
        // Nine pixels in ten are measured to 1 %, the others, as at the cap of paths, with great noise.
        for (error, seed) in [(0.0, 5), (0.02, 6), (0.05, 7), (0.1, 8)] {
            let rough = pixels(1000, 0.5, |i| error * f64::from(i % 2));
            let mut mixed = pixels(1000, 0.01, |i| error * f64::from(i % 2));
            mixed.iter_mut().zip(rough).step_by(10).for_each(|(p, r)| *p = r);
            let found = errors(&mixed, mean(&mixed), seed);
            let truth = error / (1.0f64 + 0.01).sqrt();
            assert!(!found.percentile_resolved && found.percentile_95.covers(truth), "{error} {found:?}");
            assert!(found.percentile_95.high > 0.1 && found.percentile_95.high < 2.0, "{error} {found:?}");
        }
        let clean = pixels(1000, 0.001, |i| 0.1 * f64::from(i % 2));
        let found = errors(&clean, mean(&clean), 9);
        assert!(found.percentile_resolved && found.percentile_95.low > 0.09, "{found:?}");
    }

    #[test]
    fn picks_that_were_certain_vary_by_noise_alone() {
        let with = |weight: f64, noise: f64| {
            let mut pixels = pixels(500, noise, |i| 0.1 * f64::from(i % 2));
            pixels.iter_mut().for_each(|p| p.weight = weight);
            let found = errors(&pixels, mean(&pixels), 4);
            [found.bias, found.rms].map(|e| e.high - e.low)
        };
        let [certain, noisy, picked] = [with(1.0, 0.0), with(1.0, 0.02), with(1e6, 0.02)];
        for k in 0..2 {
            assert!(
                certain[k] < 1e-12 && noisy[k] > 1e-4 && picked[k] > 1.5 * noisy[k],
                "{noisy:?} {picked:?}"
            );
        }
    }

    #[test]
    fn black_images_of_black_scenes_are_right() {
        let black = Measured { value: DVec3::ZERO, means: [DVec3::ZERO; MEANS], weight: 1.0 };
        let found = errors(&[black; 5], 0.0, 0);
        assert_eq!((found.bias.value, found.rms.value, found.percentile_95.value), (0.0, 0.0, 0.0));
        assert_eq!(errors(&[], 0.0, 0).rms.value, 0.0);
    }
}
