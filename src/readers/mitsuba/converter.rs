//! A plan under construction from Mitsuba XML.

use super::tree::{ChildObject, Object, SceneXml};
use crate::error::{Location, Log, SceneError};
use crate::file::folder_of;
use crate::plan::Contents;
use glam::DMat4;
use scene::MaterialId;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A plan under construction. The other modules add what an object describes.
pub(super) struct Converter<'a> {
    pub document: &'a SceneXml,
    /// Folder to which file names are relative.
    pub folder: PathBuf,
    pub log: &'a mut Log,
    pub contents: Contents,
    /// Material of each BSDF object.
    pub material_of: Vec<(*const Object, MaterialId)>,
    pub default_materials: [Option<MaterialId>; 2],
    /// Spectrum files read, with their hashes.
    pub sources: Vec<(PathBuf, u64)>,
    /// Groups read so far, with their numbers.
    pub groups: Vec<(Rc<Object>, usize)>,
    /// Number of the group whose meshes are being read.
    pub into_group: Option<usize>,
}

impl<'a> Converter<'a> {
    /// Returns an empty plan for the description at `path`.
    pub fn new(document: &'a SceneXml, path: &Path, log: &'a mut Log) -> Converter<'a> {
        Converter {
            document,
            folder: folder_of(path).to_owned(),
            log,
            contents: Contents::default(),
            material_of: Vec::new(),
            default_materials: [None; 2],
            sources: Vec::new(),
            groups: Vec::new(),
            into_group: None,
        }
    }
}

impl Converter<'_> {
    /// Adds all objects of the scene. Errors go to the log.
    pub fn scene(&mut self) {
        let document = self.document;
        for child in &document.root.children {
            let converted = self.part(child);
            self.log.part(converted);
        }
    }

    /// Warns of properties of the scene itself, which has none.
    pub fn report_unused(&mut self) -> Result<(), SceneError> {
        // Children of the scene are converted where something refers to them.
        self.document.root.children.iter().for_each(|child| child.used.set(true));
        self.document.root.report_unused(self.log)
    }

    fn part(&mut self, child: &ChildObject) -> Result<(), SceneError> {
        let object = self.document.object(child)?;
        match object.tag.as_str() {
            "shape" => self.shape(&object, DMat4::IDENTITY),
            "emitter" => self.scene_emitter(&object),
            // `shot` reads sensors and integrators. The others are read where an object refers to them.
            "sensor" | "integrator" | "bsdf" | "texture" => Ok(()),
            tag => self.log.warn(&object.place, format!("<{tag}> is not supported"), "it is ignored"),
        }
    }

    /// Returns the path of a file named by `object`.
    pub fn file(&self, object: &Object, name: &str) -> Result<PathBuf, SceneError> {
        let missing = || {
            let what = format!("{} \"{}\" names no file", object.tag, object.plugin);
            object.place.wrong(what, format!("add <string name=\"{name}\" value=\"...\"/>"))
        };
        // Descriptions written on Windows separate folders by backslashes.
        Ok(self.beside(&object.string(name)?.ok_or_else(missing)?, &object.place))
    }

    /// Returns the path of the file `name`: in a folder that a `<path>` names, beside the main file, or beside the file
    /// at `place` if only that exists.
    pub fn beside(&self, name: &str, place: &Location) -> PathBuf {
        let file = name.replace('\\', "/");
        if let Some(found) = self.document.in_folders(&file) {
            return found;
        }
        let beside_main = self.folder.join(&file);
        let beside_own = folder_of(&place.path).join(&file);
        if !beside_main.exists() && beside_own.exists() { beside_own } else { beside_main }
    }

    /// Returns the children of `object` with tag `tag`.
    pub fn tagged(&self, object: &Object, tag: &str) -> Result<Vec<Rc<Object>>, SceneError> {
        self.document.tagged(object, tag)
    }

    /// Returns the child of `object` with tag `tag`; the first one, with a warning, if there are several.
    pub fn first(&mut self, object: &Object, tag: &str) -> Result<Option<Rc<Object>>, SceneError> {
        let mut found = self.tagged(object, tag)?.into_iter();
        let first = found.next();
        if let Some(second) = found.next() {
            let what = format!("{} \"{}\" has a second <{tag}>", object.tag, object.plugin);
            self.log.warn(&second.place, what, "the first is used")?;
        }
        Ok(first)
    }
}
