//! Directional distribution of the light that a rough lobe reflects from one direction, for virtual lights.
//!
//! The intensity in direction ω for light from ωi is proportional to D(h) V1(ω) cos θ with the half-way normal h. The
//! maxima of D and of V1 cos θ = G1 / 2 bound it.
//!
//! Paper: Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, 2007.
//! Deviations: the Fresnel reflectance is that of the whole lobe and does not depend on the direction.

use crate::material::microfacet::Microfacets;
use base::math::{Lane, Rgb, V3};
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
    #[inline(always)]
    pub fn share<L: Lane>(&self, normal: Vec3, towards_light: Vec3, away: V3<L>) -> L {
        let one = L::from(1.0);
        let cos = away.along(normal).min(one);
        let half = V3::splat(towards_light) + away;
        let (length_sq, along) = (half.length_sq(), half.along(normal));
        let lit = cos.is_positive() & length_sq.gt(L::from(f32::MIN_POSITIVE));
        let cos_sq = (along.sq() * length_sq.recip()).min(one);
        let share = self.facets.density(cos_sq.rest(), cos_sq) * self.facets.v1(cos) * cos;
        (share * self.inv_bound).min(one).keep(lit)
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
    pub fn max_share<L: Lane>(cos_mirror: L, width_sq: f32) -> L {
        let narrow = (1.0 / width_sq - 1.0).max(0.0);
        let t = L::from(1.0) + cos_mirror.rest() * (0.5 * narrow);
        t.sq().recip()
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
