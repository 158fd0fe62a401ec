//! Sampling of directions. Base or lobe is chosen by its estimated albedo; the base is sampled by the cosine, a lobe by
//! its own rule.

use super::bsdf::Outgoing;
use super::lobe::{BsdfSample, MAX_LOBES};
use super::model::Bsdf;
use base::math::Rgb;
use base::sampling::cosine_hemisphere;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// All delta lobes of a material, for following specular chains without randomness. Each weight is the lobe's
/// reflectance or transmittance, and each pdf is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeltaLobes {
    /// Specular reflection.
    pub reflection: Option<BsdfSample>,
    /// Specular refraction or straight transmission.
    pub refraction: Option<BsdfSample>,
}

impl Bsdf<'_> {
    /// Samples `wi` with density [`Bsdf::pdf`], or a delta lobe. `u_lobe` chooses base or lobe, `u` the direction.
    ///
    /// Returns `None` if nothing is scattered or the sampled facet reflects light into the surface: the path ends.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let side = self.side(wo);
        let wo = Vec3::new(wo.x, wo.y, wo.z * side);
        if !(wo.z > 0.0) && !self.model.kinds.pass_light {
            return None;
        }
        let mut sample = if self.is_lambert() {
            let wi = cosine_hemisphere(u);
            let weight = self.base * PI;
            BsdfSample { wi, weight, pdf: wi.z * FRAC_1_PI, delta: false, eta: 1.0, straight: false }
        } else {
            self.sample_layered(&self.outgoing(wo), u_lobe, u)?
        };
        sample.wi.z *= side;
        Some(sample)
    }

    /// Samples a material that is more than Lambertian.
    pub(super) fn sample_layered(&self, outgoing: &Outgoing, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let wo = outgoing.wo;
        let smooth = |wi: Vec3, eta: f32, (value, pdf): (Rgb, f32)| {
            let weight = value * (wi.z.abs() / pdf);
            let sample = BsdfSample { wi, weight, pdf, delta: false, eta, straight: false };
            (pdf > 0.0).then_some(sample)
        };
        if u_lobe < outgoing.base_probability {
            let wi = cosine_hemisphere(u);
            return smooth(wi, 1.0, self.eval_pdf_layered(outgoing, wi));
        }
        let slot = self.pick(outgoing, u_lobe)?;
        let (lobe, pdf) = (&self.model.lobes[slot], outgoing.probabilities[slot]);
        if !lobe.is_delta() {
            let directions = lobe.sample(wo, u)?;
            let eta = lobe.refraction(wo);
            return smooth(directions.wi, eta, self.eval_pdf_between(outgoing, &directions));
        }
        let sample = lobe.delta(self.scales[slot], wo)?;
        (pdf > 0.0).then_some(BsdfSample { weight: sample.weight / pdf, pdf, ..sample })
    }

    /// Returns the slot of the lobe that `u_lobe`, beyond the base's probability, chooses.
    #[inline]
    fn pick(&self, outgoing: &Outgoing, u_lobe: f32) -> Option<usize> {
        let last = self.model.lobes.len().checked_sub(1)?;
        let mut below = outgoing.base_probability;
        for slot in 0..last.min(MAX_LOBES - 1) {
            below += outgoing.probabilities[slot];
            if u_lobe < below {
                return Some(slot);
            }
        }
        Some(last)
    }

    /// Returns the share of the light that passes straight through the surface at the cosine `cos` to the shading
    /// normal, of either sign.
    #[inline]
    pub fn straight_transmittance(&self, cos: f32) -> Rgb {
        let wo = Vec3::new(0.0, 0.0, cos);
        let passing = self.model.lobes.iter().zip(self.scales).filter(|(lobe, _)| lobe.passes_straight());
        passing.filter_map(|(lobe, scale)| lobe.delta(scale, wo)).map(|sample| sample.weight).sum()
    }

    /// Returns every delta lobe as seen from `wo`.
    pub fn delta_lobes(&self, wo: Vec3) -> DeltaLobes {
        let side = self.side(wo);
        let wo = Vec3::new(wo.x, wo.y, wo.z * side);
        let mut all = DeltaLobes::default();
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            let Some(mut sample) = lobe.delta(self.scales[slot], wo) else { continue };
            let lobe =
                if (sample.wi.z > 0.0) == (wo.z > 0.0) { &mut all.reflection } else { &mut all.refraction };
            sample.wi.z *= side;
            match lobe {
                Some(other) => other.weight += sample.weight,
                None => *lobe = Some(sample),
            }
        }
        all
    }
}
