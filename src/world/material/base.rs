//! The Lambertian base of a material, under a dielectric coat if it has one.
//!
//! Definitions are those of Mitsuba's `plastic` and `roughplastic`. The coat's transmittance attenuates the base on the
//! way in and out, and light is reflected back and forth between base and coat. Rules are those of `roughplastic`, too:
//! tables of 64 cosines, evenly spaced and linear between them; single scattering only; the internal reflectance is the
//! plain mean over the 64 cosines.

use super::fresnel;
use super::microfacet::Microfacets;
use super::table::{ANGLES, AngleTable, albedo, direction, rule};
use base::math::{Lane, Rgb, V3};
use glam::Vec3;
use scene::{Coat, Fresnel};
use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::Arc;

/// Base without its colour, and the coat on it.
#[derive(Clone, Debug)]
pub(super) struct BaseModel {
    pub interface: CoatInterface,
    /// Cosine-weighted mean of the coat's transmittance; 1 if there is no coat.
    mean_transmittance: f32,
    /// Share of the base's light that the coat reflects back to it.
    internal_reflectance: f32,
    /// BRDF per albedo, without the transmittances and the gain of internal reflection.
    factor: f32,
    /// True if internal reflection shifts the colour.
    nonlinear: bool,
}

/// Surface of the coat.
#[derive(Clone, Debug)]
pub(super) enum CoatInterface {
    /// There is no coat.
    None,
    /// Smooth interface of this index of refraction.
    Smooth(f32),
    /// Attenuation of the principled material's base, which takes half of the light at grazing angles.
    Burley,
    /// Rough interface, or microfacets over the base that take the light that they reflect.
    Rough(Arc<RoughCoat>),
}

impl PartialEq for CoatInterface {
    /// Returns true if both pass the same light.
    fn eq(&self, other: &CoatInterface) -> bool {
        match (self, other) {
            (CoatInterface::None, CoatInterface::None) | (CoatInterface::Burley, CoatInterface::Burley) => {
                true
            }
            (CoatInterface::Smooth(a), CoatInterface::Smooth(b)) => a == b,
            (CoatInterface::Rough(a), CoatInterface::Rough(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

impl CoatInterface {
    /// Returns the share of the light at each cosine that passes; 1 if there is no coat. Cosines below 0 count as 0.
    #[inline(always)]
    pub fn transmittance<L: Lane>(&self, cos: L) -> L {
        match self {
            CoatInterface::None => L::from(1.0),
            CoatInterface::Smooth(eta) => fresnel::dielectric(cos, *eta).rest(),
            CoatInterface::Burley => (fresnel::schlick_weight(cos) * 0.5).rest(),
            CoatInterface::Rough(coat) => cos.each(|cos| coat.transmittance.lookup(cos)),
        }
    }

    /// Returns the maximum transmittance at `cos` > 0 or any smaller cosine.
    #[inline(always)]
    pub fn max_transmittance<L: Lane>(&self, cos: L) -> L {
        match self {
            CoatInterface::Rough(coat) => cos.each(|cos| coat.max_transmittance.lookup(cos)),
            _ => self.transmittance(cos),
        }
    }
}

impl BaseModel {
    /// Builds the base under `coat`, whose surface is `interface`.
    pub fn new(coat: Option<Coat>, interface: CoatInterface) -> BaseModel {
        let (mean_transmittance, internal_reflectance) = match &interface {
            CoatInterface::None => (1.0, 0.0),
            CoatInterface::Burley => (1.0 - 1.0 / 42.0, 0.0),
            // The mean transmittance outside follows from the reflectance inside by reciprocity. The fit inside
            // determines the brightness of the base, so both come from it.
            CoatInterface::Smooth(eta) => {
                let internal = fresnel::diffuse_reflectance(1.0 / eta);
                (eta * eta * (1.0 - internal), internal)
            }
            CoatInterface::Rough(coat) => (coat.mean_transmittance, coat.internal_reflectance),
        };
        let coat = coat.unwrap_or(Coat { eta: 1.0, nonlinear: false });
        let factor = FRAC_1_PI / (coat.eta * coat.eta);
        BaseModel { interface, mean_transmittance, internal_reflectance, factor, nonlinear: coat.nonlinear }
    }

    /// Returns true if the BRDF is proportional to the albedo.
    pub fn is_linear(&self) -> bool {
        !self.nonlinear || self.internal_reflectance == 0.0
    }

    /// Returns the BRDF without the coat's transmittances.
    #[inline]
    pub fn brdf(&self, albedo: Rgb) -> Rgb {
        if self.internal_reflectance == 0.0 {
            return albedo * self.factor;
        }
        let returned = if self.nonlinear { albedo.min(Rgb::ONE) } else { Rgb::ONE };
        albedo * self.factor / (1.0 - returned * self.internal_reflectance)
    }

    /// Returns the share of the light from one direction that is reflected, from the BRDF times the coat's
    /// transmittance in that direction.
    #[inline(always)]
    pub fn albedo<L: Lane>(&self, brdf: V3<L>) -> V3<L> {
        brdf.times(L::from(PI * self.mean_transmittance))
    }
}

/// Tables of a rough dielectric interface over the base.
#[derive(Clone, Debug)]
pub(super) struct RoughCoat {
    /// Share of the light from outside that enters.
    transmittance: AngleTable<f32>,
    /// Maximum transmittance at this or any smaller cosine.
    max_transmittance: AngleTable<f32>,
    mean_transmittance: f32,
    internal_reflectance: f32,
}

impl RoughCoat {
    /// Tabulates an interface of the given microfacets and index of refraction.
    pub fn new(facets: &Microfacets, eta: f32) -> RoughCoat {
        // The integrand has a kink at the critical angle, which needs more nodes.
        let (coarse, fine) = (rule(32), rule(128));
        let (outside_rule, inside_rule) = if eta > 1.0 { (&coarse, &fine) } else { (&fine, &coarse) };
        let transmittance = AngleTable::new(|wo| transmittance(facets, eta, wo, outside_rule));
        let inside = Fresnel::Dielectric(1.0 / eta);
        let reflected = AngleTable::new(|wo| albedo(facets, &inside, wo, inside_rule).x);
        let internal_reflectance =
            (0..ANGLES).map(|i| reflected.0[i] * direction(i).z).sum::<f32>() * 2.0 / ANGLES as f32;
        RoughCoat::with(transmittance, internal_reflectance)
    }

    /// Returns the tables of microfacets of this albedo, which let all other light pass. The base then reflects its
    /// albedo times the light that passes from one direction.
    pub fn over(albedo: &AngleTable<Rgb>) -> RoughCoat {
        let transmittance = AngleTable(albedo.0.map(|reflected| 1.0 - reflected.x));
        RoughCoat::with(transmittance, 1.0 - transmittance.mean())
    }

    fn with(transmittance: AngleTable<f32>, internal_reflectance: f32) -> RoughCoat {
        let mut max_transmittance = transmittance;
        for i in 1..ANGLES {
            max_transmittance.0[i] = max_transmittance.0[i].max(max_transmittance.0[i - 1]);
        }
        RoughCoat {
            mean_transmittance: transmittance.mean(),
            transmittance,
            max_transmittance,
            internal_reflectance: internal_reflectance.clamp(0.0, 0.999),
        }
    }
}

/// Integrates the light from `wo` that single scattering on the facets refracts to the other side.
fn transmittance(facets: &Microfacets, eta: f32, wo: Vec3, rule: &[(f32, f32)]) -> f32 {
    let mean = facets.mean_over_visible(wo, rule, |h| {
        let cos = wo.dot(h).min(1.0);
        let interface = fresnel::interface(cos, eta);
        let wi = (cos / interface.eta - interface.cos_t) * h - wo / interface.eta;
        if cos <= 0.0 || wi.z >= 0.0 {
            return Rgb::ZERO;
        }
        let cos_t = (-wi.z).min(1.0);
        Rgb::splat((1.0 - interface.reflectance) * 2.0 * cos_t * facets.v1(cos_t))
    });
    mean.x
}
