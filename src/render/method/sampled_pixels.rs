//! Light of single pixels that a method samples, for plans: its noise and its work.

use transport::eye::ByPhotons;

/// Samples per pixel of each of the two sets.
pub const PILOT_SPP: u32 = 8;

/// Light of some pixels by two independent sets of [`PILOT_SPP`] samples each.
pub struct SampledPixels {
    /// Mean luminance of each pixel, in order, by set.
    pub luminances: [Vec<f64>; 2],
    /// Light that the method finds with photons, by group of pixels; empty if it has no photons.
    pub photons: Vec<ByPhotons>,
    /// Rays per sample.
    pub rays_a_sample: f64,
    /// All rays traced, without those of learned light, which the image shares.
    pub rays: u64,
}

impl SampledPixels {
    /// Creates the light of samples that took `rays_of_samples`, besides `other_rays` of other pilots.
    pub fn new(luminances: [Vec<f64>; 2], rays_of_samples: u64, other_rays: u64) -> SampledPixels {
        let samples = 2.0 * f64::from(PILOT_SPP) * luminances[0].len().max(1) as f64;
        let rays = rays_of_samples + other_rays;
        SampledPixels {
            luminances,
            photons: Vec::new(),
            rays_a_sample: rays_of_samples as f64 / samples,
            rays,
        }
    }
}
