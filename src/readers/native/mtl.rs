//! Material libraries of an OBJ file.

use super::builder::SceneBuilder;
use super::classic::LibraryReader;
use crate::attributes::COLOUR;
use crate::error::{Location, SceneError};
use crate::file::{fnv1a, folder_of, read_file};
use crate::mesh::encodings::{possible_paths, spellings};
use crate::mesh::mtl::{self, ClassicMaterial};
use crate::mesh::obj_references::{Definitions, References, listed_files, references};
use crate::mesh::wavefront::name;
use crate::plan::NamedAppearances;
use base::math::Rgb;
use scene::{Material, MaterialId, Reflectance};
use std::collections::{BTreeMap, BTreeSet};
use std::iter;
use std::path::{Path, PathBuf};

impl SceneBuilder<'_> {
    /// Reads the materials of the OBJ's libraries. Returns also whether the OBJ has colours of vertices. `unit` is
    /// the length of the file's unit in the world.
    pub(super) fn read_mtl(
        &mut self,
        path: &Path,
        place: &Location,
        unit: f32,
    ) -> Result<(NamedAppearances, bool), SceneError> {
        let text = read_file(path, place)?;
        let References { libraries, materials, has_colours } = references(&text);
        let mut read: Vec<(PathBuf, Vec<ClassicMaterial>)> = Vec::new();
        let mut definitions = Definitions::default();
        for (line, text) in libraries {
            let from = Location::line(path, line);
            for file in listed_files(&text, ".mtl", |name| existing_file(folder_of(path), name)) {
                match file {
                    Ok(file) if !read.iter().any(|library| library.0 == file) => {
                        let library = self.read_library(&file, &from)?;
                        definitions.add(library.iter().map(|material| material.text.as_str()));
                        read.push((file, library));
                    }
                    Ok(_) => {}
                    Err(name) => {
                        let fallback = "a grey of 0.5 is used for its materials; check the name";
                        self.log.warn(&from, format!("there is no material library \"{name}\""), fallback)?;
                    }
                }
            }
        }
        let mut named = NamedAppearances::default();
        let mut wanted: BTreeMap<usize, BTreeSet<String>> = BTreeMap::new();
        for text in materials {
            let name = match definitions.find(&text) {
                Some((name, number)) => {
                    wanted.entry(number).or_default().insert(name.clone());
                    name
                }
                None => name(text.as_bytes()),
            };
            if name != text {
                named.names.insert(text, name);
            }
        }
        self.name_repeated(&read, &wanted)?;
        let mut first = 0;
        for (file, library) in read {
            let mut reader = LibraryReader::new(self, &file, unit);
            for material in library {
                if let Some(names) = wanted.remove(&first) {
                    let appearance = reader.appearance(material)?;
                    named.appearances.extend(names.into_iter().map(|name| (name, appearance)));
                }
                first += 1;
            }
            reader.report()?;
        }
        Ok((named, has_colours))
    }

    /// Names definitions of materials that are left out, as another one has their name.
    fn name_repeated(
        &mut self,
        read: &[(PathBuf, Vec<ClassicMaterial>)],
        wanted: &BTreeMap<usize, BTreeSet<String>>,
    ) -> Result<(), SceneError> {
        let all: Vec<&ClassicMaterial> = read.iter().flat_map(|(_, library)| library).collect();
        let used = |name: &String| {
            let number = wanted.iter().find(|(_, names)| names.contains(name))?.0;
            all.get(*number).copied()
        };
        for (number, material) in all.iter().enumerate() {
            let used = used(&material.text).or_else(|| used(&material.name));
            if let Some(used) = used.filter(|used| !wanted.contains_key(&number) && !used.is_like(material)) {
                let what = format!("the material \"{}\" is also defined in {}", material.text, used.place);
                let fallback = "that definition is used instead; give each material its own name";
                self.log.warn(&material.place, what, fallback)?;
            }
        }
        Ok(())
    }

    fn read_library(&mut self, file: &Path, from: &Location) -> Result<Vec<ClassicMaterial>, SceneError> {
        let bytes = match read_file(file, from) {
            Err(SceneError::Foreign { kind, .. }) => {
                let what = format!("the material library {} is {}", file.display(), kind.what);
                let fallback = format!("a grey of 0.5 is used for its materials; {}", kind.remedy);
                self.log.warn(from, what, fallback)?;
                return Ok(Vec::new());
            }
            read => read?,
        };
        if !self.sources.iter().any(|s| s.0 == file) {
            self.sources.push((file.to_owned(), fnv1a(&bytes)));
        }
        if let Some(line) = mtl::before_materials(&bytes) {
            let what = "statements precede the first newmtl";
            self.log.warn(&Location::line(file, line), what, "they are left out")?;
        }
        let mut library = mtl::read(&bytes, file)?;
        for note in mtl::decode_codes(&mut library) {
            self.log.add(note)?;
        }
        Ok(library)
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
    let name = name.trim_matches('"');
    let beside =
        spellings(name).into_iter().filter_map(|name| Some(name.rsplit(['/', '\\']).next()?.to_owned()));
    let names = iter::once(name.to_owned()).chain(beside);
    names.flat_map(|name| possible_paths(folder, &name)).find(|path| path.is_file())
}

/// Returns the path of a file that a statement in `folder` names, and that is not there.
pub(super) fn missing_file(folder: &Path, name: &str) -> PathBuf {
    folder.join(name.trim_matches('"').replace('\\', "/"))
}
