//! Specular reflection on the front of a surface.

use super::BsdfSample;
use crate::material::fresnel::Curve;
use base::math::Rgb;
use glam::Vec3;
use scene::Fresnel;

/// Mirror with a reflectance by angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) struct Mirror {
    pub fresnel: Fresnel,
}

impl Mirror {
    /// See [`super::LobeModel::delta`].
    #[inline]
    pub fn delta(&self, scale: Rgb, wo: Vec3) -> Option<BsdfSample> {
        (wo.z > 0.0).then(|| BsdfSample::delta(reflect(wo), self.weight(scale, wo.z), 1.0))
    }

    /// Returns the share of the light at the cosine `cos` that is reflected.
    #[inline]
    pub fn weight(&self, scale: Rgb, cos: f32) -> Rgb {
        if cos > 0.0 { scale * self.fresnel.reflectance(cos) } else { Rgb::ZERO }
    }
}

/// Reflects about the shading normal.
#[inline]
pub(super) fn reflect(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}
