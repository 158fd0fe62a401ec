//! Upper bounds of BSDF · cosine over sets of directions, for clusters of lights.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1.

use super::lobe::{DirectionBound, FacetBound};
use super::model::Bsdf;
use base::math::Rgb;
use glam::Vec3;

impl Bsdf<'_> {
    /// Returns an upper bound, per channel, of `eval(wo, wi)` · cos θ_i over all `wi` within `bound` on the side of
    /// `wo`.
    ///
    /// The bound is exact for a Lambertian surface at `cos_i_max`. It excludes delta lobes, as `eval` does. NaN in
    /// `bound` means that nothing is known.
    #[inline]
    pub fn bound(&self, wo: Vec3, bound: &DirectionBound) -> Rgb {
        let cos_max = bound.cos_i_max.min(1.0);
        let cos_o = wo.z * self.side(wo);
        if cos_max <= 0.0 || !(cos_o > 0.0) {
            return Rgb::ZERO;
        }
        let coat = &self.model.base.interface;
        let mut most = self.base * (cos_max * coat.transmittance(cos_o) * coat.max_transmittance(cos_max));
        if self.model.kinds.smooth {
            let facets = FacetBound::new(cos_o, cos_max, bound);
            for (slot, lobe) in self.model.lobes.iter().enumerate() {
                most += lobe.bound(self.scales[slot], &facets);
            }
        }
        most
    }
}
