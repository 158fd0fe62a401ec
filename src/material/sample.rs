//! Choosing directions in proportion to what they carry: base or lobe by their expected share of the light,
//! cosine-weighted for the base, visible normals for a rough lobe.

use super::bsdf::{Bsdf, mean};
use super::fresnel;
use super::model::{Base, Scattering};
use crate::math::Rgb;
use crate::sampling::cosine_hemisphere;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Unit direction, away from the surface.
    pub wi: Vec3,
    /// BSDF · cos / pdf, for radiance. Flux (photons) is not compressed by refraction: multiply by `eta`².
    pub weight: Rgb,
    /// Density per solid angle; for a delta lobe, the probability of having chosen it.
    pub pdf: f32,
    /// Whether the lobe scatters into this direction only.
    pub delta: bool,
    /// Index of refraction on the side of `wi` over that on the side of `wo`; 1 unless refracted.
    pub eta: f32,
}

/// The directions in which light goes on without being spread, all of them, for following specular chains
/// without chance: each weight is what the lobe carries, each pdf is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeltaLobes {
    /// As by a mirror.
    pub reflection: Option<BsdfSample>,
    /// Through glass.
    pub refraction: Option<BsdfSample>,
}

impl Bsdf<'_> {
    /// Chooses `wi` with [`Bsdf::pdf`] (or a delta lobe): `u_lobe` picks base or lobe, `u` the direction.
    ///
    /// `None` where nothing is reflected, or the facet chosen sends the light into the surface: the path ends.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if let Scattering::Glass(_) = self.model.lobe {
            return self.sample_glass(wo, u_lobe);
        }
        let side = if wo.z < 0.0 && self.model.two_sided { -1.0 } else { 1.0 };
        let front = Vec3::new(wo.x, wo.y, wo.z * side);
        if front.z.is_nan() || front.z <= 0.0 {
            return None;
        }
        let mut sample = match (&self.model.base, &self.model.lobe) {
            (Base::Lambert, Scattering::None) => {
                let wi = cosine_hemisphere(u);
                BsdfSample { wi, weight: self.base * PI, pdf: wi.z * FRAC_1_PI, delta: false, eta: 1.0 }
            }
            _ => self.sample_layered(front, u_lobe, u)?,
        };
        sample.wi.z *= side;
        Some(sample)
    }

    fn sample_layered(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let outgoing = self.outgoing(wo);
        let base_probability = outgoing.base_probability;
        let smooth = |wi: Vec3, (value, pdf): (Rgb, f32)| {
            (pdf > 0.0).then(|| BsdfSample { wi, weight: value * (wi.z / pdf), pdf, delta: false, eta: 1.0 })
        };
        if u_lobe < base_probability {
            let wi = cosine_hemisphere(u);
            return smooth(wi, self.eval_pdf_layered(&outgoing, wi));
        }
        match &self.model.lobe {
            Scattering::Mirror(fresnel) => {
                let pdf = 1.0 - base_probability;
                let weight = self.scale * fresnel.reflectance(wo.z) / pdf;
                (pdf > 0.0).then_some(BsdfSample { wi: mirror(wo), weight, pdf, delta: true, eta: 1.0 })
            }
            Scattering::Rough(facets, _) => {
                let h = facets.sample_visible(wo, u);
                let wi = (2.0 * wo.dot(h)) * h - wo;
                if wi.z > 0.0 { smooth(wi, self.eval_pdf_rough(&outgoing, wi, h)) } else { None }
            }
            Scattering::None | Scattering::Glass(_) => None,
        }
    }

    fn sample_glass(&self, wo: Vec3, u_lobe: f32) -> Option<BsdfSample> {
        let lobes = self.delta_lobes(wo);
        let share = |lobe: Option<BsdfSample>| lobe.map_or(0.0, |s| mean(s.weight) * s.eta * s.eta);
        let (reflected, refracted) = (share(lobes.reflection), share(lobes.refraction));
        let probability = reflected / (reflected + refracted); // NaN (nothing goes on) picks neither
        let (lobe, pdf) = if u_lobe < probability {
            (lobes.reflection, probability)
        } else {
            (lobes.refraction, 1.0 - probability)
        };
        let lobe = lobe?;
        (pdf > 0.0).then_some(BsdfSample { weight: lobe.weight / pdf, pdf, ..lobe })
    }

    /// Every delta lobe as seen from `wo`.
    pub fn delta_lobes(&self, wo: Vec3) -> DeltaLobes {
        let lobe = |wi, weight, eta| Some(BsdfSample { wi, weight, pdf: 1.0, delta: true, eta });
        match &self.model.lobe {
            Scattering::Mirror(fresnel) if wo.z > 0.0 || (wo.z < 0.0 && self.model.two_sided) => {
                let weight = self.scale * fresnel.reflectance(wo.z.abs());
                DeltaLobes { reflection: lobe(mirror(wo), weight, 1.0), refraction: None }
            }
            Scattering::Glass(eta) if wo.z != 0.0 => {
                let interface = fresnel::interface(wo.z, *eta);
                let transmitted = 1.0 - interface.reflectance;
                let inv_eta = 1.0 / interface.eta;
                let through =
                    Vec3::new(-wo.x * inv_eta, -wo.y * inv_eta, -interface.cos_t.copysign(wo.z)).normalize();
                DeltaLobes {
                    reflection: lobe(mirror(wo), self.scale * interface.reflectance, 1.0),
                    // The solid angle of a pencil of rays changes at the interface, and radiance with it.
                    refraction: if transmitted > 0.0 {
                        lobe(through, self.transmittance * (transmitted * inv_eta * inv_eta), interface.eta)
                    } else {
                        None
                    },
                }
            }
            _ => DeltaLobes::default(),
        }
    }
}

/// Reflection about the shading normal.
#[inline]
fn mirror(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}
