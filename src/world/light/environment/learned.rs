//! Light of the environment that arrives in each region of the scene.
//!
//! Probabilities of tiles are in proportion to the root mean square of their light, which minimises the variance.

use super::presampled::Presamples;
use super::table::TileTable;
use super::tiles::Tile;
use crate::light::observed::{Observed, PRIOR};
use base::math::LANES;
use rayon::prelude::*;

/// Share of the samples that are by flux alone.
const BY_FLUX: f32 = 0.1;

/// Number of rays, among those known of all regions beforehand, that find full light in a tile. Tiles that no ray has
/// found lit keep some samples.
const UNSEEN: f32 = 1.0;

/// Distributions over tiles by region.
#[derive(Clone, Debug)]
pub struct LearnedSky {
    tables: Vec<TileTable>,
    /// Directions for next-event estimation: the more of a tile the more often regions choose it.
    presamples: Presamples,
}

/// Learned distributions over tiles at sixteen points.
#[derive(Clone, Copy)]
pub struct LearnedAt<'a> {
    pub(super) tables: [&'a TileTable; LANES],
    pub(super) presamples: &'a Presamples,
}

impl LearnedSky {
    /// Computes the distributions from observations; `presample` samples tiles by their shares of all samples.
    pub(super) fn new(
        tiles: &[Tile],
        observed: &Observed,
        presample: impl FnOnce(&[f32]) -> Presamples,
    ) -> LearnedSky {
        let add = |region: usize, sums: &mut [[f32; 2]]| {
            for (tile, light) in observed.rays(region, |wave| &wave.sky) {
                let [squares, rays] = &mut sums[usize::from(*tile)];
                *squares += light * light;
                *rays += 1.0;
            }
        };
        let means = observed.regions.means(add, PRIOR, &vec![UNSEEN / PRIOR; tiles.len()]);
        let table = |means: &Vec<f32>| {
            let weight = |(tile, square): (&Tile, &f32)| tile.flux * square.sqrt();
            TileTable::new(tiles, &tiles.iter().zip(means).map(weight).collect::<Vec<_>>(), BY_FLUX)
        };
        let tables: Vec<TileTable> = means.par_iter().map(table).collect();
        let share = |(number, tile): (usize, &Tile)| match tile.density > 0.0 {
            true => tables.iter().map(|table| table.density(number)).sum::<f32>() / tile.density,
            false => 0.0,
        };
        let shares: Vec<f32> = tiles.iter().enumerate().map(share).collect();
        LearnedSky { presamples: presample(&shares), tables }
    }

    /// Returns the distributions in sixteen regions.
    #[inline]
    pub(in crate::light) fn at(&self, regions: &[usize; LANES]) -> LearnedAt<'_> {
        LearnedAt { tables: regions.map(|region| &self.tables[region]), presamples: &self.presamples }
    }
}
