//! The eye pass with direct light: paths end at the first surfaces that scatter light broadly, emitters are sampled
//! there, and what is left to be found is the indirect light of the shading points that the ends are merged into.
//!
//! All pixels get the same number of samples first; then those with contrast around them get more ([`adaptive`]). A
//! pilot learns before which emitters each region of the scene sees ([`learn`]).
//!
//! [`adaptive`]: super::adaptive
//! [`learn`]: super::learn

use super::adaptive::{Choice, Luminances, MULTIPLES, pilot};
use super::merge::{MergedPoint, merge};
use super::pass::TILE;
use super::points::VisibilitySample;
use super::{ChainCounts, EyePass, EyeSettings, VisibleSurfaces, guide};
use crate::light::Learned;
use crate::material::{Bsdf, LobeSet};
use crate::math::{Rgb, luminance};
use crate::paths::{Batch, ChainEnd, Counts, Look, Reach, ScatteredEdges, Start, start};
use crate::progress::Control;
use crate::sampling::hash;
use crate::view::View;
use crate::world::World;
use rayon::prelude::*;
use std::ops::Range;

/// Number of paths traced together, about: enough to fill packets to the end, few enough for the second-level cache.
const BATCH: u32 = 1024;

/// Number of shading points that so many samples of a pixel are merged into at most, as a rule.
const MERGED: u64 = 3;

/// Share of a pixel's edge that counts as the distance to the next point: that of four eye samples a pixel, for which
/// the reach of records is set.
const SPACING: f32 = 0.5;

/// Direct light to be drawn.
#[derive(Clone, Debug, Default)]
pub struct DrawnLight {
    /// True of materials all of whose rough lobes chains follow, by material; of others they follow the sharp ones.
    pub followed: Vec<bool>,
    /// Samples beside the first ones for the pixels that need them most, as a share of the first ones.
    pub extra_samples: f32,
}

/// Maximum number of first samples that may be followed by more: their numbers are 32 bits wide.
const MAX_ADAPTIVE: u32 = u32::MAX / 4;

/// Seed of the pilot's samples over that of the others.
const PILOT_SEED: u32 = 0x3c6e_f372;

/// The ends of paths, in the order of the paths' edges.
pub(super) struct Ends<'a, 'w> {
    drawn: &'a DrawnLight,
    learned: Option<&'a Learned>,
    /// Distance between neighbouring points over that from the eye, on surfaces that face it.
    spacing_by_distance: f32,
    edges: ScatteredEdges,
    found: Vec<MergedPoint<'w>>,
    /// Their paths, and their numbers.
    order: Vec<(u32, u32)>,
}

impl<'w> Reach<'w> for Ends<'_, 'w> {
    const ENDS: bool = true;

    fn followed(&self, bsdf: &Bsdf) -> LobeSet {
        match self.drawn.followed.get(bsdf.material().0 as usize) {
            Some(true) => bsdf.rough_lobes(),
            _ => bsdf.sharp_lobes(),
        }
    }

    fn learned(&self) -> Option<&Learned> {
        self.learned
    }

    fn edges(&self) -> ScatteredEdges {
        self.edges
    }

    #[inline]
    fn end(&mut self, end: &ChainEnd<'w>) {
        if let Some(point) = MergedPoint::new(end, self.spacing_by_distance * end.distance) {
            self.order.push((end.path, self.found.len() as u32));
            self.found.push(point);
        }
    }
}

/// A thread's buffers.
pub(super) struct Workspace<'a, 'w> {
    batch: Batch,
    ends: Ends<'a, 'w>,
    merged: Vec<MergedPoint<'w>>,
}

/// Paths through the pixels of a view.
pub(super) struct Tracer<'a, 'w> {
    pub(super) world: &'w World,
    pub(super) view: &'a View,
    settings: EyeSettings,
    drawn: &'a DrawnLight,
    edges: ScatteredEdges,
    pub(super) control: &'a Control,
}

/// Samples of one pixel that have been traced together.
pub(super) struct Found<'b, 'w> {
    /// Index of the pixel, and of the first sample.
    index: usize,
    first: u32,
    /// Sum of the samples' radiances.
    sum: Rgb,
    /// Radiances that were not finite and left out.
    nonfinite: u64,
    ends: &'b [MergedPoint<'w>],
    /// Those of the pixel, by path.
    order: &'b [(u32, u32)],
}

impl<'b, 'w> Found<'b, 'w> {
    pub(super) fn ends(&self) -> impl Iterator<Item = &'b MergedPoint<'w>> {
        let ends = self.ends;
        self.order.iter().map(|(_, number)| &ends[*number as usize])
    }
}

/// Light and shading points of the first samples of a tile's pixels.
struct Tile<'w> {
    /// Pixels of the window.
    pixels: Vec<[u32; 2]>,
    /// By pixel: sum of the samples' radiances.
    sums: Vec<Rgb>,
    points: Vec<MergedPoint<'w>>,
    /// By pixel, and at last for their end: index of the first of its points.
    firsts: Vec<usize>,
    chains: ChainCounts,
    nonfinite: u64,
}

/// Numbers of samples that pixels are to get.
struct Needs {
    choice: Choice,
    /// Luminances found by the first samples, in the window and in the pixels next to it.
    luminances: Luminances,
    /// Rays traced to learn them.
    chains: ChainCounts,
}

impl<'w> EyePass<'w> {
    /// Finds direct light by `settings.spp` paths a pixel or more, which end at the first surface that scatters light
    /// broadly, and the shading points where indirect light is wanted. [`EyePass::known`] holds all the light found.
    pub fn with_direct_light(
        world: &'w World,
        view: &View,
        settings: EyeSettings,
        drawn: &DrawnLight,
        control: &Control,
    ) -> EyePass<'w> {
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        let mut tracer = Tracer { world, view, settings, drawn, edges: ScatteredEdges::default(), control };
        let mut counts = Counts::default();
        tracer.edges = guide::edges(world, view, settings, &mut tracer.workspace(None).ends, &mut counts);
        let found = tracer.learn(settings.seed);
        let learned = found.as_ref().map(|(learned, _)| learned);
        let tiles: Vec<Tile> = (0..view.window.tile_count(TILE))
            .into_par_iter()
            .map_init(
                || tracer.workspace(learned),
                |work, index| {
                    if control.is_cancelled() {
                        return None;
                    }
                    let found = tracer.first_samples(index, work);
                    control.advance(1);
                    Some(found)
                },
            )
            .flatten()
            .collect();
        let needs = tracer.needs(&tiles, learned);
        let tiles = tiles
            .into_par_iter()
            .map_init(
                || tracer.workspace(learned),
                |work, tile| tracer.more_samples(tile, needs.as_ref(), work),
            )
            .collect();
        let mut pass = EyePass::gather(&view.window, tiles, 1);
        pass.chains.rays += counts.rays;
        pass.chains.shadow_rays += counts.shadow_rays;
        if let Some((_, chains)) = &found {
            pass.chains += *chains;
        }
        if let Some(needs) = needs {
            pass.chains += needs.chains;
        }
        pass
    }
}

/// Shading points expected of each pixel with `spp` samples, at most.
pub fn merged_points(spp: u32) -> u64 {
    u64::from(spp).min(MERGED * u64::from(spp.div_ceil(BATCH)))
}

impl<'a, 'w> Tracer<'a, 'w> {
    pub(super) fn workspace<'b>(&'b self, learned: Option<&'b Learned>) -> Workspace<'b, 'w> {
        let spacing_by_distance = SPACING * self.view.pixel_angle();
        let Tracer { drawn, edges, .. } = *self;
        let ends = Ends { drawn, learned, spacing_by_distance, edges, found: Vec::new(), order: Vec::new() };
        Workspace { batch: Batch::default(), ends, merged: Vec::new() }
    }

    /// Takes the first samples of all pixels of a tile.
    fn first_samples(&self, index: usize, work: &mut Workspace<'_, 'w>) -> Tile<'w> {
        let window = &self.view.window;
        let pixels: Vec<[u32; 2]> = window.tile(index, TILE).collect();
        let film_pixels: Vec<[u32; 2]> = pixels.iter().map(|pixel| window.film_pixel(*pixel)).collect();
        let mut tile = Tile {
            sums: vec![Rgb::ZERO; pixels.len()],
            points: Vec::with_capacity(2 * pixels.len()),
            firsts: vec![0; pixels.len() + 1],
            chains: ChainCounts::default(),
            nonfinite: 0,
            pixels,
        };
        let EyeSettings { spp, seed, .. } = self.settings;
        tile.chains = self.sample(&film_pixels, 0..spp, seed, work, |found, merged| {
            tile.sums[found.index] += found.sum;
            tile.nonfinite += found.nonfinite;
            let draw = self.draw(film_pixels[found.index], found.first);
            merge(found.ends(), draw, merged);
            tile.points.extend_from_slice(merged);
            tile.firsts[found.index + 1] = tile.points.len();
        });
        tile
    }

    /// Takes more samples of the pixels of a tile that need them, and puts all samples together.
    fn more_samples(
        &self,
        mut tile: Tile<'w>,
        needs: Option<&Needs>,
        work: &mut Workspace<'_, 'w>,
    ) -> VisibleSurfaces<'w> {
        let EyeSettings { spp, seed, .. } = self.settings;
        let window = &self.view.window;
        let mut found =
            VisibleSurfaces { chains: tile.chains, nonfinite: tile.nonfinite, ..Default::default() };
        let film_pixels: Vec<[u32; 2]> = tile.pixels.iter().map(|pixel| window.film_pixel(*pixel)).collect();
        let needs = needs.filter(|_| !self.control.is_cancelled());
        let more = |pixel: &[u32; 2]| needs.map_or(0, |needs| needs.choice.more(&needs.luminances, *pixel));
        let multiples: Vec<u32> = film_pixels.iter().map(more).collect();
        let put = |found: &mut VisibleSurfaces<'w>, i: usize, points: &[MergedPoint<'w>], samples: u32| {
            let pixel = tile.pixels[i][1] * window.width + tile.pixels[i][0];
            for point in points {
                found.points.geometry.push(point.geometry);
                found.points.surfaces.push(point.surface);
                found.visibility.push(VisibilitySample { pixel, weight: point.weight / samples as f32 });
            }
        };
        let first_points = |i: usize| &tile.points[tile.firsts[i]..tile.firsts[i + 1]];
        for multiple in [0].into_iter().chain(MULTIPLES) {
            let chosen: Vec<usize> = (0..multiples.len()).filter(|i| multiples[*i] == multiple).collect();
            let total = spp * (1 + multiple);
            if multiple == 0 {
                chosen.iter().for_each(|i| put(&mut found, *i, first_points(*i), total));
            } else {
                let chosen_pixels: Vec<[u32; 2]> = chosen.iter().map(|i| film_pixels[*i]).collect();
                let chains = self.sample(&chosen_pixels, spp..total, seed, work, |more, merged| {
                    let i = chosen[more.index];
                    tile.sums[i] += more.sum;
                    found.nonfinite += more.nonfinite;
                    let before = if more.first == spp { first_points(i) } else { &[] };
                    let points = before.iter().chain(more.ends());
                    merge(points, self.draw(film_pixels[i], more.first), merged);
                    put(&mut found, i, merged, total);
                });
                found.chains += chains;
                found.chains.extra_samples += u64::from(total - spp) * chosen.len() as u64;
            }
            for i in chosen.into_iter().filter(|i| tile.sums[*i] != Rgb::ZERO) {
                let pixel = tile.pixels[i][1] * window.width + tile.pixels[i][0];
                found.known.push((pixel, tile.sums[i] / total as f32));
            }
        }
        found
    }

    /// Learns which pixels need more samples than the first; `None` if none is to get more.
    fn needs(&self, tiles: &[Tile], learned: Option<&Learned>) -> Option<Needs> {
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
            for (pixel, sum) in tile.pixels.iter().zip(&tile.sums) {
                luminances.set(window.film_pixel(*pixel), luminance(*sum / spp as f32));
            }
        }
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
    fn luminances(
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

    /// Traces samples of film pixels and calls `each` for every pixel in order, for every part of its samples if they
    /// are too many to be traced at once.
    pub(super) fn sample(
        &self,
        pixels: &[[u32; 2]],
        samples: Range<u32>,
        seed: u32,
        work: &mut Workspace<'_, 'w>,
        mut each: impl FnMut(Found<'_, 'w>, &mut Vec<MergedPoint<'w>>),
    ) -> ChainCounts {
        let Workspace { batch, ends, merged } = work;
        let look = if self.settings.spp > 1 { Look::Pixels } else { Look::EyeSamples { spp: 1, seed } };
        let mut chains = ChainCounts::default();
        let together = (BATCH / samples.len().max(1) as u32).max(1) as usize;
        for (chunk, pixels) in pixels.chunks(together).enumerate() {
            for first in samples.clone().step_by(BATCH as usize) {
                let part = first..first.saturating_add(BATCH).min(samples.end);
                let n = part.len();
                let paths = pixels
                    .iter()
                    .flat_map(|pixel| part.clone().map(move |sample| Start { pixel: *pixel, sample, seed }));
                start(batch, paths, self.view, look);
                ends.found.clear();
                ends.order.clear();
                let mut counts = Counts::default();
                let mut radiance = batch.trace(self.world, self.settings.max_depth, ends, &mut counts);
                chains.rays += counts.rays;
                chains.shadow_rays += counts.shadow_rays;
                ends.order.sort_unstable();
                let (found, mut rest) = (&ends.found[..], &ends.order[..]);
                for i in 0..pixels.len() {
                    let (mut sum, mut nonfinite) = (Rgb::ZERO, 0);
                    for value in radiance.by_ref().take(n) {
                        if value.is_finite() {
                            sum += value;
                        } else {
                            nonfinite += 1;
                        }
                    }
                    let own;
                    (own, rest) =
                        rest.split_at(rest.partition_point(|(path, _)| *path < ((i + 1) * n) as u32));
                    let index = chunk * together + i;
                    each(Found { index, first, sum, nonfinite, ends: found, order: own }, merged);
                }
            }
        }
        chains
    }

    /// Random number by which points of a film pixel are thinned whose samples start with `first`.
    fn draw(&self, [x, y]: [u32; 2], first: u32) -> f32 {
        hash(hash(x, y), self.settings.seed ^ 0x7e11 ^ first) as f32 * (1.0 / 4_294_967_296.0)
    }
}
