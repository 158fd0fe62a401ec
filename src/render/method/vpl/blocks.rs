//! Tiles of the film, block by block: eye samples share cuts within blocks of pixels.
//!
//! Blocks are aligned to the film and always computed completely, so that a crop has the pixels of the full image.

use super::Settings;
use crate::method::Output;
use crate::method::lights::{LightStore, lights_wanted};
use crate::method::sampling::HasSampling;
use crate::method::tally::Tally;
use base::film::{Image, Layer, Window};
use base::math::Rgb;
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::stats::{Contributions, Stage};
use rayon::prelude::*;
use std::mem::take;
use std::ops::Range;
use transport::eye::{EyeCounts, EyeRays, LightBySpecularLobes, VisibleSurfaces};
use transport::shade::{Shader, ShadingContext, ShadingCounts};
use world::World;
use world::view::View;

/// Side of a tile, within which occluders are cached, in pixels.
pub const TILE: u32 = 16;
/// Side of a block, within which eye samples may share a cut, in pixels.
const BLOCK: u32 = 4;
/// Maximum number of eye rays of a pixel that are in memory at a time.
const MAX_RAYS: u32 = 1024;

/// Inputs of all tiles of a frame.
pub struct BlockTiles<'a, 'w> {
    pub rays: EyeRays<'a, 'w>,
    pub window: &'a Window,
    /// Eye rays per pixel.
    pub spp: u32,
    pub control: &'a Control,
}

/// Pixels of a tile in the window, and the work that they took.
#[derive(Default)]
pub struct LitTile {
    /// Index in the window, radiance, and mean number of clusters in the cuts of a sample, by pixel.
    pub pixels: Vec<(usize, Rgb, f32)>,
    pub counts: ShadingCounts,
    pub chains: EyeCounts,
    /// Samples that were not finite and were left out.
    pub nonfinite: u64,
}

impl<'w> BlockTiles<'_, 'w> {
    /// Shades the tile whose first film pixel is `corner`; `None` if cancelled.
    pub fn shade(
        &self,
        corner: [u32; 2],
        shader: &mut Shader<'_, 'w>,
        seen: &mut VisibleSurfaces<'w>,
    ) -> Option<LitTile> {
        let mut tile = LitTile::default();
        shader.begin_chunk();
        for y in (corner[1]..corner[1] + TILE).step_by(BLOCK as usize) {
            for x in (corner[0]..corner[0] + TILE).step_by(BLOCK as usize) {
                self.block([x, y], shader, seen, &mut tile);
                if self.control.is_cancelled() {
                    return None;
                }
            }
        }
        tile.counts = shader.take_counts();
        tile.chains = take(&mut seen.chains);
        tile.nonfinite += take(&mut seen.nonfinite);
        Some(tile)
    }

    /// Shades the pixels of a block, and adds those in the window to `tile`.
    fn block(
        &self,
        [left, top]: [u32; 2],
        shader: &mut Shader<'_, 'w>,
        seen: &mut VisibleSurfaces<'w>,
        tile: &mut LitTile,
    ) {
        if pixels_of([left, top]).all(|pixel| self.window.index(pixel).is_none()) {
            return;
        }
        let mut sums = [(Rgb::ZERO, 0.0); (BLOCK * BLOCK) as usize];
        for first in (0..self.spp).step_by(MAX_RAYS as usize) {
            let samples = first..first + MAX_RAYS.min(self.spp - first);
            tile.nonfinite += self.add_samples([left, top], samples, &mut sums, shader, seen);
        }
        for (pixel, (sum, clusters)) in pixels_of([left, top]).zip(sums) {
            if let Some(index) = self.window.index(pixel) {
                tile.pixels.push((index, sum / self.spp as f32, clusters / self.spp as f32));
            }
        }
    }

    /// Adds the radiance and the clusters of some eye rays of each pixel of a block.
    ///
    /// Returns the number of rays whose radiance is not finite.
    fn add_samples(
        &self,
        corner: [u32; 2],
        samples: Range<u32>,
        sums: &mut [(Rgb, f32)],
        shader: &mut Shader<'_, 'w>,
        seen: &mut VisibleSurfaces<'w>,
    ) -> u64 {
        let count = samples.len() as u32;
        // Each ray counts as a pixel of its own until all its light is known.
        seen.clear();
        for (place, pixel) in pixels_of(corner).enumerate().filter(|(_, pixel)| self.window.on_film(*pixel)) {
            for (i, sample) in samples.clone().enumerate() {
                self.rays.trace(pixel, sample, place as u32 * count + i as u32, seen);
            }
        }
        let mut rays = vec![(Rgb::ZERO, 0.0); (BLOCK * BLOCK * count) as usize];
        for &(ray, emitted) in &seen.known {
            rays[ray as usize].0 = emitted;
        }
        shader.shade_all(&seen.points, self.control, |task, shaded| {
            let sample = &seen.visibility[task.point as usize];
            let (radiance, clusters) = &mut rays[sample.pixel as usize];
            *radiance += sample.weight * shaded.radiance;
            *clusters += shaded.clusters as f32;
        });
        let mut nonfinite = 0;
        for ((sum, clusters), rays) in sums.iter_mut().zip(rays.chunks(count as usize)) {
            for (radiance, size) in rays {
                *clusters += size;
                if radiance.is_finite() {
                    *sum += *radiance;
                } else {
                    nonfinite += 1;
                }
            }
        }
        nonfinite
    }
}

/// Iterates over the pixels of a block, given its first.
fn pixels_of([left, top]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (top..top + BLOCK).flat_map(move |y| (left..left + BLOCK).map(move |x| [x, y]))
}

impl Settings {
    /// Renders the image of `view` without keeping its eye samples.
    pub(super) fn by_blocks(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        control: &Control,
    ) -> Output {
        let mut tally = Tally::default();
        let sampling = self.sampling();
        let eye = sampling.eye(&world.scene);
        let caustics = lights.photons.for_image(world, view, eye, control, &mut tally);
        let wanted = lights_wanted(world, sampling, self.light, Vec::new());
        let lights = lights.get(world, wanted, control, &mut tally);
        let context = ShadingContext::new(world, &lights, self.compensation);
        let rays = EyeRays::new(world, view, eye);
        let tiles = BlockTiles { rays, window: &view.window, spp: eye.spp, control };
        let tiles = tally.time(Stage::Render, || self.tiles(&context, &tiles, control));

        let mut color = Image::new(view.window.width, view.window.height);
        let mut cut_size = color.map(|_| 0.0);
        let light = tally
            .time(Stage::Render, || LightBySpecularLobes::new(world, view, eye, caustics.as_ref(), control));
        let (mut work, mut chains, mut nonfinite) = (ShadingCounts::default(), light.chains, light.nonfinite);
        for tile in tiles.iter().flatten() {
            for &(pixel, radiance, clusters) in &tile.pixels {
                color.pixels[pixel] = radiance;
                cut_size.pixels[pixel] = clusters;
            }
            work += tile.counts;
            chains += tile.chains;
            nonfinite += tile.nonfinite;
        }
        let mut contributions = Contributions::default();
        contributions.add("cuts and emitters in view", color.luminance());
        light.add_to(&mut color, &mut contributions);
        contributions.report(&mut tally.stats);
        tally.count("Rays/shadow packets", work.cuts.packets);
        self.report(&work, &mut tally);
        tally.eye(&chains);
        let complete = tiles.iter().all(Option::is_some) && !control.is_cancelled();
        let extra = vec![Layer::scalar("cut", cut_size)];
        Output { extra, complete, nonfinite, ..Output::new(color, tally) }
    }

    /// Shades all tiles; `None` for those that were cancelled.
    fn tiles(&self, context: &ShadingContext, tiles: &BlockTiles, control: &Control) -> Vec<Option<LitTile>> {
        let corners: Vec<[u32; 2]> = tiles.window.film_squares(TILE).collect();
        control.begin(Stage::Render, corners.len() as u64);
        let settings = self.shading();
        let live = control.live([tiles.window.width, tiles.window.height]);
        let workspaces = Workspaces::new(|| (Shader::new(context, &settings), VisibleSurfaces::default()));
        let shade = |&corner: &[u32; 2]| {
            if control.is_cancelled() {
                return None;
            }
            let tile = workspaces.with(|(shader, seen)| tiles.shade(corner, shader, seen))?;
            if let Some(live) = &live {
                live.set(tile.pixels.iter().map(|&(at, radiance, _)| (at, radiance)));
            }
            control.advance(1);
            Some(tile)
        };
        corners.par_iter().one_by_one().map(shade).collect()
    }
}
