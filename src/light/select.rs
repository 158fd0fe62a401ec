//! Which emitter to sample for a shaded point.
//!
//! With few emitters the choice follows each one's rough irradiance at the point, mixed with its power so that
//! no emitter is starved; with many it follows power alone.

use super::{AreaLight, Distribution, Emitters, EnvironmentLight, delta_irradiance, delta_power};
use crate::math::luminance;
use crate::scene::DeltaLight;
use glam::Vec3;
use std::f32::consts::PI;

/// Up to this many emitters are weighed one by one at every shaded point.
const WEIGHED: usize = 32;

/// Share of the choice that ignores where the point is.
const BY_POWER: f32 = 0.1;

#[derive(Clone, Debug)]
pub(super) struct Selection {
    by_power: Distribution,
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
        Selection { by_power: Distribution::new(areas.chain(deltas).chain(environment)) }
    }

    /// An emitter and the probability of the choice.
    #[inline]
    pub fn sample(&self, e: &Emitters, x: Vec3, n: Vec3, u: f32) -> Option<(usize, f32)> {
        let count = self.by_power.len();
        if self.by_power.is_empty() {
            return None;
        }
        if count == 1 {
            return Some((0, 1.0));
        }
        if count > WEIGHED {
            let (i, _) = self.by_power.sample(u);
            return Some((i, self.by_power.probability(i)));
        }
        let (weights, total) = self.weights(e, x, n);
        if total <= 0.0 {
            return None;
        }
        let mut left = u * total;
        let mut chosen = None;
        for (i, w) in weights[..count].iter().enumerate() {
            if *w > 0.0 {
                chosen = Some((i, w / total));
                if left < *w {
                    break;
                }
                left -= w;
            }
        }
        chosen
    }

    /// Probability of [`Selection::sample`] choosing emitter `index`.
    #[inline]
    pub fn probability(&self, e: &Emitters, x: Vec3, n: Vec3, index: usize) -> f32 {
        match self.by_power.len() {
            1 => 1.0,
            count if count > WEIGHED => self.by_power.probability(index),
            _ => {
                let (weights, total) = self.weights(e, x, n);
                if total > 0.0 { weights[index] / total } else { 0.0 }
            }
        }
    }

    #[inline]
    fn weights(&self, e: &Emitters, x: Vec3, n: Vec3) -> ([f32; WEIGHED], f32) {
        let mut weights = [0.0; WEIGHED];
        let mut local_total = 0.0;
        for (w, a) in weights.iter_mut().zip(&e.areas) {
            let below = n.dot(a.centre - x) <= -a.radius;
            *w = if below { 0.0 } else { a.importance(x) };
        }
        let rest = &mut weights[e.areas.len()..];
        for (w, d) in rest.iter_mut().zip(&e.deltas) {
            let (direction, _, irradiance) = delta_irradiance(d, x);
            let w_raw = luminance(irradiance) * PI;
            *w = if n.dot(direction) > 0.0 && w_raw.is_finite() { w_raw } else { 0.0 };
        }
        if let Some(environment) = &e.environment {
            rest[e.deltas.len()] = PI * PI * environment.mean_luminance();
        }
        for w in &weights[..self.by_power.len()] {
            local_total += w;
        }
        if !(local_total > 0.0 && local_total.is_finite()) {
            return (weights, 0.0);
        }
        // Emitters that cannot shine on this side stay at zero.
        let mut total = 0.0;
        for (i, w) in weights[..self.by_power.len()].iter_mut().enumerate() {
            if *w > 0.0 {
                *w = *w / local_total * (1.0 - BY_POWER) + BY_POWER * self.by_power.probability(i);
                total += *w;
            }
        }
        (weights, total)
    }
}
