//! Reader of Mitsuba XML: the parts of format 3.x that the renderer models, and their spelling in 0.6.
//!
//! `tree` parses the XML. The other modules convert sensors, shapes, BSDFs, textures and emitters to a [`ScenePlan`].
//! Defaults and conventions are those of Mitsuba 3.9.1 in its `rgb` variants.
//!
//! Deviations: features without a counterpart in the scene model are replaced, with a warning each.

mod access;
mod bsdf;
mod bsdf_kinds;
mod cie;
mod converter;
mod emitter;
mod grammar;
mod integrator;
mod sensor;
mod shape;
mod sky;
mod statements;
mod texture;
mod thin;
mod tree;
mod value;
mod xml_file;

use crate::draft::DraftView;
use crate::error::{Log, SceneError};
use crate::file::stem_of;
use crate::options::LoadOptions;
use crate::plan::{Motion, ScenePlan};
use converter::Converter;
use integrator::IntegratorSettings;
use std::path::Path;
use tree::SceneXml;

/// Reads the sensors of the description at `path` as a list of views. `given` values replace defaults of `$parameters`.
pub(super) fn read_views(
    path: &Path,
    given: &[(String, String)],
    log: &mut Log,
) -> Result<Vec<Result<DraftView, SceneError>>, SceneError> {
    let document = SceneXml::read(path, given, log);
    let document = log.conclude(document)?;
    let views = Converter::new(&document, path, log).views();
    log.conclude(views)
}

/// Reads the description at `path`.
pub(super) fn read(path: &Path, options: &LoadOptions, log: &mut Log) -> Result<ScenePlan, SceneError> {
    let document = SceneXml::read(path, &options.parameters, log);
    let document = log.conclude(document)?;
    let mut converter = Converter::new(&document, path, log);
    converter.scene();
    let rest = converter.report_unused();
    converter.log.part(rest);
    let integrator = converter.integrator();
    let integrator = converter.log.part(integrator).unwrap_or_default();
    let shot = converter.shot(options.camera.as_deref());
    let (contents, read) = (converter.contents, converter.sources);
    let shot = log.conclude(shot)?;
    let stem = stem_of(path);
    let folder_name = path.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    // Scene files are often called scene.xml. The folder then gives the name.
    let name = if stem == "scene" { folder_name.unwrap_or(stem) } else { stem };
    let sources = document.sources.iter().cloned().chain(read).collect();
    let IntegratorSettings { max_depth, hides_emitters } = integrator;
    Ok(ScenePlan { name, sources, shot, max_depth, hides_emitters, motion: Motion::default(), contents })
}

#[cfg(test)]
mod tests;
