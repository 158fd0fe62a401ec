//! Lobes that scatter light broadly, to be tabulated.

use super::{Facet, LobeModel};
use base::math::{Rgb, V3};
use glam::Vec3;

/// A lobe, without its factor, that is neither a delta lobe nor followed by eye paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DullLobe<'m>(&'m LobeModel);

impl<'m> DullLobe<'m> {
    /// Wraps a lobe.
    pub(in crate::material) fn new(lobe: &'m LobeModel) -> DullLobe<'m> {
        DullLobe(lobe)
    }

    /// Returns the roughness α; infinity for lobes without microfacets, which are broader.
    pub fn alpha(&self) -> f32 {
        match self.0 {
            LobeModel::Rough(rough) => rough.alpha(),
            _ => f32::INFINITY,
        }
    }

    /// Returns the value in 1/sr for directions with z > 0.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let wo = V3::splat(wo);
        let facet = Facet::<f32>::between(wo, V3::splat(wi));
        self.0.value_pdf(&self.0.seen(wo), &facet).0.into()
    }
}
