//! One BSDF seen from one direction, evaluated and sampled for sixteen directions of incidence.

use super::bsdf::LobeSet;
use super::model::Bsdf;
use super::packet::{BsdfSamples16, Bsdfs16};
use base::math::{F32x16, LANES, Vec2x16, Vec3x16};
use glam::Vec3;

/// BSDF at one point, seen from one direction.
#[derive(Clone, Debug)]
pub struct PreparedBsdf<'m> {
    bsdf: Bsdf<'m>,
    wo: Vec3,
}

impl<'m> PreparedBsdf<'m> {
    /// Prepares a BSDF.
    pub fn new(bsdf: Bsdf<'m>, wo: Vec3) -> PreparedBsdf<'m> {
        PreparedBsdf { bsdf, wo }
    }

    /// Returns the BSDF.
    pub fn bsdf(&self) -> &Bsdf<'m> {
        &self.bsdf
    }

    /// Returns wo.
    pub fn wo(&self) -> Vec3 {
        self.wo
    }

    /// Returns true if Lambertian.
    pub fn is_lambert(&self) -> bool {
        self.bsdf.is_lambert()
    }

    /// Returns eval_pdf.
    pub fn eval_pdf16(&self, wi: &Vec3x16) -> (Vec3x16, F32x16) {
        let (mut value, mut pdf) = (Vec3x16::default(), [0.0; LANES]);
        for i in 0..LANES {
            let (v, p) = self.bsdf.eval_pdf(self.wo, wi.get(i));
            value.set(i, v);
            pdf[i] = p;
        }
        (value, pdf)
    }

    /// Returns samples.
    pub fn sample16(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        Bsdfs16::new(Vec3x16::splat(self.wo), |_| self.bsdf).sample(u_lobe, u, wanted)
    }

    /// Returns values of lobes.
    pub fn eval_lobes16(&self, lobes: LobeSet, wi: &Vec3x16) -> Vec3x16 {
        let mut value = Vec3x16::default();
        for i in 0..LANES {
            value.set(i, self.bsdf.eval_lobes(lobes, self.wo, wi.get(i)));
        }
        value
    }
}

/// Mean.
#[derive(Clone, Debug)]
pub struct MeanBsdf<'m> {
    bsdf: Bsdf<'m>,
    n: f32,
}

impl<'m> MeanBsdf<'m> {
    /// Starts.
    pub fn new(bsdf: Bsdf<'m>) -> Self {
        MeanBsdf { bsdf, n: 1.0 }
    }

    /// Adds.
    pub fn add(&mut self, other: &Bsdf<'m>) -> bool {
        if !self.bsdf.same_lobes(other) {
            return false;
        }
        self.n += 1.0;
        self.bsdf.base += other.base;
        for (mine, other) in self.bsdf.scales.iter_mut().zip(&other.scales) {
            *mine += *other;
        }
        true
    }

    /// Returns the mean.
    pub fn mean(mut self) -> Bsdf<'m> {
        let scale = 1.0 / self.n;
        self.bsdf.base *= scale;
        self.bsdf.scales.iter_mut().for_each(|s| *s *= scale);
        self.bsdf
    }
}
