//! Numbers of samples that pixels get beyond their first, from the luminances that the first have found around them.

use super::EyeCounts;
use super::adaptive::{AdaptiveRule, Luminances};
use super::effort::Effort;
use super::tracer::{BATCH, SampledTile, Tracer};
use base::math::luminance;

/// Result of the first samples that decides where more are taken.
pub(super) struct Needs {
    pub(super) choice: AdaptiveRule,
    /// Luminances found by the first samples, in the window and in the pixels next to it.
    pub(super) luminances: Luminances,
    /// Rays traced for the pixels next to the window.
    pub(super) chains: EyeCounts,
}

impl<'w> Tracer<'_, 'w> {
    /// Determines which pixels need more samples than the first; returns `None` if no pixel gets more.
    pub(super) fn needs(&self, effort: &Effort, tiles: &[SampledTile]) -> Option<Needs> {
        let (choice, seed) = (effort.choice?, self.settings.seed);
        let (window, near) = (&self.view.window, self.view.window.grown(1));
        let mut luminances = Luminances { values: vec![0.0; near.pixel_count() as usize], window: near };
        for tile in tiles {
            for ((pixel, sum), samples) in tile.pixels.iter().zip(&tile.sums).zip(&tile.samples) {
                luminances.set(window.film_pixel(*pixel), luminance(*sum / *samples as f32));
            }
        }
        self.direct.settled.smooth(window, &mut luminances);
        let is_beside = |pixel: &[u32; 2]| window.index(*pixel).is_none();
        let beside: Vec<[u32; 2]> = match near == *window {
            true => Vec::new(),
            false => near.film_pixels().filter(is_beside).collect(),
        };
        let beside: Vec<Vec<[u32; 2]>> = beside.chunks(BATCH as usize).map(<[_]>::to_vec).collect();
        let (values, chains) = self.luminances(beside.clone(), seed);
        beside
            .iter()
            .flatten()
            .zip(values.iter().flatten())
            .for_each(|(pixel, [mean, _])| luminances.set(*pixel, *mean));
        Some(Needs { choice, luminances, chains: chains.into_iter().sum() })
    }
}
