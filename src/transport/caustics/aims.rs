//! Distribution of photon paths over emitters and their directions, learned from pilot paths.
//!
//! The unit square of the random numbers that direct the paths of an emitter is divided into cells. Paths begin in a
//! cell in proportion to the photons of pilot paths in and around the cell. Cells without photons keep a small weight.

use crate::emission::{EmissionNumbers, EmissionSample, PhotonEmitter};
use base::sampling::Sampler;
use glam::Vec2;
use world::light::DiscreteDistribution;

/// Candidates for the number of cells along the edge of an emitter's square; the first that fits is taken.
const SIDES: [usize; 5] = [16, 8, 4, 2, 1];

/// Maximum number of cells of all emitters.
const MAX_CELLS: usize = 1 << 14;

/// Weight of a path in a cell, relative to the weight of a photon.
const PATH_WEIGHT: f32 = 0.01;

/// Weight of a path that may meet a mirror or glass, relative to the weight of a photon.
const AIMED_WEIGHT: f32 = 0.05;

/// Cells from which paths begin.
pub struct Aims<'a, 'w> {
    emitter: &'a PhotonEmitter<'w>,
    side: usize,
    by_weight: DiscreteDistribution,
    /// Number of paths by cell, relative to the number in proportion to flux.
    boosts: Vec<f32>,
}

/// Yield of the pilot paths of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellYield {
    /// Number of paths that may meet a mirror or glass.
    pub aimed: f32,
    /// Number of photons.
    pub photons: f32,
}

/// Beginning of a path in a cell. Its flux accounts for the distribution of cells.
pub struct Aimed {
    /// Beginning of the path.
    pub emission: EmissionSample,
    /// Cell of the beginning.
    pub cell: usize,
    /// Number of paths in the cell, relative to the number in proportion to flux.
    pub boost: f32,
}

impl<'a, 'w> Aims<'a, 'w> {
    /// Creates cells in proportion to flux.
    pub fn even(emitter: &'a PhotonEmitter<'w>) -> Aims<'a, 'w> {
        let count = emitter.shares().len();
        let fits = |side: &usize| count * side * side <= MAX_CELLS;
        let side = SIDES.into_iter().find(fits).unwrap_or(1);
        let cells = side * side;
        let by_weight = DiscreteDistribution::new(
            emitter.shares().flat_map(|share| std::iter::repeat_n(share / cells as f32, cells)),
        );
        Aims { emitter, side, by_weight, boosts: vec![1.0; count * cells] }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.boosts.len()
    }

    /// Returns cells as learned from `paths` pilot paths in proportion to flux, which `found` a yield in each cell.
    pub fn learned(&self, found: &[CellYield], paths: f32) -> Aims<'a, 'w> {
        let side = self.side;
        let cells = side * side;
        let shares: Vec<f32> = self.emitter.shares().collect();
        let even = |cell: usize| shares[cell / cells] / cells as f32;
        let weight = |cell: usize| {
            let (first, x, y) = (cell / cells * cells, cell % side, cell % cells / side);
            let near = |at: usize| at.saturating_sub(1)..(at + 2).min(side);
            let around = near(y).flat_map(|y| near(x).map(move |x| first + y * side + x));
            let photons: f32 = around.map(|cell| found[cell].photons).sum();
            photons / 9.0 + AIMED_WEIGHT * found[cell].aimed + PATH_WEIGHT * paths * even(cell)
        };
        let by_weight = DiscreteDistribution::new((0..self.cells()).map(weight));
        let boost = |cell| match even(cell) {
            even if even > 0.0 => by_weight.probability(cell) / even,
            _ => 1.0,
        };
        let boosts = (0..self.cells()).map(boost).collect();
        Aims { emitter: self.emitter, side, by_weight, boosts }
    }

    /// Samples the beginning of a path; `None` if the emitter is dark there.
    pub fn sample(&self, sampler: &mut Sampler) -> Option<Aimed> {
        let (cell, _) = self.by_weight.sample(sampler.next_1d());
        let mut numbers = EmissionNumbers::new(sampler);
        let cells = self.side * self.side;
        let index = cell / cells;
        let aim = if self.emitter.is_far(index) { &mut numbers.place } else { &mut numbers.direction };
        let corner = Vec2::new((cell % self.side) as f32, (cell % cells / self.side) as f32);
        *aim = ((*aim + corner) / self.side as f32).min(Vec2::splat(1.0 - 0.5 * f32::EPSILON));
        let boost = self.boosts[cell];
        let mut emission = self.emitter.sample_of(index, &numbers)?;
        emission.flux /= boost;
        Some(Aimed { emission, cell, boost })
    }
}
