//! Specular reflection and refraction by a smooth dielectric interface: two lobes, each with its factor.

use super::mirror::reflect;
use super::{Delta, means};
use crate::material::fresnel;
use base::math::{Lane, V3};

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
    #[inline(always)]
    pub fn delta<L: Lane>(&self, scale: V3<L>, wo: V3<L>) -> Delta<L> {
        let interface = self.interface(wo.z);
        let (weight, one) = (self.weight(scale, &interface), L::from(1.0));
        let is_inclined = wo.z.abs().is_positive();
        let passes = is_inclined & one.gt(interface.reflectance);
        match self.passage {
            Passage::Reflection => {
                Delta { wi: reflect(wo), weight, eta: one, found: is_inclined, straight: false }
            }
            Passage::Refraction if self.passes_straight() => {
                Delta { wi: -wo, weight, eta: one, found: passes, straight: true }
            }
            Passage::Refraction => {
                let inv_eta = interface.eta.recip();
                let z = L::pick(wo.z.is_positive(), -interface.cos_t, interface.cos_t);
                let through = V3::new(-wo.x * inv_eta, -wo.y * inv_eta, z);
                let wi = through.times(through.length_sq().rsqrt());
                Delta { wi, weight, eta: interface.eta, found: passes, straight: false }
            }
        }
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline(always)]
    pub fn sampling_weight<L: Lane>(&self, scale: V3<L>, cos: L) -> L {
        let interface = self.interface(cos);
        let weight = means(self.weight(scale, &interface)).keep(cos.abs().is_positive());
        match self.passage {
            Passage::Reflection => weight,
            Passage::Refraction => weight * interface.eta.sq(),
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
    #[inline(always)]
    fn interface<L: Lane>(&self, cos: L) -> fresnel::Refraction<L> {
        if !self.thin {
            return fresnel::interface(cos, self.eta);
        }
        let one = fresnel::interface(cos.abs(), self.eta).reflectance;
        let reflectance = one * 2.0 / (one + L::from(1.0));
        fresnel::Refraction { reflectance, cos_t: cos.abs(), eta: L::from(1.0) }
    }

    /// Returns the factor on radiance.
    #[inline(always)]
    fn weight<L: Lane>(&self, scale: V3<L>, interface: &fresnel::Refraction<L>) -> V3<L> {
        match self.passage {
            Passage::Reflection => scale.times(interface.reflectance),
            // Refraction changes the solid angle of a pencil of rays, and radiance with it.
            Passage::Refraction => scale.times(interface.reflectance.rest() / interface.eta.sq()),
        }
    }
}
