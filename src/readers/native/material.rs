//! Materials of the native format.

use super::builder::SceneBuilder;
use super::text::{
    AttributeText, ColourText, FilterText, MapText, MaterialText, Number, NumberText, TextureText, WrapText,
};
use crate::attenuation::absorption;
use crate::check;
use crate::error::{Location, SceneError};
use crate::layers;
use crate::layers::CoatSurface;
use crate::plan::{TexturePlan, TextureSource};
use base::math::Rgb;
use glam::{Mat3, Vec2};
use scene::{
    Coat, Distribution, Filter, Fresnel, Lobe, Material, Parameter, Principled, Reflectance, Relief,
    Roughness, Share, TextureId, Wrap,
};
use toml::Spanned;

/// Maximum nesting of materials.
const MAX_DEPTH: u32 = 8;

impl SceneBuilder<'_> {
    pub(super) fn material(&mut self, text: &Spanned<MaterialText>) -> Result<(), SceneError> {
        let place = self.file.place(text.span());
        let material = self.described(text, 0)?;
        let text = text.get_ref();
        let id = self.contents.add_material(material, place.clone());
        if self.material_ids.insert(text.name.clone(), id).is_some() {
            let what = format!("there are two materials called \"{}\"", text.name);
            return Err(place.wrong(what, "rename one"));
        }
        Ok(())
    }

    /// Returns the material of a description that is nested `depth` times.
    fn described(&mut self, text: &Spanned<MaterialText>, depth: u32) -> Result<Material, SceneError> {
        let place = self.file.place(text.span());
        let text = text.get_ref();
        check_keys(text, &place)?;
        let nested = match text.kind.as_str() {
            "blend" => Some(self.blended(text, depth, &place)?),
            "coated" => Some(self.coated(text, depth, &place)?),
            _ => None,
        };
        let material = match nested {
            Some(nested) => Material { two_sided: text.two_sided.unwrap_or(nested.two_sided), ..nested },
            None => {
                let (diffuse, coat, lobe) = self.layers(text, &place)?;
                let principled =
                    (text.kind == "principled").then(|| self.principled(text, &place)).transpose()?;
                let principled = principled.map(Box::new);
                let (two_sided, lobes) = (text.two_sided.unwrap_or(true), Vec::from_iter(lobe));
                let absorption = attenuation(text, &place)?;
                Material { two_sided, diffuse, coat, lobes, principled, absorption, ..Material::default() }
            }
        };
        let opacity = text.opacity.clone().map(|opacity| self.share(opacity, &place)).or(material.opacity);
        let relief = self.relief(text, &place)?.or(material.relief);
        Ok(Material { name: text.name.clone(), opacity, relief, ..material })
    }

    /// Returns the material `name`, a part of the material at `place`.
    fn named(&mut self, name: &Option<String>, depth: u32, place: &Location) -> Result<Material, SceneError> {
        if depth > MAX_DEPTH {
            return Err(place.wrong("materials are made of each other", "break the cycle"));
        }
        let Some(name) = name else {
            let what = "a material lacks the materials that it combines";
            return Err(place.wrong(what, "name them: first and second of a blend, base of a coated one"));
        };
        let texts = self.material_texts;
        let text = texts.iter().find(|text| text.get_ref().name == *name);
        self.described(text.ok_or_else(|| place.undefined("material", name))?, depth + 1)
    }

    fn blended(&mut self, text: &MaterialText, depth: u32, place: &Location) -> Result<Material, SceneError> {
        let materials = [self.named(&text.first, depth, place)?, self.named(&text.second, depth, place)?];
        let weight = match text.weight.clone() {
            Some(weight) => self.share(weight, place),
            None => Share::Constant(0.5),
        };
        layers::blended(weight, materials, place, self.log)
    }

    fn coated(&mut self, text: &MaterialText, depth: u32, place: &Location) -> Result<Material, SceneError> {
        let nested = self.named(&text.base, depth, place)?;
        let eta = index_of_refraction(text);
        let scale = self.factor(&text.specular, place)?;
        let fresnel = Fresnel::Dielectric(eta);
        let lobe = match text.alpha {
            None => Lobe::Mirror { fresnel, scale },
            Some(_) => self.rough(text, fresnel, scale, place)?,
        };
        layers::coated(nested, CoatSurface { eta, lobe, through: Rgb::ONE }, place, self.log)
    }

    fn layers(
        &mut self,
        text: &MaterialText,
        place: &Location,
    ) -> Result<(Reflectance, Option<Coat>, Option<Lobe>), SceneError> {
        let need = |colour: &Option<ColourText>, key: &str| {
            let what = || format!("the material \"{}\" lacks {key}", text.name);
            colour.clone().ok_or_else(|| place.wrong(what(), format!("add {key} = ...")))
        };
        let ior = index_of_refraction(text);
        Ok(match text.kind.as_str() {
            "diffuse" => (self.colour(&need(&text.reflectance, "reflectance")?, place)?, None, None),
            "glossy" => {
                let diffuse = self.colour(&need(&text.diffuse, "diffuse")?, place)?;
                let scale = self.colour(&need(&text.specular, "specular")?, place)?;
                (diffuse, None, Some(self.rough(text, Fresnel::One, scale, place)?))
            }
            "plastic" | "roughplastic" => {
                let diffuse = self.colour(&need(&text.diffuse, "diffuse")?, place)?;
                let scale = self.factor(&text.specular, place)?;
                let fresnel = Fresnel::Dielectric(ior);
                let lobe = match text.kind.as_str() {
                    "plastic" => Lobe::Mirror { fresnel, scale },
                    _ => self.rough(text, fresnel, scale, place)?,
                };
                let coat = Coat { eta: ior, nonlinear: text.nonlinear.unwrap_or(false) };
                (diffuse, Some(coat), Some(lobe))
            }
            "conductor" => (Reflectance::BLACK, None, Some(self.conductor(text, place)?)),
            "mirror" => {
                let scale = self.factor(&text.reflectance, place)?;
                (Reflectance::BLACK, None, Some(Lobe::Mirror { fresnel: Fresnel::One, scale }))
            }
            "glass" => (Reflectance::BLACK, None, Some(self.glass(text, place)?)),
            _ => (Reflectance::BLACK, None, None),
        })
    }

    fn glass(&mut self, text: &MaterialText, place: &Location) -> Result<Lobe, SceneError> {
        let reflectance = self.factor(&text.reflectance, place)?;
        let transmittance = self.factor(&text.transmittance, place)?;
        let (eta, thin) = (index_of_refraction(text), text.thin.unwrap_or(false));
        match text.alpha {
            None => Ok(Lobe::Dielectric { eta, thin, reflectance, transmittance }),
            Some(_) if thin => {
                let what = format!("the glass \"{}\" is thin and rough", text.name);
                Err(place.wrong(what, "leave out thin or alpha"))
            }
            Some(_) => {
                let (distribution, alpha) = self.facets(text, place)?;
                Ok(Lobe::RoughDielectric { distribution, alpha, eta, reflectance, transmittance })
            }
        }
    }

    fn conductor(&mut self, text: &MaterialText, place: &Location) -> Result<Lobe, SceneError> {
        let scale = self.factor(&text.specular, place)?;
        let fresnel = self.metal(text, place)?;
        match text.alpha {
            None | Some(NumberText::Number(Number(0.0))) if text.alpha_v.is_some() => {
                let what = format!("the roughness of \"{}\" is given along v alone", text.name);
                Err(place.wrong(what, "give alpha, the roughness along u, above 0"))
            }
            None | Some(NumberText::Number(Number(0.0))) => Ok(Lobe::Mirror { fresnel, scale }),
            Some(_) => self.rough(text, fresnel, scale, place),
        }
    }

    /// Returns the factor on a lobe, by default 1.
    fn factor(&mut self, colour: &Option<ColourText>, place: &Location) -> Result<Reflectance, SceneError> {
        match colour {
            Some(colour) => self.colour(colour, place),
            None => Ok(Reflectance::Constant(Rgb::ONE)),
        }
    }

    /// Returns the reflectance of a conductor, from its name or its optical constants.
    fn metal(&self, text: &MaterialText, place: &Location) -> Result<Fresnel, SceneError> {
        match (&text.preset, &text.eta, &text.k) {
            (Some(preset), None, None) => {
                let (eta, k) = check::conductor(preset, place)?;
                Ok(Fresnel::Conductor { eta, k })
            }
            (None, Some(eta), Some(k)) => {
                Ok(Fresnel::Conductor { eta: eta.rgb("eta", place)?, k: k.rgb("k", place)? })
            }
            _ => {
                let what = format!("the conductor \"{}\" is not determined", text.name);
                Err(place.wrong(what, "give either preset, or eta and k"))
            }
        }
    }

    fn rough(
        &mut self,
        text: &MaterialText,
        fresnel: Fresnel,
        scale: Reflectance,
        place: &Location,
    ) -> Result<Lobe, SceneError> {
        let (distribution, alpha) = self.facets(text, place)?;
        let Some(across) = text.alpha_v.clone() else {
            return Ok(Lobe::Rough { distribution, alpha, fresnel, scale });
        };
        if let NumberText::Number(Number(across)) = across
            && !(across > 0.0 && across <= 4.0)
        {
            let what = format!("the roughness of \"{}\" along v is {across}", text.name);
            return Err(place.wrong(what, "give a number above 0, usually up to 1"));
        }
        let alpha = [alpha, self.share(across, place)];
        Ok(Lobe::Anisotropic { distribution, alpha, fresnel, scale })
    }

    /// Returns the distribution and the roughness of microfacets.
    fn facets(
        &mut self,
        text: &MaterialText,
        place: &Location,
    ) -> Result<(Distribution, Roughness), SceneError> {
        let alpha = match text.alpha.clone().unwrap_or(NumberText::Number(Number(0.1))) {
            NumberText::Number(Number(alpha)) => {
                if !(alpha > 0.0 && alpha <= 4.0) {
                    let what = format!("the roughness of \"{}\" is {alpha}", text.name);
                    return Err(place.wrong(what, "give a number above 0, usually up to 1"));
                }
                Roughness::Constant(alpha as f32)
            }
            NumberText::File(file) => self.number(TextureText { file, ..TextureText::default() }, place),
            NumberText::Texture(texture) => self.number(texture, place),
            NumberText::Attribute(attribute) => self.attribute_number(&attribute, place),
        };
        let distribution = match text.distribution.as_deref() {
            None | Some("ggx") => Distribution::Ggx,
            Some("beckmann") => Distribution::Beckmann,
            Some(other) => {
                let what = format!("unknown distribution \"{other}\"");
                return Err(place.wrong(what, "use ggx or beckmann"));
            }
        };
        Ok((distribution, alpha))
    }

    fn principled(&mut self, text: &MaterialText, place: &Location) -> Result<Principled, SceneError> {
        let base_color = match &text.base_color {
            Some(colour) => self.colour(colour, place)?,
            None => Principled::default().base_color,
        };
        let mut share = |number: &Option<NumberText>, default| match number {
            Some(number) => self.share(number.clone(), place),
            None => Share::Constant(default),
        };
        Ok(Principled {
            base_color,
            metallic: share(&text.metallic, 0.0),
            roughness: share(&text.roughness, 0.5),
            anisotropic: share(&text.anisotropic, 0.0),
            eta: index_of_refraction(text),
            spec_tint: share(&text.spec_tint, 0.0),
            spec_trans: share(&text.spec_trans, 0.0),
            tints_each_passage: false,
            sheen: share(&text.sheen, 0.0),
            sheen_tint: share(&text.sheen_tint, 0.0),
            clearcoat: share(&text.clearcoat, 0.0),
            clearcoat_gloss: text.clearcoat_gloss.map_or(0.0, f64::from) as f32,
            ..Principled::default()
        })
    }

    fn relief(&mut self, text: &MaterialText, place: &Location) -> Result<Option<Relief>, SceneError> {
        if let (Some(_), Some(_)) = (&text.normal_map, &text.bump_map) {
            let what = format!("the material \"{}\" has two reliefs", text.name);
            return Err(place.wrong(what, "leave out normal_map or bump_map"));
        }
        let raw = |map: &MapText| match map.clone() {
            MapText::File(file) => TextureText { file, raw: true, ..TextureText::default() },
            MapText::Texture(texture) => TextureText { raw: true, ..texture },
        };
        let normals = text.normal_map.as_ref().map(raw).map(|map| Relief::Normals {
            texture: self.texture_id(&map, place),
            strength: map.scale() as f32,
            y_along_v: true,
        });
        let heights = text
            .bump_map
            .as_ref()
            .map(raw)
            .map(|map| Relief::Heights { texture: self.texture_id(&map, place), scale: map.scale() as f32 });
        Ok(normals.or(heights))
    }

    fn share(&mut self, text: NumberText, place: &Location) -> Share {
        match text {
            NumberText::Number(Number(number)) => Share::Constant(number as f32),
            NumberText::File(file) => self.number(TextureText { file, ..TextureText::default() }, place),
            NumberText::Texture(texture) => self.number(texture, place),
            NumberText::Attribute(attribute) => self.attribute_number(&attribute, place),
        }
    }

    fn attribute_number(&mut self, text: &AttributeText, place: &Location) -> Parameter<f32> {
        let texture = self.attribute_id(text, true, place);
        Parameter::Textured { texture, scale: text.scale() as f32 }
    }

    /// Returns the texture that is an attribute of meshes. `raw` is true if its image holds numbers.
    pub(super) fn attribute_id(&mut self, text: &AttributeText, raw: bool, place: &Location) -> TextureId {
        let image = text.image.as_ref().map(|image| {
            let image = match image.clone() {
                MapText::File(file) => TextureText { file, ..TextureText::default() },
                MapText::Texture(texture) => texture,
            };
            self.texture_id(&TextureText { raw: raw || image.raw, ..image }, place)
        });
        self.contents.add_attribute(&text.attribute, image)
    }

    fn number(&mut self, text: TextureText, place: &Location) -> Parameter<f32> {
        let scale = text.scale() as f32;
        let texture = self.texture_id(&TextureText { raw: true, ..text }, place);
        Parameter::Textured { texture, scale }
    }

    pub(super) fn texture(&mut self, text: &TextureText, place: &Location) -> Reflectance {
        let scale = Rgb::splat(text.scale() as f32);
        Reflectance::Textured { texture: self.texture_id(text, place), scale }
    }

    pub(super) fn texture_id(&mut self, text: &TextureText, place: &Location) -> TextureId {
        let wrap = match text.wrap {
            None | Some(WrapText::Repeat) => Wrap::Repeat,
            Some(WrapText::Mirror) => Wrap::Mirror,
            Some(WrapText::Clamp) => Wrap::Clamp,
        };
        let filter = match text.filter {
            None | Some(FilterText::Bilinear) => Filter::Bilinear,
            Some(FilterText::Nearest) => Filter::Nearest,
        };
        let tiles = text.tiles.map_or([1.0, 1.0], <[f64; 2]>::from).map(|t| t as f32);
        let to_uv = Mat3::from_scale(Vec2::from(tiles));
        let image = TextureSource::File { path: self.folder.join(&text.file), raw: text.raw };
        self.contents.add_texture(TexturePlan { place: place.clone(), image, filter, wrap, to_uv })
    }
}

/// Returns the index of refraction of a dielectric, by default 1.5.
fn index_of_refraction(text: &MaterialText) -> f32 {
    text.ior.map_or(1.5, f64::from) as f32
}

/// Returns the absorption coefficient inside glass; `None` if nothing is absorbed.
fn attenuation(text: &MaterialText, place: &Location) -> Result<Option<Rgb>, SceneError> {
    let colour = match &text.attenuation_colour {
        Some(colour) => colour.rgb("attenuation_colour", place)?,
        None => Rgb::ONE,
    };
    let distance = text.attenuation_distance.map_or(1.0, f64::from);
    let is_share = colour.min_element() >= 0.0 && colour.max_element() <= 1.0;
    if !(is_share && distance > 0.0) {
        let what = format!("the glass \"{}\" has the attenuation colour {colour} over {distance}", text.name);
        return Err(place.wrong(what, "give a colour from 0 to 1 and a distance above 0"));
    }
    let absorption = absorption(colour, distance);
    if absorption.is_some() && text.thin == Some(true) {
        let what = format!("the glass \"{}\" is thin and absorbs inside", text.name);
        return Err(place.wrong(what, "leave out thin, or give transmittance instead"));
    }
    Ok(absorption)
}

/// Returns the keys of a kind of material; `None` for an unknown kind.
fn keys_of(kind: &str) -> Option<&'static [&'static str]> {
    Some(match kind {
        "diffuse" | "mirror" => &["reflectance"],
        "glossy" => &["diffuse", "specular", "alpha", "distribution"],
        "plastic" => &["diffuse", "specular", "ior", "nonlinear"],
        "roughplastic" => &["diffuse", "specular", "ior", "nonlinear", "alpha", "distribution"],
        "conductor" => &["preset", "eta", "k", "specular", "alpha", "alpha_v", "distribution"],
        "glass" => &[
            "ior",
            "reflectance",
            "transmittance",
            "thin",
            "alpha",
            "distribution",
            "attenuation_colour",
            "attenuation_distance",
        ],
        "principled" => &[
            "base_color",
            "metallic",
            "roughness",
            "anisotropic",
            "ior",
            "spec_tint",
            "spec_trans",
            "attenuation_colour",
            "attenuation_distance",
            "sheen",
            "sheen_tint",
            "clearcoat",
            "clearcoat_gloss",
        ],
        "blend" => &["first", "second", "weight"],
        "coated" => &["base", "ior", "specular", "alpha", "distribution"],
        _ => return None,
    })
}

/// Rejects keys that mean nothing for the kind of material.
fn check_keys(text: &MaterialText, place: &Location) -> Result<(), SceneError> {
    let Some(known) = keys_of(&text.kind) else {
        let remedy = "use diffuse, glossy, plastic, roughplastic, conductor, mirror, glass, principled, blend or coated";
        return Err(place.wrong(format!("unknown kind of material \"{}\"", text.kind), remedy));
    };
    let given = [
        ("reflectance", text.reflectance.is_some()),
        ("diffuse", text.diffuse.is_some()),
        ("specular", text.specular.is_some()),
        ("transmittance", text.transmittance.is_some()),
        ("alpha", text.alpha.is_some()),
        ("alpha_v", text.alpha_v.is_some()),
        ("distribution", text.distribution.is_some()),
        ("ior", text.ior.is_some()),
        ("nonlinear", text.nonlinear.is_some()),
        ("preset", text.preset.is_some()),
        ("eta", text.eta.is_some()),
        ("k", text.k.is_some()),
        ("thin", text.thin.is_some()),
        ("attenuation_colour", text.attenuation_colour.is_some()),
        ("attenuation_distance", text.attenuation_distance.is_some()),
        ("base_color", text.base_color.is_some()),
        ("metallic", text.metallic.is_some()),
        ("roughness", text.roughness.is_some()),
        ("anisotropic", text.anisotropic.is_some()),
        ("spec_tint", text.spec_tint.is_some()),
        ("spec_trans", text.spec_trans.is_some()),
        ("sheen", text.sheen.is_some()),
        ("sheen_tint", text.sheen_tint.is_some()),
        ("clearcoat", text.clearcoat.is_some()),
        ("clearcoat_gloss", text.clearcoat_gloss.is_some()),
        ("first", text.first.is_some()),
        ("second", text.second.is_some()),
        ("weight", text.weight.is_some()),
        ("base", text.base.is_some()),
    ];
    check::keys(&format!("{} material", text.kind), known, &given, place)
}
