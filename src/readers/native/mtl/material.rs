//! Conversion of the materials of MTL.
//!
//! - `illum` 0 and 1 are Lambert surfaces.
//! - 2, 8 and 10 are a dielectric of roughness α = sqrt(2 / (Ns + 2)) over a Lambert base. Ks is the reflectance at
//!   normal incidence, limited to 0.08, the maximum of dielectrics. Exporters write greater values for all materials.
//!   Without Kd, the material is a metal of reflectance Ks.
//! - 3 and 5 are mirrors over a Lambert base, if Kd and Ks are at most 1 together. Else they are metals of reflectance
//!   Kd. Blender writes 3 for metals, with the share of metal as a grey Ka, and Ns = 1000 (1 - roughness)².
//! - 6 and 7 are glass of index Ni (1.5). They are glass with Ni = 1 only beside Tf.
//! - 4 and 9 are glass if Ni is given and not 1, or there is no Kd. Else they are as 2. Maya writes 4 everywhere.
//! - A d below 1 or map_d makes holes. Then 6 is as 3, and 4, 7 and 9 are as 2. Only if Tf and Ni speak of glass beside
//!   6 or 7, it stays glass without holes.
//! - Keywords of the extension for physically based rendering make a principled material.
//!
//! All materials are two-sided.

use super::LibraryReader;
use super::maps::SLACK;
use super::source::{SourceMaterial, Unsupported, statements};
use crate::error::{Location, SceneError};
use crate::plan::Appearance;
use crate::statements::note;
use base::math::{Rgb, luminance};
use scene::{
    Coat, Diffuse, Distribution, Emission, Fresnel, Lobe, Material, Principled, Reflectance, Roughness,
    Share, eta_of_specular,
};
use std::f32::consts::TAU;

/// Maximum reflectance of dielectrics at normal incidence.
const MAX_DIELECTRIC: f32 = 0.08;

/// Keywords of the extension for physically based rendering.
const EXTENSION: [&str; 11] =
    ["Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "map_Pr", "map_Pm", "map_Ps", "map_Pc"];

impl LibraryReader<'_, '_> {
    /// Adds a material to the plan; returns its appearance.
    pub fn appearance(&mut self, source: &SourceMaterial) -> Result<Appearance, SceneError> {
        for Unsupported { what, fallback, line } in &source.unsupported {
            self.lacks_at(source, *line, what, fallback);
        }
        let material = self.material(source)?;
        let emission = self.emission(source)?;
        let material = self.builder.contents.add_material(material, source.place.clone());
        Ok(Appearance { material, emission })
    }

    fn material(&mut self, source: &SourceMaterial) -> Result<Material, SceneError> {
        self.remark(source);
        let base = self.colour(source, "map_Kd", source.colour("Kd").unwrap_or_default())?;
        let is_bare = base == Reflectance::BLACK;
        let is_glass = is_glass(source, is_bare);
        let is_principled = EXTENSION.iter().any(|keyword| source.has(keyword));
        let surface = match source.model() {
            _ if is_principled => principled(self.principled(source, base, is_glass)?),
            _ if is_glass => self.glass(source, is_bare),
            0 | 1 => matte(base),
            3 | 5 | 6 => self.reflective(source, base)?,
            _ => self.glossy(source, base)?,
        };
        let is_lit = !surface.lobes.is_empty() && surface.principled.is_none() && !is_glass;
        if source.has("map_Ks") && !is_lit {
            let what = "map_Ks of a surface without a reflection of its own";
            self.lacks(source, "map_Ks", what, "the reflection is the same everywhere");
        }
        let opacity = if is_glass && !is_principled { None } else { self.opacity(source, is_principled)? };
        let relief = self.relief(source)?;
        Ok(Material { name: source.name.clone(), two_sided: true, opacity, relief, ..surface })
    }

    /// Names an ambient map of its own, and notes that Tr makes a surface invisible.
    fn remark(&mut self, source: &SourceMaterial) {
        // Exporters write the image of Kd twice.
        if source.has("map_Ka") && source.map("map_Ka") != source.map("map_Kd") {
            self.lacks(source, "map_Ka", "map_Ka", note(statements(), "map_Ka"));
        }
        if !source.has("d") && source.number("Tr").is_some_and(|transparency| transparency >= 1.0) {
            let place = Location::line(self.file, source.line("Tr"));
            let what = format!("Tr leaves nothing of the material \"{}\"", source.name);
            self.builder.log.note(&place, what, "nothing is seen; write d 1 if it should be opaque");
        }
    }

    /// Returns the share of the surface that is there; `None` if it is all there.
    fn opacity(&mut self, source: &SourceMaterial, is_principled: bool) -> Result<Option<Share>, SceneError> {
        let mut scale = self.limited(source, "d", source.opacity());
        if let Some(filter) = filter(source).filter(|filter| *filter != Rgb::ONE) {
            if source.model() == 4 && source.number("Ni") == Some(1.0) {
                // Maya writes its opacity so.
                scale *= luminance(filter).clamp(0.0, 1.0);
            } else if !is_principled {
                let what = format!("Tf of a surface that is not glass (illum {})", source.model());
                self.lacks(source, "Tf", what, "light passes only by d; write illum 7 and Ni for glass");
            }
        }
        self.mask(source, scale)
    }

    fn glass(&mut self, source: &SourceMaterial, is_bare: bool) -> Material {
        if !is_bare {
            let fallback = "glass has no base; write illum 2 for a matte surface";
            self.lacks(source, "Kd", "Kd of glass", fallback);
        }
        if is_cut(source) {
            self.lacks(source, "d", "d of glass that passes light by Tf", "Tf alone counts");
        }
        let white = Reflectance::Constant(Rgb::ONE);
        let transmittance = Reflectance::Constant(filter(source).unwrap_or(Rgb::ONE));
        let glass = Lobe::Dielectric { eta: index(source), thin: false, reflectance: white, transmittance };
        Material { lobes: vec![glass], ..Material::default() }
    }

    /// Returns a metal, or a mirror over a base.
    fn reflective(&mut self, source: &SourceMaterial, base: Reflectance) -> Result<Material, SceneError> {
        let mirror = |scale| Lobe::Mirror { fresnel: Fresnel::One, scale };
        let given = source.colour("Ks");
        let specular = given.unwrap_or_default();
        if base == Reflectance::BLACK {
            let scale = self.colour(source, "map_Ks", specular)?;
            return Ok(Material { lobes: vec![mirror(scale)], ..Material::default() });
        }
        if given == Some(Rgb::ZERO) {
            return Ok(matte(base));
        }
        let fits = match base {
            Reflectance::Constant(base) => (base + specular).max_element() <= 1.0 + SLACK,
            Reflectance::Textured { .. } => false,
        };
        let fits = fits && given.is_some();
        let metal = source.colour("Ka").filter(|ambient| is_grey(*ambient) && ambient.x > 0.0);
        let is_blender = is_grey(specular) && (specular.x <= 0.5 || !fits) && source.model() != 5;
        let exponent = exponent(source);
        if let Some(metal) = metal.filter(|_| is_blender) {
            return Ok(principled(Principled {
                base_color: base,
                metallic: Share::Constant(metal.x.min(1.0)),
                roughness: Share::Constant(1.0 - (exponent.clamp(0.0, 1000.0) / 1000.0).sqrt()),
                eta: eta_of_specular(given.map_or(0.5, |specular| specular.x).min(1.0).into()),
                diffuse: Diffuse::Lambertian,
                ..Principled::default()
            }));
        }
        if fits {
            let scale = self.colour(source, "map_Ks", specular)?;
            return Ok(Material { diffuse: base, lobes: vec![mirror(scale)], ..Material::default() });
        }
        let lobe = if exponent > 0.0 { rough(source, Fresnel::One, base) } else { mirror(base) };
        Ok(Material { lobes: vec![lobe], ..Material::default() })
    }

    /// Returns a dielectric over a base, or a metal without one.
    fn glossy(&mut self, source: &SourceMaterial, base: Reflectance) -> Result<Material, SceneError> {
        let default = if source.has("map_Ks") { Rgb::ONE } else { Rgb::ZERO };
        let ks = source.colour("Ks").unwrap_or(default);
        if ks == Rgb::ZERO || exponent(source) <= 0.0 {
            return Ok(matte(base));
        }
        if base == Reflectance::BLACK {
            let scale = self.colour(source, "map_Ks", ks)?;
            return Ok(Material { lobes: vec![rough(source, Fresnel::One, scale)], ..Material::default() });
        }
        let root = luminance(ks).clamp(0.0, MAX_DIELECTRIC).sqrt();
        let eta = (1.0 + root) / (1.0 - root);
        let scale = self.colour(source, "map_Ks", Rgb::ONE)?;
        let lobes = vec![rough(source, Fresnel::Dielectric(eta), scale)];
        let coat = Some(Coat { eta, nonlinear: false });
        Ok(Material { diffuse: base, lobes, coat, ..Material::default() })
    }

    /// Returns the material of the extension.
    fn principled(
        &mut self,
        source: &SourceMaterial,
        base: Reflectance,
        is_glass: bool,
    ) -> Result<Principled, SceneError> {
        // Blender writes Tf as the share that transmits.
        let filter = filter(source);
        if filter.is_some_and(|filter| !is_grey(filter)) {
            let what = "a coloured Tf of a principled material";
            self.lacks(source, "Tf", what, "its luminance is the share that transmits");
        }
        let share = |colour: Rgb| luminance(colour).clamp(0.0, 1.0);
        let spec_trans = filter.map_or(f32::from(u8::from(is_glass)), share);
        let white = Reflectance::Constant(Rgb::ONE);
        let base_color = if spec_trans == 1.0 && base == Reflectance::BLACK { white } else { base };
        let is_metal = matches!(source.model(), 3 | 6) && !source.has("Pm");
        let roughness = if exponent(source) > 0.0 { alpha(source).sqrt() } else { 0.5 };
        let specular = source.colour("Ks");
        if specular.is_some_and(|specular| !is_grey(specular)) {
            self.lacks(source, "Ks", "a coloured Ks of a principled material", "its luminance counts");
        }
        let eta = match (specular, source.number("Ni")) {
            (Some(specular), _) if spec_trans == 0.0 => eta_of_specular(share(specular).into()),
            (None, None) => Principled::default().eta,
            _ => index(source),
        };
        let coat_alpha = source.number("Pcr").map_or(0.0, |roughness| roughness * roughness);
        if coat_alpha > 0.1 && source.number("Pc").is_some_and(|coat| coat > 0.0) {
            self.lacks(source, "Pcr", "a clear coat rougher than α = 0.1", "α is 0.1");
        }
        Ok(Principled {
            base_color,
            anisotropic: self.clamped(source, "aniso", 0.0).into(),
            metallic: self.share(source, "map_Pm", "Pm", f32::from(u8::from(is_metal)))?,
            roughness: self.share(source, "map_Pr", "Pr", roughness)?,
            sheen: self.share(source, "map_Ps", "Ps", 0.0)?,
            clearcoat: self.share(source, "map_Pc", "Pc", 0.0)?,
            clearcoat_gloss: ((0.1 - coat_alpha) / 0.099).clamp(0.0, 1.0),
            anisotropic_rotation: source.number("anisor").map_or(0.0, |turns| turns * TAU),
            spec_trans: Share::Constant(spec_trans),
            eta,
            diffuse: Diffuse::Lambertian,
            ..Principled::default()
        })
    }

    fn emission(&mut self, source: &SourceMaterial) -> Result<Option<Emission>, SceneError> {
        let (radiance, texture) =
            match self.colour(source, "map_Ke", source.colour("Ke").unwrap_or_default())? {
                Reflectance::Textured { texture, scale } => (scale, Some(texture)),
                Reflectance::Constant(radiance) => (radiance, None),
            };
        Ok((radiance != Rgb::ZERO).then_some(Emission { radiance, texture, two_sided: false }))
    }
}

fn matte(diffuse: Reflectance) -> Material {
    Material { diffuse, ..Material::default() }
}

fn principled(parameters: Principled) -> Material {
    Material { principled: Some(Box::new(parameters)), ..Material::default() }
}

fn is_grey(colour: Rgb) -> bool {
    colour.max_element() == colour.min_element()
}

/// Returns the index of refraction.
fn index(source: &SourceMaterial) -> f32 {
    source.number("Ni").filter(|n| *n > 0.0).unwrap_or(1.5)
}

/// Returns Tf; black counts as none.
fn filter(source: &SourceMaterial) -> Option<Rgb> {
    source.colour("Tf").filter(|filter| *filter != Rgb::ZERO)
}

/// True if a part of the surface is not there.
fn is_cut(source: &SourceMaterial) -> bool {
    source.opacity() < 1.0 || source.has("map_d")
}

fn is_glass(source: &SourceMaterial, is_bare: bool) -> bool {
    let has_index = source.has("Ni");
    let refracts = source.number("Ni") != Some(1.0);
    let passes = filter(source).is_some();
    match source.model() {
        6 | 7 if is_cut(source) => passes && refracts && has_index,
        6 | 7 => passes || refracts,
        4 | 9 => !is_cut(source) && refracts && (has_index || is_bare),
        _ => false,
    }
}

/// Returns the Phong exponent.
fn exponent(source: &SourceMaterial) -> f32 {
    source.number("Ns").unwrap_or_default()
}

/// Returns the roughness α of the Phong exponent.
fn alpha(source: &SourceMaterial) -> f32 {
    (2.0 / (exponent(source) + 2.0)).sqrt()
}

fn rough(source: &SourceMaterial, fresnel: Fresnel, scale: Reflectance) -> Lobe {
    let alpha = Roughness::Constant(alpha(source));
    Lobe::Rough { distribution: Distribution::Ggx, alpha, fresnel, scale }
}
