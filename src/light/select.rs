//! Choice of the emitter to sample for a shaded point.
//!
//! With few emitters the choice is proportional to each one's rough irradiance at the point, mixed with its
//! power so that no emitter is starved; with many, to power alone.

use super::{AreaLight, DiscreteDistribution, Emitters, EnvironmentLight, delta_irradiance, delta_power};
use crate::math::{F32x16, LANES, U32x16, Vec3x16, luminance};
use crate::scene::DeltaLight;
use std::f32::consts::PI;

/// Maximum number of emitters that are weighted one by one at every shaded point.
const WEIGHED: usize = 32;

/// Share of the choice that is by power, whatever the point.
const BY_POWER: f32 = 0.1;

/// Sixteen points to be lit.
#[derive(Clone, Copy, Debug)]
pub struct Receivers16<'a> {
    /// Positions.
    pub position: &'a Vec3x16,
    /// Unit normals of the reflecting sides.
    pub normal: &'a Vec3x16,
}

#[derive(Clone, Debug)]
pub(super) struct Selection {
    by_power: DiscreteDistribution,
}

impl Selection {
    pub fn new(
        areas: &[AreaLight],
        deltas: &[DeltaLight],
        environment: Option<&EnvironmentLight>,
        diagonal: f32,
    ) -> Selection {
        let radius = 0.5 * diagonal;
        let areas = areas.iter().map(|a| a.power);
        let deltas = deltas.iter().map(|d| delta_power(d, radius));
        // Flux through the scene's bounding sphere.
        let environment = environment.map(|e| 4.0 * PI * PI * radius * radius * e.mean_luminance());
        Selection { by_power: DiscreteDistribution::new(areas.chain(deltas).chain(environment)) }
    }

    /// Chooses an emitter for each lane; returns it and its probability, zero where no emitter can be chosen.
    #[inline]
    pub fn sample(&self, e: &Emitters, at: Receivers16, u: &F32x16) -> (U32x16, F32x16) {
        let (mut chosen, mut choice) = ([0; LANES], [0.0; LANES]);
        let count = self.by_power.len();
        if self.by_power.is_empty() {
            return (chosen, choice);
        }
        if count == 1 {
            return (chosen, [1.0; LANES]);
        }
        if count > WEIGHED {
            for i in 0..LANES {
                let (index, _) = self.by_power.sample(u[i]);
                chosen[i] = index as u32;
                choice[i] = self.by_power.probability(index);
            }
            return (chosen, choice);
        }
        let (weights, total) = self.weights(e, at);
        let mut left = [0.0; LANES];
        for i in 0..LANES {
            left[i] = u[i] * total[i];
        }
        // Rounding may leave a remainder: then a lane keeps its last emitter of positive weight.
        let mut open = [1u32; LANES];
        for (index, w) in (0u32..).zip(&weights[..count]) {
            for i in 0..LANES {
                let takes = (open[i] != 0) & (w[i] > 0.0);
                chosen[i] = if takes { index } else { chosen[i] };
                choice[i] = if takes { w[i] } else { choice[i] };
                open[i] = u32::from((open[i] != 0) & !(takes & (left[i] < w[i])));
                left[i] -= w[i];
            }
        }
        for i in 0..LANES {
            choice[i] = if total[i] > 0.0 { choice[i] / total[i] } else { 0.0 };
        }
        (chosen, choice)
    }

    /// Probability of [`Selection::sample`] choosing emitter `index[lane]` in each lane.
    #[inline]
    pub fn probability(&self, e: &Emitters, at: Receivers16, index: &U32x16) -> F32x16 {
        match self.by_power.len() {
            1 => [1.0; LANES],
            count if count > WEIGHED => index.map(|i| self.by_power.probability(i as usize)),
            _ => {
                let (weights, total) = self.weights(e, at);
                std::array::from_fn(|i| {
                    if total[i] > 0.0 { weights[index[i] as usize][i] / total[i] } else { 0.0 }
                })
            }
        }
    }

    /// Weights of all emitters, and their sums.
    #[inline]
    fn weights(&self, e: &Emitters, at: Receivers16) -> ([F32x16; WEIGHED], F32x16) {
        let Receivers16 { position: x, normal: n } = at;
        let mut weights = [[0.0; LANES]; WEIGHED];
        for (w, light) in weights.iter_mut().zip(&e.areas) {
            for i in 0..LANES {
                w[i] = light.importance(x.get(i), n.get(i));
            }
        }
        let rest = &mut weights[e.areas.len()..];
        for (w, light) in rest.iter_mut().zip(&e.deltas) {
            for i in 0..LANES {
                let (direction, _, irradiance) = delta_irradiance(light, x.get(i));
                let raw = luminance(irradiance) * PI;
                w[i] = if n.get(i).dot(direction) > 0.0 && raw.is_finite() { raw } else { 0.0 };
            }
        }
        if let Some(environment) = &e.environment {
            rest[e.deltas.len()] = [PI * PI * environment.mean_luminance(); LANES];
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
