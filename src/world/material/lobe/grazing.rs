//! Broad scattering at grazing angles: retroreflection of rough diffuse surfaces and sheen of fibres, for the
//! principled material.
//!
//! Paper: B. Burley, *Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering*, 2015, equation 4;
//! *Physically Based Shading at Disney*, 2012, section 5.2.

use super::{
    DirectionBound, Directions, Directions16, FacetBound, FacetBounds16, LobeLanes, SeenLobe, ValuePdf16,
};
use crate::material::fresnel::schlick_weight;
use crate::material::table::{AngleTable, rule};
use base::math::{LANES, Rgb, Vec3x16, select};
use base::sampling::cosine_hemisphere;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::Arc;

/// Kind of grazing scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::material) enum GrazingKind {
    /// Retroreflection of a rough diffuse surface.
    Retro {
        /// Square root of α.
        roughness: f32,
    },
    /// Sheen of fibres.
    Sheen,
}

/// Lobe of grazing scattering without its factor.
#[derive(Clone, Debug)]
pub(in crate::material) struct Grazing {
    kind: GrazingKind,
    /// Albedo by angle.
    albedo: Arc<AngleTable<f32>>,
}

impl PartialEq for Grazing {
    fn eq(&self, other: &Grazing) -> bool {
        self.kind == other.kind
    }
}

impl GrazingKind {
    /// Returns the value in 1/sr from the weights of Schlick's approximation for both directions and the cosine between
    /// either direction and the half-way normal. The value grows with both weights. It grows with the cosine for
    /// retroreflection and falls for sheen.
    #[inline]
    fn value(self, [out, into]: [f32; 2], cos_d: f32) -> f32 {
        match self {
            GrazingKind::Retro { roughness } => {
                let r = 2.0 * roughness * cos_d * cos_d;
                FRAC_1_PI * r * (out + into + out * into * (r - 1.0))
            }
            GrazingKind::Sheen => schlick_weight(cos_d),
        }
    }

    /// Returns the maximum value for cosines with the half-way normal of at least `cos_d`.
    #[inline]
    fn max_value(self, weights: [f32; 2], cos_d: f32) -> f32 {
        match self {
            GrazingKind::Retro { .. } => self.value(weights, 1.0),
            GrazingKind::Sheen => self.value(weights, cos_d),
        }
    }
}

impl Grazing {
    /// Builds a lobe and tabulates its albedo.
    pub fn new(kind: GrazingKind) -> Grazing {
        let nodes = rule(24);
        let albedo = AngleTable::new(|wo| {
            let mut sum = 0.0;
            for &(u, weight_u) in &nodes {
                // Equal steps of the squared cosine are equal in irradiance.
                let (cos, sin) = (u.sqrt(), (1.0 - u).sqrt());
                for &(v, weight_v) in &nodes {
                    let (sin_phi, cos_phi) = (PI * v).sin_cos();
                    let wi = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
                    let value =
                        Directions::new(wo, wi).map_or(0.0, |d| kind.value(weights(&d), d.wo.dot(d.half)));
                    sum += weight_u * weight_v * PI * value;
                }
            }
            sum
        });
        Grazing { kind, albedo: Arc::new(albedo) }
    }

    /// See [`super::LobeModel::eval_pdf`].
    #[inline]
    pub fn eval_pdf(&self, scale: Rgb, probability: f32, d: &Directions) -> (Rgb, f32) {
        if !(d.wo.z > 0.0 && d.wi.z > 0.0) {
            return (Rgb::ZERO, 0.0);
        }
        (scale * self.kind.value(weights(d), d.wo.dot(d.half).min(1.0)), probability * d.wi.z * FRAC_1_PI)
    }

    /// See [`super::LobeModel::sample`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<Directions> {
        Directions::new(wo, cosine_hemisphere(u)).filter(|_| wo.z > 0.0)
    }

    /// Returns the albedo for light at the cosine `cos` > 0.
    #[inline]
    pub fn albedo(&self, scale: Rgb, cos: f32) -> Rgb {
        if cos > 0.0 { scale * self.albedo.lookup(cos) } else { Rgb::ZERO }
    }

    /// See [`super::LobeModel::bound`].
    #[inline]
    pub fn bound(&self, scale: Rgb, bound: &FacetBound) -> Rgb {
        let weights = [schlick_weight(bound.cos_o), schlick_weight(bound.cos_min)];
        scale * (self.kind.max_value(weights, bound.cos_d) * bound.cos_max * DirectionBound::WIDER)
    }

    /// See [`super::LobeModel::set_lane`].
    #[inline]
    pub fn set_lane(&self, lanes: &mut LobeLanes, lane: usize, scale: Rgb, wo: Vec3) {
        lanes.scale.set(lane, scale);
        lanes.masking[lane] = schlick_weight(wo.z);
    }

    /// See [`super::LobeModel::add_value16`].
    pub fn add_value16(&self, lanes: &LobeLanes, d: &Directions16, sum: &mut Vec3x16) {
        for l in 0..LANES {
            if d.wi.z[l] > 0.0 && d.sin_sq[l] + d.cos_sq[l] > 0.0 {
                let value = self.kind.value([lanes.masking[l], schlick_weight(d.wi.z[l])], d.cos_d[l]);
                sum.set(l, sum.get(l) + lanes.scale.get(l) * value);
            }
        }
    }

    /// See [`super::LobeModel::seen`].
    #[inline]
    pub fn seen(&self, probability: f32, wo: Vec3) -> SeenLobe {
        SeenLobe { masking: schlick_weight(wo.z), density: probability * FRAC_1_PI }
    }

    /// See [`super::LobeModel::add_eval_pdf16`].
    pub fn add_eval_pdf16(&self, scale: Rgb, seen: &SeenLobe, d: &Directions16, sum: &mut ValuePdf16) {
        let (mut value, mut pdf) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let weights = [seen.masking, schlick_weight(d.wi.z[l])];
            let reflected = self.kind.value(weights, d.cos_d[l]);
            value[l] = select(d.reflects(l), reflected, 0.0);
            pdf[l] = select(d.reflects(l), d.wi.z[l] * seen.density, 0.0);
        }
        sum.add(scale, &Vec3x16::splat(Vec3::ONE), &value, &pdf);
    }

    /// See [`super::LobeModel::add_bound16`].
    pub fn add_bound16(&self, lanes: &LobeLanes, bounds: &FacetBounds16, sum: &mut Vec3x16) {
        for l in 0..LANES {
            if bounds.cos_max[l] > 0.0 {
                let weights = [lanes.masking[l], schlick_weight(bounds.cos_min[l])];
                let most = self.kind.max_value(weights, bounds.cos_d[l]) * bounds.cos_max[l];
                sum.set(l, sum.get(l) + lanes.scale.get(l) * (most * DirectionBound::WIDER));
            }
        }
    }
}

/// Returns the weights of Schlick's approximation for both directions.
#[inline]
fn weights(d: &Directions) -> [f32; 2] {
    [schlick_weight(d.wo.z), schlick_weight(d.wi.z)]
}
