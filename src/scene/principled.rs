//! The principled material, as Mitsuba 3's plugin `principled` defines it and Blender and glTF mean it.
//!
//! Papers: B. Burley, *Physically Based Shading at Disney*, 2012; *Extending the Disney BRDF to a BSDF with Integrated
//! Subsurface Scattering*, 2015.
//! Deviations: transmission is as rough in all directions; there is no flatness (a stand-in for subsurface scattering).

use super::material::{Parameter, Reflectance, Share};

/// Diffuse base, specular reflection of a dielectric or a metal, transmission, sheen and clear coat.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// Albedo of the base where it is diffuse, reflectance at normal incidence where it is metal, square of the share
    /// that passes where it transmits.
    pub base_color: Reflectance,
    /// Share of metal; the rest is dielectric.
    pub metallic: Share,
    /// Square root of the microfacet α (GGX) of reflection and transmission.
    pub roughness: Share,
    /// From 0 to 1: `a` reflects with α / √(1 - .9 a) along u and α √(1 - .9 a) along v, texture coordinates. Where a
    /// mesh has none, u is any direction.
    pub anisotropic: f32,
    /// Angle from u, on the front counter-clockwise where v is to the left of u, to the direction in place of it.
    pub anisotropic_rotation: f32,
    /// Interior over exterior index of refraction of the dielectric. A `specular` s of Mitsuba and Blender is
    /// η = 2 / (1 - √(.08 s)) - 1.
    pub eta: f32,
    /// Share of the dielectric's reflection that has the base's hue.
    pub spec_tint: Share,
    /// Share of the dielectric that transmits light, as rough solid glass, and has no diffuse base.
    pub spec_trans: Share,
    /// Strength of light scattered at grazing angles, as by fibres, over dielectric.
    pub sheen: Share,
    /// Share of it that has the base's hue; the rest is white.
    pub sheen_tint: Share,
    /// Strength of a second specular lobe, of index 1.5 and a quarter of a coat's full reflectance.
    pub clearcoat: Share,
    /// Gloss of that lobe: 0 for satin (α .1), 1 for gloss (α .001).
    pub clearcoat_gloss: f32,
}

/// Returns the index of refraction that Mitsuba's and Blender's `specular` stands for.
pub fn eta_of_specular(specular: f64) -> f32 {
    (2.0 / (1.0 - (0.08 * specular.max(0.0)).sqrt()) - 1.0) as f32
}

impl Default for Principled {
    /// Grey of .5 and roughness .5, index 1.5: the plugin's defaults.
    fn default() -> Principled {
        let none = Share::Constant(0.0);
        Principled {
            base_color: Reflectance::Constant(base::math::Rgb::splat(0.5)),
            metallic: none,
            roughness: Share::Constant(0.5),
            anisotropic: 0.0,
            anisotropic_rotation: 0.0,
            eta: 1.5,
            spec_tint: none,
            spec_trans: none,
            sheen: none,
            sheen_tint: none,
            clearcoat: none,
            clearcoat_gloss: 0.0,
        }
    }
}

impl Principled {
    /// Returns every share.
    pub fn shares_mut(&mut self) -> [&mut Share; 7] {
        [
            &mut self.metallic,
            &mut self.roughness,
            &mut self.spec_tint,
            &mut self.spec_trans,
            &mut self.sheen,
            &mut self.sheen_tint,
            &mut self.clearcoat,
        ]
    }

    /// True if any parameter is textured.
    pub fn is_textured(&self) -> bool {
        let shares = [self.metallic, self.roughness, self.spec_tint, self.spec_trans, self.sheen]
            .into_iter()
            .chain([self.sheen_tint, self.clearcoat]);
        self.base_color.is_textured()
            || shares.into_iter().any(|share| matches!(share, Parameter::Textured { .. }))
    }
}
