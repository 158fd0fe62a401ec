//! Second specular lobe of the principled material: facets of Burley's distribution GTR1 under a clear varnish.
//!
//! Paper: B. Burley, *Physically Based Shading at Disney*, 2012, section 5.6 and appendix B. As in the paper and in
//! Mitsuba 3, there is no division by the cosines, masking is that of α = 0.25, and a factor of 1 gives a quarter of
//! the light.
//! Deviations: the Fresnel reflectance is Schlick's for an index of 1.5, for every material.

use super::{
    DirectionBound, Directions, Directions16, FacetBound, FacetBounds16, LobeLanes, SeenLobe, ValuePdf16,
    mean,
};
use crate::material::fresnel::schlick_weight;
use crate::material::microfacet::Microfacets;
use base::math::{LANES, Rgb, Vec3x16, select};
use glam::{Vec2, Vec3};
use scene::Distribution;
use std::f32::consts::{PI, TAU};

/// Reflectance at normal incidence.
const F0: f32 = 0.04;

/// Roughness α of the masking.
const MASKING_ALPHA: f32 = 0.25;

/// Share of the light that a factor of 1 gives.
const STRENGTH: f32 = 0.25;

/// Clear coat without its factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) struct ClearCoat {
    alpha_sq: f32,
    masking: Microfacets,
}

impl ClearCoat {
    /// Builds a coat of a gloss from 0 to 1.
    pub fn new(gloss: f32) -> ClearCoat {
        let alpha = 0.1 + gloss.clamp(0.0, 1.0) * (0.001 - 0.1);
        ClearCoat { alpha_sq: alpha * alpha, masking: Microfacets::new(Distribution::Ggx, MASKING_ALPHA) }
    }

    /// Returns the roughness α.
    pub(super) fn alpha(&self) -> f32 {
        self.alpha_sq.sqrt()
    }

    /// Returns the density of facets from the squared cosine of their inclination.
    #[inline]
    fn density(&self, cos_sq: f32) -> f32 {
        let a = self.alpha_sq - 1.0;
        a / (PI * self.alpha_sq.ln() * (1.0 + a * cos_sq))
    }

    /// Returns the share of facets that is not masked.
    #[inline]
    fn g1(&self, cos: f32) -> f32 {
        2.0 * cos * self.masking.v1(cos)
    }

    /// Returns the reflectance of a facet at the cosine `cos`.
    #[inline]
    fn reflectance(cos: f32) -> f32 {
        F0 + (1.0 - F0) * schlick_weight(cos)
    }

    /// See [`super::LobeModel::eval_pdf`].
    #[inline]
    pub fn eval_pdf(&self, scale: Rgb, probability: f32, d: &Directions) -> (Rgb, f32) {
        let cos_d = d.wo.dot(d.half);
        if !(d.wo.z > 0.0 && d.wi.z > 0.0 && cos_d > 0.0) {
            return (Rgb::ZERO, 0.0);
        }
        let density = self.density(d.half.z * d.half.z);
        let masked = density * self.g1(d.wo.z.min(1.0)) * self.g1(d.wi.z.min(1.0));
        (
            scale * (STRENGTH * Self::reflectance(cos_d) * masked),
            probability * density * d.half.z * 0.25 / cos_d,
        )
    }

    /// See [`super::LobeModel::sample`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
        let cos_sq = (1.0 - self.alpha_sq.powf(1.0 - u.y)) / (1.0 - self.alpha_sq);
        let (sin, cos) = ((1.0 - cos_sq).max(0.0).sqrt(), cos_sq.clamp(0.0, 1.0).sqrt());
        let (sin_phi, cos_phi) = (TAU * u.x).sin_cos();
        let half = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
        let wi = (2.0 * wo.dot(half)) * half - wo;
        (wo.z > 0.0 && wi.z > 0.0 && wo.dot(half) > 0.0).then_some(Directions { wo, wi, half })
    }

    /// Returns the share of the light at `cos` > 0 that level facets would reflect.
    #[inline]
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        let cos = cos.clamp(0.0, 1.0);
        scale * (Self::reflectance(cos) * (self.g1(cos) * cos).powi(2))
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline]
    pub fn sampling_weight(&self, scale: Rgb, cos: f32) -> f32 {
        // The floor accounts for inclined facets, which reflect light where level facets hardly do.
        if cos > 0.0 { mean(self.albedo(scale, cos)).max(0.02 * mean(scale)) } else { 0.0 }
    }

    /// See [`super::LobeModel::bound`].
    #[inline]
    pub fn bound(&self, scale: Rgb, bound: &FacetBound) -> Rgb {
        let masked =
            self.density(1.0 - bound.sin_sq) * self.g1(bound.cos_o) * self.g1(bound.cos_max) * bound.cos_max;
        scale * (STRENGTH * Self::reflectance(bound.cos_d) * masked * DirectionBound::WIDER)
    }

    /// See [`super::LobeModel::set_lane`].
    #[inline]
    pub fn set_lane(&self, lanes: &mut LobeLanes, lane: usize, scale: Rgb, wo: Vec3) {
        lanes.scale.set(lane, scale);
        lanes.masking[lane] = STRENGTH * self.g1(wo.z.min(1.0));
    }

    /// See [`super::LobeModel::add_value16`].
    pub fn add_value16(&self, lanes: &LobeLanes, d: &Directions16, sum: &mut Vec3x16) {
        for l in 0..LANES {
            if d.wi.z[l] > 0.0 && d.sin_sq[l] + d.cos_sq[l] > 0.0 {
                let masked = self.density(d.cos_sq[l]) * lanes.masking[l] * self.g1(d.wi.z[l].min(1.0));
                let value = lanes.scale.get(l) * (Self::reflectance(d.cos_d[l]) * masked);
                sum.set(l, sum.get(l) + value);
            }
        }
    }

    /// See [`super::LobeModel::seen`].
    #[inline]
    pub fn seen(&self, probability: f32, wo: Vec3) -> SeenLobe {
        SeenLobe { masking: STRENGTH * self.g1(wo.z.min(1.0)), density: probability * 0.25 }
    }

    /// See [`super::LobeModel::add_eval_pdf16`].
    pub fn add_eval_pdf16(&self, scale: Rgb, seen: &SeenLobe, d: &Directions16, sum: &mut ValuePdf16) {
        let a = self.alpha_sq - 1.0;
        let top = a / (PI * self.alpha_sq.ln());
        let masking = self.masking.v1_16(&d.wi.z);
        let (mut masked, mut pdf) = ([0.0; LANES], [0.0; LANES]);
        let mut reflectance = [0.0; LANES];
        for l in 0..LANES {
            let cos_d = d.cos_d[l];
            let reflects = d.reflects(l) & (cos_d > 0.0);
            let density = top / (1.0 + a * d.cos_sq[l]);
            let cos_i = select(d.wi.z[l] < 1.0, d.wi.z[l], 1.0);
            reflectance[l] = Self::reflectance(cos_d);
            masked[l] = select(reflects, density * seen.masking * (2.0 * cos_i * masking[l]), 0.0);
            pdf[l] = select(reflects, density * seen.density * d.cos_sq[l].sqrt() / cos_d, 0.0);
        }
        sum.add(scale, &Vec3x16 { x: reflectance, y: reflectance, z: reflectance }, &masked, &pdf);
    }

    /// See [`super::LobeModel::add_bound16`].
    pub fn add_bound16(&self, lanes: &LobeLanes, bounds: &FacetBounds16, sum: &mut Vec3x16) {
        for l in 0..LANES {
            let cos = bounds.cos_max[l];
            if cos > 0.0 {
                let masked = self.density(1.0 - bounds.sin_sq[l]) * lanes.masking[l] * self.g1(cos) * cos;
                let most = Self::reflectance(bounds.cos_d[l]) * masked * DirectionBound::WIDER;
                sum.set(l, sum.get(l) + lanes.scale.get(l) * most);
            }
        }
    }
}
