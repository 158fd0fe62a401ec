//! Transmission through a thin sheet: diffuse, or by a rough lobe around the direction of the light.
//!
//! The rough lobe is a reflection by facets whose direction is turned to the other side, as in Mitsuba's plugin
//! `principledthin`. The rest of the Fresnel reflectance is transmitted.
//!
//! Paper: B. Burley, *Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering*, 2015, section 5.
//! Deviations: there is no bound, because lightcuts gather on one side: eye paths follow these lobes.

use super::{AnisotropicLobe, Directions, RoughLobe};
use crate::material::fresnel;
use base::math::Rgb;
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

    fn eval_pdf(&self, scale: Rgb, probability: f32, d: &Directions) -> (Rgb, f32) {
        match self {
            ThinFacets::Isotropic(rough) => rough.eval_pdf(scale, probability, d),
            ThinFacets::Anisotropic(rough) => rough.eval_pdf(scale, probability, d),
        }
    }

    fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
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

    /// See [`super::LobeModel::eval_pdf`].
    pub fn eval_pdf(&self, scale: Rgb, probability: f32, d: &Directions) -> (Rgb, f32) {
        const NOTHING: (Rgb, f32) = (Rgb::ZERO, 0.0);
        if !(d.wo.z > 0.0 && d.wi.z < 0.0) {
            return NOTHING;
        }
        match self {
            Thin::Diffuse => (scale * FRAC_1_PI, probability * -d.wi.z * FRAC_1_PI),
            Thin::Rough { facets, eta } => match Directions::new(d.wo, through(d.wi)) {
                Some(turned) if is_lit(d.wi, turned.half) => {
                    let (value, pdf) = facets.eval_pdf(scale, probability, &turned);
                    (value * (1.0 - fresnel::dielectric(d.wo.dot(turned.half).clamp(0.0, 1.0), *eta)), pdf)
                }
                _ => NOTHING,
            },
        }
    }

    /// See [`super::LobeModel::sample`].
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
        if !(wo.z > 0.0) {
            return None;
        }
        match self {
            Thin::Diffuse => Some(Directions { wo, wi: through(cosine_hemisphere(u)), half: Vec3::Z }),
            Thin::Rough { facets, .. } => {
                let turned = facets.sample(wo, u)?;
                let wi = through(turned.wi);
                is_lit(wi, turned.half).then_some(Directions { wi, ..turned })
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
fn is_lit(wi: Vec3, half: Vec3) -> bool {
    wi.dot(half) < 0.0
}
