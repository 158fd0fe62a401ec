//! Eye pass with direct light.
//!
//! Paths stop at the first surfaces that scatter light broadly. Emitters are sampled there. The hits are merged into
//! shading points, whose indirect light remains to be found.
//!
//! All pixels first get the same number of samples, twice if a pilot finds that this pays ([`extra`]). Pixels in
//! high-contrast surroundings then get more ([`adaptive`]).
//!
//! [`adaptive`]: super::adaptive
//! [`extra`]: super::extra

use super::guides::Guide;
use super::merge::{MergedPoint, MergedPoints, merge};
use super::more::TilePart;
use super::points::VisibilitySample;
use super::tracer::{BATCH, SampledTile, Tracer, TracerWorkspace};
use super::{EyeCounts, EyePass, EyeSettings, LightSources, TILE, VisibleSurfaces};
use crate::paths::RayCounts;
use base::math::Rgb;
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::sampling::{hash, unit};
use rayon::prelude::*;
use world::World;
use world::view::View;

/// Expected maximum number of shading points per pixel and batch after merging.
const POINTS_PER_BATCH: u64 = 7;

impl<'w> EyePass<'w> {
    /// Samples direct light with at least `settings.spp` paths per pixel and finds the shading points that need
    /// indirect light. [`EyePass::known`] holds all the light found.
    pub fn with_direct_light(
        world: &'w World,
        view: &View,
        settings: EyeSettings,
        sources: LightSources,
        control: &Control,
    ) -> EyePass<'w> {
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        let mut counts = RayCounts::default();
        let mut tracer = Tracer::new(world, view, settings, sources, control, &mut counts);
        let effort = tracer.effort();
        tracer.light_samples.count = effort.as_ref().map_or(1, |effort| effort.light_samples);
        let rounds = effort.as_ref().map_or(1, |effort| effort.rounds);
        tracer.settings.spp *= rounds;
        let works = Workspaces::new(|| tracer.workspace_with_guides());
        let live = control.live([view.window.width, view.window.height]);
        let first = |index| {
            if control.is_cancelled() {
                return None;
            }
            let tile = works.with(|work| tracer.first_samples(index, work));
            if let Some(live) = &live {
                live.set(tile.light(view.window.width));
            }
            control.advance(1);
            Some(tile)
        };
        let tiles = (0..view.window.tile_count(TILE)).into_par_iter().one_by_one();
        let tiles: Vec<SampledTile> = tiles.map(first).flatten().collect();
        let needs = effort.as_ref().and_then(|effort| tracer.needs(effort, &tiles));
        let all_traced = tiles.len() == view.window.tile_count(TILE);
        let parts = |tile| tracer.tile_parts(tile, needs.as_ref());
        let parts: Vec<Vec<TilePart>> = tiles.into_par_iter().one_by_one().map(parts).collect();
        let parts: Vec<TilePart> = parts.into_iter().flatten().collect();
        let more = |part| works.with(|work| tracer.more_samples(part, work));
        let surfaces = parts.into_par_iter().one_by_one().map(more).collect();
        let mut pass = EyePass::gather(&view.window, surfaces, 1, all_traced, control);
        pass.chains.rays += counts.rays;
        pass.chains.shadow_rays += counts.shadow_rays;
        if let Some(needs) = needs {
            pass.chains += needs.chains;
        }
        let more = u64::from(settings.spp) * u64::from(rounds - 1);
        pass.chains.extra_samples += more * view.window.pixel_count();
        if let Some(effort) = effort {
            pass.chains += effort.chains;
            pass.light_samples = effort.light_samples;
            pass.noise = effort.noise;
        }
        pass
    }
}

/// Returns the expected maximum number of shading points per pixel with `spp` samples.
pub fn merged_points(spp: u32) -> u64 {
    u64::from(spp).min(POINTS_PER_BATCH * u64::from(spp.div_ceil(BATCH)))
}

impl<'w> VisibleSurfaces<'w> {
    /// Adds the shading points that `samples` samples of a pixel have found.
    pub(super) fn add(&mut self, pixel: u32, points: &[MergedPoint<'w>], samples: u32) {
        for point in points {
            self.points.geometry.push(point.geometry);
            self.points.surfaces.push(&point.surface);
            self.visibility.push(VisibilitySample { pixel, weight: point.weight / samples as f32 });
        }
    }
}

impl<'w> Tracer<'_, 'w> {
    /// Takes the first samples of all pixels of a tile.
    fn first_samples(&self, index: usize, work: &mut TracerWorkspace<'_, 'w>) -> SampledTile<'w> {
        let window = &self.view.window;
        let pixels: Vec<[u32; 2]> = window.tile(index, TILE).collect();
        let EyeSettings { spp, seed, .. } = self.settings;
        let settled = &self.direct.settled;
        let of_window = |pixel: &[u32; 2]| pixel[1] as usize * window.width as usize + pixel[0] as usize;
        let are_settled: Vec<bool> = pixels.iter().map(|pixel| settled.contains(of_window(pixel))).collect();
        let mut tile = SampledTile {
            sums: vec![Rgb::ZERO; pixels.len()],
            samples: vec![spp; pixels.len()],
            guides: vec![Guide::default(); if self.finds_guides() { pixels.len() } else { 0 }],
            points: MergedPoints::default(),
            ranges: vec![0..0; pixels.len()],
            chains: EyeCounts::default(),
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
                merged.iter().for_each(|point| tile.points.push(point));
                let range = &mut tile.ranges[i];
                let start = if range.start < range.end { range.start } else { start };
                *range = start..tile.points.len();
            });
        }
        // Tiles wait until all first samples are taken.
        tile.points.shrink_to_fit();
        tile
    }

    /// Returns the random number that thins the points of a film pixel whose samples start with `first`.
    pub(super) fn draw(&self, [x, y]: [u32; 2], first: u32) -> f32 {
        unit(hash(hash(x, y), self.settings.seed ^ 0x7e11 ^ first))
    }
}
