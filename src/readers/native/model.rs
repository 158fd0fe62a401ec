//! A mesh file as a scene of its own: OBJ with its MTL, PLY or STL.

use super::builder::SceneBuilder;
use super::source::SourceText;
use super::text::SceneText;
use crate::error::{Location, Log, SceneError};
use crate::file::stem_of;
use crate::mesh::{Normals, Placement};
use crate::plan::{MaterialPlan, MeshPlan, MeshSource, Motion, ScenePlan};
use crate::selection::PartSelection;
use glam::DMat4;
use std::path::Path;

/// Reads the mesh file at `path` as a scene; `extension` is that of its name, in lower case.
///
/// Deviations: a mesh without material has the colours of its vertices or faces, else a grey of 0.5.
pub(crate) fn read(path: &Path, extension: &str, log: &mut Log) -> Result<ScenePlan, SceneError> {
    let text = SceneText::default();
    let mut builder = SceneBuilder::new(SourceText { path, text: "" }, log, &text)?;
    let place = Location::file(path);
    let (geometry, material) = match extension {
        "obj" => (
            MeshSource::Obj(path.to_owned(), PartSelection::default()),
            builder.mtl_materials(path, &place, &DMat4::IDENTITY)?,
        ),
        _ => {
            let path = path.to_owned();
            let source = if extension == "stl" { MeshSource::Stl(path) } else { MeshSource::Ply(path) };
            let has_colours = source.has_colours(&place)?;
            (source, MaterialPlan::One(builder.default_material(has_colours, &place)))
        }
    };
    let placement = Placement {
        to_world: DMat4::IDENTITY,
        normals: Normals::AsGiven,
        flip_normals: false,
        v_down: false,
        needs_uv: false,
    };
    let name = stem_of(path);
    let mesh = MeshPlan { place, name: name.clone(), geometry, placement, material, emission: None };
    builder.contents.add_mesh(mesh)?;
    Ok(ScenePlan {
        name,
        shot: builder.shot(&text)?,
        sources: builder.sources,
        max_depth: None,
        hides_emitters: false,
        motion: Motion::default(),
        contents: builder.contents,
    })
}
