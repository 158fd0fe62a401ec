//! Materials of one model, each with its own colours, seen from one direction each: value, density and samples.
//!
//! `W` is the width of the view, `D` that of the incident directions: one point and one direction (`f32`, `f32`), one
//! point and sixteen directions (`f32`, `f32x16`), or sixteen of both.
//!
//! All directions are turned to the side of the normal, unless the two sides are those of an interface.

use super::lobe::{Facet, MAX_LOBES, SeenLobe, means};
use super::model::{LobeSet, Model};
use base::math::{Lane, Mask, V3};
use base::sampling::cosine_direction;
use std::f32::consts::{FRAC_1_PI, PI};

/// Minimum sum of sampling weights that is divided by.
const MIN_WEIGHT: f32 = 1e-30;

/// Materials of one model, and what depends on the direction of view alone.
#[derive(Clone, Copy)]
pub(super) struct Seen<'m, W: Lane> {
    model: &'m Model,
    pub wo: V3<W>,
    /// Normals without the relief, turned as the directions are.
    pub level_normal: V3<W>,
    /// BRDFs of the bases, times the coat's transmittance for `wo`; 0 if `wo` is below the surface.
    pub base: V3<W>,
    /// Factors on the lobes.
    pub scales: [V3<W>; MAX_LOBES],
    lobes: [SeenLobe<W>; MAX_LOBES],
    /// Probabilities of sampling the base and each lobe.
    base_probability: W,
    probabilities: [W; MAX_LOBES],
    /// Lobes with a factor or a probability other than 0.
    used: LobeSet,
}

/// Sampled directions.
pub(super) struct Sampled<D: Lane> {
    /// Unit directions.
    pub wi: V3<D>,
    /// BSDF · cos / pdf.
    pub weight: V3<D>,
    /// Densities per solid angle; for a delta lobe, the probability of its choice.
    pub pdf: D,
    /// Index of refraction on the side of `wi` over that on the side of `wo`; 1 unless refracted.
    pub eta: D,
    /// Lanes that have a direction.
    pub found: D::Mask,
    /// Lanes of delta lobes.
    pub delta: D::Mask,
    /// Lanes where light keeps its direction.
    pub straight: D::Mask,
}

impl<'m, W: Lane> Seen<'m, W> {
    /// Prepares materials with the BRDFs `base` and the factors `scales` for `wo`.
    #[inline(always)]
    pub fn new(
        model: &'m Model,
        base: V3<W>,
        scales: &[V3<W>; MAX_LOBES],
        wo: V3<W>,
        level_normal: V3<W>,
    ) -> Seen<'m, W> {
        let zero = W::from(0.0);
        let transmittance = model.base.interface.transmittance(wo.z);
        // Light that passes gaps in a surface may reach its back.
        let base = base.times(transmittance).keep(wo.z.is_positive());
        let mut seen = Seen {
            model,
            wo,
            level_normal,
            base,
            scales: [V3::zero(); MAX_LOBES],
            lobes: [SeenLobe::none(); MAX_LOBES],
            base_probability: W::from(1.0).keep(wo.z.is_positive()),
            probabilities: [zero; MAX_LOBES],
            used: LobeSet::default(),
        };
        if model.lobes.is_empty() {
            return seen;
        }
        let base_weight = means(model.base.albedo(base));
        let mut total = base_weight;
        for (slot, lobe) in model.lobes.iter().enumerate() {
            seen.scales[slot] = scales[slot];
            seen.lobes[slot] = lobe.seen(wo);
            let weight = lobe.sampling_weight(scales[slot], wo, transmittance);
            seen.probabilities[slot] = weight;
            total += weight;
        }
        let share = total.max(W::from(MIN_WEIGHT)).recip();
        seen.base_probability = base_weight * share;
        let mut left = seen.base_probability.rest();
        let last = model.lobes.len() - 1;
        for slot in 0..=last {
            // The last lobe takes the remainder, so that rounding loses nothing.
            let probability = if slot == last { left.positive() } else { seen.probabilities[slot] * share };
            left = left - probability;
            seen.probabilities[slot] = probability;
            let is_used = probability.is_positive() | means(scales[slot]).is_positive();
            seen.used.0 |= u8::from(is_used.any()) << slot;
        }
        seen
    }

    /// Pairs the view with incident directions.
    #[inline(always)]
    pub fn facet<D: Lane + From<W>>(&self, wi: V3<D>) -> Facet<D> {
        Facet::between(self.wo.widen(), wi)
    }

    /// Returns values and densities, without delta lobes.
    #[inline(always)]
    pub fn eval_pdf<D: Lane + From<W>>(&self, facet: &Facet<D>) -> (V3<D>, D) {
        let cos = facet.wi.z;
        let (is_lit, passes) = (cos.is_positive(), self.model.base.interface.transmittance(cos));
        let mut value = self.base.widen().times(passes).keep(is_lit);
        let mut pdf = (cos * D::from(self.base_probability) * FRAC_1_PI).keep(is_lit);
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            if self.used.has(slot) {
                let (lobe_value, lobe_pdf) = lobe.value_pdf(&self.lobes[slot].widen(), facet);
                value += self.scales[slot].widen() * lobe_value;
                pdf += lobe_pdf * D::from(self.probabilities[slot]);
            }
        }
        (self.shadowed(value, facet.wi), pdf)
    }

    /// Returns the part of the values that is due to some of the lobes.
    #[inline(always)]
    pub fn eval_lobes<D: Lane + From<W>>(&self, lobes: LobeSet, facet: &Facet<D>) -> V3<D> {
        let mut value = V3::zero();
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            if lobes.has(slot) && self.used.has(slot) {
                let lobe_value = lobe.value_pdf(&self.lobes[slot].widen(), facet).0;
                value += self.scales[slot].widen() * lobe_value;
            }
        }
        self.shadowed(value, facet.wi)
    }

    /// Returns values for light from `wi` with the shadows of the relief, if it has any.
    #[inline(always)]
    fn shadowed<D: Lane + From<W>>(&self, value: V3<D>, wi: V3<D>) -> V3<D> {
        match self.model.shadows {
            true => value.times(self.model.lit_share(self.level_normal.widen(), wi)),
            false => value,
        }
    }

    /// Samples directions in the lanes of `wanted`. `u_lobe` chooses base or lobe, `u` the direction.
    #[inline(always)]
    pub fn sample<D: Lane + From<W>>(&self, u_lobe: D, u: [D; 2], wanted: D::Mask) -> Sampled<D> {
        let nowhere = D::Mask::all(false);
        let wo = self.wo.widen::<D>();
        let mut below = D::from(self.base_probability);
        let base = below.gt(u_lobe) & wanted;
        let (mut left, mut found) = (wanted & !base, base & wo.z.is_positive());
        let mut facet = Facet::between(wo, cosine_direction(u));
        let mut eta = D::from(1.0);
        let (mut delta, mut straight) = (nowhere, nowhere);
        let (mut delta_weight, mut delta_pdf) = (V3::zero(), D::from(0.0));
        let last = self.model.lobes.len().wrapping_sub(1);
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            let probability = D::from(self.probabilities[slot]);
            below += probability;
            // The last lobe takes the remainder.
            let chosen = if slot == last { left } else { left & below.gt(u_lobe) };
            left = left & !chosen;
            if !chosen.any() {
                continue;
            }
            if lobe.is_delta() {
                let into = lobe.delta(self.scales[slot].widen(), wo);
                let weight = into.weight.times(probability.max(D::from(MIN_WEIGHT)).recip());
                let weight = if into.straight { weight } else { self.shadowed(weight, into.wi) };
                found = found | chosen & into.found & probability.is_positive();
                delta = delta | chosen;
                straight = if into.straight { straight | chosen } else { straight };
                facet.wi = V3::select(chosen, into.wi, facet.wi);
                delta_weight = V3::select(chosen, weight, delta_weight);
                delta_pdf = D::pick(chosen, probability, delta_pdf);
                eta = D::pick(chosen, into.eta, eta);
            } else {
                let (sampled, is_found) = lobe.sample(wo, u, chosen);
                facet = Facet::select(chosen, sampled, facet);
                found = found | chosen & is_found;
                eta = D::pick(chosen, lobe.refraction(wo.z), eta);
            }
        }
        let (mut weight, mut pdf) = (delta_weight, delta_pdf);
        if (wanted & !delta).any() {
            let (value, density) = self.eval_pdf(&facet);
            weight = V3::select(delta, weight, value.times(facet.wi.z.abs() / density));
            found = found & (delta | density.is_positive());
            pdf = D::pick(delta, pdf, density);
        }
        Sampled { wi: facet.wi, weight, pdf, eta, found, delta, straight }
    }

    /// Samples a Lambertian material.
    #[inline(always)]
    pub fn sample_lambert<D: Lane + From<W>>(&self, u: [D; 2], wanted: D::Mask) -> Sampled<D> {
        let (wi, nowhere) = (cosine_direction(u), D::Mask::all(false));
        Sampled {
            wi,
            weight: self.base.times(W::from(PI)).widen(),
            pdf: wi.z * FRAC_1_PI,
            eta: D::from(1.0),
            found: wanted & self.wo.widen::<D>().z.is_positive(),
            delta: nowhere,
            straight: nowhere,
        }
    }
}
