//! Directional distribution of the light that a rough lobe reflects from one direction, for virtual lights.
//!
//! The intensity in direction ω for light from ωi is proportional to D(h) V1(ω) cos θ with the half-way normal h. The
//! maxima of D and of V1 cos θ = G1 / 2 bound it.
//!
//! Paper: Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, 2007.
//! Deviations: the Fresnel reflectance is that of the whole lobe and does not depend on the direction.

use crate::material::microfacet::Microfacets;
use base::math::{F32x16, LANES, Rgb, Vec3x16};
use glam::Vec3;
use scene::Distribution;

/// Directional distribution of reflected light, relative to an upper bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeShape {
    facets: Microfacets,
    /// Inverse of the bound of D · V1 cos θ.
    inv_bound: f32,
}

impl LobeShape {
    /// Makes the distribution of a lobe of the given facets.
    pub(super) fn new(facets: Microfacets) -> LobeShape {
        let bound = facets.max_density(0.0) * 0.5 * facets.max_g1(1.0);
        LobeShape { facets, inv_bound: 1.0 / bound }
    }

    /// Returns the intensity in the unit direction `away` for light from the unit vector `towards_light`, relative to
    /// the bound, in 0..=1; 0 below the horizon.
    #[inline]
    pub fn share(&self, normal: Vec3, towards_light: Vec3, away: Vec3) -> f32 {
        let cos = normal.dot(away);
        let half = towards_light + away;
        let (length_sq, along) = (half.length_squared(), half.dot(normal));
        if !(cos > 0.0 && length_sq > 0.0) {
            return 0.0;
        }
        let cos = cos.min(1.0);
        let cos_sq = (along * along / length_sq).min(1.0);
        (self.facets.density_from(1.0 - cos_sq, cos_sq) * self.facets.v1(cos) * cos * self.inv_bound).min(1.0)
    }

    /// Returns [`LobeShape::share`] in all lanes. Directions have unit length or are 0.
    #[inline]
    pub fn share16(&self, normal: Vec3, towards_light: Vec3, away: &Vec3x16) -> F32x16 {
        let (mut sin_sq, mut cos_sq, mut cos) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let (x, y, z) = (away.x[l], away.y[l], away.z[l]);
            let along = normal.x * x + normal.y * y + normal.z * z;
            let h = [towards_light.x + x, towards_light.y + y, towards_light.z + z];
            let length_sq = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
            let h_along = normal.x * h[0] + normal.y * h[1] + normal.z * h[2];
            let square = h_along * h_along / if length_sq > f32::MIN_POSITIVE { length_sq } else { 1.0 };
            cos_sq[l] = if square < 1.0 { square } else { 1.0 };
            sin_sq[l] = 1.0 - cos_sq[l];
            cos[l] = if along < 1.0 { along } else { 1.0 };
        }
        let mut share = self.facets.density16(&sin_sq, &cos_sq);
        for l in 0..LANES {
            let limited = if cos[l] > 0.0 { cos[l] } else { 1.0 };
            let all = share[l] * self.facets.v1(limited) * limited * self.inv_bound;
            let all = if all < 1.0 { all } else { 1.0 };
            share[l] = if cos[l] > 0.0 { all } else { 0.0 };
        }
        share
    }

    /// Returns the squared roughness of GGX facets whose density, relative to its maximum, falls no faster with the
    /// inclination.
    pub fn width_sq(&self) -> f32 {
        self.facets.alpha
            * self.facets.alpha
            * if self.facets.distribution == Distribution::Ggx { 1.0 } else { 2.0 }
    }

    /// Returns an upper bound of the share at a cosine to the mirror direction of the light, for lobes of at most the
    /// given squared width. Facets are inclined by at least half the angle to the mirror direction.
    #[inline(always)]
    pub fn max_share(cos_mirror: f32, width_sq: f32) -> f32 {
        let sin_sq = 0.5 * (1.0 - cos_mirror);
        let narrow = 1.0 / width_sq - 1.0;
        let t = 1.0 + if narrow > 0.0 { narrow * sin_sq } else { 0.0 };
        1.0 / (t * t)
    }

    /// Returns the bound as intensity over reflected flux, 1/sr, for light at `cos`. `white` is the albedo of facets
    /// that absorb nothing.
    pub(super) fn peak(&self, cos: f32, white: f32) -> f32 {
        self.facets.v1(cos) / (self.inv_bound * white)
    }
}

/// Light that a lobe reflects from one direction.
#[derive(Clone, Copy, Debug)]
pub struct ReflectedLobe {
    /// Share of the flux that is reflected.
    pub albedo: Rgb,
    /// Bound of the intensity over the reflected flux, 1/sr.
    pub peak: f32,
    /// The light's distribution.
    pub shape: LobeShape,
}
