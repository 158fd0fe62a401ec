//! Further samples of pixels that need them, after the first samples of all pixels.
//!
//! Some tiles need many times the samples of others, so a tile is divided into parts that threads take one by one.
//! Parts end where a batch of paths ends: paths are traced together as if the tile were not divided.

use super::adaptive::{AdaptiveRule, Luminances, MULTIPLES};
use super::effort::Effort;
use super::guides::Guide;
use super::merge::{MergedPoint, merge};
use super::tracer::{BATCH, SampledTile, Tracer, TracerWorkspace, traced_together};
use super::{EyeCounts, VisibleSurfaces};
use base::math::{Rgb, luminance};
use std::sync::Arc;

/// Pixels of a tile that get equally many samples beyond the first.
pub(super) struct TilePart<'w> {
    tile: Arc<SampledTile<'w>>,
    /// Indices of the pixels in the tile.
    chosen: Vec<usize>,
    /// Number of samples beyond the first, as a multiple of these.
    multiple: u32,
    /// True for the first part of a tile, which takes the tile's counts.
    is_first: bool,
}

impl<'w> Tracer<'_, 'w> {
    /// Divides a tile into parts: pixels without further samples, then batches of pixels with further samples.
    pub(super) fn tile_parts(&self, tile: SampledTile<'w>, needs: Option<&Needs>) -> Vec<TilePart<'w>> {
        let needs = needs.filter(|_| !self.control.is_cancelled());
        let multiples = self.multiples(&tile, needs);
        let chosen = |multiple: u32| -> Vec<usize> {
            (0..multiples.len()).filter(|i| multiples[*i] == multiple).collect()
        };
        let tile = Arc::new(tile);
        let part = |chosen: Vec<usize>, multiple: u32| {
            let (tile, is_first) = (Arc::clone(&tile), multiple == 0);
            TilePart { tile, chosen, multiple, is_first }
        };
        let mut parts = vec![part(chosen(0), 0)];
        for multiple in MULTIPLES {
            let all = chosen(multiple);
            let batches = all.chunks(traced_together(self.settings.spp * multiple));
            parts.extend(batches.map(|batch| part(batch.to_vec(), multiple)));
        }
        parts
    }

    /// Takes more samples of the pixels of a part, if they need any, and merges all samples.
    pub(super) fn more_samples(
        &self,
        part: TilePart<'w>,
        work: &mut TracerWorkspace<'_, 'w>,
    ) -> VisibleSurfaces<'w> {
        let TilePart { tile, chosen, multiple, is_first } = part;
        let cancelled = self.control.is_cancelled();
        let mut found = VisibleSurfaces::default();
        if is_first {
            (found.chains, found.nonfinite) = (tile.chains, tile.nonfinite);
        }
        let mut pixels = PartPixels::chosen(&tile, &chosen);
        if multiple > 0 && !cancelled {
            self.sample_more(&tile, &chosen, multiple, &mut pixels, &mut found, work);
        } else if !cancelled {
            // Points that will not be lit are left out.
            for i in &chosen {
                found.add(self.index(&tile, *i), &first_points(&tile, *i), tile.samples[*i]);
            }
        }
        for (i, (sum, samples)) in chosen.iter().zip(pixels.sums.iter().zip(&pixels.samples)) {
            if *sum != Rgb::ZERO {
                found.known.push((self.index(&tile, *i), *sum / *samples as f32));
            }
        }
        let kept = pixels.guides.iter().zip(&pixels.samples).map(|(guide, samples)| guide.kept(*samples));
        found.shrink_to_fit();
        found.guides = chosen.iter().map(|i| self.index(&tile, *i)).zip(kept).collect();
        found
    }

    /// Takes more samples of the pixels `chosen` of a tile, and adds the shading points of all their samples.
    fn sample_more(
        &self,
        tile: &SampledTile<'w>,
        chosen: &[usize],
        multiple: u32,
        pixels: &mut PartPixels,
        found: &mut VisibleSurfaces<'w>,
        work: &mut TracerWorkspace<'_, 'w>,
    ) {
        let (spp, seed) = (self.settings.spp, self.settings.seed);
        let total = spp * (1 + multiple);
        let film_pixels: Vec<[u32; 2]> =
            chosen.iter().map(|i| self.view.window.film_pixel(tile.pixels[*i])).collect();
        let chains = self.sample(&film_pixels, spp..total, seed, work, |more, merged| {
            let (own, i) = (more.index, chosen[more.index]);
            pixels.sums[own] += more.sum;
            if let Some(guide) = pixels.guides.get_mut(own) {
                guide.add(more.guide);
            }
            found.nonfinite += more.nonfinite;
            let before = if more.first == spp { first_points(tile, i) } else { Vec::new() };
            let points = before.iter().chain(more.ends());
            merge(points, self.draw(film_pixels[own], more.first), merged);
            found.add(self.index(tile, i), merged, total);
            pixels.samples[own] = total;
        });
        found.chains += chains;
        found.chains.extra_samples += u64::from(total - spp) * chosen.len() as u64;
    }

    /// Returns the numbers of samples of a tile's pixels beyond their first, as multiples of these. Pixels with other
    /// numbers of first samples get no more.
    fn multiples(&self, tile: &SampledTile, needs: Option<&Needs>) -> Vec<u32> {
        let more = |(pixel, samples): (&[u32; 2], &u32)| match needs {
            Some(needs) if *samples == self.settings.spp => {
                needs.choice.more(&needs.luminances, self.view.window.film_pixel(*pixel))
            }
            _ => 0,
        };
        tile.pixels.iter().zip(&tile.samples).map(more).collect()
    }

    /// Returns the index in the window of a pixel of a tile.
    fn index(&self, tile: &SampledTile, i: usize) -> u32 {
        let [x, y] = tile.pixels[i];
        y * self.view.window.width + x
    }
}

/// Sums over the samples of the pixels of a part.
struct PartPixels {
    /// Sum of the samples' radiances per pixel.
    sums: Vec<Rgb>,
    /// Number of samples per pixel.
    samples: Vec<u32>,
    /// Denoiser guide per pixel, if guides are requested.
    guides: Vec<Guide>,
}

impl PartPixels {
    /// Returns the sums over the first samples.
    fn chosen(tile: &SampledTile, chosen: &[usize]) -> PartPixels {
        PartPixels {
            sums: chosen.iter().map(|i| tile.sums[*i]).collect(),
            samples: chosen.iter().map(|i| tile.samples[*i]).collect(),
            guides: chosen.iter().filter_map(|i| tile.guides.get(*i).cloned()).collect(),
        }
    }
}

/// Returns the shading points that the first samples of a pixel have found.
fn first_points<'w>(tile: &SampledTile<'w>, i: usize) -> Vec<MergedPoint<'w>> {
    tile.ranges[i].clone().map(|point| tile.points.get(point)).collect()
}

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
