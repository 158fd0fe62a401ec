//! The eye pass with direct light: paths end at the first surfaces that scatter light broadly, emitters are sampled
//! there, and what is left to be found is the indirect light of the shading points that the ends are merged into.
//!
//! All pixels get the same number of samples first; then those with contrast around them get more ([`adaptive`]). A
//! pilot learns before which emitters each region of the scene sees ([`learn`]).
//!
//! [`adaptive`]: super::adaptive
//! [`learn`]: super::learn

use super::adaptive::MULTIPLES;
use super::caustic_looks::CausticLooks;
use super::ends::Ends;
use super::guides::{FirstSurfaces, Guide};
use super::merge::{MergedPoint, merge};
use super::needs::Needs;
use super::pass::TILE;
use super::points::VisibilitySample;
use super::{ChainCounts, ExtraSamples, EyePass, EyeSettings, Settled, VisibleSurfaces, guide};
use crate::caustics::Caustics;
use crate::paths::{Batch, Counts, LightSamples, Look, ScatteredEdges, Start, start};
use base::math::{Rgb, luminance};
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::sampling::{hash, unit};
use rayon::prelude::*;
use std::ops::Range;
use world::World;
use world::light::Learned;
use world::view::View;

/// Number of paths traced together, about: enough to fill packets to the end, few enough for the second-level cache.
pub(super) const BATCH: u32 = 1024;

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
    /// Samples beside the first ones for the pixels that need them most.
    pub extra_samples: ExtraSamples,
    /// Pixels that need few samples.
    pub settled: Settled,
    /// True if a denoiser's guides are to be found on the way.
    pub guides: bool,
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
    pub(super) settings: EyeSettings,
    pub(super) drawn: &'a DrawnLight,
    pub(super) caustics: Option<&'a Caustics>,
    pub(super) edges: ScatteredEdges,
    pub(super) light_samples: LightSamples,
    pub(super) control: &'a Control,
}

/// Samples of one pixel that have been traced together.
pub(super) struct Found<'b, 'w> {
    /// Index of the pixel, and of the first sample.
    pub(super) index: usize,
    first: u32,
    /// Sum of the samples' radiances.
    pub(super) sum: Rgb,
    /// Sum of those in the first half of the samples wanted.
    pub(super) half: Rgb,
    /// Radiances that were not finite and left out.
    nonfinite: u64,
    guide: Guide,
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
pub(super) struct Tile<'w> {
    /// Pixels of the window.
    pub(super) pixels: Vec<[u32; 2]>,
    /// By pixel: sum of the samples' radiances.
    pub(super) sums: Vec<Rgb>,
    /// By pixel: number of samples.
    pub(super) samples: Vec<u32>,
    /// By pixel: what a denoiser is to know of it, if that is wanted.
    guides: Vec<Guide>,
    points: Vec<MergedPoint<'w>>,
    /// By pixel: its points.
    ranges: Vec<Range<usize>>,
    chains: ChainCounts,
    nonfinite: u64,
}

impl<'w> EyePass<'w> {
    /// Finds direct light by `settings.spp` paths a pixel or more, which end at the first surface that scatters light
    /// broadly, and the shading points where indirect light is wanted. [`EyePass::known`] holds all the light found.
    pub fn with_direct_light(
        world: &'w World,
        view: &View,
        settings: EyeSettings,
        (drawn, caustics): (&DrawnLight, Option<&Caustics>),
        control: &Control,
    ) -> EyePass<'w> {
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        let mut counts = Counts::default();
        let mut tracer = Tracer::new(world, view, settings, (drawn, caustics), control, &mut counts);
        let found = tracer.learn(settings.seed, 1);
        let learned = found.as_ref().map(|(learned, _)| learned);
        let effort = tracer.effort(learned);
        tracer.light_samples.count = effort.as_ref().map_or(1, |effort| effort.light_samples);
        let works = Workspaces::new(|| tracer.workspace_with_guides(learned));
        let first = |index| {
            if control.is_cancelled() {
                return None;
            }
            let found = works.with(|work| tracer.first_samples(index, work));
            control.advance(1);
            Some(found)
        };
        let tiles = (0..view.window.tile_count(TILE)).into_par_iter().one_by_one();
        let tiles: Vec<Tile> = tiles.map(first).flatten().collect();
        let needs = effort.as_ref().and_then(|effort| tracer.needs(effort, &tiles, learned));
        let more = |tile| works.with(|work| tracer.more_samples(tile, needs.as_ref(), work));
        let tiles = tiles.into_par_iter().one_by_one().map(more).collect();
        let mut pass = EyePass::gather(&view.window, tiles, 1, control);
        pass.chains.rays += counts.rays;
        pass.chains.shadow_rays += counts.shadow_rays;
        if let Some((_, chains)) = &found {
            pass.chains += *chains;
        }
        if let Some(needs) = needs {
            pass.chains += needs.chains;
        }
        if let Some(effort) = effort {
            pass.chains += effort.chains;
            pass.light_samples = effort.light_samples;
            pass.noise = effort.noise;
        }
        pass
    }
}

/// Shading points expected of each pixel with `spp` samples, at most.
pub fn merged_points(spp: u32) -> u64 {
    u64::from(spp).min(MERGED * u64::from(spp.div_ceil(BATCH)))
}

impl<'a, 'w> Tracer<'a, 'w> {
    /// A tracer whose scattered edges are guided as a pilot finds best; counts its rays.
    pub(super) fn new(
        world: &'w World,
        view: &'a View,
        settings: EyeSettings,
        (drawn, caustics): (&'a DrawnLight, Option<&'a Caustics>),
        control: &'a Control,
        counts: &mut Counts,
    ) -> Tracer<'a, 'w> {
        let (edges, light_samples) = (ScatteredEdges::default(), LightSamples::ONE);
        let mut tracer = Tracer { world, view, settings, drawn, caustics, edges, light_samples, control };
        let all = || tracer.workspace(None).ends;
        tracer.edges = guide::edges(world, view, settings, (all, caustics), counts);
        tracer
    }

    pub(super) fn workspace<'b>(&'b self, learned: Option<&'b Learned>) -> Workspace<'b, 'w> {
        let spacing_by_distance = SPACING * self.view.pixel_angle();
        let Tracer { drawn, caustics, edges, light_samples, .. } = *self;
        let ends = Ends {
            drawn,
            learned,
            caustics,
            looks: CausticLooks::default(),
            spacing_by_distance,
            edges,
            light_samples,
            found: Vec::new(),
            order: Vec::new(),
            first_surfaces: None,
        };
        Workspace { batch: Batch::default(), ends, merged: Vec::new() }
    }

    /// The same for samples of which guides are to be found, if any are.
    fn workspace_with_guides<'b>(&'b self, learned: Option<&'b Learned>) -> Workspace<'b, 'w> {
        let mut workspace = self.workspace(learned);
        workspace.ends.first_surfaces = self.finds_guides().then(FirstSurfaces::default);
        workspace
    }

    /// True if a denoiser's guides are to be found: paths that may not go on say nothing of surfaces.
    fn finds_guides(&self) -> bool {
        self.drawn.guides && self.settings.spp > 1 && self.settings.max_depth > 1
    }

    /// Takes the first samples of all pixels of a tile.
    fn first_samples(&self, index: usize, work: &mut Workspace<'_, 'w>) -> Tile<'w> {
        let window = &self.view.window;
        let pixels: Vec<[u32; 2]> = window.tile(index, TILE).collect();
        let EyeSettings { spp, seed, .. } = self.settings;
        let settled = &self.drawn.settled;
        let of_window = |pixel: &[u32; 2]| pixel[1] as usize * window.width as usize + pixel[0] as usize;
        let are_settled: Vec<bool> = pixels.iter().map(|pixel| settled.contains(of_window(pixel))).collect();
        let mut tile = Tile {
            sums: vec![Rgb::ZERO; pixels.len()],
            samples: vec![spp; pixels.len()],
            guides: vec![Guide::default(); if self.finds_guides() { pixels.len() } else { 0 }],
            points: Vec::with_capacity(2 * pixels.len()),
            ranges: vec![0..0; pixels.len()],
            chains: ChainCounts::default(),
            nonfinite: 0,
            pixels,
        };
        for (is_settled, samples) in [(false, 0..spp), (true, settled.samples(spp))] {
            let chosen: Vec<usize> =
                (0..are_settled.len()).filter(|i| are_settled[*i] == is_settled).collect();
            let film_pixels: Vec<[u32; 2]> =
                chosen.iter().map(|i| window.film_pixel(tile.pixels[*i])).collect();
            let number = samples.len() as u32;
            tile.chains += self.sample(&film_pixels, samples, seed, work, |found, merged| {
                let i = chosen[found.index];
                tile.sums[i] += found.sum;
                tile.samples[i] = number;
                if let Some(guide) = tile.guides.get_mut(i) {
                    guide.add(found.guide);
                }
                tile.nonfinite += found.nonfinite;
                let draw = self.draw(film_pixels[found.index], found.first);
                merge(found.ends(), draw, merged);
                let start = tile.points.len();
                tile.points.extend_from_slice(merged);
                let range = &mut tile.ranges[i];
                let start = if range.start < range.end { range.start } else { start };
                *range = start..tile.points.len();
            });
        }
        // Tiles wait for the others.
        tile.points.shrink_to_fit();
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
        let cancelled = self.control.is_cancelled();
        let needs = needs.filter(|_| !cancelled);
        let more = |(pixel, samples): (&[u32; 2], &u32)| match needs {
            Some(needs) if *samples == spp => needs.choice.more(&needs.luminances, *pixel),
            _ => 0,
        };
        let multiples: Vec<u32> = film_pixels.iter().zip(&tile.samples).map(more).collect();
        let put = |found: &mut VisibleSurfaces<'w>, i: usize, points: &[MergedPoint<'w>], samples: u32| {
            let pixel = tile.pixels[i][1] * window.width + tile.pixels[i][0];
            for point in points {
                found.points.geometry.push(point.geometry);
                found.points.surfaces.push(point.surface);
                found.visibility.push(VisibilitySample { pixel, weight: point.weight / samples as f32 });
            }
        };
        let first_points = |i: usize| &tile.points[tile.ranges[i].clone()];
        for multiple in [0].into_iter().chain(MULTIPLES) {
            let chosen: Vec<usize> = (0..multiples.len()).filter(|i| multiples[*i] == multiple).collect();
            if multiple == 0 {
                // Points that nothing will light need not be.
                let lit = if cancelled { &[] } else { &chosen[..] };
                lit.iter().for_each(|i| put(&mut found, *i, first_points(*i), tile.samples[*i]));
            } else {
                let total = spp * (1 + multiple);
                let chosen_pixels: Vec<[u32; 2]> = chosen.iter().map(|i| film_pixels[*i]).collect();
                let chains = self.sample(&chosen_pixels, spp..total, seed, work, |more, merged| {
                    let i = chosen[more.index];
                    tile.sums[i] += more.sum;
                    if let Some(guide) = tile.guides.get_mut(i) {
                        guide.add(more.guide);
                    }
                    found.nonfinite += more.nonfinite;
                    let before = if more.first == spp { first_points(i) } else { &[] };
                    let points = before.iter().chain(more.ends());
                    merge(points, self.draw(film_pixels[i], more.first), merged);
                    put(&mut found, i, merged, total);
                    tile.samples[i] = total;
                });
                found.chains += chains;
                found.chains.extra_samples += u64::from(total - spp) * chosen.len() as u64;
            }
            for i in chosen.into_iter().filter(|i| tile.sums[*i] != Rgb::ZERO) {
                let pixel = tile.pixels[i][1] * window.width + tile.pixels[i][0];
                found.known.push((pixel, tile.sums[i] / tile.samples[i] as f32));
            }
        }
        let of_window = |[x, y]: [u32; 2]| y * window.width + x;
        let kept = tile.guides.iter().zip(&tile.samples).map(|(guide, samples)| guide.kept(*samples));
        found.guides = tile.pixels.iter().map(|pixel| of_window(*pixel)).zip(kept).collect();
        found
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
        let middle = samples.start + samples.len() as u32 / 2;
        let together = (BATCH / samples.len().max(1) as u32).max(1) as usize;
        for (chunk, pixels) in pixels.chunks(together).enumerate() {
            for first in samples.clone().step_by(BATCH as usize) {
                let part = first..first.saturating_add(BATCH).min(samples.end);
                let n = part.len();
                let paths = pixels
                    .iter()
                    .flat_map(|pixel| part.clone().map(move |sample| Start { pixel: *pixel, sample, seed }));
                start(batch, paths, (self.world, self.view), (look, self.settings.spp));
                ends.looks = CausticLooks::new(n as u32);
                ends.found.clear();
                ends.order.clear();
                if let Some(first_surfaces) = &mut ends.first_surfaces {
                    first_surfaces.begin(pixels.len(), n as u32);
                }
                let mut counts = Counts::default();
                let mut radiance = batch.trace(self.world, self.settings.max_depth, ends, &mut counts);
                chains.rays += counts.rays;
                chains.shadow_rays += counts.shadow_rays;
                chains.by_photons += ends.looks.found;
                chains.square_by_photons += ends.looks.square;
                ends.order.sort_unstable();
                if let Some(first_surfaces) = &mut ends.first_surfaces {
                    let eye = (self.world, self.view);
                    first_surfaces.finish(eye, (pixels, part.start), (self.settings.spp, seed));
                }
                let (found, mut rest) = (&ends.found[..], &ends.order[..]);
                for i in 0..pixels.len() {
                    let (mut sum, mut half, mut nonfinite) = (Rgb::ZERO, Rgb::ZERO, 0);
                    for (number, value) in part.clone().zip(radiance.by_ref().take(n)) {
                        if value.is_finite() {
                            sum += value;
                            half += if number < middle { value } else { Rgb::ZERO };
                        } else {
                            nonfinite += 1;
                        }
                    }
                    chains.light += f64::from(luminance(sum));
                    let own;
                    (own, rest) =
                        rest.split_at(rest.partition_point(|(path, _)| *path < ((i + 1) * n) as u32));
                    let index = chunk * together + i;
                    let guide = ends.first_surfaces.as_ref().map_or_else(Guide::default, |first| first.of(i));
                    each(
                        Found { index, first, sum, half, nonfinite, guide, ends: found, order: own },
                        merged,
                    );
                }
            }
        }
        chains
    }

    /// Random number by which points of a film pixel are thinned whose samples start with `first`.
    fn draw(&self, [x, y]: [u32; 2], first: u32) -> f32 {
        unit(hash(hash(x, y), self.settings.seed ^ 0x7e11 ^ first))
    }
}
