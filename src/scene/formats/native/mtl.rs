//! Materials from an OBJ's MTL files.
//!
//! Classic Phong materials become a Lambert base and a GGX lobe with α = sqrt(2 / (Ns + 2)); illumination models 3
//! and 5 a mirror, 4, 6, 7 and 9, or a dissolve below 1, glass. The lobe is dimmed where base and lobe would reflect
//! more than they receive. All are two-sided.

use super::Builder;
use super::text::TextureText;
use crate::math::Rgb;
use crate::scene::formats::error::{Place, SceneError};
use crate::scene::formats::mesh::mtl::{self, ClassicMaterial};
use crate::scene::formats::mesh::obj;
use crate::scene::formats::plan::{fnv1a, folder_of, read_file};
use crate::scene::material::{Distribution, Fresnel, Lobe, Material, MaterialId, Reflectance};
use std::collections::BTreeMap;
use std::path::Path;

impl Builder<'_> {
    /// Reads the materials of the OBJ's libraries, by name.
    pub(super) fn read_mtl(
        &mut self,
        path: &Path,
        place: &Place,
    ) -> Result<BTreeMap<String, MaterialId>, SceneError> {
        let mut ids = BTreeMap::new();
        let text = read_file(path, place)?;
        let from = Place::file(path);
        let folder = folder_of(path);
        for library in obj::material_libraries(&text) {
            let file = folder.join(library.replace('\\', "/"));
            let bytes = read_file(&file, &from)?;
            if !self.sources.iter().any(|s| s.0 == file) {
                self.sources.push((file.clone(), fnv1a(&bytes)));
            }
            for source in mtl::read(&bytes, &file)? {
                let material = self.convert_mtl(&source, &file)?;
                let id = self.contents.add_material(material, source.place);
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

    /// Returns the material for faces that the file leaves without one.
    pub(super) fn default_material(&mut self, place: &Place) -> MaterialId {
        let grey = Reflectance::Constant(Rgb::splat(0.5));
        let material =
            Material { name: "default".into(), two_sided: true, diffuse: grey, ..Material::default() };
        self.contents.add_material(material, place.clone())
    }

    fn convert_mtl(&mut self, source: &ClassicMaterial, file: &Path) -> Result<Material, SceneError> {
        let place = &source.place;
        let (kd, ks) = (source.diffuse, source.specular);
        let name = source.name.clone();
        let made = |diffuse, lobe| Material {
            name: name.clone(),
            two_sided: true,
            diffuse,
            lobes: Vec::from_iter(lobe),
            ..Material::default()
        };
        if source.emissive != Rgb::ZERO {
            let what = format!("the material \"{name}\" emits");
            self.log.warn(place, what, "it does not: give the mesh an emission in the scene file")?;
        }
        for map in &source.other_maps {
            self.log.warn(place, format!("the material \"{name}\" has a {map}"), "it is ignored")?;
        }
        if matches!(source.model, 4 | 6 | 7 | 9) || source.dissolve < 1.0 {
            let eta = source.ior.filter(|n| *n > 0.0).unwrap_or(1.5);
            let white = Reflectance::Constant(Rgb::ONE);
            let glass = Lobe::Dielectric { eta, thin: false, reflectance: white, transmittance: white };
            return Ok(made(Reflectance::BLACK, Some(glass)));
        }
        if matches!(source.model, 3 | 5) {
            let scale = Reflectance::Constant(ks.min(Rgb::ONE));
            return Ok(made(Reflectance::BLACK, Some(Lobe::Mirror { fresnel: Fresnel::One, scale })));
        }
        let diffuse = match &source.diffuse_map {
            Some(map) => match self.mtl_texture(map, file) {
                // Many exporters write a black Kd beside a map.
                Reflectance::Textured { texture, .. } if kd != Rgb::ZERO => {
                    Reflectance::Textured { texture, scale: kd.min(Rgb::ONE) }
                }
                other => other,
            },
            None => Reflectance::Constant(kd),
        };
        if source.model < 2 || ks == Rgb::ZERO || source.exponent <= 0.0 {
            return Ok(made(diffuse, None));
        }
        let room = (Rgb::ONE - kd.min(Rgb::ONE)).max(Rgb::ZERO);
        let lobe = Lobe::Rough {
            distribution: Distribution::Ggx,
            alpha: (2.0 / (source.exponent + 2.0)).sqrt().into(),
            fresnel: Fresnel::One,
            scale: Reflectance::Constant(ks.min(room)),
        };
        if ks.cmpgt(room).any() {
            let what = format!("Kd and Ks of the material \"{name}\" exceed 1 together");
            self.log.warn(place, what, "its lobe is dimmed")?;
        }
        Ok(made(diffuse, Some(lobe)))
    }

    fn mtl_texture(&mut self, name: &str, file: &Path) -> Reflectance {
        let beside = folder_of(file).join(name.replace('\\', "/"));
        let relative = beside.strip_prefix(&self.folder).unwrap_or(&beside).to_string_lossy().into_owned();
        self.texture(&TextureText { file: relative, ..TextureText::default() }, &Place::file(file))
    }
}
