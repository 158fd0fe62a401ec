//! Materials with the same lobe and coat, at sixteen points at once: the formulas of [`Bsdf::eval`] and
//! [`Bsdf::bound`] as loops over lanes that compile to vector code.

use super::bound::{DirectionBound, min_facet_cos, min_facet_sin_sq};
use super::bsdf::Bsdf;
use super::model::{Base, Model, Scattering};
use crate::math::{F32x16, LANES, Rgb, Vec3x16};
use glam::Vec3;

/// Sixteen materials that differ in nothing but colour, each seen from one direction on the side of its normal.
#[derive(Clone, Copy, Debug)]
pub struct AlikeBsdfs16<'m> {
    model: &'m Model,
    wo: Vec3x16,
    /// BRDFs of the bases, for light that has passed the coat on its way in.
    base: Vec3x16,
    /// Factors on the lobes.
    scale: Vec3x16,
    /// Masking of `wo`.
    masking: F32x16,
}

/// Bounds of the directions towards light, by lane; see [`DirectionBound`].
#[derive(Clone, Copy, Debug, Default)]
pub struct DirectionBounds16 {
    /// Largest cosine to the normal, at most 1.
    pub cos_i_max: F32x16,
    /// Least cosine to the normal.
    pub cos_i_min: F32x16,
    /// Largest cosine to the mirror direction of `wo`.
    pub cos_mirror_max: F32x16,
}

impl<'m> AlikeBsdfs16<'m> {
    /// The materials `at(lane)`, each with its `wo` (z >= 0); `None` if they are not alike.
    pub fn new(at: impl Fn(usize) -> (Bsdf<'m>, Vec3)) -> Option<AlikeBsdfs16<'m>> {
        let model = at(0).0.model;
        let mut all = AlikeBsdfs16 {
            model,
            wo: Vec3x16::default(),
            base: Vec3x16::default(),
            scale: Vec3x16::default(),
            masking: [0.0; LANES],
        };
        if matches!(model.lobe, Scattering::Glass(_)) {
            return None;
        }
        for lane in 0..LANES {
            let (bsdf, wo) = at(lane);
            if bsdf.model.lobe != model.lobe || bsdf.model.coat != model.coat {
                return None;
            }
            all.wo.set(lane, wo);
            // Seen edge-on nothing is reflected.
            if wo.z > 0.0 {
                all.base.set(lane, bsdf.base * bsdf.coat_transmittance(wo.z));
                all.scale.set(lane, bsdf.scale);
                if let Scattering::Rough(facets, _) = &model.lobe {
                    all.masking[lane] = facets.v1(wo.z.min(1.0));
                }
            }
        }
        Some(all)
    }

    /// [`Bsdf::eval`] times the cosine of `wi`, in all lanes.
    #[inline]
    pub fn response(&self, wi: &Vec3x16) -> Vec3x16 {
        let mut response = self.through_coat(&wi.z);
        if let Scattering::Rough(facets, fresnel) = &self.model.lobe {
            let (mut sin_sq, mut cos_sq, mut cos_d) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for l in 0..LANES {
                let (wo, wi) = (self.wo.get(l), wi.get(l));
                let h = wo + wi;
                let length_sq = h.length_squared();
                // Both grazing and opposite, no facet is seen at all.
                let inverse = if length_sq > 1e-20 { 1.0 / length_sq } else { 0.0 };
                sin_sq[l] = (h.x * h.x + h.y * h.y) * inverse;
                cos_sq[l] = h.z * h.z * inverse;
                let d = wo.dot(h) * inverse.sqrt();
                cos_d[l] = if d < 1.0 { d } else { 1.0 };
            }
            let reflectance = fresnel.reflectance16(&cos_d);
            let mut masked = facets.density16(&sin_sq, &cos_sq);
            for l in 0..LANES {
                let cos_i = if wi.z[l] < 1.0 { wi.z[l] } else { 1.0 };
                masked[l] *= self.masking[l] * facets.v1(if cos_i > 0.0 { cos_i } else { 1.0 });
                masked[l] = if sin_sq[l] + cos_sq[l] > 0.0 { masked[l] } else { 0.0 };
            }
            self.add_lobe(&mut response, &reflectance, &masked);
        }
        for l in 0..LANES {
            let cos_i = if wi.z[l] > 0.0 { wi.z[l] } else { 0.0 };
            response.set(l, response.get(l) * cos_i);
        }
        response
    }

    /// [`Bsdf::bound`] in all lanes.
    #[inline]
    pub fn bound(&self, bound: &DirectionBounds16) -> Vec3x16 {
        let mut most = match &self.model.base {
            Base::RoughCoat(coat) => self.base_times(|l| coat.max_transmittance.lookup(bound.cos_i_max[l])),
            _ => self.through_coat(&bound.cos_i_max),
        };
        for l in 0..LANES {
            let cos = if bound.cos_i_max[l] > 0.0 { bound.cos_i_max[l] } else { 0.0 };
            most.set(l, most.get(l) * cos);
        }
        let Scattering::Rough(facets, fresnel) = &self.model.lobe else { return most };
        let (mut masked, mut cos_d) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let cos_o = if self.wo.z[l] < 1.0 { self.wo.z[l] } else { 1.0 };
            let cos_max = bound.cos_i_max[l];
            let cos_min = if bound.cos_i_min[l] > 0.0 { bound.cos_i_min[l] } else { 0.0 };
            let cos_min = if cos_min < cos_max { cos_min } else { cos_max };
            let mirror = bound.cos_mirror_max[l];
            masked[l] = min_facet_sin_sq(cos_o, cos_min, cos_max, mirror);
            cos_d[l] = min_facet_cos(cos_o, cos_min, mirror);
        }
        let mut masked = facets.max_density16(&masked);
        for l in 0..LANES {
            let cos = bound.cos_i_max[l];
            let lit = cos > 0.0;
            masked[l] *=
                self.masking[l] * 0.5 * facets.max_g1(if lit { cos } else { 1.0 }) * DirectionBound::WIDER;
            masked[l] = if lit { masked[l] } else { 0.0 };
        }
        let reflectance = match &self.model.max_reflectance {
            Some(table) => {
                let mut reflectance = Vec3x16::default();
                (0..LANES).for_each(|l| reflectance.set(l, table.floor(cos_d[l])));
                reflectance
            }
            None => fresnel.reflectance16(&cos_d),
        };
        self.add_lobe(&mut most, &reflectance, &masked);
        most
    }

    /// Share of the light at each cosine that passes the coat; 1 where there is none.
    #[inline]
    pub fn coat_transmittance(&self, cos: &F32x16) -> F32x16 {
        let mut passes = [1.0; LANES];
        if self.model.coat != 0 {
            for l in 0..LANES {
                passes[l] = self.model.base.coat_transmittance(cos[l].clamp(0.0, 1.0));
            }
        }
        passes
    }

    fn through_coat(&self, cos: &F32x16) -> Vec3x16 {
        let passes = self.coat_transmittance(cos);
        self.base_times(|l| passes[l])
    }

    #[inline(always)]
    fn base_times(&self, factor: impl Fn(usize) -> f32) -> Vec3x16 {
        let mut product = Vec3x16::default();
        for l in 0..LANES {
            let f = factor(l);
            product.x[l] = self.base.x[l] * f;
            product.y[l] = self.base.y[l] * f;
            product.z[l] = self.base.z[l] * f;
        }
        product
    }

    #[inline(always)]
    fn add_lobe(&self, sum: &mut Vec3x16, reflectance: &Vec3x16, masked: &F32x16) {
        for l in 0..LANES {
            let lobe: Rgb = self.scale.get(l) * reflectance.get(l) * masked[l];
            sum.set(l, sum.get(l) + lobe);
        }
    }
}
