//! Reflection and refraction by the facets of a rough dielectric interface: two lobes, each with its factor.
//!
//! Paper: Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, 2007, equations 20 and 21.
//! Deviations: single scattering only. There is no bound, because lightcuts gather on one side: eye paths follow these
//! lobes for any roughness.

use super::interface::Passage;
use super::mean;
use crate::material::fresnel;
use crate::material::microfacet::Microfacets;
use base::math::{Rgb, V3};
use glam::{Vec2, Vec3};

/// Minimum share of the samples for reflection and for refraction. Inclined facets may reflect or refract light that a
/// smooth interface would not.
const MIN_SHARE: f32 = 0.1;

/// Rough interface, for either reflection or refraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) struct RoughInterface {
    pub facets: Microfacets,
    /// Index of refraction behind the normal over that in front; not 1.
    pub eta: f32,
    pub passage: Passage,
    /// True if the lobe scatters only light from behind the normal.
    pub inside_only: bool,
}

/// Two directions, turned so that `wo` is on the side of the normal.
struct Facing {
    wo: Vec3,
    wi: Vec3,
    /// -1 if turned, else 1.
    side: f32,
    /// Index of refraction on the far side over that on the side of `wo`.
    eta: f32,
}

impl RoughInterface {
    /// Returns the index of refraction on the far side over that on the side of the cosine `cos_o` for refraction; 1
    /// for reflection.
    #[inline]
    pub fn refraction(&self, cos_o: f32) -> f32 {
        match self.passage {
            Passage::Reflection => 1.0,
            Passage::Refraction => self.eta_from(cos_o),
        }
    }

    /// Returns the index of refraction on the far side over that on the side of the cosine `cos`.
    #[inline]
    fn eta_from(&self, cos: f32) -> f32 {
        if cos >= 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// Turns two directions to the side of `wo`; `None` if the lobe scatters nothing there.
    #[inline]
    fn facing(&self, wo: Vec3, wi: Vec3) -> Option<Facing> {
        if wo.z == 0.0 || self.inside_only && wo.z > 0.0 {
            return None;
        }
        let side = 1.0f32.copysign(wo.z);
        let turned = |v: Vec3| Vec3::new(v.x, v.y, v.z * side);
        Some(Facing { wo: turned(wo), wi: turned(wi), side, eta: self.eta_from(wo.z) })
    }

    /// Returns value and density for directions on any side.
    pub fn value_pdf(&self, wo: Vec3, wi: Vec3) -> (f32, f32) {
        const NOTHING: (f32, f32) = (0.0, 0.0);
        let Some(Facing { wo, wi, eta, .. }) = self.facing(wo, wi) else { return NOTHING };
        let reflects = self.passage == Passage::Reflection;
        if wi.z == 0.0 || (wi.z > 0.0) != reflects {
            return NOTHING;
        }
        let sum = if reflects { wo + wi } else { wo + eta * wi };
        let Some(half) = sum.try_normalize() else { return NOTHING };
        let half = if half.z < 0.0 { -half } else { half };
        let (cos_o, cos_i) = (wo.dot(half), wi.dot(half));
        if cos_o <= 0.0 || (cos_i > 0.0) != reflects {
            return NOTHING;
        }
        let density = self.facets.density(half.x * half.x + half.y * half.y, half.z * half.z);
        let (out, into) = (wo.z.min(1.0), wi.z.abs().min(1.0));
        let masked = density * self.facets.v1(out) * self.facets.v1(into);
        let visible = 2.0 * density * self.facets.v1_exact(out) * cos_o;
        let reflectance = fresnel::dielectric(cos_o.min(1.0), eta);
        let (value, per_angle) = match reflects {
            true => (reflectance * masked, 0.25 / cos_o),
            false => {
                let root = cos_o + eta * cos_i;
                // Refraction scales radiance by the squared index, which cancels the index in the Jacobian.
                let change = -cos_i / (root * root);
                ((1.0 - reflectance) * masked * 4.0 * cos_o * change, eta * eta * change)
            }
        };
        let pdf = visible * per_angle;
        if value.is_finite() && pdf.is_finite() { (value, pdf) } else { NOTHING }
    }

    /// Samples a direction; `None` if the facet scatters light to the wrong side.
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Vec3> {
        let facing = self.facing(wo, wo)?;
        let half = Vec3::from(self.facets.sample_visible(V3::splat(facing.wo), u.to_array()));
        let cos = facing.wo.dot(half);
        let mut wi = match self.passage {
            Passage::Reflection => 2.0 * cos * half - facing.wo,
            Passage::Refraction => {
                let interface = fresnel::interface(cos.min(1.0), facing.eta);
                if cos <= 0.0 || interface.reflectance >= 1.0 {
                    return None;
                }
                ((cos / facing.eta - interface.cos_t) * half - facing.wo / facing.eta).normalize()
            }
        };
        if cos <= 0.0 || wi.z == 0.0 || (wi.z > 0.0) != (self.passage == Passage::Reflection) {
            return None;
        }
        wi.z *= facing.side;
        Some(wi)
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline]
    pub fn sampling_weight(&self, scale: Rgb, cos: f32) -> f32 {
        mean(self.albedo(scale, cos))
    }

    /// Estimates the share of the light at `cos` that the lobe scatters, by a smooth interface.
    #[inline]
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        if cos == 0.0 || self.inside_only && cos > 0.0 {
            return Rgb::ZERO;
        }
        let reflectance = fresnel::interface(cos, self.eta).reflectance;
        let share = MIN_SHARE + (1.0 - 2.0 * MIN_SHARE) * reflectance;
        scale * if self.passage == Passage::Reflection { share } else { 1.0 - share }
    }
}
