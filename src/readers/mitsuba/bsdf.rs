//! Conversion of BSDFs to materials.
//!
//! Deviations: anisotropic glass and layered coatings have no counterpart. The nearest material replaces each of them,
//! with a warning.

use super::bsdf_kinds::{diffuse, glass};
use super::converter::Converter;
use super::tree::Object;
use super::value::numbers;
use crate::error::SceneError;
use crate::layers;
use crate::layers::CoatSurface;
use base::math::{Rgb, luminance};
use scene::{Fresnel, Lobe, Material, MaterialId, Reflectance, Relief, ReliefRules, Share};
use std::rc::Rc;

/// Sum of missing weights of a mixture, above which that share is absorbed. Less is rounding.
const MIN_LOST: f64 = 1e-4;

impl Converter<'_> {
    /// Returns the material of a shape: its BSDF's, or Mitsuba's default, which is black for emitters.
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
        // The document owns every object, so an address identifies an object.
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
            return Err(bsdf.place.wrong("bsdfs refer to each other", "break the cycle"));
        }
        let name = bsdf.id.clone().unwrap_or_else(|| match bsdf.place.line {
            Some(line) => format!("{}:{line}", bsdf.plugin),
            None => bsdf.plugin.clone(),
        });
        let material = match bsdf.plugin.as_str() {
            "diffuse" => {
                // Mitsuba 0.6 accepts both names.
                let old = bsdf.has("diffuse_reflectance");
                let parameter = if old { "diffuse_reflectance" } else { "reflectance" };
                diffuse(name, self.reflectance(bsdf, parameter, 0.5)?)
            }
            "roughdiffuse" => {
                let what = "the bsdf \"roughdiffuse\" is not supported";
                self.log.warn(&bsdf.place, what, "a Lambertian surface is used instead")?;
                diffuse(name, self.reflectance(bsdf, "reflectance", 0.5)?)
            }
            "difftrans" => self.diffuse_transmitter(bsdf, name)?,
            "plastic" | "roughplastic" => self.plastic(bsdf, name)?,
            "conductor" | "roughconductor" => self.conductor(bsdf, name)?,
            "dielectric" | "thindielectric" | "roughdielectric" => self.dielectric(bsdf, name)?,
            "principled" => self.principled(bsdf, name)?,
            "principledthin" => self.principled_thin(bsdf, name)?,
            "phong" | "ward" => self.classic_glossy(bsdf, name)?,
            "null" => {
                let white = Reflectance::Constant(Rgb::ONE);
                let clear =
                    Lobe::Dielectric { eta: 1.0, thin: false, reflectance: white, transmittance: white };
                glass(name, clear)
            }
            "twosided" => self.two_sided(bsdf, depth)?,
            "mask" => self.masked(bsdf, depth)?,
            "bumpmap" | "bump" | "normalmap" => self.relieved(bsdf, depth)?,
            "blendbsdf" => self.blended(bsdf, depth)?,
            "coating" | "roughcoating" => self.coated(bsdf, depth)?,
            "mixturebsdf" => self.mixed(bsdf, depth)?,
            other => {
                let what = format!("the bsdf \"{other}\" is not supported");
                self.log.warn(&bsdf.place, what, "a diffuse grey of 0.5 is used instead")?;
                return Ok(diffuse(name, Reflectance::Constant(Rgb::splat(0.5))));
            }
        };
        bsdf.report_unused(self.log)?;
        Ok(material)
    }

    /// Returns the nested BSDF as two-sided.
    fn two_sided(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let nested = self.nested(bsdf, depth)?;
        if let [Lobe::Dielectric { .. } | Lobe::RoughDielectric { .. }, ..] = nested.lobes[..] {
            self.log.warn(&bsdf.place, "twosided contains a transmitting bsdf", "it is left out")?;
        }
        Ok(Material { two_sided: true, ..nested })
    }

    /// Returns the nested BSDF with an opacity.
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
                    "a mask of a mask is not supported",
                    "the inner one is left out",
                )?;
                opacity
            }
        };
        Ok(Material { opacity: Some(opacity), ..nested })
    }

    /// Returns the nested BSDF under a dielectric coat; see [`layers::coated`].
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
        let nested = self.nested(bsdf, depth)?;
        let coats_before = nested.lobes.len();
        let surface = CoatSurface { eta, lobe: coat, through };
        let nested = layers::coated(nested, surface, &bsdf.place, self.log)?;
        if nested.lobes.len() == coats_before {
            return Ok(nested);
        }
        let what =
            format!("the {} reflects light between it and what it covers as plastic does", bsdf.plugin);
        self.log.note(&bsdf.place, what, "the plugin itself does not");
        Ok(nested)
    }

    /// Returns the mixture of two nested BSDFs.
    fn blended(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let weight = self.share(bsdf, "weight", 0.5)?;
        let nested = self.tagged(bsdf, "bsdf")?;
        let [first, second] = &nested[..] else {
            let what = format!("the bsdf \"{}\" holds {} others", bsdf.plugin, nested.len());
            return Err(bsdf.place.wrong(what, "nest two"));
        };
        let (first, other) = (self.material(first, depth + 1)?, self.material(second, depth + 1)?);
        layers::blended(weight, [first, other], &bsdf.place, self.log)
    }

    /// Returns the nested BSDF with a relief.
    fn relieved(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let nested = self.nested(bsdf, depth)?;
        let normals = bsdf.plugin == "normalmap";
        let named = if normals { self.document.named(bsdf, "normalmap")? } else { None };
        let texture = match named {
            Some(texture) => Some(texture),
            None => self.first(bsdf, "texture")?,
        };
        let scale = bsdf.float("scale")?.unwrap_or(1.0) as f32;
        // Only Mitsuba 3 has these rules.
        let rule = |name| bsdf.boolean(name, !self.document.is_old);
        let relief_rules =
            ReliefRules { mirrors: rule("flip_invalid_normals")?, shadows: rule("use_shadowing_function")? };
        let map = texture.map(|texture| self.texture(&texture, 0)).transpose()?;
        let relief = match map {
            Some(Reflectance::Textured { texture, .. }) if !self.contents.is_image(texture) => {
                let what = "a relief from mesh attributes is not supported";
                self.log.warn(&bsdf.place, what, "it is left out")?;
                None
            }
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
                "a relief of a relief is not supported",
                "the inner one is left out",
            )?;
        }
        Ok(match relief {
            Some(_) => Material { relief, relief_rules, ..nested },
            None => nested,
        })
    }

    /// Returns nested BSDFs, each with its share of the light. The remaining share is absorbed.
    fn mixed(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let text = bsdf.string("weights")?.unwrap_or_default();
        let nested = self.tagged(bsdf, "bsdf")?;
        let weights = numbers(&text).filter(|weights| {
            let are_shares = weights.iter().all(|weight| (0.0..f64::INFINITY).contains(weight));
            are_shares && weights.len() == nested.len() && weights.iter().sum::<f64>() > 0.0
        });
        let Some(weights) = weights else {
            let what = format!("the weights \"{text}\" do not fit {} bsdfs", nested.len());
            return Err(bsdf
                .place
                .wrong(what, "write a number of 0 or more for each bsdf, separated by commas"));
        };
        let mut parts: Vec<(f64, Material)> = Vec::with_capacity(nested.len() + 1);
        for (weight, nested) in weights.iter().zip(&nested) {
            parts.push((*weight, self.material(nested, depth + 1)?));
        }
        let lost = 1.0 - weights.iter().sum::<f64>();
        if lost > MIN_LOST {
            parts.push((lost, diffuse(bsdf.plugin.clone(), Reflectance::BLACK)));
        }
        // Parts are blended from the last to the first: each with the mixture of all later parts.
        let mut mixture: Option<(f64, Material)> = None;
        for (weight, part) in parts.into_iter().filter(|(weight, _)| *weight > 0.0).rev() {
            mixture = Some(match mixture {
                None => (weight, part),
                Some((rest, others)) => {
                    let sum = weight + rest;
                    let share = Share::Constant((rest / sum) as f32);
                    (sum, layers::blended(share, [part, others], &bsdf.place, self.log)?)
                }
            });
        }
        let Some((_, mixed)) = mixture else {
            return Err(bsdf.place.wrong("all weights are 0", "give at least one weight above 0"));
        };
        Ok(mixed)
    }

    fn nested(&mut self, bsdf: &Object, depth: u32) -> Result<Material, SceneError> {
        let Some(first) = self.first(bsdf, "bsdf")? else {
            let what = format!("the bsdf \"{}\" holds no other", bsdf.plugin);
            return Err(bsdf.place.wrong(what, "nest a <bsdf> or a <ref> to one"));
        };
        self.material(&first, depth + 1)
    }
}
