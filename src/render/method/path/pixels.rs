//! Single pixels, each with its own number of paths.

use crate::method::renderer::{PILOT_SPP, SampledPixels};
use base::math::luminance;
use base::parallel::ShortRuns;
use base::progress::Control;
use glam::DVec3;
use rayon::prelude::*;
use transport::eye::FullPaths;
use transport::paths::{Batch, Estimand, PathStart, RayCounts, start};
use world::World;
use world::light::Learned;
use world::view::View;

/// Maximum number of paths of one pixel in a batch.
const BATCH: u32 = 64;

/// Seeds of the two sets of samples of a pilot.
const PILOT_SEEDS: [u32; 2] = [0x5bd1_e995, 0x2c1b_3c6d];

/// A pixel to be traced.
#[derive(Clone, Copy, Debug)]
pub struct PixelPaths {
    /// Column and row in the film.
    pub pixel: [u32; 2],
    /// Number of paths. For [`Estimand::EyeSamples`] it must be a multiple of the eye samples, so that each has the
    /// same share.
    pub samples: u32,
}

/// Sampling of single pixels.
#[derive(Clone, Copy, Debug)]
pub struct PixelSampling<'a> {
    /// Quantity that a pixel estimates.
    pub estimand: Estimand,
    /// Seed; another one gives independent means.
    pub seed: u32,
    /// Maximum path length in edges.
    pub max_depth: u32,
    /// Learned light that guides light samples.
    pub learned: Option<&'a Learned>,
}

/// Computes the mean radiance of each pixel over its paths.
///
/// The second result is the number of radiances that were not finite and count as 0.
pub fn pixel_means(
    world: &World,
    view: &View,
    sampling: PixelSampling,
    wanted: &[PixelPaths],
    counts: &mut RayCounts,
) -> (Vec<DVec3>, u64) {
    let PixelSampling { estimand, seed, max_depth, learned } = sampling;
    let mut paths = FullPaths { learned, path_ends: None };
    let mut sums = vec![DVec3::ZERO; wanted.len()];
    let mut nonfinite = 0;
    let mut batch = Batch::default();
    let most = wanted.iter().map(|w| w.samples).max().unwrap_or(0);
    for first in (0..most).step_by(BATCH as usize) {
        let samples = |w: &PixelPaths| first.min(w.samples)..(first + BATCH).min(w.samples);
        let starts =
            wanted.iter().flat_map(|w| samples(w).map(|sample| PathStart::new(w.pixel, sample, seed)));
        start(&mut batch, starts, world, view, estimand, most);
        let mut values = batch.trace(world, max_depth, &mut paths, counts);
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

/// Samples groups of film pixels by two sets of paths; `None` if cancelled.
pub(super) fn sample_pixels(
    world: &World,
    view: &View,
    max_depth: Option<u32>,
    learned: Option<&Learned>,
    groups: &[Vec<[u32; 2]>],
    control: &Control,
) -> Option<SampledPixels> {
    let max_depth = world.scene.path_limit(max_depth);
    let sample = |pixels: &Vec<[u32; 2]>| {
        let mut counts = RayCounts::default();
        let wanted: Vec<PixelPaths> =
            pixels.iter().map(|&pixel| PixelPaths { pixel, samples: PILOT_SPP }).collect();
        let luminances = PILOT_SEEDS.map(|seed| {
            if control.is_cancelled() {
                return Vec::new();
            }
            let sampling = PixelSampling { estimand: Estimand::Pixels, seed, max_depth, learned };
            let (means, _) = pixel_means(world, view, sampling, &wanted, &mut counts);
            means.into_iter().map(|mean| f64::from(luminance(mean.as_vec3()))).collect()
        });
        (luminances, counts)
    };
    let groups: Vec<([Vec<f64>; 2], RayCounts)> = groups.par_iter().one_by_one().map(sample).collect();
    let rays = groups.iter().map(|(_, counts)| counts.rays + counts.shadow_rays).sum();
    let luminances = [0, 1].map(|set| groups.iter().flat_map(|(sets, _)| &sets[set]).copied().collect());
    (!control.is_cancelled()).then(|| SampledPixels::new(luminances, rays, 0))
}
