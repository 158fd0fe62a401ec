//! A plan under construction from a native description.

use super::group::NamedGroups;
use super::source::SourceText;
use super::text::{MaterialText, SceneText};
use crate::draft::Shot;
use crate::error::{Log, SceneError};
use crate::file::folder_of;
use crate::plan::Contents;
use lightsplat_scenes::Part;
use scene::MaterialId;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// A plan under construction. The other modules add cameras, materials, meshes and lights.
pub(super) struct SceneBuilder<'a> {
    pub file: SourceText<'a>,
    /// Folder to which file names are relative.
    pub folder: PathBuf,
    pub log: &'a mut Log,
    pub parts: Vec<Part>,
    pub part_used: Vec<bool>,
    /// Files of imported models and materials, with their hashes.
    pub sources: Vec<(PathBuf, u64)>,
    pub material_ids: BTreeMap<String, MaterialId>,
    /// Descriptions of all materials.
    pub material_texts: &'a [Spanned<MaterialText>],
    /// Cameras of the first glTF model that has some.
    pub model_shot: Option<Shot>,
    /// Groups by name, and instances of them.
    pub groups: NamedGroups,
    pub contents: Contents,
}

impl<'a> SceneBuilder<'a> {
    /// Returns an empty plan; parts are generated if the description asks for it.
    pub fn new(
        file: SourceText<'a>,
        log: &'a mut Log,
        scene: &'a SceneText,
    ) -> Result<SceneBuilder<'a>, SceneError> {
        let mut parts = Vec::new();
        if let Some(name) = &scene.generator {
            let unknown = || file.place(name.span()).undefined("generator", name.get_ref());
            parts = lightsplat_scenes::generate(name.get_ref()).ok_or_else(unknown)?;
        }
        Ok(SceneBuilder {
            file,
            folder: folder_of(file.path).to_owned(),
            log,
            part_used: vec![false; parts.len()],
            parts,
            sources: Vec::new(),
            material_ids: BTreeMap::new(),
            material_texts: &scene.material,
            model_shot: None,
            groups: NamedGroups::default(),
            contents: Contents::default(),
        })
    }

    /// Adds a file of a model or a material, with its hash.
    pub fn add_source(&mut self, path: &Path, hash: u64) {
        if !self.sources.iter().any(|known| known.0 == path) {
            self.sources.push((path.to_owned(), hash));
        }
    }

    /// Returns the maximum path length, in edges.
    pub fn max_depth(&self, scene: &SceneText) -> Result<Option<u32>, SceneError> {
        match &scene.max_depth {
            Some(depth) if *depth.get_ref() == 0 => {
                let remedy = "give 1 for emitters alone, or more";
                Err(self.file.place(depth.span()).wrong("max_depth is 0, which no path has", remedy))
            }
            depth => Ok(depth.as_ref().map(|depth| *depth.get_ref())),
        }
    }

    /// Warns of generated parts that no mesh uses.
    pub fn report_unused_parts(&mut self, scene: &SceneText) -> Result<(), SceneError> {
        let unused = self.parts.iter().zip(&self.part_used).filter(|(_, used)| !**used);
        let names: Vec<&str> = unused.map(|(part, _)| part.name.as_str()).collect();
        match &scene.generator {
            Some(generator) if !names.is_empty() => {
                let what = format!("no mesh uses the generated parts {}", names.join(", "));
                self.log.warn(&self.file.place(generator.span()), what, "they are left out")
            }
            _ => Ok(()),
        }
    }
}
