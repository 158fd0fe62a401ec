//! Materials at sixteen points at once. Lambertian materials are evaluated in all lanes together, others one by one.

use super::lobe::BsdfSample;
use super::model::Bsdf;
use base::math::{F32x16, LANES, Rgb, U32x16, Vec2x16, Vec3x16, lanes_in, mask_of};
use base::sampling::cosine_hemisphere;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// Sixteen materials, each at one point and seen from one direction.
#[derive(Clone, Debug)]
pub struct Bsdfs16<'m> {
    lanes: [Bsdf<'m>; LANES],
    wo: Vec3x16,
    /// BRDF of each Lambertian lane.
    base: Vec3x16,
    /// -1 if a two-sided surface is seen from behind, else 1.
    side: F32x16,
    /// Lanes whose materials are more than Lambertian.
    layered: u16,
    /// Lanes that scatter into more than isolated directions.
    smooth: u16,
}

/// Sampled directions; see [`super::lobe::BsdfSample`] for the fields.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSamples16 {
    /// Unit directions.
    pub wi: Vec3x16,
    /// BSDF · cos / pdf.
    pub weight: Vec3x16,
    /// Densities per solid angle; infinite for a delta lobe.
    pub pdf: F32x16,
    /// Ratios of indices of refraction.
    pub eta: F32x16,
    /// Not zero if the path continues.
    pub goes_on: U32x16,
    /// Not zero if the path continues straight through the surface.
    pub(super) straight: U32x16,
}

impl<'m> Bsdfs16<'m> {
    /// Collects the materials that `at` returns for each lane, seen from `wo`.
    #[inline]
    pub fn new(wo: Vec3x16, at: impl FnMut(usize) -> Bsdf<'m>) -> Bsdfs16<'m> {
        let lanes: [Bsdf; LANES] = std::array::from_fn(at);
        let mut base = Vec3x16::default();
        let (mut layered, mut smooth, mut two_sided) = (0, 0, [0.0; LANES]);
        for (i, bsdf) in lanes.iter().enumerate() {
            base.set(i, bsdf.base);
            layered |= u16::from(!bsdf.is_lambert()) << i;
            smooth |= u16::from(bsdf.has_smooth()) << i;
            two_sided[i] = if bsdf.two_sided() { -1.0 } else { 1.0 };
        }
        let mut side = [1.0; LANES];
        for i in 0..LANES {
            side[i] = if wo.z[i] < 0.0 { two_sided[i] } else { 1.0 };
        }
        Bsdfs16 { lanes, wo, base, side, layered, smooth }
    }

    /// Returns the lanes that are Lambertian and nothing else.
    #[inline]
    pub fn lambertian(&self) -> u16 {
        !self.layered
    }

    /// Returns the lanes that scatter into more than isolated directions.
    #[inline]
    pub fn smooth(&self) -> u16 {
        self.smooth
    }

    /// Reduces materials in `lanes` to their delta lobes and the lobes too sharp to count as diffuse, if they have such
    /// sharp lobes. Returns the lanes of these materials.
    #[inline]
    pub fn keep_glossy(&mut self, lanes: u16) -> u16 {
        let mut glossy = 0;
        for i in lanes_in(lanes & self.layered) {
            if let Some(part) = self.lanes[i].glossy_part() {
                self.lanes[i] = part;
                self.base.set(i, Rgb::ZERO);
                glossy |= 1 << i;
            }
        }
        glossy
    }

    /// Returns the material of a lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> &Bsdf<'m> {
        &self.lanes[lane]
    }

    /// Returns the direction from which a lane is seen.
    #[inline]
    pub fn wo(&self, lane: usize) -> Vec3 {
        self.wo.get(lane)
    }

    /// Returns [`Bsdf::eval_pdf`] in the lanes of `wanted`; other lanes are undefined.
    #[inline]
    pub fn eval_pdf(&self, wi: &Vec3x16, wanted: u16) -> (Vec3x16, F32x16) {
        let (mut value, mut pdf) = (Vec3x16::default(), [0.0; LANES]);
        for i in 0..LANES {
            let (cos_o, cos_i) = (self.wo.z[i] * self.side[i], wi.z[i] * self.side[i]);
            let lit = (cos_o > 0.0) & (cos_i > 0.0);
            value.set(i, if lit { self.base.get(i) } else { Rgb::ZERO });
            pdf[i] = if lit { cos_i * FRAC_1_PI } else { 0.0 };
        }
        for i in lanes_in(self.layered & wanted) {
            let (v, p) = self.lanes[i].eval_pdf(self.wo.get(i), wi.get(i));
            value.set(i, v);
            pdf[i] = p;
        }
        (value, pdf)
    }

    /// Returns [`Bsdf::sample`] in the lanes of `wanted`; other lanes are undefined.
    #[inline]
    pub fn sample(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let mut s = BsdfSamples16::NONE;
        for i in 0..LANES {
            let mut wi = cosine_hemisphere(u.get(i));
            s.pdf[i] = wi.z * FRAC_1_PI;
            wi.z *= self.side[i];
            s.wi.set(i, wi);
            s.weight.set(i, self.base.get(i) * PI);
            s.eta[i] = 1.0;
            s.goes_on[i] = u32::from(self.wo.z[i] * self.side[i] > 0.0);
        }
        for i in lanes_in(self.layered & wanted) {
            s.set(i, self.lanes[i].sample(self.wo.get(i), u_lobe[i], u.get(i)));
        }
        s
    }
}

impl BsdfSamples16 {
    /// Samples of paths that all end.
    pub(super) const NONE: BsdfSamples16 = BsdfSamples16 {
        wi: Vec3x16::ZERO,
        weight: Vec3x16::ZERO,
        pdf: [0.0; LANES],
        eta: [0.0; LANES],
        goes_on: [0; LANES],
        straight: [0; LANES],
    };

    /// Sets a lane to a sample, or ends the path of the lane.
    #[inline]
    pub(super) fn set(&mut self, lane: usize, sample: Option<BsdfSample>) {
        self.goes_on[lane] = u32::from(sample.is_some());
        if let Some(sample) = sample {
            self.wi.set(lane, sample.wi);
            self.weight.set(lane, sample.weight);
            self.pdf[lane] = if sample.delta { f32::INFINITY } else { sample.pdf };
            self.eta[lane] = sample.eta;
            self.straight[lane] = u32::from(sample.straight);
        }
    }

    /// Returns the lanes of delta lobes.
    #[inline]
    pub fn delta(&self) -> u16 {
        mask_of(&self.pdf.map(|pdf| u32::from(pdf == f32::INFINITY)))
    }

    /// Returns the lanes where the path continues straight through the surface.
    #[inline]
    pub fn straight(&self) -> u16 {
        mask_of(&self.straight)
    }

    /// Returns the lanes where the path continues.
    #[inline]
    pub fn going_on(&self) -> u16 {
        mask_of(&self.goes_on)
    }
}
