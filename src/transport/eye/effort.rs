//! Sample counts for direct light, estimated from a pilot: extra samples per pixel, and light samples per surface.
//!
//! Squares of pixels all over the film are sampled twice, with the same paths but different light samples at their
//! ends. The difference is the noise due to light samples. The difference between the two halves of a pixel's samples,
//! each stratified by itself, is all of the noise. If light samples cause the share ρ of the variance, `n` light
//! samples leave the variance 1 - ρ + ρ / n at the cost c + n. The product of both is least at n = √(c ρ / (1 - ρ)).

use super::adaptive::{AdaptiveRule, Luminances, pilot};
use super::tracer::{PixelSamples, Tracer};
use super::{EyeCounts, EyeSettings};
use crate::paths::LightSamples;
use base::math::{Rgb, luminance};
use base::parallel::{ShortRuns, Workspaces};
use rayon::prelude::*;

/// Maximum number of first samples that may be followed by more, so that sample numbers fit into 32 bits.
const MAX_ADAPTIVE: u32 = u32::MAX / 4;

/// Seed of the pilot's samples, combined with the image's seed.
const PILOT_SEED: u32 = 0x3c6e_f372;

/// Offset into the light-sample sequence for the pilot's second pass, so that it is independent of the first.
const SECOND_PASS_OFFSET: u32 = 1 << 20;

/// Cost of an eye sample without its light sample, over the cost of a light sample.
const SAMPLE_COST: f32 = 3.0;

/// Maximum number of light samples.
const MAX_LIGHT_SAMPLES: f32 = 4.0;

/// Result of the pilot.
pub(super) struct Effort {
    /// Rule that chooses the pixels with more samples; `None` if no pixel gets more.
    pub choice: Option<AdaptiveRule>,
    /// Light samples per chain end.
    pub light_samples: u32,
    /// Number of times that all pixels get the first samples.
    pub rounds: u32,
    /// Mean over pixels of the relative variance, at most 1 per pixel.
    pub noise: f32,
    /// Rays that the pilot traced.
    pub chains: EyeCounts,
}

/// Means of all samples of pixels, and of the first half of them, by group.
type Means = Vec<Vec<[f32; 2]>>;

impl<'w> Tracer<'_, 'w> {
    /// Runs the pilot; returns `None` with a single sample per pixel, or with so many that no pixel needs more.
    pub(super) fn effort(&mut self) -> Option<Effort> {
        let EyeSettings { spp, seed, .. } = self.settings;
        if !(2..=MAX_ADAPTIVE).contains(&spp) {
            return None;
        }
        let squares = pilot(self.view.window.film);
        let pixels: Vec<Vec<[u32; 2]>> =
            squares.iter().map(|square| square.film_pixels().collect()).collect();
        let (values, traced) = self.luminances(pixels.clone(), seed ^ PILOT_SEED);
        self.light_samples.first = SECOND_PASS_OFFSET;
        let (again, traced_again) = self.luminances(pixels, seed ^ PILOT_SEED);
        self.light_samples = LightSamples::ONE;
        let chains: EyeCounts = traced.into_iter().chain(traced_again).sum();
        let means = |group: &Vec<[f32; 2]>| group.iter().map(|[mean, _]| *mean).collect();
        let filled = |(window, group)| Luminances { window, values: means(group) };
        let sampled: usize = 2 * values.iter().map(Vec::len).sum::<usize>() * spp as usize;
        let film = self.view.window.film_pixel_count() as f64;
        let a_sample = (chains.rays + chains.shadow_rays) as f64 / sampled.max(1) as f64;
        let rays = a_sample * f64::from(spp) * film;
        let squares: Vec<Luminances> = squares.into_iter().zip(&values).map(filled).collect();
        let dark = AdaptiveRule::new(&squares, 0.0).dark;
        let noise = PixelNoise::estimated(&values, &again, spp, dark);
        let light_samples = noise.light_samples();
        let extra = &self.direct.extra_samples;
        let rounds = extra.rounds(rays, noise.with(light_samples));
        let share = extra.share(f64::from(rounds) * rays);
        let choice = (share > 0.0).then(|| AdaptiveRule::new(&squares, share));
        Some(Effort { choice, light_samples, rounds, noise: noise.all / rounds as f32, chains })
    }

    /// Returns the luminances that the first samples of groups of film pixels find, by all of them and by the first
    /// half, and the rays of each group. Luminances are 0 once cancelled.
    pub(super) fn luminances(&self, groups: Vec<Vec<[u32; 2]>>, seed: u32) -> (Means, Vec<EyeCounts>) {
        let spp = self.settings.spp;
        let works = Workspaces::new(|| self.workspace());
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

/// Relative variance of a pixel, at most 1, averaged over pixels.
struct PixelNoise {
    all: f32,
    /// Part due to light samples.
    by_light: f32,
}

impl PixelNoise {
    /// Estimates the noise of pixels with `spp` samples that were sampled twice. `dark` is the luminance that counts
    /// as dark.
    fn estimated(values: &Means, again: &Means, spp: u32, dark: f32) -> PixelNoise {
        // A share f of the samples differs from the mean of all by √((1 - f) / f) times the error of that mean.
        let first = (spp / 2) as f32 / spp as f32;
        let to_error = (first / (1.0 - first)).sqrt();
        let square = |error: f32, mean: f32| (error / (mean + dark)).powi(2).min(1.0);
        let (mut all, mut by_light, mut count) = (0.0, 0.0, 0.0f32);
        for ([a, half_a], [b, half_b]) in values.iter().flatten().zip(again.iter().flatten()) {
            all += 0.5 * (square(to_error * (half_a - a), *a) + square(to_error * (half_b - b), *b));
            by_light += square(0.5f32.sqrt() * (a - b), 0.5 * (a + b));
            count += 1.0;
        }
        PixelNoise { all: all / count.max(1.0), by_light: by_light / count.max(1.0) }
    }

    /// Returns the relative variance with a number of light samples.
    fn with(&self, light_samples: u32) -> f32 {
        (self.all - self.by_light * (1.0 - 1.0 / light_samples as f32)).max(0.0)
    }

    /// Returns the number of light samples with the least product of variance and cost.
    fn light_samples(&self) -> u32 {
        let part = (self.by_light / self.all.max(f32::MIN_POSITIVE)).min(1.0);
        (SAMPLE_COST * part / (1.0 - part)).sqrt().clamp(1.0, MAX_LIGHT_SAMPLES).round() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;

    fn number(values: &Means, again: &Means, spp: u32) -> u32 {
        PixelNoise::estimated(values, again, spp, 0.08).light_samples()
    }

    /// The best number for a thousand pixels of mean 1 whose light samples have that part of their noise.
    fn best(part: f32, spp: u32, noise: f32) -> u32 {
        let even = |i: u32, seed: u32| 12f32.sqrt() * (owen_sobol_2d(i, seed).x - 0.5);
        let (mut values, mut again) = (Vec::new(), Vec::new());
        for i in 0..1000 {
            // Errors of the two halves' means: of what both times share, and of light samples.
            let shared = [1, 2].map(|seed| (1.0 - part).sqrt() * even(i, seed));
            let pixel = |seed: u32| {
                let [a, b] = [0, 1].map(|half| shared[half] + part.sqrt() * even(i, seed + half as u32));
                let error = noise * (2.0 / spp as f32).sqrt();
                [1.0 + error * 0.5 * (a + b), 1.0 + error * a]
            };
            values.push(pixel(3));
            again.push(pixel(5));
        }
        number(&vec![values], &vec![again], spp)
    }

    #[test]
    fn light_samples_grow_with_their_part_of_the_noise() {
        for (spp, noise) in [(16, 0.1), (4, 0.5), (64, 0.02)] {
            let counts: Vec<u32> = (0..=20).map(|i| best(i as f32 / 20.0, spp, noise)).collect();
            assert!(counts.is_sorted(), "{spp}: {counts:?}");
            assert_eq!([counts[0], counts[20]], [1, MAX_LIGHT_SAMPLES as u32], "{spp}");
            // The counts between the limits occur, too.
            assert!(counts.windows(2).all(|pair| pair[1] - pair[0] <= 1), "{spp}: {counts:?}");
        }
        // Without light nothing is known.
        assert_eq!(number(&vec![vec![[0.0; 2]; 9]], &vec![vec![[0.0; 2]; 9]], 16), 1);
    }
}
