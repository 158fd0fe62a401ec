//! Positions of a picture's samples within its pixels.

use crate::sampling::{Sampler, hash};
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

/// The random numbers of eye sample `sample` of `spp` in the film's pixel, and its place in the pixel. A
/// single sample looks through the pixel's centre, which keeps edges straight.
#[inline]
pub fn eye_sampler([x, y]: [u32; 2], seed: u32, sample: u32, spp: u32) -> (Sampler, Vec2) {
    // The film's own coordinates, so that a crop repeats the whole picture's pixels.
    let mut sampler = Sampler::new(hash(hash(x, y), seed), sample);
    let jitter = if spp > 1 { sampler.next_2d() } else { Vec2::splat(0.5) };
    (sampler, jitter)
}
