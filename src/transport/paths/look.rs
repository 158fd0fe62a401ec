//! Positions of a picture's samples within its pixels.

use base::sampling::{Sampler, hash};
use glam::Vec2;

/// Estimand of a pixel: the quantity that its value estimates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// The mean radiance over the pixel's square.
    Pixels,
    /// The mean radiance through the places of these eye samples in it.
    EyeSamples {
        /// Number of samples a pixel.
        spp: u32,
        /// The seed that chose them.
        seed: u32,
    },
}

impl Look {
    /// Seed and number of the eye sample for which sample `sample` stands.
    #[inline]
    pub fn numbers(self, seed: u32, sample: u32) -> (u32, u32) {
        match self {
            Look::Pixels => (seed, sample),
            Look::EyeSamples { spp, seed } => (seed, sample % spp.max(1)),
        }
    }

    /// The random numbers of sample `sample` in the film's pixel, and its place in the pixel. Eye samples are taken in
    /// turn; elsewhere `seed` chooses.
    #[inline]
    pub fn eye_sampler(self, pixel: [u32; 2], seed: u32, sample: u32) -> (Sampler, Vec2) {
        match self {
            Look::Pixels => {
                let mut sampler = Sampler::new(pixel_seed(pixel, seed), sample);
                let jitter = sampler.next_2d();
                (sampler, jitter)
            }
            Look::EyeSamples { spp, seed } => {
                let spp = spp.max(1);
                eye_sampler(pixel, seed, sample % spp, spp)
            }
        }
    }
}

/// Seed of the random numbers in a pixel. The pixel is given by the film's own coordinates, so that a crop repeats the
/// whole picture's pixels.
#[inline]
pub fn pixel_seed([x, y]: [u32; 2], seed: u32) -> u32 {
    hash(hash(x, y), seed)
}

/// The random numbers of eye sample `sample` of `spp` in the film's pixel, and its place in the pixel. A single sample
/// looks through the pixel's centre, which keeps edges straight.
#[inline]
pub fn eye_sampler(pixel: [u32; 2], seed: u32, sample: u32, spp: u32) -> (Sampler, Vec2) {
    let mut sampler = Sampler::new(pixel_seed(pixel, seed), sample);
    let jitter = if spp > 1 { sampler.next_2d() } else { Vec2::splat(0.5) };
    (sampler, jitter)
}
