//! A material at one point, and its value and sampling density.
//!
//! Units: `eval` is 1/sr, without the cosine; `pdf` is per solid angle.

use super::model::{Base, DIFFUSE_LOBE_ALPHA, Model, SHARP_LOBE_ALPHA, Scattering};
use crate::math::Rgb;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// A material at one point of a surface: textures are looked up, the rest is shared with [`super::Materials`].
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<'m> {
    pub(super) model: &'m Model,
    /// BRDF of the base, less the coat's transmittances by angle.
    pub(super) base: Rgb,
    /// Factor on reflection by the lobe.
    pub(super) scale: Rgb,
    /// Factor on refraction.
    pub(super) transmittance: Rgb,
}

/// What depends on `wo` alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outgoing {
    /// On the side of the normal, so z > 0.
    pub wo: Vec3,
    /// Of the coat.
    pub transmittance: f32,
    /// Probability of sampling the base rather than the lobe.
    pub base_probability: f32,
}

impl Bsdf<'_> {
    /// BSDF for light from `wi` seen from `wo`; delta lobes excluded; 0 where either is on a wrong side.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    /// Density with which [`Bsdf::sample`] chooses `wi`, delta lobes excluded.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] at once.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let Some((wo, wi)) = self.on_front(wo, wi) else { return (Rgb::ZERO, 0.0) };
        if self.is_lambert() {
            return (self.base, wi.z * FRAC_1_PI);
        }
        self.eval_pdf_layered(&self.outgoing(wo), wi)
    }

    /// True if light is scattered into more than isolated directions.
    #[inline]
    pub fn has_smooth(&self) -> bool {
        self.base != Rgb::ZERO
            || (matches!(self.model.lobe, Scattering::Rough(..)) && self.scale != Rgb::ZERO)
    }

    /// True if part of the light is reflected as by a mirror or refracted as by smooth glass.
    #[inline]
    pub fn has_delta(&self) -> bool {
        matches!(self.model.lobe, Scattering::Mirror(_) | Scattering::Glass(_))
    }

    /// Base and lobe apart, where the lobe is rough but so sharp (α ≤ 0.1) that light sampled along it
    /// says more than a sum over virtual lights, each of which would show as a highlight.
    #[inline]
    pub fn split_sharp_lobe(&self) -> Option<(Self, Self)> {
        match &self.model.lobe {
            Scattering::Rough(facets, _) if facets.alpha <= SHARP_LOBE_ALPHA && self.scale != Rgb::ZERO => {
                Some((Bsdf { scale: Rgb::ZERO, ..*self }, Bsdf { base: Rgb::ZERO, ..*self }))
            }
            _ => None,
        }
    }

    /// Whether the material is Lambertian and nothing else.
    #[inline]
    pub(super) fn is_lambert(&self) -> bool {
        matches!((&self.model.base, &self.model.lobe), (Base::Lambert, Scattering::None))
    }

    /// Which coat lies on the base (see [`super::Materials::coat_transmittance`]); 0 for none.
    #[inline]
    pub fn coat(&self) -> u32 {
        self.model.coat
    }

    /// Base and lobe apart, where both are smooth functions of direction: the BRDF of the base for light that has passed
    /// the coat on its way in, seen from the cosine `cos_out`; and the rest, if it reflects anything.
    #[inline]
    pub fn split_base(&self, cos_out: f32) -> (Rgb, Option<Self>) {
        let base = self.base * self.coat_transmittance(cos_out.abs());
        let glossy = matches!(self.model.lobe, Scattering::Rough(..)) && self.scale != Rgb::ZERO;
        (base, glossy.then_some(Bsdf { base: Rgb::ZERO, ..*self }))
    }

    /// The albedo, if the material is Lambertian and nothing else.
    #[inline]
    pub fn lambert_albedo(&self) -> Option<Rgb> {
        self.is_lambert().then(|| self.base * PI)
    }

    /// Whether the side away from the normal behaves as the front does.
    #[inline]
    pub fn two_sided(&self) -> bool {
        self.model.two_sided
    }

    /// Share of the flux arriving from `wi` that a virtual light in this place radiates diffusely, to the side
    /// of `wi`: what the base reflects (through the coat, if there is one, in and out) and, where the lobe is
    /// rough enough to pass for diffuse, what the lobe reflects.
    ///
    /// The virtual light's intensity per cosine is flux · `diffuse_albedo` / π.
    #[inline]
    pub fn diffuse_albedo(&self, wi: Vec3) -> Rgb {
        let Some((wi, _)) = self.on_front(wi, wi) else { return Rgb::ZERO };
        let mut albedo = self.base_albedo(self.coat_transmittance(wi.z));
        if let (Scattering::Rough(facets, _), Some(table)) = (&self.model.lobe, &self.model.lobe_albedo)
            && facets.alpha >= DIFFUSE_LOBE_ALPHA
        {
            albedo += self.scale * table.lookup(wi.z);
        }
        albedo
    }

    /// Both directions mirrored to the side of the normal, or `None` where nothing is reflected.
    #[inline]
    pub(super) fn on_front(&self, mut wo: Vec3, mut wi: Vec3) -> Option<(Vec3, Vec3)> {
        if wo.z < 0.0 && self.model.two_sided {
            wo.z = -wo.z;
            wi.z = -wi.z;
        }
        (wo.z > 0.0 && wi.z > 0.0 && !matches!(self.model.lobe, Scattering::Glass(_))).then_some((wo, wi))
    }

    /// What [`Bsdf::eval_pdf_layered`] and sampling need to know about `wo` (z > 0).
    #[inline]
    pub(super) fn outgoing(&self, wo: Vec3) -> Outgoing {
        let transmittance = self.coat_transmittance(wo.z);
        let base = mean(self.base_albedo(transmittance));
        let base_probability = if base > 0.0 {
            let lobe = match &self.model.lobe {
                Scattering::None | Scattering::Glass(_) => 0.0,
                Scattering::Mirror(fresnel) => mean(self.scale * fresnel.reflectance(wo.z)),
                Scattering::Rough(..) => match &self.model.lobe_albedo {
                    Some(table) => mean(self.scale * table.lookup(wo.z)),
                    None => mean(self.scale) * (1.0 - transmittance).max(0.0),
                },
            };
            base / (base + lobe)
        } else {
            0.0
        };
        Outgoing { wo, transmittance, base_probability }
    }

    #[inline]
    pub(super) fn eval_pdf_layered(&self, outgoing: &Outgoing, wi: Vec3) -> (Rgb, f32) {
        match self.model.lobe {
            Scattering::Rough(..) => {
                let h = outgoing.wo + wi;
                let length_sq = h.length_squared();
                if length_sq < 1e-20 {
                    return (Rgb::ZERO, 0.0); // both grazing and opposite: no facet is seen at all
                }
                self.eval_pdf_rough(outgoing, wi, h / length_sq.sqrt())
            }
            _ => self.eval_pdf_base(outgoing, wi),
        }
    }

    /// Base alone.
    #[inline]
    pub(super) fn eval_pdf_base(&self, outgoing: &Outgoing, wi: Vec3) -> (Rgb, f32) {
        if outgoing.base_probability == 0.0 {
            return (Rgb::ZERO, 0.0);
        }
        let transmittance = outgoing.transmittance * self.coat_transmittance(wi.z);
        (self.base * transmittance, outgoing.base_probability * wi.z * FRAC_1_PI)
    }

    /// Base and rough lobe, for the facet normal `h` half-way between the directions.
    #[inline]
    pub(super) fn eval_pdf_rough(&self, outgoing: &Outgoing, wi: Vec3, h: Vec3) -> (Rgb, f32) {
        let (mut value, mut pdf) = self.eval_pdf_base(outgoing, wi);
        if let Scattering::Rough(facets, fresnel) = &self.model.lobe {
            let density = facets.density(h);
            let cos_o = outgoing.wo.z.min(1.0);
            let masked = density * facets.v1(cos_o) * facets.v1(wi.z.min(1.0));
            value += self.scale * fresnel.reflectance(outgoing.wo.dot(h).min(1.0)) * masked;
            pdf += (1.0 - outgoing.base_probability) * 0.5 * density * facets.v1_exact(cos_o);
        }
        (value, pdf)
    }

    /// Share of the light at `cos` > 0 that passes the coat; 1 where there is none.
    #[inline]
    pub fn coat_transmittance(&self, cos: f32) -> f32 {
        self.model.base.coat_transmittance(cos)
    }

    /// Share of the light from one direction that the base reflects, given the coat's transmittance for it.
    #[inline]
    fn base_albedo(&self, transmittance: f32) -> Rgb {
        self.base * (PI * transmittance * self.model.mean_transmittance)
    }
}

/// Mean of the channels.
#[inline]
pub(super) fn mean(c: Rgb) -> f32 {
    (c.x + c.y + c.z) * (1.0 / 3.0)
}
