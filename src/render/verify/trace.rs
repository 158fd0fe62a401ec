//! Path-traced values of the pixels picked.

use super::measure::{MEANS, Measured};
use super::picks::Pick;
use crate::method::Method;
use crate::method::path::{PixelPaths, PixelSampling, RayCounts, pixel_means};
use base::film::metrics::REL_MSE_FLOOR;
use base::film::{Image, sharpen};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::sampling::hash;
use glam::DVec3;
use rayon::prelude::*;
use transport::paths::Estimand;
use world::World;
use world::view::View;

/// Number of paths for each mean of a pixel in the pilot.
const PILOT: u32 = 4;

/// Standard error to reach, over the radiance of the pixel.
const TARGET: f64 = 0.01;

/// Number of pixels of a task.
const TASK: usize = 16;

/// Seed that separates these paths from those of the image, which may have the same seed.
const SEED: u32 = 0x7e57_ab1e;

/// Traced pixels and their cost.
pub struct TracedPixels {
    /// Pixels in the order of the picks.
    pub pixels: Vec<Measured>,
    /// Number of pixels with fewer paths than they need.
    pub at_cap: usize,
    /// Number of paths.
    pub paths: u64,
    /// Number of radiances that were not finite.
    pub nonfinite: u64,
}

/// Traces paths through the pixels picked; `None` if cancelled.
pub fn trace(
    world: &World,
    view: &View,
    image: &Image,
    picks: &[Pick],
    settings: &VerifySettings,
    control: &Control,
) -> Option<TracedPixels> {
    let spp = match settings.estimand {
        Estimand::Pixels => 1,
        Estimand::EyeSamples { spp, .. } => spp.max(1),
    };
    let most = (settings.max_samples / MEANS as u32).max(PILOT).next_multiple_of(spp);
    let least = PILOT.next_multiple_of(spp);
    let sum: DVec3 = image.pixels.iter().map(|p| p.as_dvec3()).sum();
    let mean = sum.element_sum() / (3 * image.pixels.len().max(1)) as f64;
    // Dark pixels need not reach a standard error relative to themselves.
    let floor = REL_MSE_FLOOR * mean * mean;
    let tracing = Tracing { world, view, image, settings, control };
    let task = |picks: &[Pick]| {
        let mut traced = TracedPixels { pixels: Vec::new(), at_cap: 0, paths: 0, nonfinite: 0 };
        let mut samples = vec![least; picks.len()];
        let pilot = tracing.measure(picks, &samples, 0, &mut traced)?;
        for (samples, pixel) in samples.iter_mut().zip(&pilot) {
            let needed = f64::from(least) * pixel.relative_variance(floor) / (TARGET * TARGET);
            traced.at_cap += usize::from(needed > f64::from(most));
            *samples = (needed.min(f64::from(most)) as u32).max(least).next_multiple_of(spp);
        }
        traced.pixels = tracing.measure(picks, &samples, 1, &mut traced)?;
        Some(traced)
    };
    let parts: Vec<Option<TracedPixels>> = picks.par_chunks(TASK).one_by_one().map(task).collect();
    let mut all = TracedPixels { pixels: Vec::with_capacity(picks.len()), at_cap: 0, paths: 0, nonfinite: 0 };
    for part in parts {
        let part = part?;
        all.pixels.extend(part.pixels);
        all.at_cap += part.at_cap;
        all.paths += part.paths;
        all.nonfinite += part.nonfinite;
    }
    Some(all)
}

/// Inputs shared by all pixels.
struct Tracing<'a> {
    world: &'a World,
    view: &'a View,
    image: &'a Image,
    settings: &'a VerifySettings,
    control: &'a Control,
}

impl Tracing<'_> {
    /// Returns the pixels that a picked pixel is a sum of, with their weights: more than itself if the image is
    /// sharpened.
    fn parts(&self, pick: &Pick) -> Vec<([u32; 2], f32)> {
        let View { camera, window } = self.view;
        let (column, row) = (pick.index as u32 % window.width, pick.index as u32 / window.width);
        let a = camera.filter.sharpening();
        if a == 0.0 {
            return vec![(window.film_pixel([column, row]), 1.0)];
        }
        let along = |i: u32, n: u32| {
            [-1, 0, 1].map(|d| i.wrapping_add_signed(d)).into_iter().zip(sharpen::weights(a, i, n))
        };
        let rows = along(row, window.height);
        let parts = rows.flat_map(|(y, by_row)| {
            along(column, window.width).map(move |(x, by_column)| ([x, y], by_row * by_column))
        });
        parts
            .filter(|(_, weight)| *weight != 0.0)
            .map(|(pixel, weight)| (window.film_pixel(pixel), weight))
            .collect()
    }

    /// Traces all means of some pixels, each of so many samples. Another `round` gives independent means.
    fn measure(
        &self,
        picks: &[Pick],
        samples: &[u32],
        round: u32,
        traced: &mut TracedPixels,
    ) -> Option<Vec<Measured>> {
        let Tracing { world, view, settings, .. } = *self;
        let max_depth = world.scene.path_limit(settings.max_depth);
        let measured = |pick: &Pick| Measured {
            value: self.image.pixels[pick.index].as_dvec3(),
            means: [DVec3::ZERO; MEANS],
            weight: pick.weight,
        };
        let mut pixels: Vec<Measured> = picks.iter().map(measured).collect();
        let parts = picks.iter().zip(samples).enumerate().flat_map(|(i, (pick, &samples))| {
            self.parts(pick)
                .into_iter()
                .map(move |(pixel, weight)| (i, weight, PixelPaths { pixel, samples }))
        });
        let parts: Vec<(usize, f32, PixelPaths)> = parts.collect();
        let wanted: Vec<PixelPaths> = parts.iter().map(|(.., wanted)| *wanted).collect();
        let mut counts = RayCounts::default();
        for k in 0..MEANS {
            if self.control.is_cancelled() {
                return None;
            }
            let seed = hash(hash(settings.seed, SEED), round * MEANS as u32 + k as u32);
            let sampling = PixelSampling { estimand: settings.estimand, seed, max_depth, learned: None };
            let (means, nonfinite) = pixel_means(world, view, sampling, &wanted, &mut counts);
            for (&(pixel, weight, _), mean) in parts.iter().zip(means) {
                pixels[pixel].means[k] += f64::from(weight) * mean;
            }
            traced.nonfinite += nonfinite;
        }
        traced.paths += MEANS as u64 * wanted.iter().map(|w| u64::from(w.samples)).sum::<u64>();
        self.control.advance(picks.len() as u64);
        Some(pixels)
    }
}

/// Settings of a verification.
#[derive(Clone, Copy, Debug)]
pub struct VerifySettings {
    /// Approximate number of pixels.
    pub pixels: usize,
    /// Quantity that a pixel estimates.
    pub estimand: Estimand,
    /// Seed of the choice of pixels and of their paths.
    pub seed: u32,
    /// Maximum path length in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
    /// Maximum number of paths per pixel.
    pub max_samples: u32,
}

impl VerifySettings {
    /// Returns these settings for an image of `method`, whose eye samples may differ from those planned with.
    pub fn with_samples_of(self, method: &Method) -> VerifySettings {
        let estimand = match self.estimand {
            Estimand::Pixels => Estimand::Pixels,
            Estimand::EyeSamples { .. } => Estimand::EyeSamples { spp: method.spp(), seed: method.seed() },
        };
        VerifySettings { estimand, ..self }
    }
}

impl Default for VerifySettings {
    fn default() -> VerifySettings {
        VerifySettings {
            pixels: 1000,
            estimand: Estimand::Pixels,
            seed: 0,
            max_depth: None,
            max_samples: 4096,
        }
    }
}
