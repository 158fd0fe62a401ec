//! Reflection by isotropic microfacets.
//!
//! The value is F D V1(wo) V1(wi), the density of sampling visible normals D V1(wo) / 2 (see [`Microfacets`]). The
//! bound takes the maxima of D and of the Fresnel reflectance F over the half-way normals that a set of directions
//! allows ([`FacetBound`]). Masking times cosine grows with the cosine.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1 (bounds).
//! Deviations: single scattering only; masked light is lost.

use super::{DirectionBound, Facet, FacetBound, LobeShape, ReflectedLobe, SeenLobe, means};
use crate::material::fresnel::Curve;
use crate::material::microfacet::Microfacets;
use crate::material::table::{ANGLES, AngleTable};
use base::math::{Lane, Rgb, V3, luminance};
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

    /// See [`super::LobeModel::seen`].
    #[inline(always)]
    pub(super) fn seen<L: Lane>(&self, wo: V3<L>) -> SeenLobe<L> {
        SeenLobe { masking: self.facets.v1(wo.z), density: self.facets.v1_exact(wo.z) * 0.5 }
    }

    /// See [`super::LobeModel::value_pdf`]: F D V1(wo) V1(wi), and D V1(wo) / 2.
    #[inline(always)]
    pub(super) fn value_pdf<L: Lane>(&self, seen: &SeenLobe<L>, facet: &Facet<L>) -> (V3<L>, L) {
        let (sin_sq, cos_sq) = facet.inclination();
        let density = self.facets.density(sin_sq, cos_sq);
        let masked = density * seen.masking * self.facets.v1(facet.wi.z);
        (self.fresnel.reflected(facet.cos_d).times(masked), density * seen.density)
    }

    /// See [`super::LobeModel::sample`].
    #[inline(always)]
    pub(super) fn sample<L: Lane>(&self, wo: V3<L>, u: [L; 2]) -> Facet<L> {
        Facet::reflected(wo, self.facets.sample_visible(wo, u))
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline(always)]
    pub(super) fn sampling_weight<L: Lane>(&self, scale: V3<L>, cos: L, transmittance: L) -> L {
        match &self.albedo {
            Some(table) => means(scale * table.colours(cos)),
            None => means(scale) * transmittance.rest().positive(),
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

    /// See [`super::LobeModel::max_masking`].
    #[inline(always)]
    pub(super) fn max_masking<L: Lane>(&self, cos_o: L) -> L {
        self.facets.v1(cos_o)
    }

    /// See [`super::LobeModel::bound`].
    #[inline(always)]
    pub(super) fn bound<L: Lane>(&self, masking: L, bound: &FacetBound<L>) -> V3<L> {
        let masked = self.facets.max_density(bound.sin_sq) * masking * self.facets.max_g1(bound.cos_max);
        let reflectance = match &self.max_reflectance {
            Some(table) => V3::from_fn(|lane| table.floor(bound.cos_d.lane(lane))),
            None => self.fresnel.reflected(bound.cos_d),
        };
        reflectance.times(masked * (0.5 * DirectionBound::WIDER))
    }
}

/// Tabulates the maximum reflectance at any cosine >= that of each entry, so that [`AngleTable::floor`] is a bound.
fn max_reflectance_table(fresnel: &Fresnel) -> AngleTable<Rgb> {
    let normal = fresnel.reflectance(1.0);
    AngleTable(std::array::from_fn(|i| {
        let cos = i as f32 / (ANGLES - 1) as f32;
        fresnel.max_reflectance(f32::max(cos - 1e-6, 0.0), normal).into()
    }))
}
