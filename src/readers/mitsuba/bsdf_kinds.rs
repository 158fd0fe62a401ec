//! Conversion of BSDFs that nest no other.

use super::converter::Converter;
use super::tree::Object;
use crate::check;
use crate::constants;
use crate::error::SceneError;
use base::math::{Rgb, luminance};
use scene::{
    Coat, Distribution, Fresnel, Lobe, Material, Parameter, Principled, Reflectance, Roughness, Share,
    eta_of_specular,
};

impl Converter<'_> {
    pub(super) fn plastic(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let eta = self.relative_ior(bsdf, "polypropylene")?;
        let diffuse = self.reflectance(bsdf, "diffuse_reflectance", 0.5)?;
        let scale = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let fresnel = Fresnel::Dielectric(eta);
        let lobe = match bsdf.plugin.as_str() {
            "plastic" => Lobe::Mirror { fresnel, scale },
            _ => self.rough(bsdf, fresnel, scale)?,
        };
        let coat = Some(Coat { eta, nonlinear: bsdf.boolean("nonlinear", false)? });
        Ok(Material { name, diffuse, coat, lobes: vec![lobe], ..Material::default() })
    }

    pub(super) fn conductor(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let scale = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let preset = bsdf.string("material")?;
        // In Mitsuba 0.6 the metal's index is relative to the exterior index.
        let outside = match bsdf.has("ext_eta") {
            true => self.ior(bsdf, "ext_eta", "vacuum")?,
            false => 1.0,
        } as f32;
        let fresnel = if bsdf.has("eta") || bsdf.has("k") {
            let mut constants = [Rgb::ZERO, Rgb::ONE];
            for (name, constant) in ["eta", "k"].into_iter().zip(&mut constants) {
                let given = self.colour(bsdf, name)?.unwrap_or(*constant);
                *constant = given.max(Rgb::ZERO);
                if given != *constant {
                    // Colours of measured spectra may lie outside Rec. 709.
                    let what = format!("the conductor's {name} is {given}");
                    self.log.warn(&bsdf.place, what, "it is clamped to 0")?;
                }
            }
            let [eta, k] = constants;
            Fresnel::Conductor { eta: eta / outside, k: k / outside }
        } else {
            match preset.as_deref() {
                None | Some("none") => Fresnel::One,
                Some(preset) => {
                    let (eta, k) = check::conductor(preset, &bsdf.place)?;
                    Fresnel::Conductor { eta: eta / outside, k: k / outside }
                }
            }
        };
        let lobe = match bsdf.plugin.as_str() {
            "conductor" => Lobe::Mirror { fresnel, scale },
            _ => self.rough(bsdf, fresnel, scale)?,
        };
        Ok(Material { name, lobes: vec![lobe], ..Material::default() })
    }

    pub(super) fn dielectric(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let eta = self.relative_ior(bsdf, "bk7")?;
        let reflectance = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let transmittance = self.reflectance(bsdf, "specular_transmittance", 1.0)?;
        if bsdf.plugin == "roughdielectric" {
            let (distribution, [u, v]) = self.facets(bsdf)?;
            let alpha = match (u, v) {
                (Roughness::Constant(a), Roughness::Constant(b)) if a != b => {
                    let fallback = "the geometric mean is used, without the direction of highlights";
                    self.log.warn(&bsdf.place, "anisotropic glass is not supported", fallback)?;
                    Roughness::Constant((a * b).sqrt())
                }
                (u, v) if u != v => {
                    let fallback = "the roughness along u is used in both directions";
                    self.log.warn(&bsdf.place, "anisotropic glass is not supported", fallback)?;
                    u
                }
                _ => u,
            };
            let lobe = Lobe::RoughDielectric { distribution, alpha, eta, reflectance, transmittance };
            return Ok(glass(name, lobe));
        }
        let thin = bsdf.plugin == "thindielectric";
        Ok(glass(name, Lobe::Dielectric { eta, thin, reflectance, transmittance }))
    }

    /// Returns a Phong or Ward material: a Lambert base and a microfacet lobe of the same reflectance.
    ///
    /// For Phong, GGX with α² = 1 / (exponent + 2) replaces the lobe. This α is within 4 % of the least-squares fit
    /// over inclinations up to 57°, for exponents from 5 to 1000. For Ward, Beckmann of the same α replaces the lobe;
    /// they differ in factors of the cosines.
    pub(super) fn classic_glossy(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let diffuse = self.reflectance(bsdf, "diffuse_reflectance", 0.5)?;
        let scale = self.reflectance(bsdf, "specular_reflectance", 0.2)?;
        let (distribution, alpha) = if bsdf.plugin == "phong" {
            (Distribution::Ggx, (1.0 / (bsdf.positive("exponent", 30.0)? + 2.0)).sqrt())
        } else {
            let alpha = (bsdf.positive("alpha_u", 0.1)? * bsdf.positive("alpha_v", 0.1)?).sqrt();
            (Distribution::Beckmann, alpha)
        };
        let what = format!("the bsdf \"{}\" is not supported", bsdf.plugin);
        self.log.warn(
            &bsdf.place,
            what,
            format!("a {distribution:?} lobe of alpha {alpha:.4} is used instead"),
        )?;
        let alpha = (alpha as f32).into();
        let lobe = Lobe::Rough { distribution, alpha, fresnel: Fresnel::One, scale };
        Ok(Material { name, diffuse, lobes: vec![lobe], ..Material::default() })
    }

    pub(super) fn principled(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let mut share = |name: &str, default: f32| self.share(bsdf, name, default);
        let mut principled = Principled {
            metallic: share("metallic", 0.0)?,
            roughness: share("roughness", 0.5)?,
            spec_tint: share("spec_tint", 0.0)?,
            spec_trans: share("spec_trans", 0.0)?,
            sheen: share("sheen", 0.0)?,
            sheen_tint: share("sheen_tint", 0.0)?,
            clearcoat: share("clearcoat", 0.0)?,
            ..Principled::default()
        };
        principled.base_color = self.reflectance(bsdf, "base_color", 0.5)?;
        principled.eta = match bsdf.has("eta") {
            true => self.ior(bsdf, "eta", "bk7")? as f32,
            false => eta_of_specular(bsdf.float("specular")?.unwrap_or(0.5)),
        };
        principled.clearcoat_gloss = match self.share(bsdf, "clearcoat_gloss", 0.0)? {
            Share::Constant(gloss) => gloss,
            Share::Textured { .. } => {
                self.log.warn(&bsdf.place, "a textured clearcoat_gloss is not supported", "it is 0.5")?;
                0.5
            }
        };
        principled.anisotropic = self.share(bsdf, "anisotropic", 0.0)?;
        if self.share(bsdf, "flatness", 0.0)? != Share::Constant(0.0) {
            self.log.warn(&bsdf.place, "flatness is not supported", "it is left out")?;
        }
        Ok(Material { name, principled: Some(Box::new(principled)), ..Material::default() })
    }

    pub(super) fn rough(
        &mut self,
        bsdf: &Object,
        fresnel: Fresnel,
        scale: Reflectance,
    ) -> Result<Lobe, SceneError> {
        let (distribution, alpha) = self.facets(bsdf)?;
        Ok(match alpha {
            [u, v] if u != v => Lobe::Anisotropic { distribution, alpha, fresnel, scale },
            [alpha, _] => Lobe::Rough { distribution, alpha, fresnel, scale },
        })
    }

    /// Returns the distribution of microfacets, and their roughness along u and v.
    pub(super) fn facets(&mut self, bsdf: &Object) -> Result<(Distribution, [Roughness; 2]), SceneError> {
        let distribution = match bsdf.string("distribution")?.map(|d| d.to_lowercase()).as_deref() {
            None | Some("beckmann") => Distribution::Beckmann,
            Some("ggx") => Distribution::Ggx,
            Some("phong" | "as") => {
                let fallback = "Beckmann with the same alpha is used instead";
                self.log.warn(&bsdf.place, "the Phong distribution is not supported", fallback)?;
                Distribution::Beckmann
            }
            Some(other) => {
                let what = format!("unknown distribution \"{other}\"");
                return Err(bsdf.place.wrong(what, "use beckmann or ggx"));
            }
        };
        let alpha = if bsdf.has("alpha_u") || bsdf.has("alpha_v") {
            [self.alpha(bsdf, "alpha_u")?, self.alpha(bsdf, "alpha_v")?]
        } else {
            [self.alpha(bsdf, "alpha")?; 2]
        };
        Ok((distribution, alpha))
    }

    pub(super) fn alpha(&mut self, bsdf: &Object, name: &str) -> Result<Roughness, SceneError> {
        match self.document.named(bsdf, name)? {
            Some(texture) => self.number(&texture),
            None => Ok(Roughness::Constant(bsdf.positive(name, 0.1)? as f32)),
        }
    }

    /// Returns a share of light or surface: a number, the luminance of a colour, or a texture.
    pub(super) fn share(&mut self, bsdf: &Object, name: &str, default: f32) -> Result<Share, SceneError> {
        if let Some(colour) = self.colour(bsdf, name)? {
            return Ok(Share::Constant(luminance(colour)));
        }
        match self.document.named(bsdf, name)? {
            Some(texture) => self.number(&texture),
            None => Ok(Share::Constant(default)),
        }
    }

    pub(super) fn number(&mut self, texture: &Object) -> Result<Parameter<f32>, SceneError> {
        Ok(match self.texture(texture, 0)? {
            Reflectance::Constant(colour) => Parameter::Constant(luminance(colour)),
            Reflectance::Textured { texture, scale } => {
                Parameter::Textured { texture: self.of_numbers(texture), scale: luminance(scale) }
            }
        })
    }

    /// Returns the interior over the exterior index of refraction.
    pub(super) fn relative_ior(&mut self, bsdf: &Object, interior: &str) -> Result<f32, SceneError> {
        let (inside, outside) = (self.ior(bsdf, "int_ior", interior)?, self.ior(bsdf, "ext_ior", "air")?);
        Ok((inside / outside) as f32)
    }

    pub(super) fn ior(&mut self, bsdf: &Object, name: &str, default: &str) -> Result<f64, SceneError> {
        let material = match bsdf.property(name).map(|p| &p.value) {
            Some(super::value::PropertyValue::String(material)) => material.clone(),
            Some(_) => return bsdf.positive(name, 1.0),
            None => default.to_owned(),
        };
        let unknown = || {
            let what = format!("no index of refraction is known for \"{material}\"");
            bsdf.place.wrong(what, "give the number")
        };
        constants::index_of_refraction(&material).ok_or_else(unknown)
    }
}

pub(super) fn diffuse(name: String, diffuse: Reflectance) -> Material {
    Material { name, diffuse, ..Material::default() }
}

/// Returns the material of a single lobe of glass.
pub(super) fn glass(name: String, lobe: Lobe) -> Material {
    Material { name, two_sided: true, lobes: vec![lobe], ..Material::default() }
}
