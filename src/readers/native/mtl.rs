//! Conversion of the classic materials in an OBJ's MTL files.
//!
//! A classic material becomes a dielectric of roughness α = sqrt(2 / (Ns + 2)) over a Lambert base. Ks is the
//! reflectance at normal incidence, limited to 0.08, the maximum of dielectrics. Exporters write greater values for all
//! materials. If Kd is black, the material is a metal of reflectance Ks.
//!
//! Illumination models 3 and 5 are mirrors; 4, 6, 7 and 9 are glass. d and map_d are the opacity, Ke is the emission.
//! All materials are two-sided.

use super::builder::SceneBuilder;
use super::text::TextureText;
use crate::attributes::COLOUR;
use crate::error::{Location, SceneError};
use crate::file::{fnv1a, folder_of, read_file};
use crate::mesh::mtl::{self, ClassicMaterial};
use crate::mesh::obj;
use crate::plan::Appearance;
use base::math::{Rgb, luminance};
use scene::{Coat, Distribution, Emission, Fresnel, Lobe, Material, MaterialId, Reflectance, Share};
use std::collections::BTreeMap;
use std::path::Path;

/// Maximum reflectance of dielectrics at normal incidence.
const MAX_DIELECTRIC: f32 = 0.08;

impl SceneBuilder<'_> {
    /// Reads the materials of the OBJ's libraries, by name. Returns also whether the OBJ has colours of vertices.
    pub(super) fn read_mtl(
        &mut self,
        path: &Path,
        place: &Location,
    ) -> Result<(BTreeMap<String, Appearance>, bool), SceneError> {
        let mut appearances = BTreeMap::new();
        let text = read_file(path, place)?;
        let used = obj::used_materials(&text);
        let has_colours = obj::has_colours(&text);
        let from = Location::file(path);
        let folder = folder_of(path);
        for library in obj::material_libraries(&text) {
            let file = folder.join(library.replace('\\', "/"));
            let bytes = read_file(&file, &from)?;
            if !self.sources.iter().any(|s| s.0 == file) {
                self.sources.push((file.clone(), fnv1a(&bytes)));
            }
            for source in mtl::read(&bytes, &file)?.into_iter().filter(|source| used.contains(&source.name)) {
                let material = self.convert_mtl(&source, &file)?;
                let emission = self.mtl_emission(&source, &file);
                let material = self.contents.add_material(material, source.place);
                appearances.insert(source.name, Appearance { material, emission });
            }
        }
        if appearances.is_empty() && !has_colours {
            self.log.warn(
                place,
                "neither the mesh nor its file has a material",
                "a grey of 0.5 stands in",
            )?;
        }
        Ok((appearances, has_colours))
    }

    /// Returns the material of faces without one: diffuse, of the colours of the mesh if it has some, else grey.
    pub(super) fn default_material(&mut self, has_colours: bool, place: &Location) -> MaterialId {
        let diffuse = match has_colours {
            true => {
                let texture = self.contents.add_attribute(COLOUR, None);
                Reflectance::Textured { texture, scale: Rgb::ONE }
            }
            false => Reflectance::Constant(Rgb::splat(0.5)),
        };
        let material = Material { name: "default".into(), two_sided: true, diffuse, ..Material::default() };
        self.contents.add_material(material, place.clone())
    }

    fn convert_mtl(&mut self, source: &ClassicMaterial, file: &Path) -> Result<Material, SceneError> {
        let place = &source.place;
        let (kd, ks) = (source.diffuse, source.specular);
        let name = source.name.clone();
        let is_glass = matches!(source.model, 4 | 6 | 7 | 9);
        let opacity = if is_glass { None } else { self.mtl_opacity(source, file) };
        let made = |diffuse, lobe| Material {
            name: name.clone(),
            two_sided: true,
            opacity,
            diffuse,
            lobes: Vec::from_iter(lobe),
            ..Material::default()
        };
        for map in &source.other_maps {
            self.log.warn(place, format!("the material \"{name}\" has a {map}"), "it is ignored")?;
        }
        if is_glass {
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
        let lobe = |fresnel, scale| Lobe::Rough {
            distribution: Distribution::Ggx,
            alpha: (2.0 / (source.exponent + 2.0)).sqrt().into(),
            fresnel,
            scale: Reflectance::Constant(scale),
        };
        if source.diffuse_map.is_none() && kd == Rgb::ZERO {
            return Ok(made(Reflectance::BLACK, Some(lobe(Fresnel::One, ks.min(Rgb::ONE)))));
        }
        let root = luminance(ks).clamp(0.0, MAX_DIELECTRIC).sqrt();
        let eta = (1.0 + root) / (1.0 - root);
        let coated = made(diffuse, Some(lobe(Fresnel::Dielectric(eta), Rgb::ONE)));
        Ok(Material { coat: Some(Coat { eta, nonlinear: false }), ..coated })
    }

    fn mtl_opacity(&mut self, source: &ClassicMaterial, file: &Path) -> Option<Share> {
        let scale = source.dissolve.clamp(0.0, 1.0);
        match &source.opacity_map {
            Some(map) => {
                let text = TextureText { raw: true, ..self.mtl_file(map, file) };
                let texture = self.texture_id(&text, &Location::file(file));
                Some(Share::Textured { texture, scale })
            }
            None => (scale < 1.0).then_some(Share::Constant(scale)),
        }
    }

    fn mtl_emission(&mut self, source: &ClassicMaterial, file: &Path) -> Option<Emission> {
        let map = source.emissive_map.as_ref().map(|map| self.mtl_texture(map, file));
        let texture = match map {
            Some(Reflectance::Textured { texture, .. }) => Some(texture),
            _ => None,
        };
        // Many exporters write a black Ke beside a map.
        let radiance =
            if texture.is_some() && source.emissive == Rgb::ZERO { Rgb::ONE } else { source.emissive };
        (radiance != Rgb::ZERO).then_some(Emission { radiance, texture, two_sided: false })
    }

    fn mtl_texture(&mut self, name: &str, file: &Path) -> Reflectance {
        let text = self.mtl_file(name, file);
        self.texture(&text, &Location::file(file))
    }

    /// Returns the image that an MTL file names.
    fn mtl_file(&self, name: &str, file: &Path) -> TextureText {
        let beside = folder_of(file).join(name.replace('\\', "/"));
        let relative = beside.strip_prefix(&self.folder).unwrap_or(&beside).to_string_lossy().into_owned();
        TextureText { file: relative, ..TextureText::default() }
    }
}
