//! Directions of the environment that shine on each region of the scene, learned from free and occluded rays: from a
//! room, most of the sky is hidden, and samples drawn by its radiance alone are lost.
//!
//! Paper: Vévoda, Kondapaneni & Křivánek, *Bayesian online regression for adaptive direct illumination sampling*, 2018:
//! probabilities by region follow what shadow rays there have found, and every light keeps some.
//!
//! Deviations: learned once, before any sample is taken, by a pilot; probabilities are in proportion to the root mean
//! square of a tile's light, which is least variance, by its sample mean under a prior that is the mean over all
//! regions. Estimates have no bias, however little was learned, because some samples are drawn by flux alone.

use super::EnvironmentLight;
use super::table::Table;
use crate::light::regions::Regions;
use base::math::{LANES, Vec3x16};
use glam::Vec3;

/// Share of the samples that are drawn by flux alone.
const BY_FLUX: f32 = 0.2;

/// Maximum number of points in a region.
const POINTS: usize = 64;

/// Weight, in rays, of the mean over all regions in what a region learns of a tile.
const PRIOR: f32 = 1.0;

/// Points, and rays from there.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Tiles that the rays of each point in turn go to, and light that came from there, relative to the tile's own;
    /// 0 along occluded rays.
    pub rays: Vec<(u16, f32)>,
}

/// Distributions by region.
#[derive(Clone, Debug)]
pub struct LearnedSky {
    regions: Regions,
    tables: Vec<Table>,
}

impl LearnedSky {
    /// Learns from points of which each looked as often as the others.
    pub fn new(light: &EnvironmentLight, looks: &Looks) -> LearnedSky {
        let tiles = light.tiles.all();
        let (regions, members) = Regions::new(&looks.points, POINTS);
        let each = looks.rays.len() / looks.points.len().max(1);
        let rays_of = |point: u32| looks.rays[point as usize * each..][..each].iter();
        let sums = |points: &[u32], mut sums: Vec<[f32; 2]>| {
            for (tile, light) in points.iter().flat_map(|point| rays_of(*point)) {
                let [squares, rays] = &mut sums[usize::from(*tile)];
                *squares += light * light;
                *rays += 1.0;
            }
            sums
        };
        let all: Vec<u32> = (0..looks.points.len() as u32).collect();
        let mean_square = |[squares, rays]: &[f32; 2]| if *rays > 0.0 { squares / rays } else { 0.0 };
        let prior: Vec<[f32; 2]> = sums(&all, vec![[0.0; 2]; tiles.len()])
            .iter()
            .map(|sums| [mean_square(sums) * PRIOR, PRIOR])
            .collect();
        let table = |members: &Vec<u32>| {
            let sums = sums(members, prior.clone());
            let weights: Vec<f32> =
                tiles.iter().zip(&sums).map(|(tile, sums)| tile.flux * mean_square(sums).sqrt()).collect();
            Table::new(tiles, &weights, BY_FLUX)
        };
        LearnedSky { tables: members.iter().map(table).collect(), regions }
    }

    /// Distributions at sixteen points.
    #[inline]
    pub(super) fn at(&self, x: &Vec3x16) -> [&Table; LANES] {
        self.regions.find(x).map(|region| &self.tables[region])
    }
}
