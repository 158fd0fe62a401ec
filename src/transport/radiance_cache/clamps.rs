//! Limits of the contributions of virtual lights to the points of up to sixteen records.

use super::candidate::Candidate;
use crate::bias_compensation::Compensation;
use crate::bias_compensation::near_surface::BRIGHTER;
use base::math::{F32x16, LANES, LUMINANCE, Rgb, Vec3x16};

/// Limits of the contributions of indirect virtual lights to the points of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Clamps {
    limits: F32x16,
    /// Limits of luminances, applied in addition.
    luminances: F32x16,
    /// True if `limits` bounds geometry terms, false if it bounds luminances.
    geometry: bool,
}

impl Clamps {
    /// Returns limits such that no light gives more than the luminances `limits` to the points of `task`.
    pub fn new(compensation: &Option<Compensation>, limits: &F32x16, task: &[Candidate]) -> Clamps {
        let Some(c) = compensation else {
            return Clamps { limits: *limits, luminances: [f32::INFINITY; LANES], geometry: false };
        };
        let mut bounds = [f32::INFINITY; LANES];
        for ((bound, limit), candidate) in bounds.iter_mut().zip(limits).zip(task) {
            *bound = c.bound(candidate.point.position, *limit);
        }
        Clamps { limits: bounds, luminances: limits.map(|limit| limit * BRIGHTER), geometry: true }
    }

    /// Returns the share of a light's contribution that each point retains. `responses` is the irradiance at unit
    /// intensity.
    #[inline]
    pub fn retained(&self, intensity: Rgb, responses: &Vec3x16) -> F32x16 {
        let weights = if self.geometry { Rgb::X } else { intensity * LUMINANCE };
        let mut retained = [1.0; LANES];
        for l in 0..LANES {
            let (value, limit) = (weights.dot(responses.get(l)), self.limits[l]);
            retained[l] = if value > limit { limit / value } else { 1.0 };
            let given = (intensity * LUMINANCE).dot(responses.get(l)) * retained[l];
            if given > self.luminances[l] {
                retained[l] *= self.luminances[l] / given;
            }
        }
        retained
    }

    /// Returns the maximum geometry term at a point; infinite if another quantity is limited.
    pub fn bound(&self, lane: usize) -> f32 {
        if self.geometry { self.limits[lane] } else { f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamps_keep_what_is_within_the_limit() {
        for (intensity, term) in [(0.5, 8.0), (2.0, 0.25), (4.0, 16.0)] {
            let retained = |limit: f32, geometry: bool| {
                let responses = Vec3x16::splat(Rgb::splat(term));
                Clamps { limits: [limit; LANES], luminances: [f32::INFINITY; LANES], geometry }
                    .retained(Rgb::splat(intensity), &responses)[3]
            };
            let luminance = retained(2.0, false) * intensity * term;
            assert!((luminance - (intensity * term).min(2.0)).abs() < 1e-5);
            assert_eq!(retained(4.0, true) * term, term.min(4.0));
            assert_eq!(retained(f32::INFINITY, false), 1.0);
            let both = Clamps { limits: [4.0; LANES], luminances: [2.0; LANES], geometry: true };
            let given =
                intensity * term * both.retained(Rgb::splat(intensity), &Vec3x16::splat(Rgb::splat(term)))[3];
            assert!((given - (intensity * f32::min(term, 4.0)).min(2.0)).abs() < 1e-5);
        }
        let clamps = Clamps::new(&None, &[2.0; LANES], &[]);
        assert_eq!((clamps.bound(0), Clamps { geometry: true, ..clamps }.bound(0)), (f32::INFINITY, 2.0));
    }
}
