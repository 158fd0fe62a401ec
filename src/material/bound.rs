//! Upper bounds of BSDF · cosine over sets of directions, for clusters of lights.
//!
//! With c = cos θ_i and m = wi · (mirror direction of wo), the other angles follow: wo · wi = 2 cos θ_o c - m, so
//! the facet normal h half-way between has cos² θ_h = (cos θ_o + c)² / (2 + 4 cos θ_o c - 2 m), and
//! cos² (wo, h) = (1 + 2 cos θ_o c - m) / 2. The first grows with m and has no maximum in c between the ends of
//! its range; the second is least at the smallest c and the largest m. That bounds D and the Fresnel reflectance;
//! masking times cosine grows with c. Independently of c, the angle between n and h is at least half that between
//! wi and the mirror direction, and the angle between wo and h at most half the sum of the two inclinations.
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

/// Rounding of a cosine or of a product of two, in the caller and here. It matters for α below 0.01.
const SLACK: f32 = 5e-7;

impl DirectionBound {
    /// Covers the rounding of the reflectance and of D at the tip of a narrow lobe.
    pub(super) const WIDER: f32 = 1.000_01;
}

impl Bsdf<'_> {
    /// An upper bound, per channel, of `eval(wo, wi)` · cos θ_i over all `wi` within `bound`.
    ///
    /// NaN in a bound counts as not knowing. Exact for a Lambertian surface at `cos_i_max`. Delta lobes are not included, as they are not in `eval`.
    #[inline]
    pub fn bound(&self, wo: Vec3, bound: &DirectionBound) -> Rgb {
        let cos_max = bound.cos_i_max.min(1.0);
        if cos_max <= 0.0 {
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
        let cos_min = bound.cos_i_min.max(0.0).min(cos_max);
        let density = facets.max_density(min_facet_sin_sq(cos_o, cos_min, cos_max, bound.cos_mirror_max));
        let masked = density * facets.v1(cos_o) * 0.5 * facets.max_g1(cos_max);
        let cos_d = min_facet_cos(cos_o, cos_min, bound.cos_mirror_max);
        let reflectance = match &self.model.max_reflectance {
            Some(table) => table.floor(cos_d),
            None => fresnel.reflectance(cos_d),
        };
        base + self.scale * reflectance * (masked * DirectionBound::WIDER)
    }
}

/// The least squared sine of the facet normal's inclination.
#[inline(always)]
pub(super) fn min_facet_sin_sq(cos_o: f32, cos_i_min: f32, cos_i_max: f32, cos_mirror: f32) -> f32 {
    let at = |cos_i: f32| {
        // 1 - cos² θ_h, the numerator arranged so that nothing large cancels. Where cos_i and cos_mirror
        // exclude each other this may be anything; the bound below then decides.
        let length_sq = 2.0 + 4.0 * cos_o * cos_i - 2.0 * cos_mirror;
        let difference = cos_o - cos_i;
        (2.0 * (1.0 - cos_mirror - SLACK) - difference * difference) / length_sq.max(SLACK)
    };
    let by_cosines = at(cos_i_min).min(at(cos_i_max));
    let by_mirror = 0.5 * (1.0 - cos_mirror - SLACK);
    by_cosines.max(by_mirror).max(0.0)
}

/// The least cosine between `wo` and the facet normal.
#[inline(always)]
pub(super) fn min_facet_cos(cos_o: f32, cos_i_min: f32, cos_mirror: f32) -> f32 {
    let product = cos_o * cos_i_min;
    let sin_product = ((1.0 - cos_o * cos_o) * (1.0 - cos_i_min * cos_i_min)).max(0.0).sqrt();
    let cos_between = (2.0 * product - cos_mirror).max(product - sin_product);
    (0.5 * (1.0 + cos_between) - SLACK).max(0.0).sqrt()
}
