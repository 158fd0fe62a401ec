//! Materials at sixteen points at once: lanes of one model are evaluated together.

use super::lobe::{BsdfSample, MAX_LOBES};
use super::model::{Bsdf, LobeSet, Model};
use super::seen::{Sampled, Seen};
use base::math::{F32x16, LANES, Lane, Mask16, Rgb, U32x16, V3, Vec2x16, Vec3x16, f32x16, lanes_in, mask_of};
use base::sampling::cosine_direction;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// Minimum number of lanes of one model that are evaluated together. Fewer are faster one by one.
const MIN_ALIKE: u32 = 3;

/// Sixteen materials, each at one point and seen from one direction.
#[derive(Clone, Debug)]
pub struct Bsdfs16<'m> {
    models: [&'m Model; LANES],
    wo: Vec3x16,
    /// BRDFs of the bases, without the transmittances of coats.
    base: Vec3x16,
    /// Factors on the lobes.
    scales: [Vec3x16; MAX_LOBES],
    /// Normals without reliefs, in the shading frames.
    level_normal: Vec3x16,
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
    straight: U32x16,
}

impl<'m> Bsdfs16<'m> {
    /// Collects the materials that `at` returns for each lane, seen from `wo`.
    #[inline]
    pub fn new(wo: Vec3x16, mut at: impl FnMut(usize) -> Bsdf<'m>) -> Bsdfs16<'m> {
        let first = at(0);
        let mut all = Bsdfs16 {
            models: [first.model; LANES],
            wo,
            base: Vec3x16::ZERO,
            scales: [Vec3x16::ZERO; MAX_LOBES],
            level_normal: Vec3x16::ZERO,
            side: [1.0; LANES],
            layered: 0,
            smooth: 0,
        };
        all.set(0, &first);
        for lane in 1..LANES {
            all.set(lane, &at(lane));
        }
        all
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, bsdf: &Bsdf<'m>) {
        self.models[lane] = bsdf.model;
        self.base.set(lane, bsdf.base);
        for slot in 0..bsdf.model.lobes.len() {
            self.scales[slot].set(lane, bsdf.scales[slot]);
        }
        self.level_normal.set(lane, bsdf.level_normal);
        self.side[lane] = bsdf.side(self.wo.get(lane));
        self.layered |= u16::from(!bsdf.is_lambert()) << lane;
        self.smooth |= u16::from(bsdf.has_smooth()) << lane;
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
        for lane in lanes_in(lanes & self.layered) {
            if let Some(part) = self.lane(lane).glossy_part() {
                self.replace(lane, &part);
                glossy |= 1 << lane;
            }
        }
        glossy
    }

    /// Replaces the material of a lane by a part of it.
    #[inline]
    pub fn replace(&mut self, lane: usize, part: &Bsdf<'m>) {
        (self.layered, self.smooth) = (self.layered & !(1 << lane), self.smooth & !(1 << lane));
        self.set(lane, part);
    }

    /// Returns the material of a lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> Bsdf<'m> {
        let mut scales = [Rgb::ZERO; MAX_LOBES];
        for slot in 0..self.models[lane].lobes.len() {
            scales[slot] = self.scales[slot].get(lane);
        }
        let (base, level_normal) = (self.base.get(lane), self.level_normal.get(lane));
        Bsdf { model: self.models[lane], base, scales, level_normal }
    }

    /// Returns the direction from which a lane is seen.
    #[inline]
    pub fn wo(&self, lane: usize) -> Vec3 {
        self.wo.get(lane)
    }

    /// Returns [`Bsdf::eval_pdf`] in the lanes of `wanted`; other lanes are undefined.
    #[inline]
    pub fn eval_pdf(&self, wi: &Vec3x16, wanted: u16) -> (Vec3x16, F32x16) {
        let turned = self.turned(wi);
        let is_lit = self.turned(&self.wo).z.is_positive() & turned.z.is_positive();
        let mut value = self.base.load().keep(is_lit);
        let mut pdf = (turned.z * FRAC_1_PI).keep(is_lit);
        let mut left = self.layered & wanted;
        while left != 0 {
            let lanes = self.take_alike(&mut left);
            let (v, p) = if lanes.count_ones() < MIN_ALIKE {
                self.eval_one_by_one(wi, lanes)
            } else {
                let seen = self.seen(lanes);
                seen.eval_pdf(&seen.facet(turned))
            };
            let lanes = Mask16::of(lanes);
            value = V3::select(lanes, v, value);
            pdf = f32x16::pick(lanes, p, pdf);
        }
        (value.into(), pdf.to_array())
    }

    /// Returns [`Bsdf::eval_lobes`] in the lanes of `wanted`, for a set of lobes in each; 0 in other lanes.
    pub fn eval_lobes(&self, lobes: &[LobeSet; LANES], wi: &Vec3x16, wanted: u16) -> Vec3x16 {
        let (turned, mut values) = (self.turned(wi), Vec3x16::ZERO);
        let mut left = self.layered & wanted;
        while left != 0 {
            let (set, alike) = (lobes[left.trailing_zeros() as usize], self.take_alike(&mut left));
            let lanes =
                lanes_in(alike).filter(|lane| lobes[*lane] == set).fold(0, |all, lane| all | 1 << lane);
            left |= alike & !lanes;
            let seen = self.seen(lanes);
            values.put(Mask16::of(lanes), seen.eval_lobes(set, &seen.facet(turned)));
        }
        values
    }

    /// Returns [`Bsdf::sample`] in the lanes of `wanted`; other lanes are undefined.
    #[inline]
    pub fn sample(&self, u_lobe: &F32x16, u: &Vec2x16, wanted: u16) -> BsdfSamples16 {
        let (side, numbers) = (f32x16::new(self.side), [f32x16::new(u.x), f32x16::new(u.y)]);
        let wi = cosine_direction(numbers);
        let none = Mask16::of(0);
        let lambertian = Sampled {
            wi,
            weight: self.base.load().times(f32x16::from(PI)),
            pdf: wi.z * FRAC_1_PI,
            eta: f32x16::from(1.0),
            found: self.turned(&self.wo).z.is_positive(),
            delta: none,
            straight: none,
        };
        let mut samples = BsdfSamples16::new(&lambertian, side);
        let mut left = self.layered & wanted;
        while left != 0 {
            let lanes = self.take_alike(&mut left);
            if lanes.count_ones() < MIN_ALIKE {
                for lane in lanes_in(lanes) {
                    let sample = self.lane(lane).sample(self.wo.get(lane), u_lobe[lane], u.get(lane));
                    samples.set(lane, sample);
                }
            } else {
                let wanted = Mask16::of(lanes);
                let sampled = self.seen(lanes).sample(f32x16::new(*u_lobe), numbers, wanted);
                samples.put(wanted, &BsdfSamples16::new(&sampled, side));
            }
        }
        samples
    }

    /// Evaluates some lanes one by one.
    fn eval_one_by_one(&self, wi: &Vec3x16, lanes: u16) -> (V3<f32x16>, f32x16) {
        let (mut values, mut pdfs) = (Vec3x16::ZERO, [0.0; LANES]);
        for lane in lanes_in(lanes) {
            let (value, pdf) = self.lane(lane).eval_pdf(self.wo.get(lane), wi.get(lane));
            values.set(lane, value);
            pdfs[lane] = pdf;
        }
        (values.load(), f32x16::new(pdfs))
    }

    /// Turns directions to the side of the normal.
    #[inline(always)]
    fn turned(&self, v: &Vec3x16) -> V3<f32x16> {
        let v = v.load();
        V3::new(v.x, v.y, v.z * f32x16::new(self.side))
    }

    /// Takes the lanes of the first model from those `left`.
    #[inline(always)]
    fn take_alike(&self, left: &mut u16) -> u16 {
        let model = self.models[left.trailing_zeros() as usize];
        let mut lanes = 0;
        for (lane, other) in self.models.iter().enumerate() {
            let is_alike =
                std::ptr::eq(*other, model) || other.lobe_list == model.lobe_list && other.coat == model.coat;
            lanes |= u16::from(is_alike) << lane;
        }
        lanes &= *left;
        *left &= !lanes;
        lanes
    }

    /// Prepares lanes that differ in colour only.
    #[inline(always)]
    fn seen(&self, lanes: u16) -> Seen<'m, f32x16> {
        let model = self.models[lanes.trailing_zeros() as usize];
        let mut scales = [V3::zero(); MAX_LOBES];
        for slot in 0..model.lobes.len() {
            scales[slot] = self.scales[slot].load();
        }
        let [wo, level_normal] = [&self.wo, &self.level_normal].map(|v| self.turned(v));
        Seen::new(model, self.base.load(), &scales, wo, level_normal)
    }
}

impl BsdfSamples16 {
    /// Stores samples whose directions are turned to the side of the normal.
    #[inline(always)]
    fn new(sampled: &Sampled<f32x16>, side: f32x16) -> BsdfSamples16 {
        let V3 { x, y, z } = sampled.wi;
        let flags = |mask: Mask16| {
            let (mut row, bits) = ([0; LANES], mask.bits());
            for (lane, flag) in row.iter_mut().enumerate() {
                *flag = u32::from(bits) >> lane & 1;
            }
            row
        };
        BsdfSamples16 {
            wi: V3::new(x, y, z * side).into(),
            weight: sampled.weight.into(),
            pdf: f32x16::pick(sampled.delta, f32x16::from(f32::INFINITY), sampled.pdf).to_array(),
            eta: sampled.eta.to_array(),
            goes_on: flags(sampled.found),
            straight: flags(sampled.straight),
        }
    }

    /// Sets the lanes of a mask to other samples.
    #[inline(always)]
    fn put(&mut self, mask: Mask16, other: &BsdfSamples16) {
        self.wi.put(mask, other.wi.load());
        self.weight.put(mask, other.weight.load());
        mask.put(&mut self.pdf, &other.pdf);
        mask.put(&mut self.eta, &other.eta);
        mask.put_u32(&mut self.goes_on, &other.goes_on);
        mask.put_u32(&mut self.straight, &other.straight);
    }

    /// Sets a lane to a sample, or ends the path of the lane.
    #[inline]
    fn set(&mut self, lane: usize, sample: Option<BsdfSample>) {
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
