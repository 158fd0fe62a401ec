//! Choice of the emitter to sample for a shaded point.
//!
//! Candidates are the environment and the nodes of a cut of a tree over the emitters, or all emitters if there are few.
//! A candidate is chosen in proportion to its estimated irradiance at the point, mixed with its power so that no
//! emitter is starved. The choice continues down the tree.

use super::area::AreaLight;
use super::delta::DeltaEmitter;
use super::distribution::DiscreteDistribution;
use super::environment::EnvironmentLight;
use super::observed::Observed;
use super::receivers::Receivers16;
use super::tree::{BY_POWER, EmitterTree, LearnedEmitters, MAX_FACTORS, PointAndNormal};
use base::math::{F32x16, LANES, U32x16, lanes_in};
use std::f32::consts::PI;

/// Maximum number of candidates that are weighted one by one at every shaded point, the environment included.
const MAX_CANDIDATES: usize = 32;

/// Number of nodes in the cut of the tree if there are more emitters than candidates.
const CUT: usize = 16;

/// Maximum number of candidates whose weights are a small array.
const FEW: usize = 8;

/// Maximum weight of the environment relative to all other emitters at points which these light. The environment may
/// be invisible from where it is much brighter than lamps, as it is in a closed room.
const MAX_ENVIRONMENT: f32 = 31.0;

/// Choice among the emitters of a scene.
#[derive(Clone, Debug)]
pub(super) struct EmitterChoice {
    /// Distribution of the candidates by power: nodes of the cut, then the environment.
    by_power: DiscreteDistribution,
    /// Emitter of each candidate; `None` for nodes above several emitters.
    candidates: Vec<Option<u32>>,
    /// Tree over all emitters but the environment.
    tree: EmitterTree,
    /// Index of the environment, which follows all other emitters.
    environment: u32,
    /// Weight of the environment at every point, if there is one.
    environment_weight: Option<f32>,
}

impl EmitterChoice {
    /// Builds the tree, in a scene of the given diagonals (see [`EmitterTree::new`]).
    pub fn new(
        areas: &[AreaLight],
        deltas: &[DeltaEmitter],
        environment: Option<&EnvironmentLight>,
        extents: [f32; 2],
    ) -> EmitterChoice {
        let radius = 0.5 * extents[1];
        let few = areas.len() + deltas.len() < MAX_CANDIDATES;
        let cut = if few { MAX_CANDIDATES - 1 } else { CUT };
        let (tree, powers) = EmitterTree::new(areas, deltas, extents, cut);
        // Flux through the scene's bounding sphere.
        let flux = environment.map(|e| 4.0 * PI * PI * radius * radius * e.mean_luminance());
        let index = (areas.len() + deltas.len()) as u32;
        EmitterChoice {
            by_power: DiscreteDistribution::new(powers.into_iter().chain(flux)),
            candidates: tree.top_emitters().chain(flux.map(|_| Some(index))).collect(),
            tree,
            environment: index,
            environment_weight: environment.map(|e| PI * PI * e.mean_luminance()),
        }
    }

    /// Learns the visibility of the emitters in the tree; `None` if nearly all are visible from everywhere.
    pub fn learn(&self, observed: &Observed) -> Option<LearnedEmitters> {
        LearnedEmitters::new(&self.tree, observed)
    }

    /// Returns the minimum number of observers in a region, of so many in all, for which factors fit into memory.
    pub fn fewest_observers(&self, observers: usize) -> usize {
        observers.saturating_mul(self.tree.slots()) / MAX_FACTORS
    }

    /// Chooses an emitter for each lane of `wanted`. Returns the emitters and their probabilities, which are zero if no
    /// emitter can be chosen.
    #[inline]
    pub fn sample(&self, at: Receivers16, u: &F32x16, wanted: u16) -> (U32x16, F32x16) {
        match self.by_power.len() {
            _ if self.by_power.is_empty() => ([0; LANES], [0.0; LANES]),
            1 => ([0; LANES], [1.0; LANES]),
            0..=FEW => self.sample_among::<FEW>(at, u, wanted),
            _ => self.sample_among::<MAX_CANDIDATES>(at, u, wanted),
        }
    }

    /// Chooses an emitter among at most `N` candidates (see [`EmitterChoice::sample`]).
    #[inline]
    fn sample_among<const N: usize>(&self, at: Receivers16, u: &F32x16, wanted: u16) -> (U32x16, F32x16) {
        let (mut chosen, mut choice) = ([0; LANES], [0.0; LANES]);
        let factors = at.emitter_factors();
        let mut weights = [[0.0; LANES]; N];
        let weights = &mut weights[..self.by_power.len()];
        let total = self.weigh(at, factors.as_ref(), weights);
        let mut left = [0.0; LANES];
        for i in 0..LANES {
            left[i] = u[i] * total[i];
        }
        // A lane passes the candidates whose cumulative weight does not exceed its random number.
        let (mut within, mut weight) = (left, weights[0]);
        for index in 0..weights.len() {
            let next = weights[(index + 1).min(weights.len() - 1)];
            for i in 0..LANES {
                left[i] -= weights[index][i];
                let passes = left[i] >= 0.0;
                chosen[i] += u32::from(passes);
                within[i] = if passes { left[i] } else { within[i] };
                weight[i] = if passes { next[i] } else { weight[i] };
            }
        }
        for i in 0..LANES {
            if chosen[i] as usize >= weights.len() {
                // Rounding left a remainder: the lane takes its last candidate of positive weight.
                let last = weights.iter().rposition(|w| w[i] > 0.0).unwrap_or(0);
                (chosen[i], weight[i]) = (last as u32, weights[last][i]);
            }
        }
        for i in 0..LANES {
            choice[i] = if total[i] > 0.0 { weight[i] / total[i] } else { 0.0 };
            within[i] /= weight[i];
        }
        let (mut emitters, mut below) = ([0; LANES], 0u16);
        for i in 0..LANES {
            match self.candidates[chosen[i] as usize] {
                Some(emitter) => emitters[i] = emitter,
                None => below |= u16::from(choice[i] > 0.0) << i,
            }
        }
        for lane in lanes_in(below & wanted) {
            let point = PointAndNormal { x: at.position.get(lane), n: at.normal.get(lane) };
            let within = within[lane].min(1.0 - f32::EPSILON);
            let factors = factors.map(|factors| factors[lane]);
            let sample = self.tree.sample(chosen[lane] as usize, point, factors, within);
            let (emitter, probability) = sample.unwrap_or_default();
            emitters[lane] = emitter;
            choice[lane] *= probability;
        }
        (emitters, choice)
    }

    /// Returns the probability with which [`EmitterChoice::sample`] chooses emitter `index[lane]`, for the lanes of
    /// `wanted`.
    #[inline]
    pub fn probability(&self, at: Receivers16, index: &U32x16, wanted: u16) -> F32x16 {
        match self.by_power.len() {
            1 => [1.0; LANES],
            0..=FEW => self.probability_among::<FEW>(at, index, wanted),
            _ => self.probability_among::<MAX_CANDIDATES>(at, index, wanted),
        }
    }

    /// Returns the probability with which [`EmitterChoice::sample_among`] chooses an emitter in each lane.
    #[inline]
    fn probability_among<const N: usize>(&self, at: Receivers16, index: &U32x16, wanted: u16) -> F32x16 {
        let factors = at.emitter_factors();
        let mut probability = [1.0; LANES];
        // Lanes that are not wanted take any candidate; there may be none behind those of the tree.
        let mut candidates = [0; LANES];
        for lane in lanes_in(wanted) {
            if index[lane] == self.environment {
                candidates[lane] = self.by_power.len() as u32 - 1;
                continue;
            }
            let point = PointAndNormal { x: at.position.get(lane), n: at.normal.get(lane) };
            let factors = factors.map(|factors| factors[lane]);
            let (top, below) = self.tree.probability(index[lane] as usize, point, factors);
            (candidates[lane], probability[lane]) = (top as u32, below);
        }
        let mut weights = [[0.0; LANES]; N];
        let total = self.weigh(at, factors.as_ref(), &mut weights[..self.by_power.len()]);
        for i in 0..LANES {
            let choice = if total[i] > 0.0 { weights[candidates[i] as usize][i] / total[i] } else { 0.0 };
            probability[i] *= choice;
        }
        probability
    }

    /// Writes the weights of all candidates. Returns their sums.
    #[inline]
    fn weigh(&self, at: Receivers16, factors: Option<&[&[f32]; LANES]>, weights: &mut [F32x16]) -> F32x16 {
        self.tree.weigh(at.position, at.normal, weights);
        if let Some(factors) = factors {
            for (lane, factors) in factors.iter().enumerate() {
                for (w, factor) in weights.iter_mut().zip(&factors[..self.tree.len()]) {
                    w[lane] *= factor;
                }
            }
        }
        let mut local_total = [0.0; LANES];
        for w in weights[..self.tree.len()].iter() {
            for i in 0..LANES {
                local_total[i] += w[i];
            }
        }
        if let Some(weight) = self.environment_weight {
            let row = &mut weights[self.by_power.len() - 1];
            for i in 0..LANES {
                let most = if local_total[i] > 0.0 { MAX_ENVIRONMENT * local_total[i] } else { weight };
                row[i] = if weight < most { weight } else { most };
                local_total[i] += row[i];
            }
        }
        let mut scale = [0.0; LANES];
        for i in 0..LANES {
            let usable = (local_total[i] > 0.0) & (local_total[i] < f32::INFINITY);
            scale[i] = if usable { (1.0 - BY_POWER) / local_total[i] } else { 0.0 };
        }
        let mut total = [0.0; LANES];
        for (index, w) in weights.iter_mut().enumerate() {
            let by_power = BY_POWER * self.by_power.probability(index);
            for i in 0..LANES {
                // The weight of emitters that cannot light this side stays zero.
                let shines = (w[i] > 0.0) & (scale[i] > 0.0);
                w[i] = if shines { w[i] * scale[i] + by_power } else { 0.0 };
                total[i] += w[i];
            }
        }
        total
    }
}
