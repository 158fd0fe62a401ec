//! Mitsuba XML: the parts of the 3.x format that the renderer models, and the 0.6 spellings of the same.
//!
//! `tree` reads the XML, the other modules turn sensors, shapes, bsdfs, textures and emitters into a
//! [`Plan`]. Defaults and conventions are those of Mitsuba 3.9.1 in its `rgb` variants.
//!
//! Instances are copies of their group's meshes, placed: a scene of one level of geometry is what occluder caches,
//! emitters and records of objects are made for, and interiors repeat a chair ten times, not a tree ten thousand
//! times. A copy takes about 100 bytes of memory a triangle; a note says that there are copies.
//!
//! Deviations: features without a counterpart in the scene model are replaced, and every replacement is
//! reported.

mod access;
mod bsdf;
mod bsdf_kinds;
mod cie;
mod emitter;
mod integrator;
mod sensor;
mod shape;
mod sky;
mod texture;
mod tree;
mod value;

use super::LoadOptions;
use super::error::{Log, Place, SceneError};
use super::file::{folder_of, stem_of};
use super::plan::{Contents, Plan};
use glam::DMat4;
use scene::MaterialId;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use tree::{Child, Document, Object};

/// Reads the description at `path`.
pub(super) fn read(path: &Path, options: &LoadOptions, log: &mut Log) -> Result<Plan, SceneError> {
    let document = Document::read(path, &options.parameters, log);
    let document = log.conclude(document)?;
    let folder = folder_of(path).to_owned();
    let mut converter = Converter {
        document: &document,
        folder,
        log,
        contents: Contents::default(),
        material_of: Vec::new(),
        default_materials: [None; 2],
        sources: Vec::new(),
        instances: (0, None),
    };
    converter.scene();
    let shot = converter.shot(options.camera.as_deref());
    converter.report_instances();
    let (contents, read) = (converter.contents, converter.sources);
    let (shot, max_depth, hides_emitters) = log.conclude(shot)?;
    let stem = stem_of(path);
    let folder_name = path.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    // Scene files are usually called scene.xml; then the folder's name is used.
    let name = if stem == "scene" { folder_name.unwrap_or(stem) } else { stem };
    let sources = document.sources.iter().cloned().chain(read).collect();
    Ok(Plan { name, sources, generator: None, shot, max_depth, hides_emitters, contents })
}

struct Converter<'a> {
    document: &'a Document,
    /// Folder that file names are relative to.
    folder: PathBuf,
    log: &'a mut Log,
    contents: Contents,
    /// Source of each material: the bsdf object and its wrapping.
    material_of: Vec<(*const Object, MaterialId)>,
    default_materials: [Option<MaterialId>; 2],
    /// Files read on the way (spectra), with their hashes.
    sources: Vec<(PathBuf, u64)>,
    /// Number of meshes placed as instances, and place of the first instance.
    instances: (usize, Option<Place>),
}

impl Converter<'_> {
    fn scene(&mut self) {
        let document = self.document;
        for child in &document.root.children {
            let converted = self.part(child);
            self.log.part(converted);
        }
    }

    fn part(&mut self, child: &Child) -> Result<(), SceneError> {
        let object = self.document.object(child)?;
        match object.tag.as_str() {
            "shape" => self.shape(&object, DMat4::IDENTITY),
            "emitter" => self.scene_emitter(&object),
            // Sensors and integrators are read by `shot`, the others where they are referred to.
            "sensor" | "integrator" | "bsdf" | "texture" | "scene" => Ok(()),
            tag => self.log.warn(&object.place, format!("<{tag}> is not modelled"), "it is ignored"),
        }
    }

    /// Finds a file named by `object`: beside the main file, or beside the file that names it.
    fn file(&self, object: &Object, name: &str) -> Result<PathBuf, SceneError> {
        let missing = || {
            let what = format!("{} \"{}\" names no file", object.tag, object.plugin);
            object.place.wrong(what, format!("add <string name=\"{name}\" value=\"...\"/>"))
        };
        // Descriptions written on Windows name files with backslashes.
        Ok(self.beside(&object.string(name)?.ok_or_else(missing)?, &object.place))
    }

    /// Path of the file called `name` at `place`.
    fn beside(&self, name: &str, place: &Place) -> PathBuf {
        let file = name.replace('\\', "/");
        let beside_main = self.folder.join(&file);
        let beside_own = folder_of(&place.path).join(&file);
        if !beside_main.exists() && beside_own.exists() { beside_own } else { beside_main }
    }

    fn tagged(&self, object: &Object, tag: &str) -> Result<Vec<Rc<Object>>, SceneError> {
        self.document.tagged(object, tag)
    }
}

#[cfg(test)]
mod tests;
