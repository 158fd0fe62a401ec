//! Materials with the same lobes and coat at sixteen points at once: [`Bsdf::eval`] and [`Bsdf::bound`] as loops over
//! lanes that compile to vector code.

use super::lobe::{DirectionBounds16, Directions16, FacetBounds16, LobeLanes, MAX_LOBES};
use super::model::{Bsdf, Model};
use base::math::{F32x16, LANES, Vec3x16};
use glam::Vec3;

/// Sixteen materials that differ only in colour, each seen from one direction on the side of its normal.
#[derive(Clone, Copy, Debug)]
pub struct AlikeBsdfs16<'m> {
    model: &'m Model,
    wo: Vec3x16,
    /// BRDFs of the bases, times the coat's transmittance for `wo`.
    base: Vec3x16,
    lobes: [LobeLanes; MAX_LOBES],
}

impl<'m> AlikeBsdfs16<'m> {
    /// Collects the material and its `wo` (z >= 0) that `at` returns for each lane. Returns `None` if the lobes or
    /// coats differ, or a material transmits light.
    pub fn new(at: impl Fn(usize) -> (Bsdf<'m>, Vec3)) -> Option<AlikeBsdfs16<'m>> {
        let first = at(0).0;
        let zero = Vec3x16::default();
        let mut all = AlikeBsdfs16 {
            model: first.model,
            wo: zero,
            base: zero,
            lobes: [LobeLanes::default(); MAX_LOBES],
        };
        for lane in 0..LANES {
            let (bsdf, wo) = at(lane);
            if !bsdf.same_lobes(&first) || bsdf.coat() != first.coat() || bsdf.model.kinds.across {
                return None;
            }
            all.wo.set(lane, wo);
            // A surface that is seen edge-on reflects nothing.
            if wo.z > 0.0 {
                all.base.set(lane, bsdf.base * bsdf.coat_transmittance(wo.z));
                for (slot, lobe) in bsdf.model.lobes.iter().enumerate() {
                    lobe.set_lane(&mut all.lobes[slot], lane, bsdf.scales[slot], wo);
                }
            }
        }
        Some(all)
    }

    /// Returns [`Bsdf::eval`] times the cosine of `wi`, in all lanes.
    #[inline]
    pub fn response(&self, wi: &Vec3x16) -> Vec3x16 {
        let mut response = self.base_times(&self.coat_transmittance(&wi.z));
        if self.model.kinds.smooth {
            let directions = Directions16::new(&self.wo, wi);
            for (slot, lobe) in self.model.lobes.iter().enumerate() {
                lobe.add_value16(&self.lobes[slot], &directions, &mut response);
            }
        }
        for l in 0..LANES {
            let cos_i = if wi.z[l] > 0.0 { wi.z[l] } else { 0.0 };
            response.set(l, response.get(l) * cos_i);
        }
        response
    }

    /// Returns [`Bsdf::bound`] in all lanes.
    #[inline]
    pub fn bound(&self, bounds: &DirectionBounds16) -> Vec3x16 {
        let cos_max = &bounds.cos_i_max;
        let mut most = self.base_times(&self.model.base.interface.max_transmittance16(cos_max));
        for l in 0..LANES {
            let cos = if cos_max[l] > 0.0 { cos_max[l] } else { 0.0 };
            most.set(l, most.get(l) * cos);
        }
        if self.model.kinds.smooth {
            let facets = FacetBounds16::new(&self.wo.z, bounds);
            for (slot, lobe) in self.model.lobes.iter().enumerate() {
                lobe.add_bound16(&self.lobes[slot], &facets, &mut most);
            }
        }
        most
    }

    /// Returns the share of the light at each cosine that passes the coat; 1 if there is none.
    #[inline]
    pub fn coat_transmittance(&self, cos: &F32x16) -> F32x16 {
        self.model.base.interface.transmittance16(cos)
    }

    /// Returns the BRDFs of the bases times a factor per lane.
    #[inline(always)]
    fn base_times(&self, factor: &F32x16) -> Vec3x16 {
        let mut product = Vec3x16::default();
        for l in 0..LANES {
            product.x[l] = self.base.x[l] * factor[l];
            product.y[l] = self.base.y[l] * factor[l];
            product.z[l] = self.base.z[l] * factor[l];
        }
        product
    }
}
