//! Wavefront MTL, the material libraries of an OBJ file: `source` parses them, `material` and `maps` convert the
//! materials.

mod maps;
mod material;
mod options;
mod source;
#[cfg(test)]
mod tests;

use super::builder::SceneBuilder;
use crate::error::{Location, SceneError};
use crate::file::{fnv1a, folder_of, read_file};
use crate::findings::Findings;
use crate::mesh::encodings::existing_file;
use crate::mesh::obj_references::{Definitions, References, listed_files, references};
use crate::mesh::wavefront::name;
use crate::plan::NamedAppearances;
use source::SourceMaterial;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Converter of the materials of a library.
struct LibraryReader<'b, 'a> {
    builder: &'b mut SceneBuilder<'a>,
    file: &'b Path,
    /// Length of the file's unit in the world.
    unit: f32,
    /// Features that are not supported, with the names of the materials that ask for them.
    findings: Findings,
}

impl LibraryReader<'_, '_> {
    /// Adds a feature that is not supported, at the line of the statement `keyword` or of the material.
    fn lacks(&mut self, source: &SourceMaterial, keyword: &str, what: impl Display, fallback: &str) {
        self.lacks_at(source, source.line(keyword), what, fallback);
    }

    fn lacks_at(&mut self, source: &SourceMaterial, line: u32, what: impl Display, fallback: &str) {
        let (place, what) = (Location::line(self.file, line), format!("{what} is not supported"));
        self.findings.lacks_at(place, &what, fallback, &format!("\"{}\"", source.name));
    }
}

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
        let mut read: Vec<(PathBuf, Vec<SourceMaterial>)> = Vec::new();
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
            let findings = Findings::default();
            let mut reader = LibraryReader { builder: self, file: &file, unit, findings };
            for material in library {
                if let Some(names) = wanted.remove(&first) {
                    let appearance = reader.appearance(&material)?;
                    named.appearances.extend(names.into_iter().map(|name| (name, appearance)));
                }
                first += 1;
            }
            let findings = reader.findings;
            findings.write(&Location::file(&file), self.log)?;
        }
        Ok((named, has_colours))
    }

    /// Names definitions of materials that are left out, as another one has their name.
    fn name_repeated(
        &mut self,
        read: &[(PathBuf, Vec<SourceMaterial>)],
        wanted: &BTreeMap<usize, BTreeSet<String>>,
    ) -> Result<(), SceneError> {
        let all: Vec<&SourceMaterial> = read.iter().flat_map(|(_, library)| library).collect();
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

    fn read_library(&mut self, file: &Path, from: &Location) -> Result<Vec<SourceMaterial>, SceneError> {
        let bytes = match read_file(file, from) {
            Err(SceneError::Foreign { kind, .. }) => {
                let what = format!("the material library {} is {}", file.display(), kind.what);
                let fallback = format!("a grey of 0.5 is used for its materials; {}", kind.remedy);
                self.log.warn(from, what, fallback)?;
                return Ok(Vec::new());
            }
            read => read?,
        };
        self.add_source(file, fnv1a(&bytes));
        if let Some(line) = source::before_materials(&bytes) {
            let what = "statements precede the first newmtl";
            self.log.warn(&Location::line(file, line), what, "they are left out")?;
        }
        let mut library = source::read(&bytes, file)?;
        for note in source::decode_codes(&mut library) {
            self.log.add(note)?;
        }
        Ok(library)
    }
}
