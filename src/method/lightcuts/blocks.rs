//! Tiles of the film, block by block: eye samples share cuts within blocks of pixels.
//!
//! Blocks are aligned to the film and always computed whole, so a crop repeats the whole picture's pixels.

use crate::eye::{ChainCounts, EyeRays, VisibleSurfaces};
use crate::film::Window;
use crate::math::Rgb;
use crate::progress::Control;
use crate::shade::{Shader, ShadingCounts};
use std::mem::take;

/// Pixels along the edge of a tile, within which occluders are remembered.
pub const TILE: u32 = 16;
/// Pixels along the edge of a block, within which eye samples may share a cut.
const BLOCK: u32 = 4;

/// The tiles of a frame.
pub struct Tiles<'a, 'w> {
    pub rays: EyeRays<'a, 'w>,
    pub window: &'a Window,
    /// Eye rays a pixel.
    pub spp: u32,
    pub control: &'a Control,
}

/// A tile's pixels in the window, and the work done for them.
#[derive(Default)]
pub struct Tile {
    /// Index in the window, radiance, and mean number of clusters in the cuts of a sample.
    pub pixels: Vec<(usize, Rgb, f32)>,
    pub counts: ShadingCounts,
    pub chains: ChainCounts,
    /// Samples that were not finite and left out.
    pub nonfinite: u64,
}

impl<'w> Tiles<'_, 'w> {
    /// Shades the tile whose first film pixel is `corner`; `None` once cancelled.
    pub fn shade(
        &self,
        corner: [u32; 2],
        shader: &mut Shader<'_, 'w>,
        seen: &mut VisibleSurfaces<'w>,
    ) -> Option<Tile> {
        let mut tile = Tile::default();
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

    fn block(
        &self,
        [left, top]: [u32; 2],
        shader: &mut Shader<'_, 'w>,
        seen: &mut VisibleSurfaces<'w>,
        tile: &mut Tile,
    ) {
        let pixels = || (top..top + BLOCK).flat_map(move |y| (left..left + BLOCK).map(move |x| [x, y]));
        if pixels().all(|pixel| self.window.index(pixel).is_none()) {
            return;
        }
        // Each ray counts as a pixel of its own until all its light is known.
        seen.clear();
        for (place, pixel) in pixels().enumerate().filter(|(_, pixel)| self.window.on_film(*pixel)) {
            for sample in 0..self.spp {
                self.rays.trace(pixel, sample, place as u32 * self.spp + sample, seen);
            }
        }
        let mut rays = vec![(Rgb::ZERO, 0.0); (BLOCK * BLOCK * self.spp) as usize];
        for &(ray, emitted) in &seen.known {
            rays[ray as usize].0 = emitted;
        }
        shader.shade_all(&seen.points, self.control, |task, shaded| {
            let sample = &seen.visibility[task.point as usize];
            let (radiance, clusters) = &mut rays[sample.pixel as usize];
            *radiance += sample.weight * shaded.radiance;
            *clusters += shaded.clusters as f32;
        });
        for (pixel, rays) in pixels().zip(rays.chunks(self.spp as usize)) {
            let Some(index) = self.window.index(pixel) else { continue };
            let (mut sum, mut clusters) = (Rgb::ZERO, 0.0);
            for (radiance, size) in rays {
                clusters += size;
                if radiance.is_finite() {
                    sum += *radiance;
                } else {
                    tile.nonfinite += 1;
                }
            }
            tile.pixels.push((index, sum / self.spp as f32, clusters / self.spp as f32));
        }
    }
}
