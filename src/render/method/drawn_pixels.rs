//! A few pixels by the light that a method draws at random: what plans learn of its noise and its work.

use transport::eye::ByPhotons;

/// Samples a pixel of each of two sets.
pub const PILOT_SPP: u32 = 8;

/// Light of some pixels by two independent sets of [`PILOT_SPP`] samples each.
pub struct DrawnPixels {
    /// Mean luminances of the pixels, in order, by set.
    pub luminances: [Vec<f64>; 2],
    /// Light that the method has by photons, by group of pixels; empty if it has no photons.
    pub photons: Vec<ByPhotons>,
    /// Rays a sample.
    pub rays_a_sample: f64,
    /// All rays traced, also those of what the method learns first.
    pub rays: u64,
}

impl DrawnPixels {
    /// Light of `rays_of_samples` rays after which, or before, `other_rays` were traced.
    pub fn new(luminances: [Vec<f64>; 2], rays_of_samples: u64, other_rays: u64) -> DrawnPixels {
        let samples = 2.0 * f64::from(PILOT_SPP) * luminances[0].len().max(1) as f64;
        let rays = rays_of_samples + other_rays;
        DrawnPixels { luminances, photons: Vec::new(), rays_a_sample: rays_of_samples as f64 / samples, rays }
    }
}
