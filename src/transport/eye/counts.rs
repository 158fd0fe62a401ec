//! RayCounts of the eye pass: its rays, and the light of its techniques.

use base::stats::add_fields;
use std::iter::Sum;

/// Name of the counter of [`EyeCounts::overflow`].
pub const DROPPED_BRANCHES: &str = "Eye/branches dropped";

/// Rays traced by eye chains, and the light that the paths behind them found.
#[derive(Clone, Copy, Debug, Default)]
pub struct EyeCounts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
    /// Number of branches dropped because too many were pending; their light is missing.
    pub overflow: u64,
    /// Number of samples beyond the first ones of every pixel.
    pub extra_samples: u64,
    /// Luminance of all light in passes that look up photons, summed over the samples.
    pub light: f64,
    /// Luminance of the photons' light, summed over the samples.
    pub by_photons: f64,
    /// Second moment of the path estimator for the photons' light, summed over the samples.
    pub square_by_photons: f64,
}
add_fields!(EyeCounts { rays, shadow_rays, overflow, extra_samples, light, by_photons, square_by_photons });

impl Sum for EyeCounts {
    fn sum<I: Iterator<Item = EyeCounts>>(counts: I) -> EyeCounts {
        counts.fold(EyeCounts::default(), |mut sum, counts| {
            sum += counts;
            sum
        })
    }
}

impl EyeCounts {
    /// Returns the photons' part of light with luminance `found`.
    pub fn by_photons(&self, found: f64) -> f64 {
        if self.light > 0.0 { found * (self.by_photons / self.light) } else { 0.0 }
    }
}
