//! Bsdfs to materials.
//!
//! Deviations: anisotropy and layered coatings have no counterpart; each is replaced by the
//! nearest material, with a warning.

use super::Converter;
use super::tree::Object;
use crate::math::{Rgb, luminance};
use crate::scene::formats::check;
use crate::scene::formats::constants;
use crate::scene::formats::error::SceneError;
use crate::scene::material::{
    Blend, Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Parameter, Reflectance, Roughness, Share,
};
use crate::scene::principled::{Principled, eta_of_specular};
use crate::scene::relief::Relief;
use std::rc::Rc;

impl Converter<'_> {
    /// The material of a shape: its bsdf's, or Mitsuba's default, which is black on emitters.
    pub(super) fn material_of_shape(
        &mut self,
        bsdf: Option<&Rc<Object>>,
        emits: bool,
    ) -> Result<MaterialId, SceneError> {
        let Some(bsdf) = bsdf else {
            let slot = usize::from(emits);
            if let Some(id) = self.default_materials[slot] {
                return Ok(id);
            }
            let albedo = Rgb::splat(if emits { 0.0 } else { 0.5 });
            let material = diffuse("default".into(), Reflectance::Constant(albedo));
            let id = self.contents.add_material(material, self.document.root.place.clone());
            self.default_materials[slot] = Some(id);
            return Ok(id);
        };
        // The document keeps every object, so the address is its identity.
        let key = Rc::as_ptr(bsdf);
        if let Some((_, id)) = self.material_of.iter().find(|(object, _)| *object == key) {
            return Ok(*id);
        }
        let mut material = self.material(bsdf, 0)?;
        if let Some(id) = &bsdf.id {
            material.name = id.clone();
        }
        let id = self.contents.add_material(material, bsdf.place.clone());
        self.material_of.push((key, id));
        Ok(id)
    }

    fn material(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        if depth > 8 {
            return Err(bsdf.place.wrong("bsdfs refer to each other", "break the circle"));
        }
        let name = bsdf.id.clone().unwrap_or_else(|| match bsdf.place.line {
            Some(line) => format!("{}:{line}", bsdf.plugin),
            None => bsdf.plugin.clone(),
        });
        let material = match bsdf.plugin.as_str() {
            "diffuse" => {
                // 0.6 knows both names.
                let old = bsdf.has("diffuse_reflectance");
                let parameter = if old { "diffuse_reflectance" } else { "reflectance" };
                diffuse(name, self.reflectance(bsdf, parameter, 0.5)?)
            }
            "roughdiffuse" => {
                bsdf.ignore(&["alpha", "use_fast_approx"]);
                self.log.warn(&bsdf.place, "a rough diffuse surface is not modelled", "it is Lambertian")?;
                diffuse(name, self.reflectance(bsdf, "reflectance", 0.5)?)
            }
            "difftrans" => {
                self.log.warn(
                    &bsdf.place,
                    "diffuse transmission is not modelled",
                    "the surface reflects it",
                )?;
                diffuse(name, self.reflectance(bsdf, "transmittance", 0.5)?)
            }
            "plastic" | "roughplastic" => self.plastic(bsdf, name)?,
            "conductor" | "roughconductor" => self.conductor(bsdf, name)?,
            "dielectric" | "thindielectric" | "roughdielectric" => self.dielectric(bsdf, name)?,
            "principled" => self.principled(bsdf, name)?,
            "phong" | "ward" => self.classic_glossy(bsdf, name)?,
            "null" => glass(name, (1.0, false), [Reflectance::Constant(Rgb::ONE); 2]),
            "twosided" => self.two_sided(bsdf, depth)?,
            "mask" => self.masked(bsdf, depth)?,
            "bumpmap" | "bump" | "normalmap" => self.relieved(bsdf, depth)?,
            "blendbsdf" => self.blended(bsdf, depth)?,
            "coating" | "roughcoating" => self.coated(bsdf, depth)?,
            "mixturebsdf" => self.wrapped(bsdf, depth)?,
            other => {
                let what = format!("the bsdf \"{other}\" is not modelled");
                self.log.warn(&bsdf.place, what, "a diffuse grey of 0.5 stands in")?;
                return Ok(diffuse(name, Reflectance::Constant(Rgb::splat(0.5))));
            }
        };
        bsdf.report_unused(self.log)?;
        Ok(material)
    }

    /// The nested bsdf seen from both sides.
    fn two_sided(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let nested = self.nested(bsdf, depth)?;
        if let [Lobe::Dielectric { .. } | Lobe::RoughDielectric { .. }, ..] = nested.lobes[..] {
            self.log.warn(&bsdf.place, "twosided stands around a transmitting bsdf", "it is left out")?;
        }
        Ok(Material { two_sided: true, ..nested })
    }

    /// The nested bsdf with gaps.
    fn masked(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let opacity = self.share(bsdf, "opacity", 0.5)?;
        let nested = self.nested(bsdf, depth)?;
        let opacity = match (opacity, nested.opacity) {
            (opacity, None) => opacity,
            (Share::Constant(a), Some(Share::Constant(b))) => Share::Constant(a * b),
            (Share::Constant(a), Some(Share::Textured { texture, scale })) => {
                Share::Textured { texture, scale: a * scale }
            }
            (opacity, Some(_)) => {
                self.log.warn(
                    &bsdf.place,
                    "a mask of a mask is not modelled",
                    "the inner one is left out",
                )?;
                opacity
            }
        };
        Ok(Material { opacity: Some(opacity), ..nested })
    }

    /// The nested bsdf under a dielectric coat: a diffuse one is that of plastic, and lobes lose at the coat as much as
    /// at normal incidence.
    fn coated(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let eta = self.relative_ior(bsdf, "bk7")?;
        let scale = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let absorption = self.colour(bsdf, "sigma_a")?.unwrap_or(Rgb::ZERO);
        let absorbed = -2.0 * bsdf.positive("thickness", 1.0)? as f32 * absorption;
        let through = Rgb::from_array(absorbed.to_array().map(f32::exp));
        let fresnel = Fresnel::Dielectric(eta);
        let coat = match bsdf.plugin.as_str() {
            "coating" => Lobe::Mirror { fresnel, scale },
            _ => self.rough(bsdf, fresnel, scale)?,
        };
        let mut nested = self.nested(bsdf, depth)?;
        let transmits = |lobe: &Lobe| matches!(lobe, Lobe::Dielectric { .. } | Lobe::RoughDielectric { .. });
        let is_layered = nested.coat.is_some() || nested.principled.is_some() || nested.blend.is_some();
        if is_layered || nested.lobes.iter().any(transmits) {
            let what = "a coating of plastic, glass, principled materials or blends is not modelled";
            self.log.warn(&bsdf.place, what, "it is left out")?;
            return Ok(nested);
        }
        let normal = 4.0 * eta / ((eta + 1.0) * (eta + 1.0));
        for lobe in &mut nested.lobes {
            if let Lobe::Rough { scale, .. } | Lobe::Mirror { scale, .. } = lobe {
                *scale = scale.times(through * (normal * normal));
            }
        }
        nested.diffuse = nested.diffuse.times(through);
        nested.coat = Some(Coat { eta, nonlinear: true });
        nested.lobes.insert(0, coat);
        let what =
            format!("the {} reflects light between it and what it covers as plastic does", bsdf.plugin);
        self.log.note(&bsdf.place, what, "the plugin itself does not");
        Ok(nested)
    }

    /// Two nested bsdfs, mixed.
    fn blended(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let weight = self.share(bsdf, "weight", 0.5)?;
        let nested = self.tagged(bsdf, "bsdf")?;
        let [first, second] = &nested[..] else {
            let what = format!("the bsdf \"{}\" holds {} others", bsdf.plugin, nested.len());
            return Err(bsdf.place.wrong(what, "nest two"));
        };
        let (first, other) = (self.material(first, depth + 1)?, self.material(second, depth + 1)?);
        let is_based =
            |material: &Material| material.principled.is_some() || material.diffuse != Reflectance::BLACK;
        let coat = |material: &Material| (material.coat, material.principled.is_some());
        if is_based(&first) && is_based(&other) && coat(&first) != coat(&other) {
            let fallback = "that of the first is on both";
            self.log.warn(&bsdf.place, "a blend of bases under different coats is not modelled", fallback)?;
        }
        for (is_left_out, what) in [
            (first.blend.is_some(), "a blend as the first bsdf of a blend"),
            (other.opacity.is_some() || other.relief.is_some(), "a mask or relief of the second bsdf"),
        ] {
            if is_left_out {
                self.log.warn(&bsdf.place, format!("{what} is not modelled"), "it is left out")?;
            }
        }
        let blend = Some(Box::new(Blend { weight, other }));
        Ok(Material { blend, ..first })
    }

    /// The nested bsdf with a relief.
    fn relieved(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let nested = self.nested(bsdf, depth)?;
        let normals = bsdf.plugin == "normalmap";
        let named = if normals { self.document.named(bsdf, "normalmap")? } else { None };
        let texture = match named {
            Some(texture) => Some(texture),
            None => self.tagged(bsdf, "texture")?.into_iter().next(),
        };
        let scale = bsdf.float("scale")?.unwrap_or(1.0) as f32;
        let relief = match texture.map(|texture| self.texture(&texture, 0)).transpose()? {
            Some(Reflectance::Textured { texture, .. }) if normals => {
                Some(Relief::Normals { texture, strength: 1.0, y_along_v: false })
            }
            Some(Reflectance::Textured { texture, scale: factor }) => {
                Some(Relief::Heights { texture, scale: scale * luminance(factor) })
            }
            _ => None,
        };
        if relief.is_some() && nested.relief.is_some() {
            self.log.warn(
                &bsdf.place,
                "a relief of a relief is not modelled",
                "the inner one is left out",
            )?;
        }
        Ok(Material { relief: relief.or(nested.relief), ..nested })
    }

    /// Modifiers that are left out.
    fn wrapped(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let what = format!("the bsdf \"{}\" is not modelled", bsdf.plugin);
        self.log.warn(&bsdf.place, what, "the (first) bsdf inside it is used alone")?;
        let nested = self.nested(bsdf, depth)?;
        // The warning covers the maps and weights too.
        self.tagged(bsdf, "texture")?;
        bsdf.properties.iter().for_each(|p| p.used.set(true));
        Ok(nested)
    }

    fn nested(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let nested = self.tagged(bsdf, "bsdf")?;
        let Some(first) = nested.first() else {
            let what = format!("the bsdf \"{}\" holds no other", bsdf.plugin);
            return Err(bsdf.place.wrong(what, "nest a <bsdf> or a <ref> to one"));
        };
        if let (Some(second), "twosided") = (nested.get(1), bsdf.plugin.as_str()) {
            self.log.warn(&second.place, "different sides are not modelled", "the first bsdf is on both")?;
        }
        self.material(first, depth + 1)
    }

    fn plastic(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
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

    fn conductor(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let scale = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let preset = bsdf.string("material")?;
        let fresnel = if bsdf.has("eta") || bsdf.has("k") {
            let eta = self.colour(bsdf, "eta")?.unwrap_or(Rgb::ZERO);
            let k = self.colour(bsdf, "k")?.unwrap_or(Rgb::ONE);
            // In 0.6 both are relative to the medium outside.
            let outside = match bsdf.has("ext_eta") {
                true => self.ior(bsdf, "ext_eta", "vacuum")?,
                false => 1.0,
            } as f32;
            Fresnel::Conductor { eta: eta / outside, k: k / outside }
        } else {
            match preset.as_deref() {
                None | Some("none") => Fresnel::One,
                Some(preset) => {
                    let (eta, k) = check::conductor(preset, &bsdf.place)?;
                    Fresnel::Conductor { eta, k }
                }
            }
        };
        let lobe = match bsdf.plugin.as_str() {
            "conductor" => Lobe::Mirror { fresnel, scale },
            _ => self.rough(bsdf, fresnel, scale)?,
        };
        Ok(Material { name, lobes: vec![lobe], ..Material::default() })
    }

    fn dielectric(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let eta = self.relative_ior(bsdf, "bk7")?;
        let reflectance = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let transmittance = self.reflectance(bsdf, "specular_transmittance", 1.0)?;
        if bsdf.plugin == "roughdielectric" {
            let (distribution, alpha) = self.facets(bsdf)?;
            let lobe = Lobe::RoughDielectric { distribution, alpha, eta, reflectance, transmittance };
            return Ok(Material { name, two_sided: true, lobes: vec![lobe], ..Material::default() });
        }
        Ok(glass(name, (eta, bsdf.plugin == "thindielectric"), [reflectance, transmittance]))
    }

    /// Phong and Ward: a Lambert base and a microfacet lobe of the same reflectance. For Phong's it is GGX with the α,
    /// within 4 %, that is nearest in the mean square over inclinations up to 57°, for exponents from 5 to 1000; Ward's
    /// is Beckmann's but for its factors of the cosines.
    fn classic_glossy(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let diffuse = self.reflectance(bsdf, "diffuse_reflectance", 0.5)?;
        let scale = self.reflectance(bsdf, "specular_reflectance", 0.2)?;
        let (distribution, alpha) = if bsdf.plugin == "phong" {
            (Distribution::Ggx, (1.0 / (bsdf.positive("exponent", 30.0)? + 2.0)).sqrt())
        } else {
            bsdf.ignore(&["variant"]);
            let alpha = (bsdf.positive("alpha_u", 0.1)? * bsdf.positive("alpha_v", 0.1)?).sqrt();
            (Distribution::Beckmann, alpha)
        };
        let what = format!("the bsdf \"{}\" is not modelled", bsdf.plugin);
        self.log.warn(&bsdf.place, what, format!("a {distribution:?} lobe of alpha {alpha:.4} stands in"))?;
        let alpha = (alpha as f32).into();
        let lobe = Lobe::Rough { distribution, alpha, fresnel: Fresnel::One, scale };
        Ok(Material { name, diffuse, lobes: vec![lobe], ..Material::default() })
    }

    fn principled(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
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
                self.log.warn(&bsdf.place, "a textured clearcoat_gloss is not modelled", "it is 0.5")?;
                0.5
            }
        };
        for (name, what) in [("anisotropic", "anisotropic roughness"), ("flatness", "flatness")] {
            let none = Share::Constant(0.0);
            if self.share(bsdf, name, 0.0)? != none {
                self.log.warn(&bsdf.place, format!("{what} is not modelled"), "it is left out")?;
            }
        }
        bsdf.ignore(&["main_specular_sampling_rate", "clearcoat_sampling_rate"]);
        bsdf.ignore(&["diffuse_reflectance_sampling_rate"]);
        Ok(Material { name, principled: Some(Box::new(principled)), ..Material::default() })
    }

    fn rough(&mut self, bsdf: &Object, fresnel: Fresnel, scale: Reflectance) -> Result<Lobe, SceneError> {
        let (distribution, alpha) = self.facets(bsdf)?;
        Ok(Lobe::Rough { distribution, alpha, fresnel, scale })
    }

    /// Distribution and roughness of microfacets.
    fn facets(&mut self, bsdf: &Object) -> Result<(Distribution, Roughness), SceneError> {
        let distribution = match bsdf.string("distribution")?.map(|d| d.to_lowercase()).as_deref() {
            None | Some("beckmann") => Distribution::Beckmann,
            Some("ggx") => Distribution::Ggx,
            Some("phong" | "as") => {
                let fallback = "Beckmann of the same alpha stands in";
                self.log.warn(&bsdf.place, "the Phong distribution is not modelled", fallback)?;
                Distribution::Beckmann
            }
            Some(other) => {
                let what = format!("unknown distribution \"{other}\"");
                return Err(bsdf.place.wrong(what, "use beckmann or ggx"));
            }
        };
        bsdf.ignore(&["sample_visible"]);
        let alpha = if bsdf.has("alpha_u") || bsdf.has("alpha_v") {
            let (u, v) = (self.alpha(bsdf, "alpha_u")?, self.alpha(bsdf, "alpha_v")?);
            match (u, v) {
                _ if u == v => u,
                (Roughness::Constant(u), Roughness::Constant(v)) => {
                    let fallback = "the geometric mean is used";
                    self.log.warn(&bsdf.place, "anisotropic roughness is not modelled", fallback)?;
                    Roughness::Constant((u * v).sqrt())
                }
                _ => {
                    let fallback = "that along u is used both ways";
                    self.log.warn(&bsdf.place, "anisotropic roughness is not modelled", fallback)?;
                    u
                }
            }
        } else {
            self.alpha(bsdf, "alpha")?
        };
        Ok((distribution, alpha))
    }

    fn alpha(&mut self, bsdf: &Object, name: &str) -> Result<Roughness, SceneError> {
        match self.document.named(bsdf, name)? {
            Some(texture) => self.number(&texture),
            None => Ok(Roughness::Constant(bsdf.positive(name, 0.1)? as f32)),
        }
    }

    /// A share of light or surface: a number, a colour of that luminance, or a texture.
    fn share(&mut self, bsdf: &Object, name: &str, default: f32) -> Result<Share, SceneError> {
        if let Some(colour) = self.colour(bsdf, name)? {
            return Ok(Share::Constant(luminance(colour)));
        }
        match self.document.named(bsdf, name)? {
            Some(texture) => self.number(&texture),
            None => Ok(Share::Constant(default)),
        }
    }

    fn number(&mut self, texture: &Object) -> Result<Parameter<f32>, SceneError> {
        Ok(match self.texture(texture, 0)? {
            Reflectance::Constant(colour) => Parameter::Constant(luminance(colour)),
            Reflectance::Textured { texture, scale } => {
                Parameter::Textured { texture, scale: luminance(scale) }
            }
        })
    }

    /// Interior over exterior.
    fn relative_ior(&mut self, bsdf: &Object, interior: &str) -> Result<f32, SceneError> {
        let (inside, outside) = (self.ior(bsdf, "int_ior", interior)?, self.ior(bsdf, "ext_ior", "air")?);
        Ok((inside / outside) as f32)
    }

    fn ior(&mut self, bsdf: &Object, name: &str, default: &str) -> Result<f64, SceneError> {
        let material = match bsdf.property(name).map(|p| &p.value) {
            Some(super::value::Value::String(material)) => material.clone(),
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

fn diffuse(name: String, diffuse: Reflectance) -> Material {
    Material { name, diffuse, ..Material::default() }
}

/// Glass of an index of refraction, perhaps a thin sheet of it, with factors on reflection and transmission.
fn glass(name: String, (eta, thin): (f32, bool), [reflectance, transmittance]: [Reflectance; 2]) -> Material {
    let lobe = Lobe::Dielectric { eta, thin, reflectance, transmittance };
    Material { name, two_sided: true, lobes: vec![lobe], ..Material::default() }
}
