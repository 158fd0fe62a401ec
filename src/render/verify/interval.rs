//! Confidence intervals by resampling.
//!
//! Paper: Efron, *Better Bootstrap Confidence Intervals*, 1987: percentiles of the estimate over resamples, shifted for
//! bias and for skewness (BCa). Errors of images are skewed: a small part of the pixels has most of the square error.

use base::sampling::hash;
use serde::Serialize;

/// Number of resamples.
pub const RESAMPLES: u32 = 2000;

/// Standard normal quantile of 97.5 %.
pub const NORMAL_975: f64 = 1.959963984540054;

/// An estimate and its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Estimate {
    /// True if the interval covers `truth`.
    pub fn covers(&self, truth: f64) -> bool {
        self.low <= truth && truth <= self.high
    }

    /// Maps estimate and interval by a non-decreasing function.
    pub fn map(self, f: impl Fn(f64) -> f64) -> Estimate {
        Estimate { value: f(self.value), low: f(self.low), high: f(self.high) }
    }
}

/// Samples the number of times that each of `count` items occurs in resample `r`.
///
/// Resamples are made one at a time, since all resamples of a large image would not fit into memory.
pub fn resample(times: &mut Vec<u16>, count: usize, seed: u32, r: u32) {
    times.clear();
    times.resize(count, 0);
    let stream = hash(seed, r);
    for k in 0..count as u32 {
        let chosen = (u64::from(hash(k, stream)) * count as u64) >> 32;
        times[chosen as usize] += 1;
    }
}

/// Computes the interval around `value`, from the estimates of resamples and their [`acceleration`] (0 if unknown).
pub fn bca(value: f64, mut again: Vec<f64>, acceleration: f64) -> Estimate {
    again.retain(|x| x.is_finite());
    again.sort_by(f64::total_cmp);
    let n = again.len();
    if n == 0 {
        return Estimate { value, low: value, high: value };
    }
    let below = again.partition_point(|&x| x < value) as f64;
    let not_above = again.partition_point(|&x| x <= value) as f64;
    let share = (0.5 * (below + not_above) / n as f64).clamp(1.0 / n as f64, 1.0 - 1.0 / n as f64);
    let bias = normal_quantile(share);
    let end = |z: f64| {
        let z = bias + z;
        let p = normal_cdf(bias + z / (1.0 - acceleration * z).max(0.1));
        again[((p * n as f64) as usize).min(n - 1)]
    };
    Estimate { value, low: end(-NORMAL_975), high: end(NORMAL_975) }
}

/// Returns a sixth of the skewness of `influences`, whose mean is 0, over the root of their number.
pub fn acceleration(influences: impl Iterator<Item = f64>) -> f64 {
    let (mut squares, mut cubes) = (0.0, 0.0);
    for d in influences {
        squares += d * d;
        cubes += d * d * d;
    }
    if squares > 0.0 { cubes / (6.0 * squares.powf(1.5)) } else { 0.0 }
}

fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)
}

/// Returns the inverse of [`normal_cdf`] for 0 < p < 1, by bisection.
fn normal_quantile(p: f64) -> f64 {
    let (mut low, mut high) = (-40.0, 40.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if normal_cdf(middle) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_invert_the_distribution() {
        for (p, z) in [(0.5, 0.0), (0.975, NORMAL_975), (0.025, -NORMAL_975), (0.841344746, 1.0)] {
            assert!((normal_quantile(p) - z).abs() < 1e-6, "{p}");
        }
    }

    #[test]
    fn intervals_of_skewed_means_cover_the_truth_about_as_often_as_they_say() {
        // Squares of normal numbers: mean 1, skewness √8.
        let normal = |a: u32, b: u32| {
            let u = |x: u32| (f64::from(x) + 0.5) / 4294967296.0;
            let (r, t) = ((-2.0 * u(hash(a, 2 * b)).ln()).sqrt(), u(hash(a, 2 * b + 1)));
            r * (std::f64::consts::TAU * t).cos()
        };
        let (trials, n) = (300, 60);
        let mut covered = 0;
        for trial in 0..trials {
            let values: Vec<f64> = (0..n).map(|i| normal(trial, i).powi(2)).collect();
            let mean = |times: &[u16]| {
                times.iter().zip(&values).map(|(&t, v)| f64::from(t) * v).sum::<f64>() / f64::from(n)
            };
            let value = mean(&vec![1; n as usize]);
            let mut times = Vec::new();
            let again = (0..RESAMPLES).map(|r| {
                resample(&mut times, n as usize, trial, r);
                mean(&times)
            });
            let again = again.collect();
            let skew = acceleration(values.iter().map(|v| v - value));
            covered += u32::from(bca(value, again, skew).covers(1.0));
        }
        let share = f64::from(covered) / f64::from(trials);
        assert!((0.90..=0.985).contains(&share), "{share}");
    }
}
