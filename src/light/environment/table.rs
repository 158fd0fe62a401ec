//! Distribution over tiles.

use super::tiles::Tile;

/// Probabilities of tiles.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Sums of the probabilities before each tile, and at last of all.
    cumulative: Vec<f32>,
    /// Factor by which the densities of directions within each tile are multiplied: its probability times
    /// [`Tile::density`].
    density: Vec<f32>,
}

impl Table {
    /// A distribution in proportion to `weights`, mixed with `by_flux` of that by flux; by flux alone if no weight is
    /// positive.
    pub fn new(tiles: &[Tile], weights: &[f32], by_flux: f32) -> Table {
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
        Table { cumulative, density }
    }

    /// Returns the tile at `u` in [0, 1), and `u` stretched to [0, 1) within it.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32) {
        let count = self.density.len();
        let u = u * self.cumulative[count];
        let (mut first, mut size) = (0, count);
        while size > 1 {
            let half = size / 2;
            first = if self.cumulative[first + half] <= u { first + half } else { first };
            size -= half;
        }
        let (low, high) = (self.cumulative[first], self.cumulative[first + 1]);
        let rest = if high > low { (u - low) / (high - low) } else { 0.0 };
        (first, rest.clamp(0.0, 1.0 - f32::EPSILON))
    }

    /// Factor on the densities of directions within a tile.
    #[inline]
    pub fn density(&self, tile: usize) -> f32 {
        self.density[tile]
    }
}
