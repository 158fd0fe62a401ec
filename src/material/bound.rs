//! Upper bounds of BSDF · cosine over sets of directions, for clusters of lights.
//!
//! The facet normal h is half-way between wo and wi, so the angle between n and h is at least half the angle
//! between wi and the mirror direction of wo: that bounds D. Masking times cosine grows with cos θ_i, the
//! Fresnel reflectance with the angle between wo and h, which is at most half the sum of the two inclinations.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1, for the use made of such bounds.

use super::bsdf::Bsdf;
use super::model::{Base, Scattering};
use crate::math::Rgb;
use glam::Vec3;

/// What is known of a set of directions towards light. The normal is the one on the side of `wo`: for a
/// two-sided surface seen from behind, the reversed shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionBound {
    /// No direction's cosine to the normal is larger; where this is <= 0 nothing is reflected.
    pub cos_i_max: f32,
    /// No direction's cosine to the normal is smaller. Anything <= 0 means that grazing light is possible.
    pub cos_i_min: f32,
    /// No direction's cosine to the mirror direction of `wo` is larger.
    pub cos_mirror_max: f32,
}

/// Added to sin² θ_h's lower bound: twice the rounding of a cosine near 1, so that caller and bound may each
/// have rounded once. It matters for α below 0.01.
const SIN_SQ_SLACK: f32 = 2.5e-7;

impl Bsdf<'_> {
    /// An upper bound, per channel, of `eval(wo, wi)` · cos θ_i over all `wi` within `bound`.
    ///
    /// Exact for a Lambertian surface at `cos_i_max`. Delta lobes are not included, as they are not in `eval`.
    #[inline]
    pub fn bound(&self, wo: Vec3, bound: &DirectionBound) -> Rgb {
        let cos_max = bound.cos_i_max.min(1.0);
        if cos_max.is_nan() || cos_max <= 0.0 {
            return Rgb::ZERO;
        }
        let Some((wo, _)) = self.on_front(wo, wo) else { return Rgb::ZERO };
        let base = match &self.model.base {
            Base::None => Rgb::ZERO,
            Base::Lambert => self.base * cos_max,
            Base::SmoothCoat(_) => {
                self.base * (cos_max * self.coat_transmittance(wo.z) * self.coat_transmittance(cos_max))
            }
            Base::RoughCoat(coat) => {
                let inwards = coat.max_transmittance.lookup(cos_max);
                self.base * (cos_max * coat.transmittance.lookup(wo.z) * inwards)
            }
        };
        let Scattering::Rough(facets, fresnel) = &self.model.lobe else { return base };
        let cos_o = wo.z.min(1.0);
        let sin_sq_h = (0.5 * (1.0 - bound.cos_mirror_max) - SIN_SQ_SLACK).clamp(0.0, 1.0);
        let density = facets.max_density(sin_sq_h);
        let masked = density * facets.v1(cos_o) * 0.5 * facets.max_g1(cos_max);
        let cos_d = half_angle_cos(cos_o, bound.cos_i_min.clamp(0.0, 1.0));
        base + self.scale * fresnel.max_reflectance(cos_d) * masked
    }
}

/// Cosine of half the sum of two angles given by their cosines, both in 0..=1; rounded down.
#[inline]
fn half_angle_cos(cos_a: f32, cos_b: f32) -> f32 {
    let sin_product = ((1.0 - cos_a * cos_a) * (1.0 - cos_b * cos_b)).max(0.0).sqrt();
    let cos_sum = cos_a * cos_b - sin_product;
    (0.5 * (1.0 + cos_sum) - 1e-6).max(0.0).sqrt()
}
