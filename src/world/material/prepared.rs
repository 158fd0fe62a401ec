//! A material at one point, seen from one direction: value, density and samples of sixteen incident directions at once.

use super::bsdf::LobeSet;
use super::model::Bsdf;
use super::packet::BsdfSamples16;
use base::math::{F32x16, LANES, Vec2x16, Vec3x16, lanes_in};
use glam::Vec3;

/// BSDF at one point, seen from one direction. Evaluates and samples sixteen incident directions at once.
#[derive(Clone, Copy, Debug)]
pub struct PreparedBsdf<'m> {
    bsdf: Bsdf<'m>,
    wo: Vec3,
}

impl<'m> PreparedBsdf<'m> {
    /// Prepares a BSDF for the direction `wo`, on either side.
    #[inline]
    pub fn new(bsdf: Bsdf<'m>, wo: Vec3) -> PreparedBsdf<'m> {
        PreparedBsdf { bsdf, wo }
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
        let (mut values, mut pdfs) = (Vec3x16::ZERO, [0.0; LANES]);
        for l in 0..LANES {
            let (value, pdf) = self.bsdf.eval_pdf(self.wo, wi.get(l));
            values.set(l, value);
            pdfs[l] = pdf;
        }
        (values, pdfs)
    }

    /// Returns [`Bsdf::sample`] in the lanes of `wanted`; no other lane goes on.
    #[inline]
    pub fn sample16(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let mut samples = BsdfSamples16::default();
        for l in lanes_in(wanted) {
            samples.set(l, self.bsdf.sample(self.wo, u_lobe[l], u.get(l)));
        }
        samples
    }

    /// Returns [`Bsdf::eval_lobes`] in all lanes.
    #[inline]
    pub fn eval_lobes16(&self, lobes: LobeSet, wi: &Vec3x16) -> Vec3x16 {
        let mut values = Vec3x16::ZERO;
        for l in 0..LANES {
            values.set(l, self.bsdf.eval_lobes(lobes, self.wo, wi.get(l)));
        }
        values
    }
}
