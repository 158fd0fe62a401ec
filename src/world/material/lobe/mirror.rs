//! Specular reflection on the front of a surface.

use super::Delta;
use crate::material::fresnel::Curve;
use base::math::{Lane, V3};
use scene::Fresnel;

/// Mirror with a reflectance by angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) struct Mirror {
    pub fresnel: Fresnel,
}

impl Mirror {
    /// See [`super::LobeModel::delta`].
    #[inline(always)]
    pub fn delta<L: Lane>(&self, scale: V3<L>, wo: V3<L>) -> Delta<L> {
        let (weight, found) = (self.weight(scale, wo.z), wo.z.is_positive());
        Delta { wi: reflect(wo), weight, eta: L::from(1.0), found, straight: false }
    }

    /// Returns the share of the light at the cosine `cos` > 0 that is reflected.
    #[inline(always)]
    pub fn weight<L: Lane>(&self, scale: V3<L>, cos: L) -> V3<L> {
        scale * self.fresnel.reflected(cos)
    }
}

/// Reflects about the shading normal.
#[inline(always)]
pub(super) fn reflect<L: Lane>(wo: V3<L>) -> V3<L> {
    V3::new(-wo.x, -wo.y, wo.z)
}
