//! Directions of each tile, sampled beforehand for next-event estimation.
//!
//! Sampling a direction of a map searches tables that exceed the caches, and then reads the map. A presample takes one
//! read. The samples of a tile lie in a grid of cells of the unit square, so that random numbers stay stratified. A
//! tile has the more of them the more often it is chosen. Shadows of the sun would show steps otherwise.
//!
//! Errors: the expected value of an estimate is a mean over fixed directions, in place of an integral. The random
//! numbers of a tile's directions are a net, and radiance over density hardly varies in a tile. On a map with texels a
//! thousand times as bright as others, tiles differ by up to 1.8 % and irradiances by .04 %. Where few tiles are seen,
//! as through a window, they have more directions of their own ([`super::LearnedSky`]).
//!
//! Densities stay those of continuous directions, also in multiple importance sampling.

use super::sample::EnvironmentSample;
use base::math::{LANES, Rgb};
use base::sampling::{hash, owen_sobol_2d};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Minimum number of cells along an edge of a tile's grid.
const MIN_EDGE: u32 = 8;

/// Maximum number of cells along an edge of a tile's grid.
const MAX_EDGE: u32 = 128;

/// Seed of the directions, combined with the tile's number.
const SEED: u32 = 0x51a7_3ed5;

/// A sampled direction of a tile.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct Presample {
    /// Unit world direction.
    pub direction: Vec3,
    /// Density relative to that of the tile's choice; 0 if the direction is not usable.
    pub density: f32,
    /// Radiance arriving from that direction, without that of discs before or behind the tile.
    pub radiance: Rgb,
    /// True if a disc contains the direction.
    pub on_disc: bool,
}

/// Sampled directions of all tiles.
#[derive(Clone, Debug, Default)]
pub(super) struct Presamples {
    samples: Vec<Presample>,
    /// Position of each tile's first sample, and the number of cells along the edge of its grid.
    grids: Vec<(u32, u32)>,
}

impl Presamples {
    /// Samples all tiles, which are chosen with probabilities in proportion to `shares` on average. Calls `sample` with
    /// a tile and sixteen pairs of random numbers, and `on_disc` to know if a disc contains a direction.
    pub fn new(
        shares: &[f32],
        sample: impl Fn(usize, &[Vec2; LANES]) -> [Option<EnvironmentSample>; LANES] + Sync,
        on_disc: impl Fn(Vec3) -> bool + Sync,
    ) -> Presamples {
        let mean = shares.iter().sum::<f32>() / shares.len() as f32;
        let of_tile = |(tile, share): (usize, &f32)| {
            let edge = edge(share / mean);
            let mut cells = vec![Presample::default(); (edge * edge) as usize];
            for points in (0..edge * edge).step_by(LANES) {
                let u = std::array::from_fn(|i| owen_sobol_2d(points + i as u32, hash(tile as u32, SEED)));
                for (u, found) in u.iter().zip(sample(tile, &u)) {
                    if let Some(EnvironmentSample { direction, radiance, pdf }) = found {
                        let on_disc = on_disc(direction);
                        cells[cell(edge, *u)] = Presample { direction, density: pdf, radiance, on_disc };
                    }
                }
            }
            (edge, cells)
        };
        let tiles: Vec<(u32, Vec<Presample>)> = shares.par_iter().enumerate().map(of_tile).collect();
        let mut found = Presamples { samples: Vec::new(), grids: Vec::new() };
        for (edge, cells) in tiles {
            found.grids.push((found.samples.len() as u32, edge));
            found.samples.extend(cells);
        }
        found
    }

    /// Returns the position of the sample of a tile at the random numbers `u`.
    #[inline]
    pub fn find(&self, tile: usize, u: Vec2) -> usize {
        let (first, edge) = self.grids[tile];
        first as usize + cell(edge, u)
    }

    /// Returns the samples of a tile.
    #[cfg(test)]
    pub fn of_tile(&self, tile: usize) -> &[Presample] {
        let (first, edge) = self.grids[tile];
        &self.samples[first as usize..][..(edge * edge) as usize]
    }

    /// Returns the sample at a position.
    #[inline]
    pub fn get(&self, position: usize) -> &Presample {
        &self.samples[position]
    }
}

/// Returns the number of cells along the edge of the grid of a tile, by its share over the mean of all tiles.
fn edge(relative: f32) -> u32 {
    // A tile without light is never chosen.
    let mut edge = if relative > 0.0 { MIN_EDGE } else { 1 };
    // A grid has at least half as many cells as is in proportion to its share, up to the maximum.
    while edge < MAX_EDGE && relative * (MIN_EDGE * MIN_EDGE) as f32 > (2 * edge * edge) as f32 {
        edge *= 2;
    }
    edge
}

/// Returns the number of the cell that contains a point of the unit square.
#[inline]
fn cell(edge: u32, u: Vec2) -> usize {
    let at = |u: f32| ((u * edge as f32) as u32).min(edge - 1);
    (at(u.y) * edge + at(u.x)) as usize
}
