//! The native format: a TOML description over glTF, OBJ, PLY and generated geometry.
//!
//! Its keys, their types, units and defaults stand in `docs/scene-format.md`, which the tests hold against the code.

mod camera;
mod colour;
mod light;
mod material;
mod mesh;
mod mistake;
mod mtl;
mod path;
mod sky;
mod text;

use super::error::{Log, Place, SceneError};
use super::file::{folder_of, read_text, stem_of};
use super::plan::{Contents, Plan};
use crate::draft::Shot;
use lightsplat_scenes::Part;
use scene::MaterialId;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use text::{MaterialText, SceneText};
use toml::Spanned;

/// Reads the description at `path`.
pub(super) fn read(path: &Path, log: &mut Log) -> Result<Plan, SceneError> {
    let (text, hash) = read_text(path, &Place::file(path))?;
    let file = File { path, text: &text };
    let scene: SceneText = toml::from_str(&text).map_err(|error| mistake::of(file, &error))?;
    let mut builder = Builder::new(file, log, &scene)?;
    for material in &scene.material {
        let read = builder.material(material);
        if builder.log.part(read).is_none() {
            // Meshes may have it, without an error of theirs.
            builder.material_ids.entry(material.get_ref().name.clone()).or_insert(MaterialId(0));
        }
    }
    for mesh in &scene.mesh {
        let read = builder.mesh(mesh);
        builder.log.part(read);
    }
    for light in &scene.light {
        let read = builder.light(light);
        builder.log.part(read);
    }
    let environment = scene.environment.as_ref().map(|e| builder.environment(e)).transpose();
    builder.contents.environment = builder.log.part(environment).flatten();
    if let Some(sky) = &scene.sky {
        let read = builder.sky(sky);
        builder.log.part(read);
    }
    let depth = builder.max_depth(&scene);
    let max_depth = builder.log.part(depth).flatten();
    let shot = builder.shot(&scene);
    let shot = builder.log.conclude(shot)?;
    builder.report_unused_parts(&scene)?;
    let mut sources = vec![(path.to_owned(), hash)];
    sources.append(&mut builder.sources);
    Ok(Plan {
        name: scene.name.clone().unwrap_or_else(|| stem_of(path)),
        sources,
        generator: scene.generator.as_ref().map(|g| g.get_ref().clone()),
        shot,
        max_depth,
        hides_emitters: scene.hide_emitters.unwrap_or(false),
        contents: builder.contents,
    })
}

/// The text, for line numbers.
#[derive(Clone, Copy)]
struct File<'a> {
    path: &'a Path,
    text: &'a str,
}

impl File<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        let before = self.text.as_bytes().get(..span.start).unwrap_or_default();
        let line = before.iter().filter(|&&b| b == b'\n').count() as u32 + 1;
        Place::line(self.path, line)
    }
}

struct Builder<'a> {
    file: File<'a>,
    /// Folder that file names are relative to.
    folder: PathBuf,
    log: &'a mut Log,
    parts: Vec<Part>,
    part_used: Vec<bool>,
    /// Files read on the way (MTL), with their hashes.
    sources: Vec<(PathBuf, u64)>,
    material_ids: BTreeMap<String, MaterialId>,
    /// All materials as described.
    material_texts: &'a [Spanned<MaterialText>],
    /// Cameras of the first glTF model with one.
    model_shot: Option<Shot>,
    contents: Contents,
}

impl<'a> Builder<'a> {
    fn new(file: File<'a>, log: &'a mut Log, scene: &'a SceneText) -> Result<Builder<'a>, SceneError> {
        let mut parts = Vec::new();
        if let Some(name) = &scene.generator {
            let unknown = || file.place(name.span()).undefined("generator", name.get_ref());
            parts = lightsplat_scenes::generate(name.get_ref()).ok_or_else(unknown)?;
        }
        Ok(Builder {
            file,
            folder: folder_of(file.path).to_owned(),
            log,
            part_used: vec![false; parts.len()],
            parts,
            sources: Vec::new(),
            material_ids: BTreeMap::new(),
            material_texts: &scene.material,
            model_shot: None,
            contents: Contents::default(),
        })
    }

    fn max_depth(&self, scene: &SceneText) -> Result<Option<u32>, SceneError> {
        match &scene.max_depth {
            Some(depth) if *depth.get_ref() == 0 => {
                let remedy = "give 1 for emitters alone, or more";
                Err(self.file.place(depth.span()).wrong("max_depth is 0, which no path has", remedy))
            }
            depth => Ok(depth.as_ref().map(|depth| *depth.get_ref())),
        }
    }

    fn report_unused_parts(&mut self, scene: &SceneText) -> Result<(), SceneError> {
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

#[cfg(test)]
mod page;
#[cfg(test)]
mod tests;
