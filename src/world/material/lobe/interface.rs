//! Specular reflection and refraction by a smooth dielectric interface: two lobes, each with its factor.

use super::BsdfSample;
use super::mean;
use super::mirror::reflect;
use crate::material::fresnel;
use base::math::Rgb;
use glam::Vec3;

/// Smooth interface, for either reflection or refraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) struct Interface {
    /// Index of refraction behind the normal over that in front.
    pub eta: f32,
    /// True for both interfaces of a thin sheet together.
    pub thin: bool,
    pub passage: Passage,
}

/// Reflection or refraction at an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::material) enum Passage {
    Reflection,
    Refraction,
}

impl Interface {
    /// See [`super::LobeModel::delta`]; `wo` may be on either side.
    #[inline]
    pub fn delta(&self, scale: Rgb, wo: Vec3) -> Option<BsdfSample> {
        let interface = self.interface(wo.z);
        let weight = self.weight(scale, &interface);
        match self.passage {
            _ if wo.z == 0.0 => None,
            Passage::Reflection => Some(BsdfSample::delta(reflect(wo), weight, 1.0)),
            Passage::Refraction if interface.reflectance >= 1.0 => None,
            Passage::Refraction if self.passes_straight() => {
                Some(BsdfSample { straight: true, ..BsdfSample::delta(-wo, weight, 1.0) })
            }
            Passage::Refraction => {
                let inv_eta = 1.0 / interface.eta;
                let z = -interface.cos_t.copysign(wo.z);
                let through = Vec3::new(-wo.x * inv_eta, -wo.y * inv_eta, z).normalize();
                Some(BsdfSample::delta(through, weight, interface.eta))
            }
        }
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline]
    pub fn sampling_weight(&self, scale: Rgb, cos: f32) -> f32 {
        let interface = self.interface(cos);
        let weight = mean(self.weight(scale, &interface));
        match self.passage {
            _ if cos == 0.0 => 0.0,
            Passage::Reflection => weight,
            Passage::Refraction => weight * interface.eta * interface.eta,
        }
    }

    /// Returns true if light keeps its direction.
    #[inline]
    pub fn passes_straight(&self) -> bool {
        self.passage == Passage::Refraction && (self.thin || self.eta == 1.0)
    }

    /// Returns true if light changes its direction.
    pub fn bends(&self) -> bool {
        self.eta != 1.0 && !self.passes_straight()
    }

    /// Solves the interface; for a thin sheet, both interfaces with all reflections between them.
    #[inline]
    fn interface(&self, cos: f32) -> fresnel::Refraction {
        if !self.thin {
            return fresnel::interface(cos, self.eta);
        }
        let one = fresnel::interface(cos.abs(), self.eta);
        let reflectance = 2.0 * one.reflectance / (1.0 + one.reflectance);
        fresnel::Refraction { reflectance, cos_t: cos.abs(), eta: 1.0 }
    }

    /// Returns the factor on radiance.
    #[inline]
    fn weight(&self, scale: Rgb, interface: &fresnel::Refraction) -> Rgb {
        match self.passage {
            Passage::Reflection => scale * interface.reflectance,
            Passage::Refraction => {
                let inv_eta = 1.0 / interface.eta;
                // Refraction changes the solid angle of a pencil of rays, and radiance with it.
                scale * ((1.0 - interface.reflectance) * inv_eta * inv_eta)
            }
        }
    }
}
