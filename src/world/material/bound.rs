//! Upper bounds of BSDF · cosine over sets of directions, for clusters of lights.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1.

use super::lobe::{DirectionBound, FacetBound, MAX_LOBES};
use super::model::{Bsdf, Model};
use super::seen::Seen;
use base::math::{F32x16, LANES, Lane, Rgb, V3, Vec3x16, f32x16};
use glam::Vec3;

impl Bsdf<'_> {
    /// Returns an upper bound, per channel, of `eval(wo, wi)` · cos θ_i over all `wi` within `bound` on the side of
    /// `wo`.
    ///
    /// The bound is exact for a Lambertian surface at `cos_i_max`. It excludes delta lobes, as `eval` does. NaN in
    /// `bound` means that nothing is known.
    #[inline]
    pub fn bound(&self, wo: Vec3, bound: &DirectionBound) -> Rgb {
        let cos_o = wo.z * self.side(wo);
        if !(cos_o > 0.0 && bound.cos_i_max > 0.0 || bound.cos_i_max.is_nan()) {
            return Rgb::ZERO;
        }
        let base = V3::splat(self.base * self.coat_transmittance(cos_o));
        let lobe = |slot: usize| (V3::splat(self.scales[slot]), self.model.lobes[slot].max_masking(cos_o));
        self.model.bound::<f32>(base, lobe, cos_o, bound).into()
    }
}

impl Model {
    /// Returns the bound for bases of BRDF `base`, which includes the coat's transmittance for `wo`. `lobe` returns the
    /// factor on the lobe in a slot and its masking.
    #[inline(always)]
    fn bound<L: Lane>(
        &self,
        base: V3<L>,
        lobe: impl Fn(usize) -> (V3<L>, L),
        cos_o: L,
        bound: &DirectionBound<L>,
    ) -> V3<L> {
        let cos_max = bound.cos_i_max.min(L::from(1.0)).positive();
        let mut most = base.times(self.base.interface.max_transmittance(cos_max) * cos_max);
        if self.kinds.smooth {
            let facets = FacetBound::new(cos_o, cos_max, bound);
            for (slot, model) in self.lobes.iter().enumerate() {
                let (scale, masking) = lobe(slot);
                most += scale * model.bound(masking, &facets);
            }
        }
        most.keep(cos_o.is_positive() & cos_max.is_positive())
    }
}

/// Sixteen materials that differ only in colour, each seen from one direction on the side of its normal: responses and
/// bounds.
#[derive(Clone, Copy)]
pub struct AlikeBsdfs16<'m> {
    model: &'m Model,
    seen: Seen<'m, f32x16>,
    max_masking: [f32x16; MAX_LOBES],
}

impl<'m> AlikeBsdfs16<'m> {
    /// Collects the material and its `wo` (z >= 0) that `at` returns for each lane. Returns `None` if the lobes or
    /// coats differ, or a material transmits light.
    pub fn new(at: impl Fn(usize) -> (Bsdf<'m>, Vec3)) -> Option<AlikeBsdfs16<'m>> {
        let first = at(0).0;
        let (mut base, mut wo, mut level_normal) = (Vec3x16::ZERO, Vec3x16::ZERO, Vec3x16::ZERO);
        let mut scales = [Vec3x16::ZERO; MAX_LOBES];
        for lane in 0..LANES {
            let (bsdf, out) = at(lane);
            if !bsdf.is_alike(&first) || bsdf.model.kinds.across {
                return None;
            }
            base.set(lane, bsdf.base);
            wo.set(lane, out);
            level_normal.set(lane, bsdf.level_normal);
            for (row, scale) in scales.iter_mut().zip(bsdf.scales) {
                row.set(lane, scale);
            }
        }
        let (model, wo) = (first.model, wo.load());
        let mut max_masking = [f32x16::from(0.0); MAX_LOBES];
        for (masking, lobe) in max_masking.iter_mut().zip(&model.lobes) {
            *masking = lobe.max_masking(wo.z);
        }
        let scales = scales.map(|row| row.load());
        let seen = Seen::new(model, base.load(), &scales, wo, level_normal.load());
        Some(AlikeBsdfs16 { model, seen, max_masking })
    }

    /// Returns [`Bsdf::eval`] times the cosine of `wi`, in all lanes.
    #[inline]
    pub fn response(&self, wi: V3<f32x16>) -> V3<f32x16> {
        self.seen.eval_pdf(&self.seen.facet(wi)).0.times(wi.z.positive())
    }

    /// Returns [`Bsdf::bound`] in all lanes.
    #[inline]
    pub fn bound(&self, bounds: &DirectionBound<f32x16>) -> V3<f32x16> {
        let lobe = |slot: usize| (self.seen.scales[slot], self.max_masking[slot]);
        self.model.bound(self.seen.base, lobe, self.seen.wo.z, bounds)
    }

    /// Returns the share of the light at each cosine that passes the coat; 1 if there is none.
    #[inline]
    pub fn coat_transmittance(&self, cos: &F32x16) -> F32x16 {
        self.model.base.interface.transmittance(f32x16::new(*cos)).to_array()
    }
}
