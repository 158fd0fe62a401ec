//! Sampling of directions. Base or lobe is chosen by its estimated albedo; the base is sampled by the cosine, a lobe by
//! its own rule.

use super::lobe::BsdfSample;
use super::model::Bsdf;
use super::seen::Sampled;
use base::math::{Rgb, V3};
use glam::{Vec2, Vec3};

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
        let seen = self.seen(wo, side);
        let sampled = match self.is_lambert() {
            true => seen.sample_lambert(u.to_array(), true),
            false => seen.sample(u_lobe, u.to_array(), true),
        };
        let sample = sampled.found.then(|| sampled.single());
        sample.map(|s| BsdfSample { wi: s.wi * Vec3::new(1.0, 1.0, side), ..s })
    }

    /// Returns the share of the light that passes straight through the surface at the cosine `cos` to the shading
    /// normal, of either sign.
    #[inline]
    pub fn straight_transmittance(&self, cos: f32) -> Rgb {
        let wo = Vec3::new(0.0, 0.0, cos);
        let passing = self.model.lobes.iter().zip(self.scales).filter(|(lobe, _)| lobe.passes_straight());
        let delta = passing.map(|(lobe, scale)| lobe.delta::<f32>(V3::splat(scale), V3::splat(wo)));
        delta.filter(|delta| delta.found).map(|delta| Rgb::from(delta.weight)).sum()
    }

    /// Returns every delta lobe as seen from `wo`.
    pub fn delta_lobes(&self, wo: Vec3) -> DeltaLobes {
        let side = self.side(wo);
        let wo = Vec3::new(wo.x, wo.y, wo.z * side);
        let mut all = DeltaLobes::default();
        for (slot, lobe) in self.model.lobes.iter().enumerate() {
            let delta = lobe.delta::<f32>(V3::splat(self.scales[slot]), V3::splat(wo));
            if !delta.found {
                continue;
            }
            let (wi, weight) = (Vec3::from(delta.wi), Rgb::from(delta.weight));
            let lobe = if (wi.z > 0.0) == (wo.z > 0.0) { &mut all.reflection } else { &mut all.refraction };
            let (wi, straight) = (Vec3::new(wi.x, wi.y, wi.z * side), delta.straight);
            let weight = if straight { weight } else { weight * self.lit_share(wi) };
            match lobe {
                Some(other) => other.weight += weight,
                None => {
                    *lobe = Some(BsdfSample { wi, weight, pdf: 1.0, delta: true, eta: delta.eta, straight });
                }
            }
        }
        all
    }
}

impl Sampled<f32> {
    /// Returns the sample.
    #[inline(always)]
    fn single(&self) -> BsdfSample {
        BsdfSample {
            wi: self.wi.into(),
            weight: self.weight.into(),
            pdf: self.pdf,
            delta: self.delta,
            eta: self.eta,
            straight: self.straight,
        }
    }
}
