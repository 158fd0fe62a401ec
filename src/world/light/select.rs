//! Choice of the emitter to sample for a shaded point.
//!
//! Candidates are the environment and the nodes of a cut of a tree over the emitters, or all emitters if there are few.
//! A candidate is chosen in proportion to its estimated irradiance at the point, mixed with its power so that no
//! emitter is starved. The choice continues down the tree.

use super::area::AreaLight;
use super::distribution::DiscreteDistribution;
use super::environment::EnvironmentLight;
use super::receivers::Receivers16;
use super::tree::{BY_POWER, EmitterObservations, EmitterTree, LearnedEmitters, PointAndNormal};
use base::math::{F32x16, LANES, U32x16, lanes_in};
use scene::DeltaLight;
use std::f32::consts::PI;

/// Maximum number of candidates that are weighted one by one at every shaded point, the environment included.
const MAX_CANDIDATES: usize = 32;

/// Number of nodes in the cut of the tree if there are more emitters than candidates.
const CUT: usize = 16;

/// Choice among the emitters of a scene.
#[derive(Clone, Debug)]
pub(super) struct EmitterChoice {
    /// Distribution of the candidates by power: nodes of the cut, then the environment.
    by_power: DiscreteDistribution,
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
        deltas: &[DeltaLight],
        environment: Option<&EnvironmentLight>,
        extents: [f32; 2],
    ) -> EmitterChoice {
        let radius = 0.5 * extents[1];
        let few = areas.len() + deltas.len() < MAX_CANDIDATES;
        let cut = if few { MAX_CANDIDATES - 1 } else { CUT };
        let (tree, powers) = EmitterTree::new(areas, deltas, extents, cut);
        // Flux through the scene's bounding sphere.
        let flux = environment.map(|e| 4.0 * PI * PI * radius * radius * e.mean_luminance());
        EmitterChoice {
            by_power: DiscreteDistribution::new(powers.into_iter().chain(flux)),
            tree,
            environment: (areas.len() + deltas.len()) as u32,
            environment_weight: environment.map(|e| PI * PI * e.mean_luminance()),
        }
    }

    /// Learns the visibility of the emitters in the tree; `None` if nearly all are visible from everywhere.
    pub fn learn(&self, observations: &EmitterObservations) -> Option<LearnedEmitters> {
        LearnedEmitters::new(&self.tree, observations)
    }

    /// Chooses an emitter for each lane of `wanted`. Returns the emitters and their probabilities, which are zero if no
    /// emitter can be chosen.
    #[inline]
    pub fn sample(&self, at: Receivers16, u: &F32x16, wanted: u16) -> (U32x16, F32x16) {
        let (mut chosen, mut choice) = ([0; LANES], [0.0; LANES]);
        let count = self.by_power.len();
        if self.by_power.is_empty() {
            return (chosen, choice);
        }
        if count == 1 {
            return (chosen, [1.0; LANES]);
        }
        let factors = at.emitter_factors();
        let (weights, total) = self.weights(at, &factors);
        let mut left = [0.0; LANES];
        for i in 0..LANES {
            left[i] = u[i] * total[i];
        }
        // A lane passes the candidates whose cumulative weight does not exceed its random number.
        let mut within = left;
        for w in &weights[..count] {
            for i in 0..LANES {
                left[i] -= w[i];
                let passes = left[i] >= 0.0;
                chosen[i] += u32::from(passes);
                within[i] = if passes { left[i] } else { within[i] };
            }
        }
        for i in 0..LANES {
            if chosen[i] as usize >= count {
                // Rounding left a remainder: the lane takes its last candidate of positive weight.
                let last = weights[..count].iter().rposition(|w| w[i] > 0.0);
                chosen[i] = last.unwrap_or(0) as u32;
            }
            let weight = weights[chosen[i] as usize][i];
            choice[i] = if total[i] > 0.0 { weight / total[i] } else { 0.0 };
            within[i] /= weight;
        }
        for lane in lanes_in(wanted) {
            let candidate = chosen[lane] as usize;
            if candidate == self.tree.len() {
                chosen[lane] = self.environment;
            } else if choice[lane] > 0.0 {
                let point = PointAndNormal { x: at.position.get(lane), n: at.normal.get(lane) };
                let within = within[lane].min(1.0 - f32::EPSILON);
                let below = self.tree.sample(candidate, point, factors[lane], within);
                let (emitter, probability) = below.unwrap_or_default();
                chosen[lane] = emitter;
                choice[lane] *= probability;
            }
        }
        (chosen, choice)
    }

    /// Returns the probability with which [`EmitterChoice::sample`] chooses emitter `index[lane]`, for the lanes of
    /// `wanted`.
    #[inline]
    pub fn probability(&self, at: Receivers16, index: &U32x16, wanted: u16) -> F32x16 {
        if self.by_power.len() == 1 {
            return [1.0; LANES];
        }
        let factors = at.emitter_factors();
        let mut probability = [1.0; LANES];
        let mut candidates = [self.tree.len() as u32; LANES];
        for lane in lanes_in(wanted) {
            if index[lane] != self.environment {
                let point = PointAndNormal { x: at.position.get(lane), n: at.normal.get(lane) };
                let (top, below) = self.tree.probability(index[lane] as usize, point, factors[lane]);
                (candidates[lane], probability[lane]) = (top as u32, below);
            }
        }
        let (weights, total) = self.weights(at, &factors);
        for i in 0..LANES {
            let choice = if total[i] > 0.0 { weights[candidates[i] as usize][i] / total[i] } else { 0.0 };
            probability[i] *= choice;
        }
        probability
    }

    /// Returns the weights of all candidates, and their sums.
    #[inline]
    fn weights(
        &self,
        at: Receivers16,
        factors: &[Option<&[f32]>; LANES],
    ) -> ([F32x16; MAX_CANDIDATES], F32x16) {
        let mut weights = [[0.0; LANES]; MAX_CANDIDATES];
        self.tree.weigh(at.position, at.normal, &mut weights);
        for (lane, factors) in factors.iter().enumerate() {
            for (w, factor) in
                weights.iter_mut().zip(factors.iter().flat_map(|factors| &factors[..self.tree.len()]))
            {
                w[lane] *= factor;
            }
        }
        if let Some(weight) = self.environment_weight {
            weights[self.by_power.len() - 1] = [weight; LANES];
        }
        let weights_used = &mut weights[..self.by_power.len()];
        let mut local_total = [0.0; LANES];
        for w in weights_used.iter() {
            for i in 0..LANES {
                local_total[i] += w[i];
            }
        }
        let mut scale = [0.0; LANES];
        for i in 0..LANES {
            let usable = (local_total[i] > 0.0) & (local_total[i] < f32::INFINITY);
            scale[i] = if usable { (1.0 - BY_POWER) / local_total[i] } else { 0.0 };
        }
        let mut total = [0.0; LANES];
        for (index, w) in weights_used.iter_mut().enumerate() {
            let by_power = BY_POWER * self.by_power.probability(index);
            for i in 0..LANES {
                // The weight of emitters that cannot light this side stays zero.
                let shines = (w[i] > 0.0) & (scale[i] > 0.0);
                w[i] = if shines { w[i] * scale[i] + by_power } else { 0.0 };
                total[i] += w[i];
            }
        }
        (weights, total)
    }
}
