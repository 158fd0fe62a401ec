//! Materials from an OBJ's MTL files, read by `tobj`.
//!
//! Classic Phong materials become a Lambert base and a GGX lobe with α = sqrt(2 / (Ns + 2)); illumination models 3
//! and 5 a mirror, 4, 6, 7 and 9, or a dissolve below 1, glass. The lobe is dimmed where base and lobe would reflect
//! more than they receive. All are two-sided.

use super::Builder;
use super::text::TextureText;
use crate::math::Rgb;
use crate::scene::formats::error::{Place, SceneError};
use crate::scene::formats::mesh::obj;
use crate::scene::formats::plan::{fnv1a, read_file};
use crate::scene::material::{Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance};
use std::collections::BTreeMap;
use std::path::Path;

const BLACK: Reflectance = Reflectance::Constant(Rgb::ZERO);

impl Builder<'_> {
    /// The materials of the OBJ's libraries, by name.
    pub(super) fn read_mtl(
        &mut self,
        path: &Path,
        place: &Place,
    ) -> Result<BTreeMap<String, MaterialId>, SceneError> {
        let mut ids = BTreeMap::new();
        let text = read_file(path, place)?;
        let from = Place::file(path);
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        for library in obj::material_libraries(&text) {
            let file = folder.join(library.replace('\\', "/"));
            let bytes = read_file(&file, &from)?;
            if !self.sources.iter().any(|s| s.0 == file) {
                self.sources.push((file.clone(), fnv1a(&bytes)));
            }
            let wrong =
                |e: tobj::LoadError| SceneError::Syntax { place: Place::file(&file), message: e.to_string() };
            let (materials, _) = tobj::load_mtl_buf(&mut bytes.as_slice()).map_err(wrong)?;
            for source in materials {
                let material = self.convert_mtl(&source, &file)?;
                let id = self.add_material(material, Place::file(&file));
                ids.insert(source.name, id);
            }
        }
        if ids.is_empty() {
            self.log.warn(
                place,
                "neither the mesh nor its file has a material",
                "a grey of 0.5 stands in",
            )?;
        }
        Ok(ids)
    }

    /// For what the file leaves without a material.
    pub(super) fn default_material(&mut self, place: &Place) -> MaterialId {
        let grey = Reflectance::Constant(Rgb::splat(0.5));
        let material =
            Material { name: "default".into(), two_sided: true, diffuse: grey, coat: None, lobe: Lobe::None };
        self.add_material(material, place.clone())
    }

    fn convert_mtl(&mut self, source: &tobj::Material, file: &Path) -> Result<Material, SceneError> {
        let place = Place::file(file);
        let colour = |c: Option<[f32; 3]>| Rgb::from(c.unwrap_or_default());
        let (kd, ks) = (colour(source.diffuse), colour(source.specular));
        let name = source.name.clone();
        let made =
            |diffuse, lobe| Material { name: name.clone(), two_sided: true, diffuse, coat: None, lobe };
        if colour(source.emissive) != Rgb::ZERO {
            let what = format!("the material \"{name}\" emits");
            self.log.warn(&place, what, "it does not: give the mesh an emission in the scene file")?;
        }
        for (map, what) in [
            (&source.specular_texture, "specular"),
            (&source.normal_texture, "bump or normal"),
            (&source.shininess_texture, "shininess"),
            (&source.dissolve_texture, "opacity"),
        ] {
            if map.is_some() {
                self.log.warn(
                    &place,
                    format!("the material \"{name}\" has a {what} map"),
                    "it is ignored",
                )?;
            }
        }
        let model = source.illumination_model.unwrap_or(2);
        if matches!(model, 4 | 6 | 7 | 9) || source.dissolve.is_some_and(|d| d < 1.0) {
            let eta = source.optical_density.filter(|n| *n > 0.0).unwrap_or(1.5);
            let white = Reflectance::Constant(Rgb::ONE);
            return Ok(made(BLACK, Lobe::Dielectric { eta, reflectance: white, transmittance: white }));
        }
        if matches!(model, 3 | 5) {
            let scale = Reflectance::Constant(ks.min(Rgb::ONE));
            return Ok(made(BLACK, Lobe::Mirror { fresnel: Fresnel::One, scale }));
        }
        let diffuse = match &source.diffuse_texture {
            Some(map) => {
                let texture = self.mtl_texture(map, file);
                match texture {
                    // Many exporters write a black Kd beside a map.
                    Reflectance::Textured { texture, .. } if kd != Rgb::ZERO => {
                        Reflectance::Textured { texture, scale: kd.min(Rgb::ONE) }
                    }
                    other => other,
                }
            }
            None => Reflectance::Constant(kd),
        };
        let exponent = source.shininess.unwrap_or(0.0);
        if model < 2 || ks == Rgb::ZERO || exponent <= 0.0 {
            return Ok(made(diffuse, Lobe::None));
        }
        let room = (Rgb::ONE - kd.min(Rgb::ONE)).max(Rgb::ZERO);
        let lobe = Lobe::Rough {
            distribution: Distribution::Ggx,
            alpha: (2.0 / (exponent + 2.0)).sqrt(),
            fresnel: Fresnel::One,
            scale: Reflectance::Constant(ks.min(room)),
        };
        if ks.cmpgt(room).any() {
            let what = format!("Kd and Ks of the material \"{name}\" exceed 1 together");
            self.log.warn(&place, what, "its lobe is dimmed")?;
        }
        Ok(made(diffuse, lobe))
    }

    /// `map_Kd`: options come first, the file name last.
    fn mtl_texture(&mut self, map: &str, file: &Path) -> Reflectance {
        let name = if map.starts_with('-') { map.split_whitespace().last().unwrap_or(map) } else { map };
        let beside = file.parent().unwrap_or(Path::new("")).join(name.replace('\\', "/"));
        let relative = beside.strip_prefix(&self.folder).unwrap_or(&beside).to_string_lossy().into_owned();
        let text =
            TextureText { file: relative, wrap: None, filter: None, raw: false, scale: None, tiles: None };
        self.texture(&text, &Place::file(file))
    }
}
