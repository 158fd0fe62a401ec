//! A material at one point, seen from one direction: value, density and samples of sixteen incident directions at once.
//!
//! Loops over lanes compile to vector code. Lane by lane are: materials that transmit light, gaps seen from behind, and
//! the sampling of lobes other than those of GGX facets.

use super::bsdf::Outgoing;
use super::lobe::{BsdfSample, Directions16, MAX_LOBES, Sampled16, SeenLobe, ValuePdf16};
use super::lobe_set::LobeSet;
use super::model::Bsdf;
use super::packet::BsdfSamples16;
use base::math::{F32x16, LANES, Rgb, Vec2x16, Vec3x16, lanes_in, select};
use base::sampling::cosine_hemisphere;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// BSDF at one point, seen from one direction. Evaluates and samples sixteen incident directions at once.
#[derive(Clone, Copy, Debug)]
pub struct PreparedBsdf<'m> {
    bsdf: Bsdf<'m>,
    wo: Vec3,
    /// Factor on the z of directions that turns them to the side of the normal.
    side: f32,
    outgoing: Outgoing,
    lobes: [SeenLobe; MAX_LOBES],
}

impl<'m> PreparedBsdf<'m> {
    /// Prepares a BSDF for the direction `wo`, on either side.
    #[inline]
    pub fn new(bsdf: Bsdf<'m>, wo: Vec3) -> PreparedBsdf<'m> {
        let side = bsdf.side(wo);
        let turned = Vec3::new(wo.x, wo.y, wo.z * side);
        let probabilities = [0.0; MAX_LOBES];
        let mut outgoing = Outgoing { wo: turned, transmittance: 1.0, base_probability: 1.0, probabilities };
        let mut lobes = [SeenLobe::default(); MAX_LOBES];
        if !bsdf.is_lambert() && (turned.z > 0.0 || bsdf.model.kinds.pass_light) {
            outgoing = bsdf.outgoing(turned);
            if turned.z > 0.0 {
                for (slot, lobe) in bsdf.model.lobes.iter().enumerate() {
                    lobes[slot] = lobe.seen(outgoing.probabilities[slot], turned);
                }
            }
        }
        PreparedBsdf { bsdf, wo, side, outgoing, lobes }
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
        let mut sum = ValuePdf16::ZERO;
        if self.bsdf.model.kinds.across {
            self.eval_one_by_one(wi, &mut sum);
        } else if self.is_lambert() && self.is_seen() {
            self.eval_lambert(wi, &mut sum);
        } else if self.is_seen() {
            self.eval_layered(&self.turned(wi), &mut sum);
        }
        (sum.value, sum.pdf)
    }

    /// Returns [`Bsdf::sample`] in the lanes of `wanted`; no other lane goes on.
    #[inline]
    pub fn sample16(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let kinds = &self.bsdf.model.kinds;
        if kinds.across || kinds.pass_light && !self.is_seen() {
            return self.sample_one_by_one(u_lobe, u, wanted);
        }
        if !self.is_seen() {
            return BsdfSamples16::NONE;
        }
        let mut samples = match self.is_lambert() {
            true => self.sample_lambert(u, wanted),
            false => self.sample_layered(u_lobe, u, wanted),
        };
        for l in 0..LANES {
            samples.wi.z[l] *= self.side;
        }
        samples
    }

    /// Returns [`Bsdf::eval_lobes`] in all lanes.
    pub fn eval_lobes16(&self, lobes: LobeSet, wi: &Vec3x16) -> Vec3x16 {
        let mut sum = ValuePdf16::ZERO;
        if self.bsdf.model.kinds.across {
            for l in 0..LANES {
                sum.value.set(l, self.bsdf.eval_lobes(lobes, self.wo, wi.get(l)));
            }
        } else if self.is_seen() {
            let (wo, wi) = (Vec3x16::splat(self.outgoing.wo), self.turned(wi));
            self.add_lobes(lobes, &Directions16::new(&wo, &wi), &mut sum);
        }
        sum.value
    }

    /// Returns true if the surface is seen from the side on which it reflects light.
    #[inline(always)]
    fn is_seen(&self) -> bool {
        self.outgoing.wo.z > 0.0
    }

    /// Turns directions to the side of the normal.
    #[inline(always)]
    fn turned(&self, wi: &Vec3x16) -> Vec3x16 {
        let mut turned = *wi;
        for l in 0..LANES {
            turned.z[l] *= self.side;
        }
        turned
    }

    /// Evaluates directions lane by lane.
    fn eval_one_by_one(&self, wi: &Vec3x16, sum: &mut ValuePdf16) {
        let wi = self.turned(wi);
        for l in 0..LANES {
            let (value, pdf) = self.bsdf.eval_pdf_layered(&self.outgoing, wi.get(l));
            sum.value.set(l, value);
            sum.pdf[l] = pdf;
        }
    }

    /// Evaluates a Lambertian material.
    #[inline(always)]
    fn eval_lambert(&self, wi: &Vec3x16, sum: &mut ValuePdf16) {
        let base = self.bsdf.base;
        for l in 0..LANES {
            let cos = wi.z[l] * self.side;
            let lit = cos > 0.0;
            sum.value.x[l] = select(lit, base.x, 0.0);
            sum.value.y[l] = select(lit, base.y, 0.0);
            sum.value.z[l] = select(lit, base.z, 0.0);
            sum.pdf[l] = select(lit, cos * FRAC_1_PI, 0.0);
        }
    }

    /// Evaluates a material that is more than Lambertian; `wi` is turned.
    fn eval_layered(&self, wi: &Vec3x16, sum: &mut ValuePdf16) {
        if !self.bsdf.model.kinds.smooth {
            return self.eval_base(wi, |l| wi.z[l] > 0.0, sum);
        }
        let wo = Vec3x16::splat(self.outgoing.wo);
        self.eval_between(&Directions16::new(&wo, wi), sum);
    }

    /// Evaluates base and lobes; `sum` is zero.
    #[inline]
    fn eval_between(&self, directions: &Directions16, sum: &mut ValuePdf16) {
        self.eval_base(directions.wi, |l| directions.reflects(l), sum);
        self.add_lobes(LobeSet::ALL, directions, sum);
    }

    /// Evaluates the base in the lanes that are `lit`; `sum` is zero.
    #[inline(always)]
    fn eval_base(&self, wi: &Vec3x16, lit: impl Fn(usize) -> bool, sum: &mut ValuePdf16) {
        let outgoing = &self.outgoing;
        if outgoing.base_probability == 0.0 {
            return;
        }
        let passes = self.bsdf.model.base.interface.transmittance16(&wi.z);
        let (base, density) =
            (self.bsdf.base * outgoing.transmittance, outgoing.base_probability * FRAC_1_PI);
        for l in 0..LANES {
            let (lit, cos) = (lit(l), wi.z[l]);
            let passes = select(lit, passes[l], 0.0);
            sum.value.x[l] = base.x * passes;
            sum.value.y[l] = base.y * passes;
            sum.value.z[l] = base.z * passes;
            sum.pdf[l] = select(lit, cos * density, 0.0);
        }
    }

    /// Adds values and densities of some lobes.
    #[inline]
    fn add_lobes(&self, lobes: LobeSet, directions: &Directions16, sum: &mut ValuePdf16) {
        for (slot, lobe) in self.bsdf.model.lobes.iter().enumerate() {
            let scale = self.bsdf.scales[slot];
            if lobes.has(slot) && (scale != Rgb::ZERO || self.outgoing.probabilities[slot] > 0.0) {
                lobe.add_eval_pdf16(scale, &self.lobes[slot], directions, sum);
            }
        }
    }

    /// Samples directions lane by lane.
    fn sample_one_by_one(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let mut samples = BsdfSamples16::NONE;
        for l in lanes_in(wanted) {
            let sample = self.bsdf.sample_layered(&self.outgoing, u_lobe[l], u.get(l));
            samples.set(l, sample.map(|s| BsdfSample { wi: s.wi * Vec3::new(1.0, 1.0, self.side), ..s }));
        }
        samples
    }

    /// Samples a Lambertian material.
    #[inline(always)]
    fn sample_lambert(&self, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let mut samples =
            BsdfSamples16 { weight: Vec3x16::splat(self.bsdf.base * PI), ..BsdfSamples16::NONE };
        for l in 0..LANES {
            let wi = cosine_hemisphere(u.get(l));
            samples.wi.set(l, wi);
            samples.pdf[l] = wi.z * FRAC_1_PI;
            samples.eta[l] = 1.0;
            samples.goes_on[l] = u32::from(wanted) >> l & 1;
        }
        samples
    }

    /// Samples a material that is more than Lambertian.
    fn sample_layered(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let (base, chosen) = self.choose(u_lobe, wanted);
        let (wo, lobes) = (self.outgoing.wo, &self.bsdf.model.lobes);
        let mut sampled = Sampled16 { found: base, ..Sampled16::NONE };
        if base != 0 {
            for l in 0..LANES {
                sampled.wi.set(l, cosine_hemisphere(u.get(l)));
            }
        }
        for (lobe, &mask) in lobes.iter().zip(&chosen) {
            if mask != 0 && !lobe.is_delta() {
                lobe.sample16(wo, u, mask, &mut sampled);
            }
        }
        let mut samples = self.weighted(&sampled, base);
        for (slot, &mask) in chosen[..lobes.len()].iter().enumerate() {
            if mask != 0 && lobes[slot].is_delta() {
                let probability = self.outgoing.probabilities[slot];
                let sample = lobes[slot].delta(self.bsdf.scales[slot], wo).filter(|_| probability > 0.0);
                let sample = sample.map(|s| BsdfSample { weight: s.weight / probability, ..s });
                lanes_in(mask).for_each(|l| samples.set(l, sample));
            }
        }
        samples
    }

    /// Weighs sampled directions, of which those of the lanes `base` have no facet normal.
    fn weighted(&self, sampled: &Sampled16, base: u16) -> BsdfSamples16 {
        let wi = &sampled.wi;
        let mut sum = ValuePdf16::ZERO;
        if self.bsdf.model.kinds.smooth {
            let wo = Vec3x16::splat(self.outgoing.wo);
            let mut directions = Directions16::new(&wo, wi);
            directions.set_half(sampled.found & !base, &sampled.half);
            self.eval_between(&directions, &mut sum);
        } else {
            self.eval_base(wi, |l| wi.z[l] > 0.0, &mut sum);
        }
        let mut samples = BsdfSamples16 { wi: *wi, pdf: sum.pdf, eta: [1.0; LANES], ..BsdfSamples16::NONE };
        for l in 0..LANES {
            let factor = wi.z[l].abs() / sum.pdf[l];
            samples.weight.x[l] = sum.value.x[l] * factor;
            samples.weight.y[l] = sum.value.y[l] * factor;
            samples.weight.z[l] = sum.value.z[l] * factor;
            samples.goes_on[l] = u32::from(sum.pdf[l] > 0.0) & (u32::from(sampled.found) >> l);
        }
        samples
    }

    /// Returns the lanes of `wanted` that choose the base, and those that choose each lobe.
    #[inline]
    fn choose(&self, u_lobe: &F32x16, wanted: u16) -> (u16, [u16; MAX_LOBES]) {
        let outgoing = &self.outgoing;
        let mut below = outgoing.base_probability;
        let base = lanes_below(u_lobe, below) & wanted;
        let (mut lobes, mut left) = ([0; MAX_LOBES], wanted & !base);
        let count = self.bsdf.model.lobes.len();
        for slot in 0..count {
            below += outgoing.probabilities[slot];
            // The last lobe takes the remainder.
            lobes[slot] = if slot + 1 == count { left } else { lanes_below(u_lobe, below) & left };
            left &= !lobes[slot];
        }
        (base, lobes)
    }
}

/// Returns the lanes of numbers below a limit.
#[inline]
fn lanes_below(numbers: &F32x16, limit: f32) -> u16 {
    let mut mask = 0;
    for l in 0..LANES {
        mask |= u32::from(numbers[l] < limit) << l;
    }
    mask as u16
}
