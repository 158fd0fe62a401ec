//! Emitters, and the directions from each, from which paths are worth beginning: learned from a few paths.
//!
//! The unit square of the random numbers that aim the paths of an emitter is divided into cells. Paths begin in cells
//! in proportion to the photons that the first paths in the cell and around it have left, or could have, and a little
//! everywhere.

use crate::emission::{EmissionNumbers, EmissionSample, PhotonEmitter};
use base::sampling::Sampler;
use glam::Vec2;
use world::light::DiscreteDistribution;

/// Cells along the edge of an emitter's square: as many as the number of all cells allows.
const SIDES: [usize; 5] = [16, 8, 4, 2, 1];
const MAX_CELLS: usize = 1 << 14;

/// Weight of a path in a cell, and of one that may meet a mirror or glass, over that of a photon.
const PATH: f32 = 0.01;
const AIMED: f32 = 0.05;

/// Cells from which paths begin.
pub struct Aims<'a, 'w> {
    emitter: &'a PhotonEmitter<'w>,
    side: usize,
    by_weight: DiscreteDistribution,
    /// By cell: paths that begin there over those that would in proportion to flux.
    boosts: Vec<f32>,
}

/// Yield of the first paths, by cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Yield {
    /// Paths that may meet a mirror or glass.
    pub aimed: f32,
    /// Photons.
    pub photons: f32,
}

/// The beginning of a path, with the flux of paths that begin as [`Aims`] has them.
pub struct Aimed {
    /// The beginning.
    pub emission: EmissionSample,
    /// Its cell.
    pub cell: usize,
    /// Paths that begin in the cell over those that would in proportion to flux.
    pub boost: f32,
}

impl<'a, 'w> Aims<'a, 'w> {
    /// Cells in proportion to flux.
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

    /// Cells as `found` by `paths` paths that began evenly, by cell.
    pub fn learned(&self, found: &[Yield], paths: f32) -> Aims<'a, 'w> {
        let side = self.side;
        let cells = side * side;
        let shares: Vec<f32> = self.emitter.shares().collect();
        let even = |cell: usize| shares[cell / cells] / cells as f32;
        let weight = |cell: usize| {
            let (first, x, y) = (cell / cells * cells, cell % side, cell % cells / side);
            let near = |at: usize| at.saturating_sub(1)..(at + 2).min(side);
            let around = near(y).flat_map(|y| near(x).map(move |x| first + y * side + x));
            let photons: f32 = around.map(|cell| found[cell].photons).sum();
            photons / 9.0 + AIMED * found[cell].aimed + PATH * paths * even(cell)
        };
        let by_weight = DiscreteDistribution::new((0..self.cells()).map(weight));
        let boost = |cell| match even(cell) {
            even if even > 0.0 => by_weight.probability(cell) / even,
            _ => 1.0,
        };
        let boosts = (0..self.cells()).map(boost).collect();
        Aims { emitter: self.emitter, side, by_weight, boosts }
    }

    /// Begins a path; `None` where an emitter is dark.
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
