//! Reflection by microfacets whose roughness differs along u and v of the texture: brushed metals.
//!
//! The facets are those of an isotropic distribution of roughness 1 after a stretch of the surface by (α_u, α_v, 1).
//! Density, masking and sampling follow from that distribution ([`Microfacets`]). Local x is along u.
//!
//! Paper: E. Heitz, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, 2014, section 5.3.
//! Deviations: eye paths follow the lobe for any roughness, because virtual lights and series do not support a
//! direction on the surface. The bounds use the larger roughness for the density and the smaller one for masking. The
//! albedo is the mean over azimuths.

use super::{
    DirectionBound, Directions, Directions16, FacetBound, FacetBounds16, LobeLanes, SeenLobe, ValuePdf16,
    mean,
};
use crate::material::fresnel::Curve;
use crate::material::microfacet::Microfacets;
use crate::material::table::{AngleTable, rule};
use base::math::{LANES, Rgb, Vec3x16, select};
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
                let Some(d) = self.sample(wo, Vec2::new(u, v)) else { continue };
                let reflectance = self.fresnel.reflectance(wo.dot(d.half).min(1.0));
                sum += reflectance * (2.0 * d.wi.z * self.v1(d.wi) * weight_u * weight_v);
            }
        }
        sum / AZIMUTHS as f32
    }

    /// Returns a direction after the stretch, not of unit length.
    #[inline]
    fn stretched(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.x * self.alpha.x, v.y * self.alpha.y, v.z)
    }

    /// Returns the area of facets with unit normal `h` per area and solid angle.
    #[inline]
    fn density(&self, h: Vec3) -> f32 {
        let slopes = Vec2::new(h.x, h.y) / self.alpha;
        self.unit.density_from(slopes.length_squared(), h.z * h.z) / (self.alpha.x * self.alpha.y)
    }

    /// Returns V1 = G1 / (2 cos θ) for the unit direction `v` above the surface.
    #[inline]
    fn v1(&self, v: Vec3) -> f32 {
        let stretched = self.stretched(v);
        let length = stretched.length();
        self.unit.v1((stretched.z / length).min(1.0)) / length
    }

    /// Returns the V1 of the density of visible normals (see [`Microfacets::v1_exact`]).
    #[inline]
    fn v1_exact(&self, v: Vec3) -> f32 {
        let stretched = self.stretched(v);
        let length = stretched.length();
        self.unit.v1_exact((stretched.z / length).min(1.0)) / length
    }

    /// See [`super::LobeModel::eval_pdf`].
    #[inline]
    pub fn eval_pdf(&self, scale: Rgb, probability: f32, d: &Directions) -> (Rgb, f32) {
        if !(d.wo.z > 0.0 && d.wi.z > 0.0) {
            return (Rgb::ZERO, 0.0);
        }
        let density = self.density(d.half);
        let masked = density * self.v1(d.wo) * self.v1(d.wi);
        let value = scale * self.fresnel.reflectance(d.wo.dot(d.half).min(1.0)) * masked;
        (value, probability * 0.5 * density * self.v1_exact(d.wo))
    }

    /// See [`super::LobeModel::sample`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
        let slope = self.unit.sample_visible(self.stretched(wo).normalize(), u);
        let half = self.stretched(slope).try_normalize()?;
        let wi = (2.0 * wo.dot(half)) * half - wo;
        (wo.z > 0.0 && wi.z > 0.0).then_some(Directions { wo, wi, half })
    }

    /// Returns the albedo for light at the cosine `cos`, averaged over azimuths.
    #[inline]
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        scale * self.albedo.lookup(cos)
    }

    /// See [`super::LobeModel::sampling_weight`].
    #[inline]
    pub fn sampling_weight(&self, scale: Rgb, cos: f32) -> f32 {
        if cos > 0.0 { mean(self.albedo(scale, cos)) } else { 0.0 }
    }

    /// Returns a bound of value times cosine, without the factor.
    #[inline]
    fn most(&self, masking: f32, sin_sq: f32, cos_max: f32, cos_d: f32) -> Rgb {
        let [narrow, wide] = &self.ends;
        let density = wide.max_density(sin_sq) * (wide.alpha / narrow.alpha);
        let masked = density * OVERSHOOT * OVERSHOOT * masking * 0.5 * narrow.max_g1(cos_max);
        self.fresnel.max_reflectance(cos_d, self.fresnel.reflectance(1.0)) * (masked * DirectionBound::WIDER)
    }

    /// See [`super::LobeModel::bound`].
    #[inline]
    pub fn bound(&self, scale: Rgb, bound: &FacetBound) -> Rgb {
        scale * self.most(self.ends[0].v1(bound.cos_o), bound.sin_sq, bound.cos_max, bound.cos_d)
    }

    /// See [`super::LobeModel::set_lane`].
    #[inline]
    pub fn set_lane(&self, lanes: &mut LobeLanes, lane: usize, scale: Rgb, wo: Vec3) {
        lanes.scale.set(lane, scale);
        lanes.masking[lane] = self.ends[0].v1(wo.z.min(1.0));
    }

    /// See [`super::LobeModel::add_value16`].
    pub fn add_value16(&self, lanes: &LobeLanes, d: &Directions16, sum: &mut Vec3x16) {
        for l in 0..LANES {
            if let Some(d) = Directions::new(d.wo.get(l), d.wi.get(l)) {
                sum.set(l, sum.get(l) + self.eval_pdf(lanes.scale.get(l), 0.0, &d).0);
            }
        }
    }

    /// See [`super::LobeModel::seen`].
    #[inline]
    pub fn seen(&self, probability: f32, wo: Vec3) -> SeenLobe {
        SeenLobe { masking: self.v1(wo), density: probability * 0.5 * self.v1_exact(wo) }
    }

    /// See [`super::LobeModel::add_eval_pdf16`].
    pub fn add_eval_pdf16(&self, scale: Rgb, seen: &SeenLobe, d: &Directions16, sum: &mut ValuePdf16) {
        let (inverse, area) = (1.0 / (self.alpha * self.alpha), self.alpha.x * self.alpha.y);
        let (mut slope_sq, mut cos, mut inv_length) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            slope_sq[l] = d.x_sq[l] * inverse.x + d.y_sq[l] * inverse.y;
            let stretched = self.stretched(d.wi.get(l));
            inv_length[l] = 1.0 / stretched.length();
            cos[l] = stretched.z * inv_length[l];
        }
        let density = self.unit.density16(&slope_sq, &d.cos_sq);
        let reflectance = self.fresnel.reflectance16(&d.cos_d);
        let mut masked = self.unit.v1_16(&cos);
        let mut pdf = [0.0; LANES];
        for l in 0..LANES {
            let density = select(d.reflects(l), density[l] / area, 0.0);
            let masking = select(d.reflects(l), masked[l] * inv_length[l], 0.0);
            masked[l] = density * seen.masking * masking;
            pdf[l] = density * seen.density;
        }
        sum.add(scale, &reflectance, &masked, &pdf);
    }

    /// See [`super::LobeModel::add_bound16`].
    pub fn add_bound16(&self, lanes: &LobeLanes, bounds: &FacetBounds16, sum: &mut Vec3x16) {
        for l in 0..LANES {
            let cos = bounds.cos_max[l];
            if cos > 0.0 {
                let most = self.most(lanes.masking[l], bounds.sin_sq[l], cos, bounds.cos_d[l]);
                sum.set(l, sum.get(l) + lanes.scale.get(l) * most);
            }
        }
    }
}
