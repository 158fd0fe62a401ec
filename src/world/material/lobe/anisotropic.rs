//! Reflection by microfacets whose roughness differs along u and v of the texture: brushed metals.
//!
//! The facets are those of an isotropic distribution of roughness 1 after a stretch of the surface by (α_u, α_v, 1).
//! Density, masking and sampling follow from that distribution ([`Microfacets`]). Local x is along u.
//!
//! Paper: E. Heitz, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, 2014, section 5.3.
//! Deviations: eye paths follow the lobe for any roughness, because virtual lights and series do not support a
//! direction on the surface. The bounds use the larger roughness for the density and the smaller one for masking. The
//! albedo is the mean over azimuths.

use super::{DirectionBound, Facet, FacetBound, SeenLobe, means};
use crate::material::fresnel::Curve;
use crate::material::microfacet::Microfacets;
use crate::material::table::{AngleTable, rule};
use base::math::{Lane, Rgb, V3};
use glam::{Vec2, Vec3};
use scene::{Distribution, Fresnel};
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// Number of azimuths in a quarter of the circle over which the albedo is averaged.
const AZIMUTHS: usize = 4;

/// Factor by which masking may exceed that of the smaller roughness, because Walter's fit of Beckmann's masking exceeds
/// 1 by 7e-5.
const OVERSHOOT: f32 = 1.0001;

/// Anisotropic lobe without its factor. Lobes are equal if roughness and Fresnel reflectance are.
#[derive(Clone, Debug)]
pub(in crate::material) struct AnisotropicLobe {
    /// The distribution of roughness 1.
    unit: Microfacets,
    /// Distributions of the smaller and the larger roughness.
    ends: [Microfacets; 2],
    /// Roughness along x and y.
    alpha: Vec2,
    fresnel: Fresnel,
    /// Albedo by angle; black until it is tabulated.
    pub albedo: Arc<AngleTable<Rgb>>,
}

impl PartialEq for AnisotropicLobe {
    fn eq(&self, other: &AnisotropicLobe) -> bool {
        self.unit == other.unit && self.alpha == other.alpha && self.fresnel == other.fresnel
    }
}

impl AnisotropicLobe {
    /// Builds a lobe of a roughness along x and one along y, without its albedo.
    pub fn new(distribution: Distribution, alpha: [f32; 2], fresnel: Fresnel) -> AnisotropicLobe {
        let ends = [alpha[0].min(alpha[1]), alpha[0].max(alpha[1])];
        let ends = ends.map(|alpha| Microfacets::new(distribution, alpha));
        let alpha = alpha.map(|alpha| Microfacets::new(distribution, alpha).alpha);
        let black = Arc::new(AngleTable([Rgb::ZERO; crate::material::table::ANGLES]));
        let unit = Microfacets::new(distribution, 1.0);
        AnisotropicLobe { unit, ends, alpha: Vec2::from(alpha), fresnel, albedo: black }
    }

    /// Tabulates the albedo by angle.
    pub fn albedo_table(&self) -> AngleTable<Rgb> {
        let nodes = rule(24);
        AngleTable::new(|wo| self.integrated(wo, &nodes))
    }

    /// Returns the roughness along x and along y.
    pub fn alpha(&self) -> [f32; 2] {
        self.alpha.to_array()
    }

    /// Returns the lobe with another roughness along x and along y.
    pub fn with_alpha(&self, alpha: [f32; 2]) -> AnisotropicLobe {
        AnisotropicLobe::new(self.unit.distribution, alpha, self.fresnel)
    }

    /// Returns the smaller roughness α.
    pub(super) fn min_alpha(&self) -> f32 {
        self.alpha.min_element()
    }

    /// Integrates the albedo for the inclination of `wo`, in the xz plane, as the mean over azimuths.
    fn integrated(&self, wo: Vec3, rule: &[(f32, f32)]) -> Rgb {
        let mut sum = Rgb::ZERO;
        for i in 0..AZIMUTHS {
            let azimuth = (i as f32 + 0.5) * FRAC_PI_2 / AZIMUTHS as f32;
            let wo = Vec3::new(wo.x * azimuth.cos(), wo.x * azimuth.sin(), wo.z);
            for (&(u, weight_u), &(v, weight_v)) in rule.iter().flat_map(|u| rule.iter().map(move |v| (u, v)))
            {
                let facet = self.sample(V3::splat(wo), [u, v]);
                if facet.reflects {
                    let reflectance = self.fresnel.reflectance(facet.cos_d);
                    sum += reflectance * (2.0 * facet.wi.z * self.v1(facet.wi) * weight_u * weight_v);
                }
            }
        }
        sum / AZIMUTHS as f32
    }

    /// Returns a direction after the stretch, not of unit length.
    #[inline(always)]
    fn stretched<L: Lane>(&self, v: V3<L>) -> V3<L> {
        V3::new(v.x * self.alpha.x, v.y * self.alpha.y, v.z)
    }

    /// Returns the area of facets with unit normal `h` per area and solid angle.
    #[inline(always)]
    fn density<L: Lane>(&self, h: V3<L>) -> L {
        let slopes_sq = (h.x * (1.0 / self.alpha.x)).sq() + (h.y * (1.0 / self.alpha.y)).sq();
        self.unit.density(slopes_sq, h.z.sq()) * (1.0 / (self.alpha.x * self.alpha.y))
    }

    /// Returns V1 = G1 / (2 cos θ) for the unit direction `v` above the surface.
    #[inline(always)]
    fn v1<L: Lane>(&self, v: V3<L>) -> L {
        let stretched = self.stretched(v);
        let inv_length = stretched.length_sq().rsqrt();
        self.unit.v1(stretched.z * inv_length) * inv_length
    }

    /// See [`super::LobeModel::seen`].
    #[inline(always)]
    pub(super) fn seen<L: Lane>(&self, wo: V3<L>) -> SeenLobe<L> {
        let stretched = self.stretched(wo);
        let inv_length = stretched.length_sq().rsqrt();
        let exact = self.unit.v1_exact(stretched.z * inv_length) * inv_length;
        SeenLobe { masking: self.v1(wo), density: exact * 0.5 }
    }

    /// See [`super::LobeModel::value_pdf`].
    #[inline(always)]
    pub(super) fn value_pdf<L: Lane>(&self, seen: &SeenLobe<L>, facet: &Facet<L>) -> (V3<L>, L) {
        let density = self.density(facet.half);
        let masked = density * seen.masking * self.v1(facet.wi);
        (self.fresnel.reflected(facet.cos_d).times(masked), density * seen.density)
    }

    /// See [`super::LobeModel::sample`].
    #[inline(always)]
    pub(super) fn sample<L: Lane>(&self, wo: V3<L>, u: [L; 2]) -> Facet<L> {
        let stretched = self.stretched(wo);
        let slope = self.unit.sample_visible(stretched.times(stretched.length_sq().rsqrt()), u);
        let half = self.stretched(slope);
        Facet::reflected(wo, half.times(half.length_sq().max(L::from(f32::MIN_POSITIVE)).rsqrt()))
    }

    /// Returns the albedo for light at the cosine `cos`, averaged over azimuths.
    #[inline]
    pub(super) fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        scale * self.albedo.lookup(cos)
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline(always)]
    pub(super) fn sampling_weight<L: Lane>(&self, scale: V3<L>, cos: L) -> L {
        means(scale * self.albedo.colours(cos))
    }

    /// See [`super::LobeModel::max_masking`].
    #[inline(always)]
    pub(super) fn max_masking<L: Lane>(&self, cos_o: L) -> L {
        self.ends[0].v1(cos_o)
    }

    /// See [`super::LobeModel::bound`].
    #[inline(always)]
    pub(super) fn bound<L: Lane>(&self, masking: L, bound: &FacetBound<L>) -> V3<L> {
        let [narrow, wide] = &self.ends;
        let wider = OVERSHOOT * OVERSHOOT * 0.5 * DirectionBound::WIDER * (wide.alpha / narrow.alpha);
        let masked = wide.max_density(bound.sin_sq) * masking * narrow.max_g1(bound.cos_max) * wider;
        self.fresnel.max_reflectance(bound.cos_d, self.fresnel.reflectance(1.0)).times(masked)
    }
}
