//! Conversion of the classic materials of MTL files.
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

use super::builder::SceneBuilder;
use crate::error::{Location, SceneError};
use crate::mesh::mtl::{ClassicMaterial, Unmodelled, mtl};
use crate::plan::Appearance;
use crate::statements::note;
use base::math::{Rgb, luminance};
use scene::{
    Coat, Diffuse, Distribution, Emission, Fresnel, Lobe, Material, Principled, Reflectance, Roughness,
    Share, eta_of_specular,
};
use std::path::Path;

/// Maximum reflectance of dielectrics at normal incidence.
const MAX_DIELECTRIC: f32 = 0.08;

/// Slack of numbers from 0 to 1 that counts as rounding.
pub(super) const SLACK: f32 = 1e-3;

/// Maximum number of materials that a message lists.
const MAX_LISTED: usize = 3;

/// Feature that is not supported, with the names of the materials that ask for it.
struct UnmodelledFeature {
    place: Location,
    what: String,
    fallback: String,
    names: Vec<String>,
}

/// Converter of the materials of a library.
pub(super) struct LibraryReader<'b, 'a> {
    pub builder: &'b mut SceneBuilder<'a>,
    pub file: &'b Path,
    /// Length of the file's unit in the world.
    pub unit: f32,
    findings: Vec<UnmodelledFeature>,
}

impl<'b, 'a> LibraryReader<'b, 'a> {
    /// Returns a converter of the materials of `file`.
    pub fn new(builder: &'b mut SceneBuilder<'a>, file: &'b Path, unit: f32) -> LibraryReader<'b, 'a> {
        LibraryReader { builder, file, unit, findings: Vec::new() }
    }

    /// Adds a material to the plan; returns its appearance.
    pub fn appearance(&mut self, mut source: ClassicMaterial) -> Result<Appearance, SceneError> {
        let material = self.material(&mut source)?;
        let emission = self.emission(&mut source)?;
        let material = self.builder.contents.add_material(material, source.place);
        for Unmodelled { what, fallback, line } in source.unmodelled {
            let name = source.name.clone();
            match self.findings.iter_mut().find(|f| f.what == what && f.fallback == fallback) {
                Some(finding) if finding.names.last() == Some(&name) => {}
                Some(finding) => finding.names.push(name),
                None => {
                    let place = Location::line(self.file, line);
                    self.findings.push(UnmodelledFeature { place, what, fallback, names: vec![name] });
                }
            }
        }
        Ok(Appearance { material, emission })
    }

    /// Warns of the features that are not supported, each once.
    pub fn report(self) -> Result<(), SceneError> {
        for UnmodelledFeature { place, what, fallback, names } in self.findings {
            let mut listed: Vec<String> =
                names.iter().take(MAX_LISTED).map(|name| format!("\"{name}\"")).collect();
            if names.len() > MAX_LISTED {
                listed.push(format!("{} more", names.len() - MAX_LISTED));
            }
            let what = format!("{what} is not supported: {}", listed.join(", "));
            self.builder.log.warn(&place, what, fallback)?;
        }
        Ok(())
    }

    fn material(&mut self, source: &mut ClassicMaterial) -> Result<Material, SceneError> {
        self.remark(source);
        let base = self.colour(source, "map_Kd", source.diffuse)?;
        let is_bare = base == Reflectance::BLACK;
        let is_glass = is_glass(source, is_bare);
        let surface = if is_principled(source) {
            self.principled(source, base, is_glass)?
        } else if is_glass {
            self.glass(source, is_bare)
        } else {
            match source.model {
                0 | 1 => Material { diffuse: base, ..Material::default() },
                3 | 5 | 6 => self.reflective(source, base)?,
                _ => self.glossy(source, base)?,
            }
        };
        let is_lit = !surface.lobes.is_empty() && surface.principled.is_none() && !is_glass;
        if source.maps.contains_key("map_Ks") && !is_lit {
            let what = "map_Ks of a surface without a reflection of its own".to_owned();
            self.lacks(source, "map_Ks", what, "the reflection is the same everywhere");
        }
        let opacity = if is_glass && !is_principled(source) { None } else { self.opacity(source)? };
        let relief = self.relief(source)?;
        Ok(Material { name: source.name.clone(), two_sided: true, opacity, relief, ..surface })
    }

    /// Names an ambient map of its own, and notes that Tr makes a surface invisible.
    fn remark(&mut self, source: &mut ClassicMaterial) {
        let text = |keyword: &str| source.maps.get(keyword).map(|map| map.text.clone());
        // Exporters write the image of Kd twice.
        if text("map_Ka").is_some_and(|ambient| Some(ambient) != text("map_Kd")) {
            self.lacks(source, "map_Ka", "map_Ka".to_owned(), note(mtl(), "map_Ka"));
        }
        let name = &source.name;
        if let (None, Some((transparency, line))) = (source.dissolve, source.transparency)
            && transparency >= 1.0
        {
            let place = Location::line(self.file, line);
            let what = format!("Tr leaves nothing of the material \"{name}\"");
            self.builder.log.note(&place, what, "nothing is seen; write d 1 if it should be opaque");
        }
    }

    fn glass(&mut self, source: &mut ClassicMaterial, is_bare: bool) -> Material {
        if !is_bare {
            let what = "Kd of glass".to_owned();
            self.lacks(source, "map_Kd", what, "glass has no base; write illum 2 for a matte surface");
        }
        if is_cut(source) {
            let what = "d of glass that passes light by Tf".to_owned();
            self.lacks(source, "map_d", what, "Tf alone counts");
        }
        let white = Reflectance::Constant(Rgb::ONE);
        let transmittance = Reflectance::Constant(filter(source).unwrap_or(Rgb::ONE));
        let glass = Lobe::Dielectric { eta: index(source), thin: false, reflectance: white, transmittance };
        Material { lobes: vec![glass], ..Material::default() }
    }

    /// Returns a metal, or a mirror over a base.
    fn reflective(
        &mut self,
        source: &mut ClassicMaterial,
        base: Reflectance,
    ) -> Result<Material, SceneError> {
        let mirror = |scale| Lobe::Mirror { fresnel: Fresnel::One, scale };
        let specular = source.specular.unwrap_or_default();
        if base == Reflectance::BLACK {
            let scale = self.colour(source, "map_Ks", specular)?;
            return Ok(Material { lobes: vec![mirror(scale)], ..Material::default() });
        }
        if source.specular == Some(Rgb::ZERO) {
            return Ok(Material { diffuse: base, ..Material::default() });
        }
        let fits = match base {
            Reflectance::Constant(base) => (base + specular).max_element() <= 1.0 + SLACK,
            Reflectance::Textured { .. } => false,
        };
        let fits = fits && source.specular.is_some();
        let is_grey = |colour: Rgb| colour.max_element() == colour.min_element();
        let metal = source.ambient.filter(|ambient| is_grey(*ambient) && ambient.x > 0.0);
        let is_blender = is_grey(specular) && (specular.x <= 0.5 || !fits) && source.model != 5;
        if let Some(metal) = metal.filter(|_| is_blender) {
            let principled = Principled {
                base_color: base,
                metallic: Share::Constant(metal.x.min(1.0)),
                roughness: Share::Constant(1.0 - (source.exponent.clamp(0.0, 1000.0) / 1000.0).sqrt()),
                eta: eta_of_specular(source.specular.map_or(0.5, |specular| specular.x).min(1.0).into()),
                diffuse: Diffuse::Lambertian,
                ..Principled::default()
            };
            return Ok(Material { principled: Some(Box::new(principled)), ..Material::default() });
        }
        if fits {
            let scale = self.colour(source, "map_Ks", specular)?;
            return Ok(Material { diffuse: base, lobes: vec![mirror(scale)], ..Material::default() });
        }
        let lobe = if source.exponent > 0.0 { rough(source, Fresnel::One, base) } else { mirror(base) };
        Ok(Material { lobes: vec![lobe], ..Material::default() })
    }

    /// Returns a dielectric over a base, or a metal without one.
    fn glossy(&mut self, source: &mut ClassicMaterial, base: Reflectance) -> Result<Material, SceneError> {
        let has_map = source.maps.contains_key("map_Ks");
        let ks = source.specular.unwrap_or(if has_map { Rgb::ONE } else { Rgb::ZERO });
        if ks == Rgb::ZERO || source.exponent <= 0.0 {
            return Ok(Material { diffuse: base, ..Material::default() });
        }
        if base == Reflectance::BLACK {
            let scale = self.colour(source, "map_Ks", ks)?;
            return Ok(Material { lobes: vec![rough(source, Fresnel::One, scale)], ..Material::default() });
        }
        let root = luminance(ks).clamp(0.0, MAX_DIELECTRIC).sqrt();
        let eta = (1.0 + root) / (1.0 - root);
        let scale = self.colour(source, "map_Ks", Rgb::ONE)?;
        let lobes = vec![rough(source, Fresnel::Dielectric(eta), scale)];
        Ok(Material {
            diffuse: base,
            lobes,
            coat: Some(Coat { eta, nonlinear: false }),
            ..Material::default()
        })
    }

    /// Returns the material of the extension.
    fn principled(
        &mut self,
        source: &mut ClassicMaterial,
        base: Reflectance,
        is_glass: bool,
    ) -> Result<Material, SceneError> {
        // Blender writes Tf as the share that transmits.
        let spec_trans = match filter(source) {
            Some(filter) => {
                if filter.max_element() != filter.min_element() {
                    let what = "a coloured Tf of a principled material".to_owned();
                    self.lacks(source, "", what, "its luminance is the share that transmits");
                }
                luminance(filter).clamp(0.0, 1.0)
            }
            None => f32::from(u8::from(is_glass)),
        };
        let white = Reflectance::Constant(Rgb::ONE);
        let base_color = if spec_trans == 1.0 && base == Reflectance::BLACK { white } else { base };
        let is_metal = matches!(source.model, 3 | 6) && !source.principled.contains_key("Pm");
        let roughness = if source.exponent > 0.0 { alpha(source).sqrt() } else { 0.5 };
        let specular = source.specular.map(|specular| {
            if specular.max_element() != specular.min_element() {
                let what = "a coloured Ks of a principled material".to_owned();
                self.lacks(source, "", what, "its luminance counts");
            }
            luminance(specular).clamp(0.0, 1.0)
        });
        let eta = match (specular, source.ior) {
            (Some(specular), _) if spec_trans == 0.0 => eta_of_specular(specular.into()),
            (None, None) => Principled::default().eta,
            _ => index(source),
        };
        let coat_alpha = source.principled.get("Pcr").map_or(0.0, |roughness| roughness * roughness);
        if coat_alpha > 0.1 && source.principled.get("Pc").is_some_and(|coat| *coat > 0.0) {
            self.lacks(source, "", "a clear coat rougher than α = 0.1".to_owned(), "α is 0.1");
        }
        let anisotropic = self.clamped(source, "aniso", 0.0);
        let principled = Principled {
            base_color,
            metallic: self.share(source, "map_Pm", "Pm", f32::from(u8::from(is_metal)))?,
            roughness: self.share(source, "map_Pr", "Pr", roughness)?,
            sheen: self.share(source, "map_Ps", "Ps", 0.0)?,
            clearcoat: self.share(source, "map_Pc", "Pc", 0.0)?,
            clearcoat_gloss: ((0.1 - coat_alpha) / 0.099).clamp(0.0, 1.0),
            anisotropic: anisotropic.into(),
            anisotropic_rotation: source.principled.get("anisor").map_or(0.0, |turns| turns * TURN),
            spec_trans: Share::Constant(spec_trans),
            eta,
            diffuse: Diffuse::Lambertian,
            ..Principled::default()
        };
        Ok(Material { principled: Some(Box::new(principled)), ..Material::default() })
    }

    fn emission(&mut self, source: &mut ClassicMaterial) -> Result<Option<Emission>, SceneError> {
        let map = self.colour(source, "map_Ke", source.emissive)?;
        Ok(match map {
            Reflectance::Textured { texture, scale } => {
                Some(Emission { radiance: scale, texture: Some(texture), two_sided: false })
            }
            Reflectance::Constant(radiance) => {
                (radiance != Rgb::ZERO).then_some(Emission { radiance, texture: None, two_sided: false })
            }
        })
    }
}

/// Angle of a full turn in radians.
const TURN: f32 = std::f32::consts::TAU;

/// Returns the index of refraction.
fn index(source: &ClassicMaterial) -> f32 {
    source.ior.filter(|n| *n > 0.0).unwrap_or(1.5)
}

/// Returns Tf; black counts as none.
fn filter(source: &ClassicMaterial) -> Option<Rgb> {
    source.filter.filter(|filter| *filter != Rgb::ZERO)
}

/// True if a part of the surface is not there.
fn is_cut(source: &ClassicMaterial) -> bool {
    source.opacity() < 1.0 || source.maps.contains_key("map_d")
}

/// True if the material has keywords of the extension.
pub(super) fn is_principled(source: &ClassicMaterial) -> bool {
    let maps = ["map_Pr", "map_Pm", "map_Ps", "map_Pc"];
    !source.principled.is_empty() || maps.iter().any(|keyword| source.maps.contains_key(keyword))
}

fn is_glass(source: &ClassicMaterial, is_bare: bool) -> bool {
    let refracts = source.ior != Some(1.0);
    let passes = filter(source).is_some();
    match source.model {
        6 | 7 if is_cut(source) => passes && refracts && source.ior.is_some(),
        6 | 7 => passes || refracts,
        4 | 9 => !is_cut(source) && refracts && (source.ior.is_some() || is_bare),
        _ => false,
    }
}

/// Returns the roughness α of the Phong exponent.
fn alpha(source: &ClassicMaterial) -> f32 {
    (2.0 / (source.exponent + 2.0)).sqrt()
}

fn rough(source: &ClassicMaterial, fresnel: Fresnel, scale: Reflectance) -> Lobe {
    let alpha = Roughness::Constant(alpha(source));
    Lobe::Rough { distribution: Distribution::Ggx, alpha, fresnel, scale }
}
