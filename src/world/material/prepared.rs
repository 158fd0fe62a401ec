//! A material at one point, seen from one direction: value, density and samples of sixteen incident directions at once.

use super::lobe_set::LobeSet;
use super::model::Bsdf;
use super::packet::BsdfSamples16;
use super::seen::Seen;
use base::math::{F32x16, Mask16, V3, Vec2x16, Vec3x16, f32x16};
use glam::Vec3;

/// BSDF at one point, seen from one direction.
#[derive(Clone, Copy)]
pub struct PreparedBsdf<'m> {
    bsdf: Bsdf<'m>,
    wo: Vec3,
    /// Factor on the z of directions that turns them to the side of the normal.
    side: f32,
    seen: Seen<'m, f32>,
}

impl<'m> PreparedBsdf<'m> {
    /// Prepares a BSDF for the direction `wo`, on either side.
    #[inline]
    pub fn new(bsdf: Bsdf<'m>, wo: Vec3) -> PreparedBsdf<'m> {
        let side = bsdf.side(wo);
        let seen = bsdf.seen(Vec3::new(wo.x, wo.y, wo.z * side));
        PreparedBsdf { bsdf, wo, side, seen }
    }

    /// Returns the BSDF.
    #[inline]
    pub fn bsdf(&self) -> &Bsdf<'m> {
        &self.bsdf
    }

    /// Returns the direction from which the surface is seen.
    #[inline]
    pub fn wo(&self) -> Vec3 {
        self.wo
    }

    /// Returns true if the material is Lambertian and nothing else.
    #[inline]
    pub fn is_lambert(&self) -> bool {
        self.bsdf.is_lambert()
    }

    /// Returns [`Bsdf::eval_pdf`] in all lanes.
    #[inline]
    pub fn eval_pdf16(&self, wi: &Vec3x16) -> (Vec3x16, F32x16) {
        let (value, pdf) = self.seen.eval_pdf(&self.seen.facet(self.turned(wi)));
        (value.into(), pdf.to_array())
    }

    /// Returns [`Bsdf::sample`] in the lanes of `wanted`; no other lane goes on.
    #[inline]
    pub fn sample16(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let (u, wanted) = ([f32x16::new(u.x), f32x16::new(u.y)], Mask16::of(wanted));
        let sampled = match self.is_lambert() {
            true => self.seen.sample_lambert(u, wanted),
            false => self.seen.sample(f32x16::new(*u_lobe), u, wanted),
        };
        BsdfSamples16::new(&sampled, f32x16::from(self.side))
    }

    /// Returns [`Bsdf::eval_lobes`] in all lanes.
    pub fn eval_lobes16(&self, lobes: LobeSet, wi: &Vec3x16) -> Vec3x16 {
        self.seen.eval_lobes(lobes, &self.seen.facet(self.turned(wi))).into()
    }

    /// Turns directions to the side of the normal.
    #[inline(always)]
    fn turned(&self, wi: &Vec3x16) -> V3<f32x16> {
        let wi = wi.load();
        V3::new(wi.x, wi.y, wi.z * self.side)
    }
}
