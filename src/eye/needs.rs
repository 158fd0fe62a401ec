//! Numbers of samples that pixels get beside their first, by what the first have found around them.

use super::adaptive::{Choice, Luminances, pilot};
use super::drawn::{BATCH, Found, Tile, Tracer};
use super::{ChainCounts, EyeSettings};
use crate::light::Learned;
use crate::math::{Rgb, luminance};
use rayon::prelude::*;

/// Maximum number of first samples that may be followed by more: their numbers are 32 bits wide.
const MAX_ADAPTIVE: u32 = u32::MAX / 4;

/// Seed of the pilot's samples over that of the others.
const PILOT_SEED: u32 = 0x3c6e_f372;

/// Numbers of samples that pixels are to get.
pub(super) struct Needs {
    pub(super) choice: Choice,
    /// Luminances found by the first samples, in the window and in the pixels next to it.
    pub(super) luminances: Luminances,
    /// Rays traced to learn them.
    pub(super) chains: ChainCounts,
}

impl<'w> Tracer<'_, 'w> {
    /// Learns which pixels need more samples than the first; `None` if none is to get more.
    pub(super) fn needs(&self, tiles: &[Tile], learned: Option<&Learned>) -> Option<Needs> {
        let EyeSettings { spp, seed, .. } = self.settings;
        let share = self.drawn.extra_samples;
        if !(share > 0.0 && (2..=MAX_ADAPTIVE).contains(&spp)) {
            return None;
        }
        let squares = pilot(self.view.window.film);
        let pixels = squares.iter().map(|square| square.film_pixels().collect()).collect();
        let (values, mut chains) = self.luminances(pixels, seed ^ PILOT_SEED, learned);
        let filled = |(window, values)| Luminances { window, values };
        let choice = Choice::new(&squares.into_iter().zip(values).map(filled).collect::<Vec<_>>(), share);

        let (window, near) = (&self.view.window, self.view.window.grown(1));
        let mut luminances = Luminances { values: vec![0.0; near.pixel_count() as usize], window: near };
        for tile in tiles {
            for ((pixel, sum), samples) in tile.pixels.iter().zip(&tile.sums).zip(&tile.samples) {
                luminances.set(window.film_pixel(*pixel), luminance(*sum / *samples as f32));
            }
        }
        self.drawn.settled.smooth(window, &mut luminances);
        let beside: Vec<[u32; 2]> =
            near.film_pixels().filter(|pixel| window.index(*pixel).is_none()).collect();
        let beside: Vec<Vec<[u32; 2]>> = beside.chunks(BATCH as usize).map(<[_]>::to_vec).collect();
        let (values, traced) = self.luminances(beside.clone(), seed, learned);
        beside
            .iter()
            .flatten()
            .zip(values.iter().flatten())
            .for_each(|(pixel, v)| luminances.set(*pixel, *v));
        chains += traced;
        Some(Needs { choice, luminances, chains })
    }

    /// Luminances that the first samples of groups of film pixels find; 0 where cancelled.
    pub(super) fn luminances(
        &self,
        groups: Vec<Vec<[u32; 2]>>,
        seed: u32,
        learned: Option<&Learned>,
    ) -> (Vec<Vec<f32>>, ChainCounts) {
        let spp = self.settings.spp;
        let found: Vec<(Vec<f32>, ChainCounts)> = groups
            .into_par_iter()
            .map_init(
                || self.workspace(learned),
                |work, pixels| {
                    let mut sums = vec![Rgb::ZERO; pixels.len()];
                    if self.control.is_cancelled() {
                        return (vec![0.0; pixels.len()], ChainCounts::default());
                    }
                    let each = |found: Found<'_, 'w>, _: &mut Vec<_>| sums[found.index] += found.sum;
                    let chains = self.sample(&pixels, 0..spp, seed, work, each);
                    (sums.into_iter().map(|sum| luminance(sum / spp as f32)).collect(), chains)
                },
            )
            .collect();
        let mut chains = ChainCounts::default();
        found.iter().for_each(|(_, traced)| chains += *traced);
        (found.into_iter().map(|(values, _)| values).collect(), chains)
    }
}
