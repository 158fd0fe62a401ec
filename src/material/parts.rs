//! Base and lobe apart, for what is precomputed of each.

use super::bsdf::Bsdf;
use super::model::{Materials, Reflectances, Scattering};
use crate::math::Rgb;
use crate::scene::{MaterialId, Reflectance, Scene};

impl Materials {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.models.len()
    }

    /// The material with every texture replaced by its mean.
    pub fn average(&self, scene: &Scene, id: MaterialId) -> Bsdf<'_> {
        let model = &self.models[id.0 as usize];
        let mean = |reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            Reflectance::Textured { texture, scale } => {
                let texels = scene.textures.get(texture.0 as usize).map_or(&[][..], |t| &t.texels);
                let sum = texels.iter().fold(glam::DVec3::ZERO, |sum, t| sum + t.as_dvec3());
                let mean = if texels.is_empty() { Rgb::ONE } else { (sum / texels.len() as f64).as_vec3() };
                (mean * scale).max(Rgb::ZERO)
            }
        };
        let Reflectances { base, scale, transmittance } = model.source;
        Bsdf {
            model,
            base: model.base_brdf(mean(base)),
            scale: mean(scale),
            transmittance: mean(transmittance),
        }
    }
}

impl<'m> Bsdf<'m> {
    /// The rough lobe alone, with factor 1, if there is one: what remains depends on roughness and Fresnel reflectance
    /// only (see [`Bsdf::same_lobe`]).
    pub fn unit_lobe(&self) -> Option<Bsdf<'m>> {
        matches!(self.model.lobe, Scattering::Rough(..)).then_some(Bsdf {
            base: Rgb::ZERO,
            scale: Rgb::ONE,
            ..*self
        })
    }

    /// Whether the lobes agree but for their factors.
    pub fn same_lobe(&self, other: &Bsdf) -> bool {
        self.model.lobe == other.model.lobe
    }

    /// Roughness α of the lobe, if it is rough.
    pub fn alpha(&self) -> Option<f32> {
        match self.model.lobe {
            Scattering::Rough(facets, _) => Some(facets.alpha),
            _ => None,
        }
    }

    /// BRDF of the base, to be multiplied by [`Bsdf::base_transmittance`] of either direction.
    #[inline]
    pub fn base_brdf(&self) -> Rgb {
        self.base
    }

    /// Share of the light at `cos` > 0 to the normal that reaches the base.
    #[inline]
    pub fn base_transmittance(&self, cos: f32) -> f32 {
        self.coat_transmittance(cos)
    }

    /// Factor on the lobe.
    #[inline]
    pub fn lobe_scale(&self) -> Rgb {
        self.scale
    }
}
