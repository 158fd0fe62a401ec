//! The eye pass with direct light: paths end at the first surfaces that scatter light broadly, emitters are sampled
//! there, and what is left to be found is the indirect light of the shading points that the ends are merged into.

use super::merge::{MergedPoint, merge};
use super::pass::TILE;
use super::points::VisibilitySample;
use super::{ChainCounts, EyePass, EyeSettings, VisibleSurfaces};
use crate::material::Bsdf;
use crate::math::Rgb;
use crate::paths::{Batch, ChainEnd, Counts, Look, Reach, Start, start};
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
}

/// The ends of paths, by the number of the path and in the order of its edges.
struct Ends<'a, 'w> {
    drawn: &'a DrawnLight,
    /// Distance between neighbouring points over that from the eye, on surfaces that face it.
    spacing_by_distance: f32,
    found: Vec<(u32, u32, MergedPoint<'w>)>,
}

impl<'w> Reach<'w> for Ends<'_, 'w> {
    const ENDS: bool = true;

    fn split<'m>(&self, bsdf: &Bsdf<'m>) -> Option<(Bsdf<'m>, Bsdf<'m>)> {
        match self.drawn.followed.get(bsdf.material().0 as usize) {
            Some(true) => bsdf.split_rough_lobes(),
            _ => bsdf.split_sharp_lobes(),
        }
    }

    fn end(&mut self, end: &ChainEnd<'w>) {
        if let Some(point) = MergedPoint::new(end, self.spacing_by_distance * end.distance) {
            self.found.push((end.path, end.depth, point));
        }
    }
}

/// A thread's buffers.
struct Workspace<'a, 'w> {
    batch: Batch,
    ends: Ends<'a, 'w>,
    merged: Vec<MergedPoint<'w>>,
}

/// A tile of the window.
struct Tile<'a, 'w> {
    world: &'w World,
    view: &'a View,
    settings: EyeSettings,
}

impl<'w> EyePass<'w> {
    /// Finds direct light by `settings.spp` paths a pixel, which end at the first surface that scatters light broadly,
    /// and the shading points where indirect light is wanted. [`EyePass::known`] holds all the light found.
    pub fn with_direct_light(
        world: &'w World,
        view: &View,
        settings: EyeSettings,
        drawn: &DrawnLight,
        control: &Control,
    ) -> EyePass<'w> {
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        let tile = Tile { world, view, settings };
        let spacing_by_distance = SPACING * view.pixel_angle();
        let workspace = || Workspace {
            batch: Batch::default(),
            ends: Ends { drawn, spacing_by_distance, found: Vec::new() },
            merged: Vec::new(),
        };
        let tiles = (0..view.window.tile_count(TILE))
            .into_par_iter()
            .map_init(workspace, |work, index| {
                if control.is_cancelled() {
                    return None;
                }
                let found = tile.trace(index, work);
                control.advance(1);
                Some(found)
            })
            .flatten()
            .collect();
        EyePass::gather(&view.window, tiles, settings.spp)
    }
}

/// Shading points expected of each pixel with `spp` samples, at most.
pub fn merged_points(spp: u32) -> u64 {
    u64::from(spp).min(MERGED * u64::from(spp.div_ceil(BATCH)))
}

impl<'w> Tile<'_, 'w> {
    fn trace(&self, index: usize, work: &mut Workspace<'_, 'w>) -> VisibleSurfaces<'w> {
        let mut found = VisibleSurfaces::default();
        let window = &self.view.window;
        let pixels: Vec<[u32; 2]> = window.tile(index, TILE).collect();
        let spp = self.settings.spp;
        for pixels in pixels.chunks((BATCH / spp).max(1) as usize) {
            for first in (0..spp).step_by(BATCH as usize) {
                self.pixels(pixels, first..first.saturating_add(BATCH).min(spp), work, &mut found);
            }
        }
        found
    }

    /// Traces some of the paths of some pixels, whose ends are merged.
    fn pixels(
        &self,
        pixels: &[[u32; 2]],
        samples: Range<u32>,
        work: &mut Workspace<'_, 'w>,
        found: &mut VisibleSurfaces<'w>,
    ) {
        let EyeSettings { spp, seed, max_depth } = self.settings;
        let window = &self.view.window;
        let Workspace { batch, ends, merged } = work;
        ends.found.clear();
        let paths = pixels.iter().flat_map(|pixel| {
            let pixel = window.film_pixel(*pixel);
            samples.clone().map(move |sample| Start { pixel, sample, seed })
        });
        let look = if spp > 1 { Look::Pixels } else { Look::EyeSamples { spp, seed } };
        start(batch, paths, self.view, look);
        let mut counts = Counts::default();
        let mut radiance = batch.trace(self.world, max_depth, ends, &mut counts);
        found.chains += ChainCounts { rays: counts.rays, shadow_rays: counts.shadow_rays, overflow: 0 };
        ends.found.sort_by_key(|(path, depth, _)| (*path, *depth));
        let mut rest = &ends.found[..];
        for (i, [x, y]) in (1..).zip(pixels) {
            let pixel = y * window.width + x;
            let mut sum = Rgb::ZERO;
            for value in radiance.by_ref().take(samples.len()) {
                if value.is_finite() {
                    sum += value;
                } else {
                    found.nonfinite += 1;
                }
            }
            if sum != Rgb::ZERO {
                found.known.push((pixel, sum));
            }
            let (own, others) =
                rest.split_at(rest.partition_point(|(path, ..)| *path < i * samples.len() as u32));
            rest = others;
            let [film_x, film_y] = window.film_pixel([*x, *y]);
            let draw =
                hash(hash(film_x, film_y), seed ^ 0x7e11 ^ samples.start) as f32 * (1.0 / 4_294_967_296.0);
            merge(own.iter().map(|(_, _, point)| *point), draw, merged);
            for point in merged.iter() {
                found.points.geometry.push(point.geometry);
                found.points.surfaces.push(point.surface);
                found.visibility.push(VisibilitySample { pixel, weight: point.weight });
            }
        }
    }
}
