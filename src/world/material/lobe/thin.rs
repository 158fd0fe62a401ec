//! Transmission through a thin sheet: diffuse, or by a rough lobe around the direction of the light.
//!
//! The rough lobe is a reflection by facets whose direction is turned to the other side, as in Mitsuba's plugin
//! `principledthin`. The rest of the Fresnel reflectance is transmitted.
//!
//! Paper: B. Burley, *Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering*, 2015, section 5.
//! Deviations: there is no bound, because lightcuts gather on one side: eye paths follow these lobes.

use super::{AnisotropicLobe, Facet, RoughLobe};
use crate::material::fresnel;
use base::math::{Rgb, V3};
use base::sampling::cosine_hemisphere;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Lobe of transmission through a thin sheet, without its factor.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::material) enum Thin {
    /// Lambertian transmission.
    Diffuse,
    /// Transmission around the direction of the light.
    Rough {
        /// Facets that reflect the light, which is then turned.
        facets: ThinFacets,
        /// Index of refraction of the sheet, which determines the share of transmitted light.
        eta: f32,
    },
}

/// Reflection by facets of reflectance 1.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::material) enum ThinFacets {
    /// Facets of the same roughness in all directions.
    Isotropic(RoughLobe),
    /// Facets of different roughness along u and v.
    Anisotropic(AnisotropicLobe),
}

impl ThinFacets {
    fn min_alpha(&self) -> f32 {
        match self {
            ThinFacets::Isotropic(rough) => rough.alpha(),
            ThinFacets::Anisotropic(rough) => rough.min_alpha(),
        }
    }

    fn value_pdf(&self, facet: &Facet<f32>) -> (Rgb, f32) {
        let (value, pdf) = match self {
            ThinFacets::Isotropic(rough) => rough.value_pdf(&rough.seen(facet.wo), facet),
            ThinFacets::Anisotropic(rough) => rough.value_pdf(&rough.seen(facet.wo), facet),
        };
        (value.into(), pdf)
    }

    fn sample(&self, wo: Vec3, u: Vec2) -> Facet<f32> {
        let (wo, u) = (V3::splat(wo), u.to_array());
        match self {
            ThinFacets::Isotropic(rough) => rough.sample(wo, u),
            ThinFacets::Anisotropic(rough) => rough.sample(wo, u),
        }
    }
}

/// Returns a direction turned to the other side.
#[inline]
fn through(v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.y, -v.z)
}

impl Thin {
    /// Returns the minimum roughness α; 1 for diffuse transmission.
    pub fn min_alpha(&self) -> f32 {
        match self {
            Thin::Diffuse => 1.0,
            Thin::Rough { facets, .. } => facets.min_alpha(),
        }
    }

    /// Returns value and density for directions on any side.
    pub fn value_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        const NOTHING: (Rgb, f32) = (Rgb::ZERO, 0.0);
        if !(wo.z > 0.0 && wi.z < 0.0) {
            return NOTHING;
        }
        match self {
            Thin::Diffuse => (Rgb::splat(FRAC_1_PI), -wi.z * FRAC_1_PI),
            Thin::Rough { facets, eta } => {
                let turned = Facet::<f32>::between(V3::splat(wo), V3::splat(through(wi)));
                if !(turned.reflects && is_lit(wi, &turned)) {
                    return NOTHING;
                }
                let (value, pdf) = facets.value_pdf(&turned);
                (value * (1.0 - fresnel::dielectric(turned.cos_d.max(0.0), *eta)), pdf)
            }
        }
    }

    /// Samples a direction; `None` if the facet scatters light to the wrong side.
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Vec3> {
        match self {
            _ if !(wo.z > 0.0) => None,
            Thin::Diffuse => Some(through(cosine_hemisphere(u))),
            Thin::Rough { facets, .. } => {
                let turned = facets.sample(wo, u);
                let wi = through(turned.wi.into());
                (turned.reflects && is_lit(wi, &turned)).then_some(wi)
            }
        }
    }

    /// Estimates the share of the light at `cos` that the lobe transmits, by a smooth sheet.
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        match self {
            _ if !(cos > 0.0) => Rgb::ZERO,
            Thin::Diffuse => scale,
            Thin::Rough { eta, .. } => scale * (1.0 - fresnel::dielectric(cos.min(1.0), *eta)),
        }
    }
}

/// Returns true if the direction leaves a facet on the side away from its normal.
#[inline]
fn is_lit(wi: Vec3, facet: &Facet<f32>) -> bool {
    wi.dot(facet.half.into()) < 0.0
}
