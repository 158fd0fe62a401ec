//! The native format: a TOML description over OBJ, PLY and generated geometry.
//!
//! ```toml
//! name = "room"                       # optional, else the file's name
//! generator = "nave"                  # optional: yields named parts
//! max_depth = 17                      # optional: longest path in edges
//! resolution = [512, 512]
//! [camera]
//! origin = [0.0, 1.6, 5.0]
//! target = [0.0, 1.6, 0.0]
//! up = [0.0, 1.0, 0.0]                # this is the default
//! fov = 60.0                          # degrees, horizontal unless fov_axis = "y"; also near, far
//! [camera.path]                       # optional walk-through
//! frames = 281                        # optional if keys have frames, which count from 1
//! keys = [{ origin = [0, 1, 5], target = [0, 1, 0] }, { origin = [1, 1, 4], target = [0, 1, 0] }]
//!                                     # each may have up and fov, and all a frame
//! [[material]]
//! name = "stone"
//! kind = "diffuse"                    # the kinds and their keys: see `material`
//! reflectance = [0.6, 0.58, 0.5]      # or 0.5, "wood.png" or { file = "wood.png", wrap = "clamp" }
//! two_sided = true                    # this is the default
//! [[mesh]]
//! part = "vault"                      # or file = "x.obj", or shape = "rectangle|cube|sphere|disk|cylinder"
//! material = "stone"                  # for OBJ optional: else its MTL materials
//! transform = [{ scale = 2.0 }, { rotate = { axis = [0, 1, 0], angle = 30 } }, { translate = [0, 1, 0] }]
//! emission = [10.0, 9.0, 8.0]         # optional; emission_two_sided = true; flip_normals = true
//! [[light]]
//! kind = "point"                      # position, intensity
//! position = [0, 2, 0]                # "spot": position, target, intensity, inner_angle, outer_angle (half
//! intensity = [5, 5, 5]               # angles in degrees); "directional": direction, irradiance
//! [environment]
//! radiance = [1.0, 1.0, 1.0]          # or file = "sky.exr", scale = 1.0, rotate_y = 0.0 (degrees)
//! ```
//!
//! Transform steps apply in order; `matrix` takes 16 numbers row by row. Shapes have Mitsuba's extents. v counts
//! upwards everywhere: pictures stand upright on a rectangle, and reach from the south pole of a sphere (-z) to
//! the north. Meshes whose file has no normals are flat. A `specular` or `diffuse` may be a texture, too.

mod camera;
mod light;
mod material;
mod mesh;
mod mtl;
mod path;
mod text;

use super::error::{Log, Place, SceneError};
use super::plan::{Contents, Plan, folder_of, read_text, stem_of};
use crate::scene::material::MaterialId;
use glam::DVec3;
use lightsplat_scenes::Part;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use text::SceneText;

/// Reads the description at `path`.
pub(super) fn read(path: &Path, log: &mut Log) -> Result<Plan, SceneError> {
    let (text, hash) = read_text(path, &Place::file(path))?;
    let file = File { path, text: &text };
    let scene: SceneText = toml::from_str(&text).map_err(|e| {
        let place = e.span().map_or(Place::file(path), |span| file.place(span));
        place.malformed(e.message())
    })?;
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
    let shot = builder.shot(&scene);
    let shot = builder.log.conclude(shot)?;
    builder.report_unused_parts(&scene)?;
    let mut sources = vec![(path.to_owned(), hash)];
    sources.append(&mut builder.sources);
    Ok(Plan {
        name: scene.name.unwrap_or_else(|| stem_of(path)),
        sources,
        generator: scene.generator.map(|g| g.into_inner()),
        shot,
        max_depth: scene.max_depth,
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
    contents: Contents,
}

impl<'a> Builder<'a> {
    fn new(file: File<'a>, log: &'a mut Log, scene: &SceneText) -> Result<Builder<'a>, SceneError> {
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
            contents: Contents::default(),
        })
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

/// Returns a finite vector, or an error at `place` that names `what`.
fn finite(v: [f64; 3], what: &str, place: &Place) -> Result<DVec3, SceneError> {
    let v = DVec3::from(v);
    let wrong = || place.wrong(format!("{what} is not finite"), "write finite numbers");
    v.is_finite().then_some(v).ok_or_else(wrong)
}

#[cfg(test)]
mod tests;
