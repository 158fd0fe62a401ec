//! Bsdfs to materials.
//!
//! Deviations: bump, normal and alpha maps, anisotropy, transmission through rough interfaces and layered
//! coatings have no counterpart; each is replaced by the nearest material, with a warning.

use super::Converter;
use super::tree::Object;
use crate::math::{Rgb, luminance};
use crate::scene::formats::check;
use crate::scene::formats::constants;
use crate::scene::formats::error::SceneError;
use crate::scene::material::{
    Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance, Roughness,
};
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
            "phong" | "ward" => self.classic_glossy(bsdf, name)?,
            "null" => glass(name, (1.0, false), [Reflectance::Constant(Rgb::ONE); 2]),
            "twosided" => self.two_sided(bsdf, depth)?,
            "mask" | "bumpmap" | "bump" | "normalmap" | "blendbsdf" | "mixturebsdf" | "coating"
            | "roughcoating" => self.wrapped(bsdf, depth)?,
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
        if let [Lobe::Dielectric { .. }, ..] = nested.lobes[..] {
            self.log.warn(&bsdf.place, "twosided stands around a transmitting bsdf", "it is left out")?;
        }
        Ok(Material { two_sided: true, ..nested })
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
        if bsdf.plugin == "roughdielectric" {
            bsdf.ignore(&["alpha", "alpha_u", "alpha_v", "distribution", "sample_visible"]);
            let fallback = "the surface is smooth glass";
            self.log.warn(&bsdf.place, "a rough dielectric is not modelled", fallback)?;
        }
        let reflectance = self.reflectance(bsdf, "specular_reflectance", 1.0)?;
        let transmittance = self.reflectance(bsdf, "specular_transmittance", 1.0)?;
        Ok(glass(name, (eta, bsdf.plugin == "thindielectric"), [reflectance, transmittance]))
    }

    /// Phong and Ward: a Lambert base and a GGX lobe of the same width and reflectance.
    fn classic_glossy(&mut self, bsdf: &Object, name: String) -> Result<Material, SceneError> {
        let diffuse = self.reflectance(bsdf, "diffuse_reflectance", 0.5)?;
        let scale = self.reflectance(bsdf, "specular_reflectance", 0.2)?;
        let alpha = if bsdf.plugin == "phong" {
            (2.0 / (bsdf.positive("exponent", 30.0)? + 2.0)).sqrt()
        } else {
            bsdf.ignore(&["variant"]);
            (bsdf.positive("alpha_u", 0.1)? * bsdf.positive("alpha_v", 0.1)?).sqrt()
        };
        let what = format!("the bsdf \"{}\" is not modelled", bsdf.plugin);
        self.log.warn(&bsdf.place, what, format!("a GGX lobe of alpha {alpha:.4} stands in"))?;
        let alpha = alpha as f32;
        let (distribution, alpha) = (Distribution::Ggx, alpha.into());
        let lobe = Lobe::Rough { distribution, alpha, fresnel: Fresnel::One, scale };
        Ok(Material { name, diffuse, lobes: vec![lobe], ..Material::default() })
    }

    fn rough(&mut self, bsdf: &Object, fresnel: Fresnel, scale: Reflectance) -> Result<Lobe, SceneError> {
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
        Ok(Lobe::Rough { distribution, alpha, fresnel, scale })
    }

    fn alpha(&mut self, bsdf: &Object, name: &str) -> Result<Roughness, SceneError> {
        let Some(texture) = self.document.named(bsdf, name)? else {
            return Ok(Roughness::Constant(bsdf.positive(name, 0.1)? as f32));
        };
        Ok(match self.texture(&texture, 0)? {
            Reflectance::Constant(colour) => Roughness::Constant(luminance(colour)),
            Reflectance::Textured { texture, scale } => {
                Roughness::Textured { texture, scale: luminance(scale) }
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
