//! Estimands of pixels, and the positions of samples within pixels.

use base::sampling::{Sampler, hash};
use glam::Vec2;

/// Estimand of a pixel: the quantity that its value estimates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimand {
    /// Mean radiance over the pixel's square.
    Pixels,
    /// Mean radiance through the positions of these eye samples.
    EyeSamples {
        /// Number of samples per pixel.
        spp: u32,
        /// Random seed of the samples.
        seed: u32,
    },
}

impl Estimand {
    /// Returns seed and number of the eye sample that sample `sample` stands for.
    #[inline]
    pub fn numbers(self, seed: u32, sample: u32) -> (u32, u32) {
        match self {
            Estimand::Pixels => (seed, sample),
            Estimand::EyeSamples { spp, seed } => (seed, sample % spp.max(1)),
        }
    }

    /// Returns the random numbers of sample `sample` of a film pixel, and its position in the pixel. Eye samples are
    /// taken in turn; otherwise `seed` chooses the position.
    #[inline]
    pub fn eye_sampler(self, pixel: [u32; 2], seed: u32, sample: u32) -> (Sampler, Vec2) {
        match self {
            Estimand::Pixels => {
                let mut sampler = Sampler::new(pixel_seed(pixel, seed), sample);
                let jitter = sampler.next_2d();
                (sampler, jitter)
            }
            Estimand::EyeSamples { spp, seed } => {
                let spp = spp.max(1);
                eye_sampler(pixel, seed, sample % spp, spp)
            }
        }
    }
}

/// Returns the seed of the random numbers of a pixel. The pixel is given in film coordinates, so that a crop repeats
/// the pixels of the full image.
#[inline]
pub fn pixel_seed([x, y]: [u32; 2], seed: u32) -> u32 {
    hash(hash(x, y), seed)
}

/// Returns the random numbers of eye sample `sample` of `spp` of a film pixel, and its position in the pixel. A single
/// sample passes through the pixel's centre, which keeps edges straight.
#[inline]
pub fn eye_sampler(pixel: [u32; 2], seed: u32, sample: u32, spp: u32) -> (Sampler, Vec2) {
    let mut sampler = Sampler::new(pixel_seed(pixel, seed), sample);
    let jitter = if spp > 1 { sampler.next_2d() } else { Vec2::splat(0.5) };
    (sampler, jitter)
}
