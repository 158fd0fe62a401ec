//! Second specular lobe of the principled material: facets of Burley's distribution GTR1 under a clear varnish.
//!
//! Paper: B. Burley, *Physically Based Shading at Disney*, 2012, section 5.6 and appendix B. As in the paper and in
//! Mitsuba 3, there is no division by the cosines, masking is that of α = 0.25, and a factor of 1 gives a quarter of
//! the light.
//! Deviations: the Fresnel reflectance is Schlick's for an index of 1.5, for every material.

use super::{DirectionBound, Facet, FacetBound, SeenLobe, means};
use crate::material::fresnel::schlick_weight;
use crate::material::microfacet::Microfacets;
use base::math::{Lane, V3};
use scene::Distribution;
use std::f32::consts::{PI, TAU};

/// Reflectance at normal incidence.
const F0: f32 = 0.04;

/// Roughness α of the masking.
const MASKING_ALPHA: f32 = 0.25;

/// Share of the light that a factor of 1 gives.
const STRENGTH: f32 = 0.25;

/// Minimum cosine between a direction and the facets, against division by 0.
const MIN_COS: f32 = 1e-9;

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
    #[inline(always)]
    fn density<L: Lane>(&self, cos_sq: L) -> L {
        let a = self.alpha_sq - 1.0;
        L::from(a / (PI * self.alpha_sq.ln())) / (cos_sq * a + L::from(1.0))
    }

    /// Returns the share of facets that is not masked.
    #[inline(always)]
    fn g1<L: Lane>(&self, cos: L) -> L {
        cos.min(L::from(1.0)) * self.masking.v1(cos) * 2.0
    }

    /// Returns the reflectance of a facet at the cosine `cos`.
    #[inline(always)]
    fn reflectance<L: Lane>(cos: L) -> L {
        schlick_weight(cos) * (1.0 - F0) + L::from(F0)
    }

    /// See [`super::LobeModel::seen`].
    #[inline(always)]
    pub(super) fn seen<L: Lane>(&self, wo: V3<L>) -> SeenLobe<L> {
        SeenLobe { masking: self.max_masking(wo.z), density: L::from(0.25) }
    }

    /// See [`super::LobeModel::value_pdf`].
    #[inline(always)]
    pub(super) fn value_pdf<L: Lane>(&self, seen: &SeenLobe<L>, facet: &Facet<L>) -> (V3<L>, L) {
        let density = self.density(facet.half.z.sq());
        let value = Self::reflectance(facet.cos_d) * density * seen.masking * self.g1(facet.wi.z);
        (V3::grey(value), density * seen.density * facet.half.z / facet.cos_d.max(L::from(MIN_COS)))
    }

    /// See [`super::LobeModel::sample`].
    #[inline(always)]
    pub(super) fn sample<L: Lane>(&self, wo: V3<L>, u: [L; 2]) -> Facet<L> {
        let cos_sq =
            ((u[1].rest() * self.alpha_sq.ln()).exp().rest() * (1.0 / (1.0 - self.alpha_sq))).positive();
        let (sin, cos) = (cos_sq.rest().positive().sqrt(), cos_sq.min(L::from(1.0)).sqrt());
        let (sin_phi, cos_phi) = (u[0].each(|u| (TAU * u).sin()), u[0].each(|u| (TAU * u).cos()));
        let facet = Facet::reflected(wo, V3::new(sin * cos_phi, sin * sin_phi, cos));
        Facet { reflects: facet.reflects & facet.cos_d.is_positive(), ..facet }
    }

    /// Returns the share of the light at `cos` > 0 that level facets would reflect.
    #[inline(always)]
    pub(super) fn albedo<L: Lane>(&self, scale: V3<L>, cos: L) -> V3<L> {
        let cos = cos.min(L::from(1.0));
        scale.times(Self::reflectance(cos) * (self.g1(cos) * cos).sq())
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline(always)]
    pub(super) fn sampling_weight<L: Lane>(&self, scale: V3<L>, cos: L) -> L {
        // The floor accounts for inclined facets, which reflect light where level facets hardly do.
        means(self.albedo(scale, cos)).max(means(scale) * 0.02)
    }

    /// See [`super::LobeModel::max_masking`].
    #[inline(always)]
    pub(super) fn max_masking<L: Lane>(&self, cos_o: L) -> L {
        self.g1(cos_o) * STRENGTH
    }

    /// See [`super::LobeModel::bound`].
    #[inline(always)]
    pub(super) fn bound<L: Lane>(&self, masking: L, bound: &FacetBound<L>) -> V3<L> {
        let masked = self.density(bound.sin_sq.rest()) * masking * self.g1(bound.cos_max) * bound.cos_max;
        V3::grey(Self::reflectance(bound.cos_d) * masked * DirectionBound::WIDER)
    }
}
