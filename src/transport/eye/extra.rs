//! Number of extra samples, from the cost of samples relative to all other work.
//!
//! Light found by records and cuts takes the same time for any number of samples. If the error has the variance A + B
//! / n and the time is R + e n, their product is least at n = √(B R / (A e)). The smaller the samples' part of the
//! time, the more samples pay off. They go to the pixels that need them most, where B is many times the mean. Where
//! all of an image is noisy, all pixels get their first samples twice.

/// Share of extra samples if samples take as many rays as all other work.
const SHARE_AT_EQUAL_RAYS: f64 = 0.3;

/// Minimum share of extra samples.
const MIN_SHARE: f32 = 0.2;

/// Relative variance of a denoised image that more samples of direct light do not reduce.
const RESIDUAL_VARIANCE: f32 = 0.003;

/// Price of a ray of other work over a ray of samples.
const OTHER_RAY: f64 = 2.0;

/// Budget of extra samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExtraSamples {
    /// Maximum number of extra samples, as a share of the first ones.
    pub most: f32,
    /// Approximate number of other rays in the image of the whole film. If unknown, the maximum is taken.
    pub other_rays: Option<f64>,
}

impl ExtraSamples {
    /// Returns the number of extra samples as a share of the first ones, which take `rays` in the whole film.
    pub fn share(&self, rays: f64) -> f32 {
        let share = |other: f64| ((SHARE_AT_EQUAL_RAYS * other / rays.max(1.0)) as f32).max(MIN_SHARE);
        self.other_rays.map_or(self.most, |other| share(other).min(self.most))
    }

    /// Returns how often all pixels get the first samples: twice if this lowers the product of error and time, else
    /// once. The first samples take `rays` in the whole film and leave the relative variance `variance`.
    pub fn rounds(&self, rays: f64, variance: f32) -> u32 {
        let Some(other) = self.other_rays.filter(|_| self.most >= 1.0) else { return 1 };
        let time = |rounds: f64| OTHER_RAY * other + rounds * rays;
        let error = |rounds: f32| f64::from((RESIDUAL_VARIANCE + variance / rounds).sqrt());
        if error(2.0) * time(2.0) < error(1.0) * time(1.0) { 2 } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extra_samples_are_fewer_the_more_of_the_time_samples_take() {
        let share = |most, rays| ExtraSamples { most, other_rays: Some(1e7) }.share(rays);
        let shares: Vec<f32> = (0..40).map(|i| share(1.0, 10f64.powf(3.0 + 0.125 * f64::from(i)))).collect();
        assert!(shares.is_sorted_by(|a, b| a >= b), "{shares:?}");
        assert_eq!([shares[0], shares[39]], [1.0, MIN_SHARE]);
        assert!(shares.iter().any(|share| *share > MIN_SHARE && *share < 1.0), "{shares:?}");
        assert_eq!([1e3, 6e6, 1e8].map(|rays| share(0.1, rays)), [0.1; 3]);
        assert_eq!(share(1.0, 0.0), 1.0);
        assert_eq!(ExtraSamples { most: 0.7, other_rays: None }.share(1e9), 0.7);
    }

    #[test]
    fn a_second_round_pays_for_noisy_images_whose_samples_are_cheap() {
        let rounds =
            |other, variance| ExtraSamples { most: 1.0, other_rays: Some(other) }.rounds(1e7, variance);
        let exponents = || (0..40).map(|i| 10f64.powf(-8.0 + 0.25 * f64::from(i)));
        let by_work: Vec<u32> = exponents().map(|work| rounds(1e14 * work, 0.1)).collect();
        let by_noise: Vec<u32> = exponents().map(|noise| rounds(1e9, noise as f32)).collect();
        for counts in [&by_work, &by_noise] {
            assert!(counts.is_sorted(), "{counts:?}");
            assert_eq!([counts[0], counts[39]], [1, 2], "{counts:?}");
        }
        // Without noise no work is enough, and without other work no noise.
        assert_eq!([rounds(1e20, 0.0), rounds(0.0, 1.0)], [1, 1]);
        // A budget below all of the first samples, or unknown work, leaves one round.
        assert_eq!(ExtraSamples { most: 0.9, other_rays: Some(1e9) }.rounds(1e7, 0.1), 1);
        assert_eq!(ExtraSamples { most: 1.0, other_rays: None }.rounds(1e7, 0.1), 1);
    }
}
