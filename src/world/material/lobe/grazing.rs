//! Broad scattering at grazing angles: retroreflection of rough diffuse surfaces and sheen of fibres, for the
//! principled material.
//!
//! Paper: B. Burley, *Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering*, 2015, equation 4;
//! *Physically Based Shading at Disney*, 2012, section 5.2.

use super::{DirectionBound, Facet, FacetBound, SeenLobe};
use crate::material::fresnel::schlick_weight;
use crate::material::table::{AngleTable, rule};
use base::math::{Lane, V3};
use base::sampling::cosine_direction;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::Arc;

/// Kind of grazing scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) enum GrazingKind {
    /// Retroreflection of a rough diffuse surface.
    Retro {
        /// Square root of α.
        roughness: f32,
    },
    /// Sheen of fibres.
    Sheen,
}

/// Lobe of grazing scattering without its factor.
#[derive(Clone, Debug)]
pub(in crate::material) struct Grazing {
    kind: GrazingKind,
    /// Albedo by angle.
    albedo: Arc<AngleTable<f32>>,
}

impl PartialEq for Grazing {
    fn eq(&self, other: &Grazing) -> bool {
        self.kind == other.kind
    }
}

impl GrazingKind {
    /// Returns the value in 1/sr from the weights of Schlick's approximation for both directions and the cosine between
    /// either direction and the half-way normal. The value grows with both weights. It grows with the cosine for
    /// retroreflection and falls for sheen.
    #[inline(always)]
    fn value<L: Lane>(self, [out, into]: [L; 2], cos_d: L) -> L {
        match self {
            GrazingKind::Retro { roughness } => {
                let r = cos_d.sq() * (2.0 * roughness);
                r * (out + into + out * into * (r - L::from(1.0))) * FRAC_1_PI
            }
            GrazingKind::Sheen => schlick_weight(cos_d),
        }
    }

    /// Returns the maximum value for cosines with the half-way normal of at least `cos_d`.
    #[inline(always)]
    fn max_value<L: Lane>(self, weights: [L; 2], cos_d: L) -> L {
        match self {
            GrazingKind::Retro { .. } => self.value(weights, L::from(1.0)),
            GrazingKind::Sheen => self.value(weights, cos_d),
        }
    }
}

impl Grazing {
    /// Builds a lobe and tabulates its albedo.
    pub fn new(kind: GrazingKind) -> Grazing {
        let nodes = rule(24);
        let albedo = AngleTable::new(|wo| {
            let mut sum = 0.0;
            for &(u, weight_u) in &nodes {
                // Equal steps of the squared cosine are equal in irradiance.
                let (cos, sin) = (u.sqrt(), (1.0 - u).sqrt());
                for &(v, weight_v) in &nodes {
                    let (sin_phi, cos_phi) = (PI * v).sin_cos();
                    let wi = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
                    let facet = Facet::<f32>::between(V3::splat(wo), V3::splat(wi));
                    if facet.reflects {
                        let weights = [schlick_weight(wo.z), schlick_weight(wi.z)];
                        sum += weight_u * weight_v * PI * kind.value(weights, facet.cos_d);
                    }
                }
            }
            sum
        });
        Grazing { kind, albedo: Arc::new(albedo) }
    }

    /// See [`super::LobeModel::seen`].
    #[inline(always)]
    pub(super) fn seen<L: Lane>(&self, wo: V3<L>) -> SeenLobe<L> {
        SeenLobe { masking: self.max_masking(wo.z), density: L::from(FRAC_1_PI) }
    }

    /// See [`super::LobeModel::value_pdf`].
    #[inline(always)]
    pub(super) fn value_pdf<L: Lane>(&self, seen: &SeenLobe<L>, facet: &Facet<L>) -> (V3<L>, L) {
        let value = self.kind.value([seen.masking, schlick_weight(facet.wi.z)], facet.cos_d);
        (V3::grey(value), facet.wi.z * seen.density)
    }

    /// See [`super::LobeModel::sample`].
    #[inline(always)]
    pub(super) fn sample<L: Lane>(&self, wo: V3<L>, u: [L; 2]) -> Facet<L> {
        Facet::between(wo, cosine_direction(u))
    }

    /// Returns the albedo for light at the cosine `cos` > 0.
    #[inline(always)]
    pub(super) fn albedo<L: Lane>(&self, scale: V3<L>, cos: L) -> V3<L> {
        scale.times(cos.each(|cos| self.albedo.lookup(cos)))
    }

    /// See [`super::LobeModel::max_masking`].
    #[inline(always)]
    pub(super) fn max_masking<L: Lane>(&self, cos_o: L) -> L {
        schlick_weight(cos_o)
    }

    /// See [`super::LobeModel::bound`].
    #[inline(always)]
    pub(super) fn bound<L: Lane>(&self, masking: L, bound: &FacetBound<L>) -> V3<L> {
        let most = self.kind.max_value([masking, schlick_weight(bound.cos_min)], bound.cos_d);
        V3::grey(most * bound.cos_max * DirectionBound::WIDER)
    }
}
