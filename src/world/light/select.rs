//! Choice of the emitter to sample for a shaded point.
//!
//! The choice starts among the nodes of a cut of a tree over the emitters, or all emitters where they are few, and the
//! environment: in proportion to the rough irradiance by each at the point, mixed with its power so that none is
//! starved. It goes on down the tree.

use super::tree::{BY_POWER, EmitterTree, LampLooks, LearnedLamps};
use super::{AreaLight, DiscreteDistribution, Emitters, EnvironmentLight, Learned};
use base::math::{F32x16, LANES, U32x16, Vec3x16, lanes_in};
use scene::DeltaLight;
use std::f32::consts::PI;

/// Maximum number of candidates that are weighted one by one at every shaded point: emitters, the environment one of
/// them.
const MAX_CANDIDATES: usize = 32;

/// Number of nodes of the tree among which the choice starts where there are more emitters. In rooms with a thousand
/// lamps 12 and 31 give a fourth and an eighth more variance than 16 to 24.
const CUT: usize = 16;

/// Sixteen points to be lit.
#[derive(Clone, Copy, Debug)]
pub struct Receivers16<'a> {
    /// Positions.
    pub position: &'a Vec3x16,
    /// Unit normals of the reflecting sides; zero where light may come from both.
    pub normal: &'a Vec3x16,
    /// Knowledge of the emitters that is used, if any.
    pub learned: Option<&'a Learned>,
}

impl<'a> Receivers16<'a> {
    /// Factors that have been learned on the importance of lamps, in each lane.
    #[inline]
    fn lamp_factors(&self) -> [Option<&'a [f32]>; LANES] {
        match self.learned.and_then(|learned| learned.lamps.as_ref()) {
            Some(lamps) => lamps.at(self.position).map(Some),
            None => [None; LANES],
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// Candidates by power: the nodes of the tree's cut, and the environment.
    by_power: DiscreteDistribution,
    /// Tree over all emitters but the environment.
    tree: EmitterTree,
}

impl Selection {
    pub fn new(
        areas: &[AreaLight],
        deltas: &[DeltaLight],
        environment: Option<&EnvironmentLight>,
        extents: [f32; 2],
    ) -> Selection {
        let radius = 0.5 * extents[1];
        let few = areas.len() + deltas.len() < MAX_CANDIDATES;
        let cut = if few { MAX_CANDIDATES - 1 } else { CUT };
        let (tree, powers) = EmitterTree::new(areas, deltas, extents, cut);
        // Flux through the scene's bounding sphere.
        let environment = environment.map(|e| 4.0 * PI * PI * radius * radius * e.mean_luminance());
        Selection { by_power: DiscreteDistribution::new(powers.into_iter().chain(environment)), tree }
    }

    /// Learns which emitters are seen from where.
    pub fn learn(&self, looks: &LampLooks) -> Option<LearnedLamps> {
        LearnedLamps::new(&self.tree, looks)
    }

    /// Chooses an emitter for each lane of `wanted`; returns it and its probability, zero where no emitter can be
    /// chosen.
    #[inline]
    pub fn sample(&self, e: &Emitters, at: Receivers16, u: &F32x16, wanted: u16) -> (U32x16, F32x16) {
        let (mut chosen, mut choice) = ([0; LANES], [0.0; LANES]);
        let count = self.by_power.len();
        if self.by_power.is_empty() {
            return (chosen, choice);
        }
        if count == 1 {
            return (chosen, [1.0; LANES]);
        }
        let factors = at.lamp_factors();
        let (weights, total) = self.weights(e, at, &factors);
        let mut left = [0.0; LANES];
        for i in 0..LANES {
            left[i] = u[i] * total[i];
        }
        // A lane passes the candidates whose weights together are no more than its number.
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
                // Rounding left a remainder: the lane gets its last candidate of positive weight.
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
                chosen[lane] = e.environment_index();
            } else if choice[lane] > 0.0 {
                let (x, n) = (at.position.get(lane), at.normal.get(lane));
                let within = within[lane].min(1.0 - f32::EPSILON);
                let below = self.tree.sample(candidate, (x, n), factors[lane], within);
                let (emitter, probability) = below.unwrap_or_default();
                chosen[lane] = emitter;
                choice[lane] *= probability;
            }
        }
        (chosen, choice)
    }

    /// Probability of [`Selection::sample`] choosing emitter `index[lane]` in each lane of `wanted`.
    #[inline]
    pub fn probability(&self, e: &Emitters, at: Receivers16, index: &U32x16, wanted: u16) -> F32x16 {
        if self.by_power.len() == 1 {
            return [1.0; LANES];
        }
        let factors = at.lamp_factors();
        let mut probability = [1.0; LANES];
        let mut candidates = [self.tree.len() as u32; LANES];
        for lane in lanes_in(wanted) {
            if index[lane] != e.environment_index() {
                let (x, n) = (at.position.get(lane), at.normal.get(lane));
                let (top, below) = self.tree.probability(index[lane] as usize, (x, n), factors[lane]);
                (candidates[lane], probability[lane]) = (top as u32, below);
            }
        }
        let (weights, total) = self.weights(e, at, &factors);
        for i in 0..LANES {
            let choice = if total[i] > 0.0 { weights[candidates[i] as usize][i] / total[i] } else { 0.0 };
            probability[i] *= choice;
        }
        probability
    }

    /// Weights of all candidates, and their sums.
    #[inline]
    fn weights(
        &self,
        e: &Emitters,
        at: Receivers16,
        factors: &[Option<&[f32]>; LANES],
    ) -> ([F32x16; MAX_CANDIDATES], F32x16) {
        let mut weights = [[0.0; LANES]; MAX_CANDIDATES];
        self.tree.weigh(at, &mut weights);
        for (lane, factors) in factors.iter().enumerate() {
            for (w, factor) in
                weights.iter_mut().zip(factors.iter().flat_map(|factors| &factors[..self.tree.len()]))
            {
                w[lane] *= factor;
            }
        }
        if let Some(environment) = &e.environment {
            weights[self.by_power.len() - 1] = [PI * PI * environment.mean_luminance(); LANES];
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
                // Emitters that cannot shine on this side keep weight zero.
                let shines = (w[i] > 0.0) & (scale[i] > 0.0);
                w[i] = if shines { w[i] * scale[i] + by_power } else { 0.0 };
                total[i] += w[i];
            }
        }
        (weights, total)
    }
}
