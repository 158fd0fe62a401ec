//! Conversion of metallic-roughness materials and their extensions to principled materials.
//!
//! Deviations:
//! - A sheet that transmits (no thickness, see `glass`) is smooth, and transmits fully or not at all.
//! - A clear coat is that of the principled material, which reflects a quarter of the extension's coat.
//! - Sheen is that of the principled material.

use super::importer::{Importer, MaterialUse};
use super::mesh::VertexColours;
use super::texture::TextureUse;
use crate::attributes::{VERTEX_ALPHA, VERTEX_COLOUR};
use crate::decode::Channel;
use crate::error::SceneError;
use crate::plan::Appearance;
use base::math::Rgb;
use gltf_json::Index;
use gltf_json::extensions::material::Material as Extensions;
use gltf_json::material::{AlphaMode, Material as Source};
use gltf_json::texture::Info;
use gltf_json::validation::Checked;
use scene::{Diffuse, Emission, Lobe, Material, Principled, Reflectance, Relief, Share, Stretch};
use serde_json::Value;

/// Extensions that are read from their JSON.
const RAW: [&str; 3] = ["KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_anisotropy"];
/// Roughness up to which glass is smooth.
const MAX_SMOOTH: f32 = 0.03;

const RED: Channel = Channel::One(0);
const GREEN: Channel = Channel::One(1);
const BLUE: Channel = Channel::One(2);
const ALPHA: Channel = Channel::One(3);

impl Importer<'_> {
    /// Returns the material of a primitive; `None` stands for the default material.
    ///
    /// Base colour and opacity are multiplied with `colours` of vertices. Glass without a volume is solid if
    /// `is_solid`.
    pub(super) fn surface(
        &mut self,
        index: Option<Index<Source>>,
        colours: VertexColours,
        is_solid: bool,
    ) -> Result<MaterialUse, SceneError> {
        let number = index.map(|index| index.value());
        if let Some(surface) = self.surfaces.get(&(number, colours, is_solid)) {
            return Ok(*surface);
        }
        let document = self.document;
        let default = Source::default();
        let source = match index {
            Some(index) => document.get(index, "material")?,
            None => &default,
        };
        let name = match (&source.name, number) {
            (Some(name), _) => name.clone(),
            (None, Some(number)) => format!("material {number}"),
            (None, None) => "default".to_owned(),
        };
        let uv_set = self.uv_set(source, &name);
        let emission = self.emission(source, colours, &name)?;
        let material = self.material(source, colours, is_solid, &name)?;
        let material = self.contents.add_material(material, document.place.clone());
        let surface = MaterialUse { appearance: Appearance { material, emission }, uv_set };
        self.surfaces.insert((number, colours, is_solid), surface);
        Ok(surface)
    }

    /// Returns the set of texture coordinates of the material's first texture. Other sets are not read.
    fn uv_set(&mut self, source: &Source, name: &str) -> u32 {
        let base = &source.pbr_metallic_roughness;
        let slots = [&base.base_color_texture, &base.metallic_roughness_texture, &source.emissive_texture];
        let normal = source.normal_texture.iter().map(|info| TextureUse::of_normal(info).set);
        let sets: Vec<u32> =
            slots.into_iter().flatten().map(|info| TextureUse::read(info).set).chain(normal).collect();
        if sets.windows(2).any(|pair| pair[0] != pair[1]) {
            let what = "a material with several sets of texture coordinates is not supported";
            self.report.lacks(what, "the first is used", name);
        }
        sets.first().copied().unwrap_or(0)
    }

    fn emission(
        &mut self,
        source: &Source,
        colours: VertexColours,
        name: &str,
    ) -> Result<Option<Emission>, SceneError> {
        let extensions = source.extensions.as_ref();
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |e| e.emissive_strength.0);
        let is_unlit = extensions.is_some_and(|e| e.unlit.is_some());
        let (factor, texture) = match is_unlit {
            true => {
                self.report.lacks("unlit materials are not supported", "they emit their colour", name);
                let base = &source.pbr_metallic_roughness;
                let [r, g, b, _] = base.base_color_factor.0;
                (Rgb::new(r, g, b), &base.base_color_texture)
            }
            false => (Rgb::from(source.emissive_factor.0) * strength, &source.emissive_texture),
        };
        if factor == Rgb::ZERO {
            return Ok(None);
        }
        let texture = match texture {
            Some(info) => self.texture(&TextureUse::read(info), Channel::Colour, name),
            None => None,
        };
        let texture = match colours {
            VertexColours::Opaque | VertexColours::WithAlpha if is_unlit => {
                Some(self.contents.add_attribute(VERTEX_COLOUR, texture))
            }
            _ => texture,
        };
        Ok(Some(Emission { radiance: factor, texture, two_sided: source.double_sided }))
    }

    fn material(
        &mut self,
        source: &Source,
        colours: VertexColours,
        is_solid: bool,
        name: &str,
    ) -> Result<Material, SceneError> {
        let default = Extensions::default();
        let extensions = source.extensions.as_ref().unwrap_or(&default);
        self.report_unread(source, extensions, name);
        let opacity = self.opacity(source, colours, name)?;
        let relief = self.relief(source, name)?;
        let material =
            Material { name: name.to_owned(), two_sided: true, opacity, relief, ..Material::default() };
        if extensions.unlit.is_some() {
            return Ok(material);
        }
        let pbr = &source.pbr_metallic_roughness;
        let base_color = self.base_colour(source, colours, name)?;
        let roughness =
            self.share(pbr.roughness_factor.0, pbr.metallic_roughness_texture.as_ref(), GREEN, name)?;
        let metallic =
            self.share(pbr.metallic_factor.0, pbr.metallic_roughness_texture.as_ref(), BLUE, name)?;
        let transmission = extensions.transmission.as_ref();
        let spec_trans = match transmission {
            Some(t) => self.share(t.transmission_factor.0, t.transmission_texture.as_ref(), RED, name)?,
            None => Share::Constant(0.0),
        };
        let eta = relative_index(extensions);
        let is_sheet = extensions.volume.as_ref().map_or(!is_solid, |v| v.thickness_factor.0 <= 0.0);
        let volume = extensions.volume.as_ref().filter(|_| transmission.is_some() && !is_sheet);
        let absorption = volume.and_then(|volume| self.absorption(volume, name));
        let is_smooth = matches!(roughness, Share::Constant(roughness) if roughness <= MAX_SMOOTH);
        let is_clear = matches!(spec_trans, Share::Constant(share) if share >= 1.0);
        let transmits = transmission.is_some_and(|t| t.transmission_factor.0 >= 0.5);
        if is_sheet && transmission.is_some_and(|t| t.transmission_factor.0 > 0.0) && !(is_smooth && is_clear)
        {
            let what = "sheets that transmit in part, or are rough, are not supported";
            self.report.lacks(what, "they are smooth, and clear from a transmission of 0.5", name);
        }
        if transmits && (is_sheet || is_smooth && is_clear) {
            let white = Reflectance::Constant(Rgb::ONE);
            let glass =
                Lobe::Dielectric { eta, thin: is_sheet, reflectance: white, transmittance: base_color };
            return Ok(Material { lobes: vec![glass], absorption, ..material });
        }
        let spec_trans = if is_sheet { Share::Constant(0.0) } else { spec_trans };
        let mut principled = Principled {
            base_color,
            metallic,
            roughness,
            eta,
            spec_trans,
            tints_each_passage: true,
            diffuse: Diffuse::Lambertian,
            ..Principled::default()
        };
        self.layers(&extensions.others, &mut principled, name)?;
        Ok(Material { principled: Some(Box::new(principled)), absorption, ..material })
    }

    /// Reads clear coat, sheen and anisotropy.
    fn layers(
        &mut self,
        extensions: &serde_json::Map<String, Value>,
        principled: &mut Principled,
        name: &str,
    ) -> Result<(), SceneError> {
        let [coat, sheen, anisotropy] = RAW.map(|key| extensions.get(key));
        if let Some(coat) = coat {
            let factor = number(coat, "clearcoatFactor").unwrap_or(0.0);
            let texture = slot(coat, "clearcoatTexture");
            principled.clearcoat = self.share(factor, texture.as_ref(), RED, name)?;
            let alpha = number(coat, "clearcoatRoughnessFactor").unwrap_or(0.0).powi(2);
            principled.clearcoat_gloss = ((0.1 - alpha) / 0.099).clamp(0.0, 1.0);
            for key in ["clearcoatRoughnessTexture", "clearcoatNormalTexture"] {
                if coat.get(key).is_some() {
                    self.report.lacks(&format!("{key} is not supported"), "it is left out", name);
                }
            }
            self.report.lacks(
                "a clear coat reflects a quarter of what it should",
                "as clear coats of principled materials do",
                name,
            );
        }
        if let Some(sheen) = sheen {
            let colour = sheen.get("sheenColorFactor").and_then(Value::as_array);
            let channels = colour.into_iter().flatten().filter_map(Value::as_f64);
            let strength = channels.fold(0.0, f64::max).clamp(0.0, 1.0) as f32;
            principled.sheen = Share::Constant(strength);
            self.report.lacks("sheen with a colour, roughness or texture", "it is white and soft", name);
        }
        if let Some(anisotropy) = anisotropy {
            self.stretch(anisotropy, principled, name)?;
        }
        Ok(())
    }

    /// Reads anisotropy: α along the extension's direction is α + (1 - α) strength².
    fn stretch(
        &mut self,
        anisotropy: &Value,
        principled: &mut Principled,
        name: &str,
    ) -> Result<(), SceneError> {
        let strength = number(anisotropy, "anisotropyStrength").unwrap_or(0.0).clamp(0.0, 1.0);
        if !(strength > 0.0) {
            return Ok(());
        }
        let texture = slot(anisotropy, "anisotropyTexture");
        principled.stretch = Stretch::AlongU;
        principled.anisotropic = self.share(strength, texture.as_ref(), BLUE, name)?;
        if let Some(info) = &texture {
            principled.anisotropic_direction = self.texture(&TextureUse::read(info), Channel::Data, name);
        }
        let rotation = number(anisotropy, "anisotropyRotation").unwrap_or(0.0);
        principled.anisotropic_rotation = if rotation.is_finite() { rotation } else { 0.0 };
        Ok(())
    }

    /// Returns a factor from 0 to 1, times a channel of a texture.
    fn share(
        &mut self,
        factor: f32,
        texture: Option<&Info>,
        channel: Channel,
        name: &str,
    ) -> Result<Share, SceneError> {
        let factor = if factor.is_finite() { factor.clamp(0.0, 1.0) } else { 0.0 };
        let texture = match texture {
            Some(info) if factor > 0.0 => self.texture(&TextureUse::read(info), channel, name),
            _ => None,
        };
        Ok(match texture {
            Some(texture) => Share::Textured { texture, scale: factor },
            None => Share::Constant(factor),
        })
    }

    fn base_colour(
        &mut self,
        source: &Source,
        colours: VertexColours,
        name: &str,
    ) -> Result<Reflectance, SceneError> {
        let base = &source.pbr_metallic_roughness;
        let [r, g, b, _] = base.base_color_factor.0;
        let scale = Rgb::new(r, g, b);
        let texture = match &base.base_color_texture {
            Some(info) => self.texture(&TextureUse::read(info), Channel::Colour, name),
            None => None,
        };
        let base_colour = match texture {
            Some(texture) => Reflectance::Textured { texture, scale },
            None => Reflectance::Constant(scale),
        };
        Ok(match colours {
            VertexColours::None => base_colour,
            VertexColours::Opaque | VertexColours::WithAlpha => {
                self.contents.times_attribute(base_colour, VERTEX_COLOUR)
            }
        })
    }

    fn relief(&mut self, source: &Source, name: &str) -> Result<Option<Relief>, SceneError> {
        let Some(normal) = &source.normal_texture else { return Ok(None) };
        let strength = if normal.scale.is_finite() { normal.scale } else { 1.0 };
        let texture = self.texture(&TextureUse::of_normal(normal), Channel::Data, name);
        Ok(texture.map(|texture| Relief::Normals { texture, strength, y_along_v: true }))
    }

    /// Returns the opacity according to the alpha mode; `None` if opaque.
    fn opacity(
        &mut self,
        source: &Source,
        colours: VertexColours,
        name: &str,
    ) -> Result<Option<Share>, SceneError> {
        let base = &source.pbr_metallic_roughness;
        let factor = base.base_color_factor.0[3];
        let texture = base.base_color_texture.as_ref();
        let opacity = match (&source.alpha_mode, texture) {
            (Checked::Valid(AlphaMode::Mask), _) => {
                let cutoff = source.alpha_cutoff.as_ref().map_or(0.5, |cutoff| cutoff.0);
                if colours == VertexColours::WithAlpha && cutoff > 0.0 && factor > 0.0 {
                    let image = match texture {
                        Some(info) => self.texture(&TextureUse::read(info), ALPHA, name),
                        None => None,
                    };
                    let cut = Some(cutoff / factor);
                    let texture = self.contents.add_cut_attribute(VERTEX_ALPHA, image, cut);
                    return Ok(Some(Share::Textured { texture, scale: 1.0 }));
                }
                // A point is opaque if its alpha times the factor reaches the cutoff.
                match texture {
                    Some(info) if factor >= cutoff => {
                        self.share(1.0, Some(info), Channel::AlphaFrom(cutoff / factor), name)?
                    }
                    _ => Share::Constant(f32::from(u8::from(factor >= cutoff))),
                }
            }
            (Checked::Valid(AlphaMode::Blend), texture) => {
                let share = self.share(factor, texture, ALPHA, name)?;
                match colours {
                    VertexColours::WithAlpha => self.contents.times_attribute(share, VERTEX_ALPHA),
                    VertexColours::None | VertexColours::Opaque => share,
                }
            }
            (Checked::Valid(AlphaMode::Opaque) | Checked::Invalid, _) => return Ok(None),
        };
        Ok(Some(opacity).filter(|opacity| *opacity != Share::Constant(1.0)))
    }

    /// Reports all unsupported features of a material.
    fn report_unread(&mut self, source: &Source, extensions: &Extensions, name: &str) {
        for key in extensions.others.keys() {
            match key.as_str() {
                key if !RAW.contains(&key) => {
                    self.report.lacks(
                        &format!("the extension {key} is not supported"),
                        "it is left out",
                        name,
                    );
                }
                _ => {}
            }
        }
        if let Some(specular) = &extensions.specular {
            let colour = Rgb::from(specular.specular_color_factor.0);
            if colour.max_element() != colour.min_element() {
                self.report.lacks("coloured reflection of dielectrics", "the reflection is white", name);
            }
            if specular.specular_texture.is_some() || specular.specular_color_texture.is_some() {
                self.report.lacks(
                    "textures of the reflection of dielectrics",
                    "only the factors are used",
                    name,
                );
            }
        }
        if matches!(source.alpha_mode, Checked::Invalid) {
            self.report.lacks("an alphaMode that glTF does not define", "the material is opaque", name);
        }
        if source.occlusion_texture.is_some() {
            self.report.note("baked occlusion is not used", "light in crevices is computed", name);
        }
    }
}

/// Returns the index of refraction of the dielectric, with its reflectance scaled by `KHR_materials_specular`.
fn relative_index(extensions: &Extensions) -> f32 {
    let ior = extensions.ior.as_ref().map_or(1.5, |ior| ior.ior.0);
    let normal_reflectance = ((ior - 1.0) / (ior + 1.0)).powi(2);
    let specular = extensions.specular.as_ref().map_or(1.0, |specular| {
        specular.specular_factor.0 * Rgb::from(specular.specular_color_factor.0).max_element()
    });
    let reflectance = normal_reflectance * specular;
    let root = if reflectance.is_finite() { reflectance.clamp(1e-6, 0.9).sqrt() } else { 0.2 };
    (1.0 + root) / (1.0 - root)
}

/// Returns a number of an extension that is read from its JSON.
fn number(extension: &Value, key: &str) -> Option<f32> {
    extension.get(key).and_then(Value::as_f64).map(|v| v as f32)
}

/// Returns a texture reference of an extension that is read from its JSON.
fn slot(extension: &Value, key: &str) -> Option<Info> {
    serde_json::from_value(extension.get(key)?.clone()).ok()
}
