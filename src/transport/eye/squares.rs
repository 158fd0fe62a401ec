//! Samples of pixels all over the film, from which sample counts are estimated (see [`super::effort`]).

use super::adaptive::{Luminances, pilot};
use super::effort::{Means, SampledSquares};
use super::tracer::{PixelSamples, Tracer};
use super::{EyeCounts, EyeSettings};
use crate::paths::LightSamples;
use base::math::{Rgb, luminance};
use base::parallel::{ShortRuns, Workspaces};
use rayon::prelude::*;
use world::light::Learned;

/// Maximum number of first samples that may be followed by more, so that sample numbers fit into 32 bits.
const MAX_ADAPTIVE: u32 = u32::MAX / 4;

/// Seed of the pilot's samples, combined with the image's seed.
const PILOT_SEED: u32 = 0x3c6e_f372;

/// Offset into the light-sample sequence for the pilot's second pass, so that it is independent of the first.
const SECOND_PASS_OFFSET: u32 = 1 << 20;

impl<'w> Tracer<'_, 'w> {
    /// Samples `count` squares of the film twice; returns `None` with a single sample per pixel, or with so many that
    /// no pixel needs more.
    pub(super) fn squares(&mut self, learned: Option<&Learned>, count: u32) -> Option<SampledSquares> {
        let EyeSettings { spp, seed, .. } = self.settings;
        if !(2..=MAX_ADAPTIVE).contains(&spp) {
            return None;
        }
        let squares = pilot(self.view.window.film, count);
        let pixels: Vec<Vec<[u32; 2]>> =
            squares.iter().map(|square| square.film_pixels().collect()).collect();
        let (values, traced) = self.luminances(pixels.clone(), seed ^ PILOT_SEED, learned);
        self.light_samples.first = SECOND_PASS_OFFSET;
        let (again, traced_again) = self.luminances(pixels, seed ^ PILOT_SEED, learned);
        self.light_samples = LightSamples::ONE;
        let chains: EyeCounts = traced.into_iter().chain(traced_again).sum();
        let means = |group: &Vec<[f32; 2]>| group.iter().map(|[mean, _]| *mean).collect();
        let filled = |(window, group)| Luminances { window, values: means(group) };
        let squares = squares.into_iter().zip(&values).map(filled).collect();
        Some(SampledSquares { squares, values, again, chains })
    }

    /// Returns the luminances that the first samples of groups of film pixels find, by all of them and by the first
    /// half, and the rays of each group. Luminances are 0 once cancelled.
    pub(super) fn luminances(
        &self,
        groups: Vec<Vec<[u32; 2]>>,
        seed: u32,
        learned: Option<&Learned>,
    ) -> (Means, Vec<EyeCounts>) {
        let spp = self.settings.spp;
        let works = Workspaces::new(|| self.workspace(learned));
        let look = |pixels: Vec<[u32; 2]>| {
            let mut sums = vec![[Rgb::ZERO; 2]; pixels.len()];
            if self.control.is_cancelled() {
                return (vec![[0.0; 2]; pixels.len()], EyeCounts::default());
            }
            let each = |found: PixelSamples<'_, 'w>, _: &mut Vec<_>| {
                let [sum, half] = &mut sums[found.index];
                *sum += found.sum;
                *half += found.half;
            };
            let chains = works.with(|work| self.sample(&pixels, 0..spp, seed, work, each));
            let counts = [spp, (spp / 2).max(1)].map(|count| count as f32);
            let mean = |sums: [Rgb; 2]| [0, 1].map(|i| luminance(sums[i] / counts[i]));
            (sums.into_iter().map(mean).collect(), chains)
        };
        groups.into_par_iter().one_by_one().map(look).unzip()
    }
}
