//! The native format: a TOML description over glTF, OBJ, PLY and generated geometry.
//!
//! The page `docs/scene-format.md` documents keys, types, units and defaults. Tests compare it with the code.

mod builder;
mod camera;
mod colour;
mod group;
mod instance;
mod light;
mod material;
mod mesh;
mod mistake;
mod model;
mod mtl;
mod path;
mod sky;
mod source;
mod text;
mod views;

use crate::error::{Location, Log, SceneError};
use crate::file::{read_text, stem_of};
use crate::plan::{Motion, ScenePlan};
use builder::SceneBuilder;
use scene::MaterialId;
use source::SourceText;
use std::path::Path;
use text::SceneText;

pub(crate) use model::read as read_model;
pub(crate) use views::read as read_views;

/// Reads the description at `path`.
pub(super) fn read(path: &Path, log: &mut Log) -> Result<ScenePlan, SceneError> {
    let (text, hash) = read_text(path, &Location::file(path))?;
    let file = SourceText { path, text: &text };
    let scene: SceneText = toml::from_str(&text).map_err(|error| mistake::error(file, &error))?;
    let mut builder = SceneBuilder::new(file, log, &scene)?;
    for material in &scene.material {
        let read = builder.material(material);
        if builder.log.part(read).is_none() {
            // Meshes that use the material then report no error of their own.
            builder.material_ids.entry(material.get_ref().name.clone()).or_insert(MaterialId(0));
        }
    }
    for mesh in &scene.mesh {
        let read = builder.mesh(mesh);
        builder.log.part(read);
    }
    for instance in &scene.instance {
        let read = builder.instance(instance);
        builder.log.part(read);
    }
    let shown = builder.show_instances();
    builder.log.part(shown);
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
    Ok(ScenePlan {
        name: scene.name.clone().unwrap_or_else(|| stem_of(path)),
        sources,
        shot,
        max_depth,
        hides_emitters: scene.hide_emitters.unwrap_or(false),
        motion: Motion::default(),
        contents: builder.contents,
    })
}

#[cfg(test)]
mod page;
#[cfg(test)]
mod tests;
