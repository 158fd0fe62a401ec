//! Visibility of the environment from each region of the scene, learned from free and occluded rays. Most of the sky is
//! occluded in a room, and samples by radiance alone are wasted.
//!
//! Paper: Vévoda, Kondapaneni & Křivánek, *Bayesian online regression for adaptive direct illumination sampling*, 2018.
//! Deviations: the visibility is learned once, before any sample is taken. Probabilities are in proportion to the root
//! mean square of a tile's light, which minimises the variance. It is the mean over samples, with the mean over all
//! regions as prior. Estimates are unbiased, because some samples are by flux alone.

use super::table::TileTable;
use super::tiles::Tile;
use crate::light::regions::Regions;
use base::math::{LANES, Vec3x16};
use glam::Vec3;
use rayon::prelude::*;

/// Share of the samples that are by flux alone.
const BY_FLUX: f32 = 0.2;

/// Maximum number of points in a region.
const POINTS: usize = 64;

/// Weight of the mean over all regions in a region's estimate for a tile, in rays.
const PRIOR: f32 = 1.0;

/// Points, and the light of the environment along rays from each.
#[derive(Clone, Debug, Default)]
pub struct SkyObservations {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Tiles to which the rays of each point in turn were traced, and the light that arrived relative to the tile's; 0
    /// for occluded rays. Every point has the same number of rays.
    pub rays: Vec<(u16, f32)>,
}

/// Distributions over tiles by region.
#[derive(Clone, Debug)]
pub struct LearnedSky {
    regions: Regions,
    tables: Vec<TileTable>,
}

impl LearnedSky {
    /// Computes the distributions from observations.
    pub(super) fn new(tiles: &[Tile], observations: &SkyObservations) -> LearnedSky {
        let (regions, members) = Regions::new(&observations.points, POINTS);
        let each = observations.rays.len() / observations.points.len().max(1);
        let rays_of = |point: u32| observations.rays[point as usize * each..][..each].iter();
        let sums = |points: &[u32], mut sums: Vec<[f32; 2]>| {
            for (tile, light) in points.iter().flat_map(|point| rays_of(*point)) {
                let [squares, rays] = &mut sums[usize::from(*tile)];
                *squares += light * light;
                *rays += 1.0;
            }
            sums
        };
        let all: Vec<u32> = (0..observations.points.len() as u32).collect();
        let mean_square = |[squares, rays]: &[f32; 2]| if *rays > 0.0 { squares / rays } else { 0.0 };
        let prior: Vec<[f32; 2]> = sums(&all, vec![[0.0; 2]; tiles.len()])
            .iter()
            .map(|sums| [mean_square(sums) * PRIOR, PRIOR])
            .collect();
        let table = |members: &Vec<u32>| {
            let sums = sums(members, prior.clone());
            let weights: Vec<f32> =
                tiles.iter().zip(&sums).map(|(tile, sums)| tile.flux * mean_square(sums).sqrt()).collect();
            TileTable::new(tiles, &weights, BY_FLUX)
        };
        LearnedSky { tables: members.par_iter().map(table).collect(), regions }
    }

    /// Returns the distributions at sixteen points.
    #[inline]
    pub(super) fn at(&self, x: &Vec3x16) -> [&TileTable; LANES] {
        self.regions.find(x).map(|region| &self.tables[region])
    }
}
