//! Single pixels, each with as many paths as are wanted for it.

use crate::paths::{Batch, Counts, FullPaths, Look, Start, start};
use crate::view::View;
use crate::world::World;
use glam::DVec3;

/// Maximum number of paths of one pixel that are traced together with those of the others.
const TOGETHER: u32 = 64;

/// A pixel whose radiance is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Column and row in the film.
    pub pixel: [u32; 2],
    /// Paths through it; for [`Look::EyeSamples`] a multiple of their number, so that each has the same share.
    pub samples: u32,
}

/// Computes the mean radiance of each pixel over its paths, and the number of radiances that were not finite
/// and count as 0. Another `seed` gives independent means.
pub fn pixel_means(
    world: &World,
    view: &View,
    look: Look,
    wanted: &[Wanted],
    (seed, max_depth): (u32, u32),
    counts: &mut Counts,
) -> (Vec<DVec3>, u64) {
    let mut sums = vec![DVec3::ZERO; wanted.len()];
    let mut nonfinite = 0;
    let mut batch = Batch::default();
    let most = wanted.iter().map(|w| w.samples).max().unwrap_or(0);
    for first in (0..most).step_by(TOGETHER as usize) {
        let samples = |w: &Wanted| first.min(w.samples)..(first + TOGETHER).min(w.samples);
        let paths =
            wanted.iter().flat_map(|w| samples(w).map(|sample| Start { pixel: w.pixel, sample, seed }));
        start(&mut batch, paths, (world, view), look);
        let mut values = batch.trace(world, max_depth, &mut FullPaths, counts);
        for (w, sum) in wanted.iter().zip(&mut sums) {
            for value in values.by_ref().take(samples(w).len()) {
                if value.is_finite() {
                    *sum += value.as_dvec3();
                } else {
                    nonfinite += 1;
                }
            }
        }
    }
    for (w, sum) in wanted.iter().zip(&mut sums) {
        *sum /= f64::from(w.samples.max(1));
    }
    (sums, nonfinite)
}
