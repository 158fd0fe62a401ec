//! Reflection by isotropic microfacets.
//!
//! The value is F D V1(wo) V1(wi), the density of sampling visible normals D V1(wo) / 2 (see [`Microfacets`]). The
//! bound takes the maxima of D and of the Fresnel reflectance F over the half-way normals that a set of directions
//! allows ([`FacetBound`]). Masking times cosine grows with the cosine.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1 (bounds).
//! Deviations: single scattering only; masked light is lost.

use super::{
    DirectionBound, Directions, Directions16, FacetBound, FacetBounds16, LobeLanes, LobeShape, ReflectedLobe,
    Sampled16, SeenLobe, ValuePdf16, mean,
};
use crate::material::fresnel::Curve;
use crate::material::microfacet::Microfacets;
use crate::material::table::{ANGLES, AngleTable};
use base::math::{LANES, Rgb, Vec2x16, Vec3x16, luminance, select};
use glam::{Vec2, Vec3};
use scene::Fresnel;
use std::sync::Arc;

/// Minimum roughness α of lobes that count as diffuse in virtual lights. Eye paths carry the light of sharper lobes.
pub(in crate::material) const DIFFUSE_ALPHA: f32 = 0.25;

/// Maximum reflectance at normal incidence of lobes that count as diffuse in virtual lights.
const DIFFUSE_REFLECTANCE: f32 = 0.1;

/// Maximum roughness α of lobes that eye paths follow like mirrors, because each virtual light would show as a
/// highlight in them.
const SHARP_ALPHA: f32 = 0.1;

/// Rough reflection lobe without its factor. Lobes are equal if roughness and Fresnel reflectance are.
#[derive(Clone, Debug)]
pub(in crate::material) struct RoughLobe {
    pub(in crate::material) facets: Microfacets,
    pub(in crate::material) fresnel: Fresnel,
    /// Maximum reflectance by the minimum cosine, for curves whose formula is slow.
    max_reflectance: Option<Arc<AngleTable<Rgb>>>,
    /// Albedo by angle, if it is needed.
    pub(in crate::material) albedo: Option<Arc<AngleTable<Rgb>>>,
    /// Albedo by angle of facets that absorb nothing, if virtual lights may radiate by the lobe.
    pub(in crate::material) white: Option<Arc<AngleTable<Rgb>>>,
}

impl PartialEq for RoughLobe {
    fn eq(&self, other: &RoughLobe) -> bool {
        self.facets == other.facets && self.fresnel == other.fresnel
    }
}

impl RoughLobe {
    /// Makes a lobe without tables of its albedo.
    pub fn new(facets: Microfacets, fresnel: Fresnel) -> RoughLobe {
        let max_reflectance = match fresnel {
            Fresnel::Conductor { .. } | Fresnel::Schlick { .. } => {
                Some(Arc::new(max_reflectance_table(&fresnel)))
            }
            Fresnel::One | Fresnel::Dielectric(_) => None,
        };
        RoughLobe { facets, fresnel, max_reflectance, albedo: None, white: None }
    }

    /// Returns the roughness α.
    pub fn alpha(&self) -> f32 {
        self.facets.alpha
    }

    /// Returns true if the lobe is too sharp to count as diffuse.
    #[inline]
    pub fn is_glossy(&self) -> bool {
        self.facets.alpha < DIFFUSE_ALPHA
    }

    /// Returns true if eye paths follow the lobe.
    #[inline]
    pub fn is_sharp(&self) -> bool {
        self.facets.alpha <= SHARP_ALPHA
    }

    /// See [`super::LobeModel::eval_pdf`].
    #[inline]
    pub(super) fn eval_pdf(&self, scale: Rgb, probability: f32, d: &Directions) -> (Rgb, f32) {
        if !(d.wo.z > 0.0 && d.wi.z > 0.0) {
            return (Rgb::ZERO, 0.0);
        }
        let density = self.facets.density(d.half);
        let cos_o = d.wo.z.min(1.0);
        let masked = density * self.facets.v1(cos_o) * self.facets.v1(d.wi.z.min(1.0));
        let value = scale * self.fresnel.reflectance(d.wo.dot(d.half).min(1.0)) * masked;
        (value, probability * 0.5 * density * self.facets.v1_exact(cos_o))
    }

    /// See [`super::LobeModel::sample`].
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
        let half = self.facets.sample_visible(wo, u);
        let wi = (2.0 * wo.dot(half)) * half - wo;
        (wo.z > 0.0 && wi.z > 0.0).then_some(Directions { wo, wi, half })
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline]
    pub(super) fn sampling_weight(&self, scale: Rgb, cos: f32, transmittance: f32) -> f32 {
        match &self.albedo {
            _ if cos <= 0.0 => 0.0,
            Some(table) => mean(scale * table.lookup(cos)),
            None => mean(scale) * (1.0 - transmittance).max(0.0),
        }
    }

    /// Returns the albedo for light at the cosine `cos` > 0; that of a mirror if no table was made.
    pub(super) fn mean_reflectance(&self, scale: Rgb, cos: f32) -> Rgb {
        let tabulated = self.albedo.as_ref().map(|table| table.lookup(cos));
        scale * tabulated.unwrap_or_else(|| self.fresnel.reflectance(cos.min(1.0)))
    }

    /// See [`super::LobeModel::diffuse_albedo`].
    #[inline]
    pub(super) fn diffuse_albedo(&self, scale: Rgb, cos: f32) -> Option<Rgb> {
        let table = self.albedo.as_ref().filter(|_| !self.is_glossy())?;
        Some(scale * table.lookup(cos))
    }

    /// Returns true if virtual lights may radiate by the lobe, for a factor of 1.
    pub(in crate::material) fn may_radiate(&self) -> bool {
        !self.is_glossy() && luminance(self.fresnel.reflectance(1.0)) > DIFFUSE_REFLECTANCE
    }

    /// See [`super::LobeModel::reflected`].
    pub(super) fn reflected(&self, scale: Rgb, cos: f32) -> Option<ReflectedLobe> {
        let albedo = self.diffuse_albedo(scale, cos)?;
        let white = self.white.as_ref()?.lookup(cos).x;
        let facing = luminance(scale * self.fresnel.reflectance(1.0));
        let shape = LobeShape::new(self.facets);
        let peak = shape.peak(cos.min(1.0), white);
        (facing > DIFFUSE_REFLECTANCE && peak.is_finite()).then_some(ReflectedLobe { albedo, peak, shape })
    }

    /// See [`super::LobeModel::bound`].
    #[inline]
    pub(super) fn bound(&self, scale: Rgb, bound: &FacetBound) -> Rgb {
        let density = self.facets.max_density(bound.sin_sq);
        let masked = density * self.facets.v1(bound.cos_o) * 0.5 * self.facets.max_g1(bound.cos_max);
        let reflectance = match &self.max_reflectance {
            Some(table) => table.floor(bound.cos_d),
            None => self.fresnel.reflectance(bound.cos_d),
        };
        scale * reflectance * (masked * DirectionBound::WIDER)
    }

    /// See [`super::LobeModel::set_lane`].
    #[inline]
    pub(super) fn set_lane(&self, lanes: &mut LobeLanes, lane: usize, scale: Rgb, wo: Vec3) {
        lanes.scale.set(lane, scale);
        lanes.masking[lane] = self.facets.v1(wo.z.min(1.0));
    }

    /// See [`super::LobeModel::add_value16`].
    #[inline(always)]
    pub(super) fn add_value16(&self, lanes: &LobeLanes, d: &Directions16, sum: &mut Vec3x16) {
        let reflectance = self.fresnel.reflectance16(&d.cos_d);
        let mut masked = self.facets.density16(&d.sin_sq, &d.cos_sq);
        let masking = self.facets.v1_16(&d.wi.z);
        for l in 0..LANES {
            masked[l] *= lanes.masking[l] * masking[l];
            masked[l] = select(d.sin_sq[l] + d.cos_sq[l] > 0.0, masked[l], 0.0);
        }
        lanes.add(sum, &reflectance, &masked);
    }

    /// See [`super::LobeModel::seen`].
    #[inline]
    pub(super) fn seen(&self, probability: f32, wo: Vec3) -> SeenLobe {
        let cos = wo.z.min(1.0);
        SeenLobe { masking: self.facets.v1(cos), density: probability * 0.5 * self.facets.v1_exact(cos) }
    }

    /// See [`super::LobeModel::add_eval_pdf16`].
    #[inline]
    pub(super) fn add_eval_pdf16(&self, scale: Rgb, seen: &SeenLobe, d: &Directions16, sum: &mut ValuePdf16) {
        let density = self.facets.density16(&d.sin_sq, &d.cos_sq);
        let reflectance = self.fresnel.reflectance16(&d.cos_d);
        let mut masked = self.facets.v1_16(&d.wi.z);
        let mut pdf = [0.0; LANES];
        for l in 0..LANES {
            let reflects = d.reflects(l);
            masked[l] = select(reflects, density[l] * seen.masking * masked[l], 0.0);
            pdf[l] = select(reflects, density[l] * seen.density, 0.0);
        }
        sum.add(scale, &reflectance, &masked, &pdf);
    }

    /// See [`super::LobeModel::sample16`]; `wo` is on the side of the normal.
    #[inline]
    pub(super) fn sample16(&self, wo: Vec3, u: &Vec2x16, mask: u16, sampled: &mut Sampled16) {
        match self.facets.ggx_normals16(wo, u) {
            Some(half) => sampled.reflect(wo, &half, mask),
            None => sampled.one_by_one(mask, |l| self.sample(wo, u.get(l))),
        }
    }

    /// See [`super::LobeModel::add_bound16`].
    #[inline(always)]
    pub(super) fn add_bound16(&self, lanes: &LobeLanes, bounds: &FacetBounds16, sum: &mut Vec3x16) {
        let mut masked = self.facets.max_density16(&bounds.sin_sq);
        for l in 0..LANES {
            let cos = bounds.cos_max[l];
            let lit = cos > 0.0;
            let max_g1 = self.facets.max_g1(if lit { cos } else { 1.0 });
            masked[l] *= lanes.masking[l] * 0.5 * max_g1 * DirectionBound::WIDER;
            masked[l] = if lit { masked[l] } else { 0.0 };
        }
        let reflectance = match &self.max_reflectance {
            Some(table) => {
                let mut reflectance = Vec3x16::default();
                (0..LANES).for_each(|l| reflectance.set(l, table.floor(bounds.cos_d[l])));
                reflectance
            }
            None => self.fresnel.reflectance16(&bounds.cos_d),
        };
        lanes.add(sum, &reflectance, &masked);
    }
}

/// Tabulates the maximum reflectance at any cosine >= that of each entry, so that [`AngleTable::floor`] is a bound.
fn max_reflectance_table(fresnel: &Fresnel) -> AngleTable<Rgb> {
    let normal = fresnel.reflectance(1.0);
    AngleTable(std::array::from_fn(|i| {
        let cos = i as f32 / (ANGLES - 1) as f32;
        fresnel.max_reflectance((cos - 1e-6).max(0.0), normal)
    }))
}
