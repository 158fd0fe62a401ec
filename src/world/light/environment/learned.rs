//! Light of the environment that arrives in each region of the scene.
//!
//! Probabilities of tiles are in proportion to the root mean square of their light, which minimises the variance.

use super::table::TileTable;
use super::tiles::Tile;
use crate::light::observed::{Observed, PRIOR};
use base::math::LANES;
use rayon::prelude::*;

/// Share of the samples that are by flux alone.
const BY_FLUX: f32 = 0.1;

/// Distributions over tiles by region.
#[derive(Clone, Debug)]
pub struct LearnedSky {
    tables: Vec<TileTable>,
}

impl LearnedSky {
    /// Computes the distributions from observations.
    pub(super) fn new(tiles: &[Tile], observed: &Observed) -> LearnedSky {
        let add = |region: usize, sums: &mut [[f32; 2]]| {
            for (tile, light) in observed.rays(region, |wave| &wave.sky) {
                let [squares, rays] = &mut sums[usize::from(*tile)];
                *squares += light * light;
                *rays += 1.0;
            }
        };
        let means = observed.regions.means(add, PRIOR, &vec![1.0; tiles.len()]);
        let table = |means: &Vec<f32>| {
            let weight = |(tile, square): (&Tile, &f32)| tile.flux * square.sqrt();
            TileTable::new(tiles, &tiles.iter().zip(means).map(weight).collect::<Vec<_>>(), BY_FLUX)
        };
        LearnedSky { tables: means.par_iter().map(table).collect() }
    }

    /// Returns the distributions in sixteen regions.
    #[inline]
    pub(in crate::light) fn at(&self, regions: &[usize; LANES]) -> [&TileTable; LANES] {
        regions.map(|region| &self.tables[region])
    }
}
