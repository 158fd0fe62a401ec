//! Where records are needed next: uncovered eye samples, spread evenly over the surfaces seen.
//!
//! Paper: Herzog et al. 2009, section 6 (records are computed where no record contributes); the coarse beginning
//! is the overture of Ward's irradiance caching. A wave takes at most one sample of each cell of one level of the
//! eye samples' index, the one nearest to the middle of what is uncovered there.

use super::splat::Layer;
use crate::eye::EyePass;
use glam::Vec3;
use rayon::prelude::*;

/// An eye sample at which to compute a record, and which layers lack it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pick {
    /// The eye sample.
    pub sample: u32,
    /// Direct, indirect.
    pub lacks: [bool; 2],
}

/// Which layers have no record at a sample that wants them.
#[inline]
pub fn lacking(layers: &[Layer; 2], wanted: [bool; 2], sample: usize) -> [bool; 2] {
    [0, 1].map(|l| wanted[l] && layers[l].sums[sample].weight <= 0.0)
}

/// The picks of every other cell of `level` (`parity` 0 or 1): siblings take turns, so that
/// what one needs may be covered already by the other's record.
pub fn pick(
    samples: &EyePass,
    layers: &[Layer; 2],
    wanted: impl Fn(usize) -> [bool; 2] + Sync,
    level: u32,
    parity: usize,
) -> Vec<Pick> {
    let cells = (1usize << level) / 2;
    (0..cells.max(1))
        .into_par_iter()
        .filter_map(|pair| {
            let cell = if level == 0 { 0 } else { 2 * pair + parity };
            let range = samples.index.range(level, cell);
            let uncovered = |i: &usize| lacking(layers, wanted(*i), *i) != [false; 2];
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for i in range.clone().filter(uncovered) {
                sum += samples.points.geometry[i].position;
                count += 1.0;
            }
            if count == 0.0 {
                return None;
            }
            let middle = sum / count;
            let distance = |i: &usize| samples.points.geometry[*i].position.distance_squared(middle);
            let sample = range.filter(uncovered).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            Some(Pick { sample: sample as u32, lacks: lacking(layers, wanted(sample), sample) })
        })
        .collect()
}
