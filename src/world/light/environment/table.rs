//! Distributions over tiles.

use super::tiles::Tile;

/// Number of sums that are compared at once: a cache line.
const WIDTH: usize = 16;

/// Probabilities of tiles.
#[derive(Clone, Debug)]
pub(super) struct TileTable {
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
    pub fn new(tiles: &[Tile], weights: &[f32], by_flux: f32) -> TileTable {
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

    /// Returns the tile at `u` in [0, 1), and `u` rescaled to [0, 1) within it.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32) {
        let u = u * self.total;
        // Sums do not decrease, so that the passed sums can be counted in any order.
        let passed = |line: &[f32; WIDTH]| line.iter().map(|sum| usize::from(*sum <= u)).sum::<usize>();
        let line = self.firsts.iter().map(passed).sum::<usize>();
        let tile = (line * WIDTH + passed(&self.cumulative[line])).clamp(1, self.density.len()) - 1;
        let at = |i: usize| self.cumulative[i / WIDTH][i % WIDTH];
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

/// Splits numbers into lines; infinity fills the last line.
fn lines(numbers: &[f32]) -> Vec<[f32; WIDTH]> {
    let line = |part: &[f32]| std::array::from_fn(|i| part.get(i).copied().unwrap_or(f32::INFINITY));
    numbers.chunks(WIDTH).map(line).collect()
}
