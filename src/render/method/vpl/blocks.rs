//! Tiles of the film, block by block: eye samples share cuts within blocks of pixels.
//!
//! Blocks are aligned to the film and always computed completely, so that a crop has the pixels of the full image.

use base::film::Window;
use base::math::Rgb;
use base::progress::Control;
use std::mem::take;
use std::ops::Range;
use transport::eye::{EyeCounts, EyeRays, VisibleSurfaces};
use transport::shade::{Shader, ShadingCounts};

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
