//! Specular reflection and refraction by a smooth dielectric interface, two lobes with a factor each.

use super::mean;
use super::mirror::reflect;
use crate::material::fresnel;
use crate::material::sample::BsdfSample;
use crate::math::Rgb;
use glam::Vec3;

/// Interface, of which one of the two ways on is this lobe's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) struct Interface {
    /// Index of refraction behind the normal over that in front.
    pub eta: f32,
    pub passage: Passage,
}

/// Way on from an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::material) enum Passage {
    Reflection,
    Refraction,
}

impl Interface {
    /// See [`super::LobeModel::delta`]; `wo` may be on either side.
    #[inline]
    pub fn delta(&self, scale: Rgb, wo: Vec3) -> Option<BsdfSample> {
        let interface = fresnel::interface(wo.z, self.eta);
        let weight = self.weight(scale, &interface);
        match self.passage {
            _ if wo.z == 0.0 => None,
            Passage::Reflection => Some(BsdfSample::delta(reflect(wo), weight, 1.0)),
            Passage::Refraction if interface.reflectance >= 1.0 => None,
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
        let interface = fresnel::interface(cos, self.eta);
        let weight = mean(self.weight(scale, &interface));
        match self.passage {
            _ if cos == 0.0 => 0.0,
            Passage::Reflection => weight,
            Passage::Refraction => weight * interface.eta * interface.eta,
        }
    }

    /// Returns the factor on radiance.
    #[inline]
    fn weight(&self, scale: Rgb, interface: &fresnel::Interface) -> Rgb {
        match self.passage {
            Passage::Reflection => scale * interface.reflectance,
            Passage::Refraction => {
                let inv_eta = 1.0 / interface.eta;
                // The solid angle of a pencil of rays changes at the interface, and radiance with it.
                scale * ((1.0 - interface.reflectance) * inv_eta * inv_eta)
            }
        }
    }
}
