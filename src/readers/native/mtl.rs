//! Material libraries of an OBJ file.

use super::builder::SceneBuilder;
use super::classic::LibraryReader;
use crate::attributes::COLOUR;
use crate::error::{Location, SceneError};
use crate::file::{fnv1a, folder_of, read_file};
use crate::mesh::mtl;
use crate::mesh::obj_references::{References, listed_files, references};
use crate::plan::Appearance;
use base::math::Rgb;
use scene::{Material, MaterialId, Reflectance};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

impl SceneBuilder<'_> {
    /// Reads the materials of the OBJ's libraries, by name. Returns also whether the OBJ has colours of
    /// vertices. `unit` is the length of the file's unit in the world.
    pub(super) fn read_mtl(
        &mut self,
        path: &Path,
        place: &Location,
        unit: f32,
    ) -> Result<(BTreeMap<String, Appearance>, bool), SceneError> {
        let text = read_file(path, place)?;
        let References { libraries, materials, has_colours } = references(&text);
        let mut appearances = BTreeMap::new();
        let mut read = BTreeSet::new();
        for (line, text) in libraries {
            let from = Location::line(path, line);
            for file in listed_files(&text, ".mtl", |name| existing_file(folder_of(path), name)) {
                match file {
                    Ok(file) if read.insert(file.clone()) => {
                        self.read_library(&file, &from, &materials, unit, &mut appearances)?;
                    }
                    Ok(_) => {}
                    Err(name) => {
                        let fallback = "a grey of 0.5 is used for its materials; check the name";
                        self.log.warn(&from, format!("there is no material library \"{name}\""), fallback)?;
                    }
                }
            }
        }
        Ok((appearances, has_colours))
    }

    /// Adds the materials of a library that are used and not yet defined.
    fn read_library(
        &mut self,
        file: &Path,
        from: &Location,
        used: &BTreeSet<String>,
        unit: f32,
        appearances: &mut BTreeMap<String, Appearance>,
    ) -> Result<(), SceneError> {
        let bytes = match read_file(file, from) {
            Err(SceneError::Foreign { kind, .. }) => {
                let what = format!("the material library {} is {}", file.display(), kind.what);
                return self.log.warn(
                    from,
                    what,
                    format!("a grey of 0.5 is used for its materials; {}", kind.remedy),
                );
            }
            read => read?,
        };
        if !self.sources.iter().any(|s| s.0 == file) {
            self.sources.push((file.to_owned(), fnv1a(&bytes)));
        }
        let materials = mtl::read(&bytes, file)?;
        let is_wanted = |name: &String| used.contains(name) && !appearances.contains_key(name);
        let wanted: Vec<_> = materials.into_iter().filter(|material| is_wanted(&material.name)).collect();
        let mut reader = LibraryReader::new(self, file, unit);
        for material in wanted {
            let (name, appearance) = reader.appearance(material)?;
            appearances.insert(name, appearance);
        }
        reader.report()
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
}

/// Returns the path of the file that a statement in `folder` names, if there is one.
///
/// A file beside the statement's stands for one in a folder that does not exist, as of another machine.
pub(super) fn existing_file(folder: &Path, name: &str) -> Option<PathBuf> {
    let [whole, last] = possible_files(folder, name);
    [whole, last].into_iter().find(|path| path.is_file())
}

/// Returns the path of the file that a statement in `folder` names, and the path of a file beside it.
pub(super) fn possible_files(folder: &Path, name: &str) -> [PathBuf; 2] {
    let name = name.trim_matches('"').replace('\\', "/");
    let last = name.rsplit('/').next().unwrap_or(&name);
    [folder.join(&name), folder.join(last)]
}
