//! Distributions over tiles.

use super::tiles::Tile;
use base::math::{F32x16, LANES, lanes_in};

/// Number of sums that are compared at once: a cache line.
const WIDTH: usize = 16;

/// Probabilities of tiles.
#[derive(Clone, Debug)]
pub struct TileTable {
    /// Sums of the probabilities before each tile, then the total, then infinity, in lines.
    cumulative: Vec<[f32; WIDTH]>,
    /// First sum of each line but the first, then infinity, in lines.
    firsts: Vec<[f32; WIDTH]>,
    /// Sum of all probabilities.
    total: f32,
    /// Factor on the densities of directions within each tile: its probability times [`Tile::density`].
    density: Vec<f32>,
}

impl TileTable {
    /// Builds a distribution in proportion to `weights`, mixed with a share `by_flux` of the distribution by flux; by
    /// flux alone if no weight is positive.
    pub(super) fn new(tiles: &[Tile], weights: &[f32], by_flux: f32) -> TileTable {
        let total: f32 = weights.iter().sum();
        let usable = total > 0.0 && total.is_finite();
        let (scale, by_flux) = if usable { ((1.0 - by_flux) / total, by_flux) } else { (0.0, 1.0) };
        let (mut cumulative, mut sum) = (vec![0.0], 0.0f64);
        let density = tiles.iter().zip(weights).map(|(tile, weight)| {
            let probability = if tile.flux > 0.0 { weight * scale + by_flux * tile.flux } else { 0.0 };
            sum += f64::from(probability);
            cumulative.push(sum as f32);
            probability * tile.density
        });
        let density = density.collect();
        let cumulative = lines(&cumulative);
        let firsts: Vec<f32> = cumulative[1..].iter().map(|line| line[0]).collect();
        TileTable { firsts: lines(&firsts), cumulative, total: sum as f32, density }
    }

    /// Returns the tiles at the numbers `u` in [0, 1) of the lanes of `wanted`, and the numbers rescaled to [0, 1)
    /// within them. The lanes wait for memory together, because the tables of many regions exceed the caches.
    #[inline]
    pub fn sample(tables: &[&TileTable; LANES], u: &F32x16, wanted: u16) -> ([usize; LANES], F32x16) {
        let (mut places, mut numbers) = ([0; LANES], [0.0; LANES]);
        for i in lanes_in(wanted) {
            numbers[i] = u[i] * tables[i].total;
            places[i] = tables[i].line_at(numbers[i]);
        }
        let mut lines = [[0.0; WIDTH]; LANES];
        for i in lanes_in(wanted) {
            lines[i] = tables[i].cumulative[places[i]];
        }
        let (mut found, mut rest) = ([0; LANES], [0.0; LANES]);
        for i in lanes_in(wanted) {
            (found[i], rest[i]) = tables[i].tile_in(places[i], &lines[i], numbers[i]);
        }
        (found, rest)
    }

    /// Returns the line of the last sum up to `u`.
    #[inline]
    fn line_at(&self, u: f32) -> usize {
        // Sums do not decrease, so that the passed sums can be counted in any order.
        self.firsts.iter().map(|line| passed(line, u)).sum()
    }

    /// Returns the tile of the last sum up to `u` in the `sums` of a line, and the place of `u` in it from 0 to 1.
    #[inline]
    fn tile_in(&self, line: usize, sums: &[f32; WIDTH], u: f32) -> (usize, f32) {
        let tile = (line * WIDTH + passed(sums, u)).clamp(1, self.density.len()) - 1;
        let at = |i: usize| {
            if i / WIDTH == line { sums[i % WIDTH] } else { self.cumulative[i / WIDTH][i % WIDTH] }
        };
        let (low, high) = (at(tile), at(tile + 1));
        let rest = if high > low { (u - low) / (high - low) } else { 0.0 };
        (tile, rest.clamp(0.0, 1.0 - f32::EPSILON))
    }

    /// Returns the factor on the densities of directions within a tile.
    #[inline]
    pub fn density(&self, tile: usize) -> f32 {
        self.density[tile]
    }
}

/// Returns the number of sums of a line up to `u`.
#[inline]
fn passed(line: &[f32; WIDTH], u: f32) -> usize {
    let mut passed = 0;
    for sum in line {
        passed += u32::from(*sum <= u);
    }
    passed as usize
}

/// Splits numbers into lines; infinity fills the last line.
fn lines(numbers: &[f32]) -> Vec<[f32; WIDTH]> {
    let line = |part: &[f32]| std::array::from_fn(|i| part.get(i).copied().unwrap_or(f32::INFINITY));
    numbers.chunks(WIDTH).map(line).collect()
}
