//! The principled material, as in Mitsuba 3's plugin `principled`, Blender and glTF.
//!
//! Papers: B. Burley, *Physically Based Shading at Disney*, 2012; *Extending the Disney BRDF to a BSDF with Integrated
//! Subsurface Scattering*, 2015.
//! Deviations: transmission is isotropic. Flatness, an approximation of subsurface scattering, is missing.

use super::parameter::{Parameter, Reflectance, Share};
use super::texture::TextureId;

/// Diffuse base, specular reflection of a dielectric or a metal, transmission, sheen and clear coat.
#[derive(Clone, Debug, PartialEq)]
pub struct Principled {
    /// Colour of the base. It is the albedo of the diffuse part, the normal reflectance of metal, and what tints
    /// transmitted light (see [`Principled::tints_each_passage`]).
    pub base_color: Reflectance,
    /// Fraction of metal; the rest is dielectric.
    pub metallic: Share,
    /// Square root of the microfacet α (GGX) of reflection and transmission.
    pub roughness: Share,
    /// Anisotropy of reflection, from 0 to 1; see `stretch`.
    ///
    /// Without texture coordinates, u is any direction.
    pub anisotropic: Share,
    /// Effect of the anisotropy on the roughness along u and v.
    pub stretch: Stretch,
    /// Angle in radians from u to the axis that replaces u. It is counter-clockwise seen from the front, if v is to the
    /// left of u.
    pub anisotropic_rotation: f32,
    /// Texture of directions that replace u before the rotation. Red and green are the coordinates along u and v;
    /// texels from 0 to 1 stand for coordinates from -1 to 1.
    pub anisotropic_direction: Option<TextureId>,
    /// Interior over exterior index of refraction of the dielectric.
    ///
    /// A `specular` s of Mitsuba and Blender is η = 2 / (1 - √(0.08 s)) - 1.
    pub eta: f32,
    /// Fraction of the dielectric's reflection that has the base's hue.
    pub spec_tint: Share,
    /// Fraction of the dielectric that transmits light as rough solid glass, without a diffuse base.
    pub spec_trans: Share,
    /// True if each passage through the surface multiplies light by the base's colour, as in glTF. Else it multiplies
    /// by the root, so that the way in and out has the colour, as in Mitsuba.
    pub tints_each_passage: bool,
    /// Diffuse part of the dielectric.
    pub diffuse: Diffuse,
    /// Strength of sheen over the dielectric: light scattered at grazing angles, as by fibres.
    pub sheen: Share,
    /// Fraction of the sheen that has the base's hue; the rest is white.
    pub sheen_tint: Share,
    /// Strength of the clear coat: a second specular lobe of index 1.5 and a quarter of a coat's reflectance.
    pub clearcoat: Share,
    /// Gloss of the clear coat: 0 for satin (α = 0.1), 1 for gloss (α = 0.001).
    pub clearcoat_gloss: f32,
    /// Share of the diffuse light that goes to the other side, if the material is a thin sheet, as in Mitsuba's plugin
    /// `principledthin`.
    ///
    /// Both sides of a sheet are alike. Transmitted light keeps its direction, but for the roughness. There is no metal
    /// and no clear coat. Only the share `spec_trans` has specular reflection.
    pub thin: Option<Share>,
}

/// Diffuse part of a dielectric that is no thin sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Diffuse {
    /// Burley's, as in Mitsuba: half of the light is lost at grazing angles, and rough surfaces reflect more.
    #[default]
    Burley,
    /// Lambertian, of the light that the dielectric does not reflect, as in glTF and Blender.
    Lambertian,
}

/// Effect of an anisotropy `a` on microfacets of roughness α.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stretch {
    /// α / √(1 - 0.9 a) along u and α √(1 - 0.9 a) along v, as in Burley's model.
    #[default]
    AboutMean,
    /// α + (1 - α) a² along u and α along v, as in glTF.
    AlongU,
}

impl Stretch {
    /// Returns the roughness along u and along v.
    pub fn alphas(self, alpha: f32, anisotropy: f32) -> [f32; 2] {
        match self {
            Stretch::AboutMean => {
                let aspect = (1.0 - 0.9 * anisotropy).sqrt();
                [alpha / aspect, alpha * aspect]
            }
            Stretch::AlongU => [alpha + (1.0 - alpha) * anisotropy * anisotropy, alpha],
        }
    }
}

/// Returns the index of refraction for `specular` of Mitsuba and Blender.
pub fn eta_of_specular(specular: f64) -> f32 {
    (2.0 / (1.0 - (0.08 * specular.max(0.0)).sqrt()) - 1.0) as f32
}

impl Default for Principled {
    /// Returns the plugin's defaults: grey of 0.5, roughness 0.5, index 1.5.
    fn default() -> Principled {
        let none = Share::Constant(0.0);
        Principled {
            base_color: Reflectance::Constant(base::math::Rgb::splat(0.5)),
            metallic: none,
            roughness: Share::Constant(0.5),
            anisotropic: none,
            stretch: Stretch::default(),
            anisotropic_rotation: 0.0,
            anisotropic_direction: None,
            eta: 1.5,
            spec_tint: none,
            spec_trans: none,
            tints_each_passage: false,
            diffuse: Diffuse::default(),
            sheen: none,
            sheen_tint: none,
            clearcoat: none,
            clearcoat_gloss: 0.0,
            thin: None,
        }
    }
}

impl Principled {
    /// Returns every share.
    pub fn shares_mut(&mut self) -> [&mut Share; 8] {
        [
            &mut self.metallic,
            &mut self.roughness,
            &mut self.anisotropic,
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
            .chain([self.sheen_tint, self.clearcoat, self.anisotropic])
            .chain(self.thin);
        self.base_color.is_textured()
            || shares.into_iter().any(|share| matches!(share, Parameter::Textured { .. }))
    }
}
