//! A parsed scene description, before any mesh or picture is opened; [`Plan::realise`] opens them all.
//!
//! Both readers end in a [`Plan`]. Files are read in parallel, each once; results are in the order of the
//! description, and so are errors.

use super::budget::{TriangleBudget, lacking};
use super::error::{Log, Place, SceneError};
use super::file::{fnv1a, read_file};
use super::mesh::{self, Placement, RawMesh};
use super::picture::{self, Channel, Picture};
use super::sky::SkyPlan;
use crate::draft::{Draft, DraftMesh, Shot};
use base::math::Rgb;
use glam::{DMat3, DMat4, DVec3, Mat3};
use rayon::prelude::*;
use scene::requirements::ENVIRONMENT_TEXEL_BYTES;
use scene::{
    DeltaLight, DistantDisc, Emission, Environment, EnvironmentMap, Filter, Material, MaterialId, Texture,
    TextureId, Wrap,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Size of a texel that is copied while an environment is made.
const COPY_BYTES: u64 = 12;

/// The whole content of a scene description.
#[derive(Clone, Debug)]
pub struct Plan {
    pub name: String,
    /// The description's own files, main file first, with the hash of their bytes.
    pub sources: Vec<(PathBuf, u64)>,
    pub generator: Option<String>,
    pub shot: Shot,
    pub max_depth: Option<u32>,
    pub hides_emitters: bool,
    pub contents: Contents,
}

/// All but the cameras of a description, in the making.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    pub meshes: Vec<MeshPlan>,
    pub materials: Vec<Material>,
    /// Place in the files where each material is described.
    pub material_places: Vec<Place>,
    pub textures: Vec<TexturePlan>,
    pub lights: Vec<(DeltaLight, DVec3)>,
    pub environment: Option<EnvironmentPlan>,
    pub discs: Vec<DistantDisc>,
    pub budget: TriangleBudget,
}

impl Contents {
    /// Adds a mesh; an error if there is no memory for it.
    pub fn add_mesh(&mut self, plan: MeshPlan) -> Result<(), SceneError> {
        let triangles = match &plan.geometry {
            Geometry::Ready(raw) => raw.triangles.len(),
            Geometry::Shared(raw) => raw.triangles.len(),
            // Counted when they are read.
            Geometry::Obj(..) | Geometry::Ply(_) | Geometry::Serialized(..) => 0,
        };
        self.budget.take(triangles, &plan.place)?;
        self.meshes.push(plan);
        Ok(())
    }

    /// Adds a material that is described at `place`.
    pub fn add_material(&mut self, material: Material, place: Place) -> MaterialId {
        self.materials.push(material);
        self.material_places.push(place);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// Adds a texture; the same one asked for twice is read and stored once.
    pub fn add_texture(&mut self, plan: TexturePlan) -> TextureId {
        let same = |t: &TexturePlan| {
            t.image == plan.image && t.filter == plan.filter && t.wrap == plan.wrap && t.to_uv == plan.to_uv
        };
        let at = self.textures.iter().position(same).unwrap_or_else(|| {
            self.textures.push(plan);
            self.textures.len() - 1
        });
        TextureId(at as u32)
    }
}

/// A mesh to be read or tessellated.
#[derive(Clone, Debug)]
pub(crate) struct MeshPlan {
    pub place: Place,
    pub name: String,
    pub geometry: Geometry,
    pub placement: Placement,
    pub material: MaterialPlan,
    pub emission: Option<Emission>,
}

/// Part of a file that is asked for: nodes, objects or groups by name, with all below them, but none of `except`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Names, or none for everything.
    pub only: Vec<String>,
    pub except: Vec<String>,
}

/// Source of a mesh.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// File, and the objects and groups of it that are asked for.
    Obj(PathBuf, Selection),
    Ply(PathBuf),
    /// File and index of the mesh in it.
    Serialized(PathBuf, usize),
    Ready(RawMesh),
    /// One that other plans place as well.
    Shared(Arc<RawMesh>),
}

/// Light and look of surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    pub material: MaterialId,
    pub emission: Option<Emission>,
}

/// Choice of a mesh's materials.
#[derive(Clone, Debug)]
pub(crate) enum MaterialPlan {
    One(MaterialId),
    /// Materials by the file's own names, and the one for unknown names.
    ByName(BTreeMap<String, Look>, MaterialId),
}

/// A texture to be read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TexturePlan {
    pub place: Place,
    pub image: Image,
    pub filter: Filter,
    pub wrap: Wrap,
    pub to_uv: Mat3,
}

/// Source of a texture's texels.
#[derive(Clone, Debug, PartialEq)]
pub enum Image {
    File {
        path: PathBuf,
        raw: bool,
    },
    Ready(String, Picture),
    /// A channel of a picture, or its colour.
    Part {
        name: String,
        source: PictureSource,
        channel: Channel,
    },
}

/// Encoded picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PictureSource {
    File(PathBuf),
    Bytes(Arc<[u8]>),
}

/// An environment to be read.
#[derive(Clone, Debug)]
pub(crate) enum EnvironmentPlan {
    Constant(Rgb),
    Map { place: Place, path: PathBuf, scale: f32, to_world: DMat4 },
    Sky(SkyPlan),
}

/// A task on a file's bytes.
enum Task<'a> {
    Mesh(usize, &'a MeshPlan),
    Texture(usize, &'a TexturePlan, Channel),
    Environment(&'a Place),
}

enum Done {
    Meshes(usize, Vec<DraftMesh>),
    Texture(usize, Picture),
    Environment(Picture),
}

impl Plan {
    /// Opens every file; returns the scene and the hash over the bytes of all its files.
    pub fn realise(self, log: &mut Log) -> Result<(Draft, u64), SceneError> {
        let files = self.contents.tasks();
        let outcomes: Vec<Result<(u64, Vec<Done>), SceneError>> =
            files.par_iter().map(|(path, tasks)| carry_out(path, tasks, &self.contents.budget)).collect();

        let mut sources: Vec<PathBuf> = self.sources.iter().map(|s| s.0.clone()).collect();
        let mut hashes: Vec<u64> = self.sources.iter().map(|s| s.1).collect();
        let mut meshes: Vec<Vec<DraftMesh>> = vec![Vec::new(); self.contents.meshes.len()];
        let mut pictures: Vec<Option<Picture>> = vec![None; self.contents.textures.len()];
        let (mut sky, mut errors) = (None, Vec::new());
        for ((path, _), outcome) in files.iter().zip(outcomes) {
            let (hash, done) = match outcome {
                Ok(made) => made,
                Err(error) => {
                    errors.push(error);
                    continue;
                }
            };
            sources.push(path.to_path_buf());
            hashes.push(hash);
            for done in done {
                match done {
                    Done::Meshes(i, m) => meshes[i] = m,
                    Done::Texture(i, p) => pictures[i] = Some(p),
                    Done::Environment(p) => sky = Some(p),
                }
            }
        }
        if !errors.is_empty() {
            return Err(SceneError::all(errors));
        }
        let contents = self.contents;
        for (plan, made) in contents.meshes.iter().zip(&mut meshes) {
            match &plan.geometry {
                Geometry::Ready(raw) => *made = finish_mesh(plan, raw.clone()),
                Geometry::Shared(raw) => *made = finish_mesh(plan, RawMesh::clone(raw)),
                Geometry::Obj(path, _) | Geometry::Ply(path) | Geometry::Serialized(path, _) => {
                    if made.iter().all(|mesh| mesh.triangles.is_empty()) {
                        let what = format!("no triangles or polygons are found in {}", path.display());
                        log.warn(&plan.place, what, "the mesh is left out; repair or re-export it")?;
                    }
                }
            }
        }
        contents.decode_embedded(&mut pictures)?;
        let textures =
            contents.textures.into_iter().zip(pictures).filter_map(|(t, p)| texture(t, p)).collect();
        let environment = match (contents.environment, sky) {
            (Some(EnvironmentPlan::Constant(radiance)), _) => Some(Environment::Constant(radiance)),
            (Some(EnvironmentPlan::Map { place, scale, to_world, .. }), Some(picture)) => {
                let map = environment_map(picture, scale, &to_world);
                let map = map.ok_or_else(|| {
                    let remedy = "give a factor of 0 or more that leaves the picture's values finite";
                    place.wrong(format!("the environment's scale is {scale}"), remedy)
                })?;
                Some(Environment::Map(map))
            }
            (Some(EnvironmentPlan::Sky(sky)), _) => sky.map().map(Environment::Map),
            _ => None,
        };
        let draft = Draft {
            name: self.name,
            sources,
            shot: self.shot,
            max_depth: self.max_depth,
            hides_emitters: self.hides_emitters,
            meshes: meshes.into_iter().flatten().collect(),
            materials: contents.materials,
            material_places: contents.material_places,
            textures,
            lights: contents.lights,
            environment,
            discs: contents.discs,
        };
        let bytes: Vec<u8> = hashes.iter().flat_map(|h| h.to_le_bytes()).collect();
        Ok((draft, fnv1a(&bytes)))
    }
}

impl Contents {
    /// Returns the tasks of each file, files by first mention.
    fn tasks(&self) -> Vec<(&Path, Vec<Task<'_>>)> {
        let mut files: Vec<(&Path, Vec<Task>)> = Vec::new();
        let mut by_path: BTreeMap<&Path, usize> = BTreeMap::new();
        let mut add = |path, task| {
            let at = *by_path.entry(path).or_insert_with(|| {
                files.push((path, Vec::new()));
                files.len() - 1
            });
            files[at].1.push(task);
        };
        for (i, mesh) in self.meshes.iter().enumerate() {
            match &mesh.geometry {
                Geometry::Obj(path, _) | Geometry::Ply(path) | Geometry::Serialized(path, _) => {
                    add(path, Task::Mesh(i, mesh));
                }
                Geometry::Ready(_) | Geometry::Shared(_) => {}
            }
        }
        for (i, texture) in self.textures.iter().enumerate() {
            match &texture.image {
                Image::File { path, raw } => {
                    let channel = if *raw { Channel::Data } else { Channel::Colour };
                    add(path, Task::Texture(i, texture, channel));
                }
                Image::Part { source: PictureSource::File(path), channel, .. } => {
                    add(path, Task::Texture(i, texture, *channel));
                }
                Image::Ready(..) | Image::Part { .. } => {}
            }
        }
        if let Some(EnvironmentPlan::Map { place, path, .. }) = &self.environment {
            add(path, Task::Environment(place));
        }
        files
    }

    /// Decodes the pictures that descriptions hold themselves.
    fn decode_embedded(&self, pictures: &mut [Option<Picture>]) -> Result<(), SceneError> {
        let decode = |(plan, picture): (&TexturePlan, &mut Option<Picture>)| {
            if let Image::Part { source: PictureSource::Bytes(bytes), channel, name } = &plan.image {
                *picture = Some(picture::decode(bytes, *channel, Path::new(name), &plan.place)?);
            }
            Ok(())
        };
        self.textures.par_iter().zip(pictures).try_for_each(decode)
    }
}

fn carry_out(path: &Path, tasks: &[Task], budget: &TriangleBudget) -> Result<(u64, Vec<Done>), SceneError> {
    let from = match tasks.first() {
        Some(Task::Mesh(_, plan)) => &plan.place,
        Some(Task::Texture(_, plan, _)) => &plan.place,
        Some(Task::Environment(place)) => place,
        None => return Ok((0, Vec::new())),
    };
    let bytes = read_file(path, from)?;
    let hash = fnv1a(&bytes);
    let done: Vec<Result<Done, SceneError>> =
        tasks.par_iter().map(|task| one(task, &bytes, path, budget)).collect();
    Ok((hash, done.into_iter().collect::<Result<_, _>>()?))
}

fn one(task: &Task, bytes: &[u8], path: &Path, budget: &TriangleBudget) -> Result<Done, SceneError> {
    Ok(match task {
        Task::Mesh(i, plan) => {
            let raw = match &plan.geometry {
                Geometry::Obj(_, selection) => mesh::obj::read(bytes, path, selection)?,
                Geometry::Ply(_) => mesh::ply::read(bytes, path)?,
                Geometry::Serialized(_, index) => mesh::serialized::read(bytes, *index, path)?,
                Geometry::Ready(raw) => raw.clone(),
                Geometry::Shared(raw) => RawMesh::clone(raw),
            };
            budget.take(raw.triangles.len(), &plan.place)?;
            Done::Meshes(*i, finish_mesh(plan, raw))
        }
        Task::Texture(i, plan, channel) => {
            Done::Texture(*i, picture::decode(bytes, *channel, path, &plan.place)?)
        }
        Task::Environment(place) => {
            let picture = picture::decode(bytes, Channel::Colour, path, place)?;
            let Picture { width, height, .. } = picture;
            if let Some(lack) = lacking((width * height) as u64 * (ENVIRONMENT_TEXEL_BYTES + COPY_BYTES)) {
                let what = format!("{}: light of its {width} x {height} texels takes {lack}", path.display());
                return Err(place.wrong(what, picture::SMALLER));
            }
            Done::Environment(picture)
        }
    })
}

fn finish_mesh(plan: &MeshPlan, raw: RawMesh) -> Vec<DraftMesh> {
    let parts = match &plan.material {
        MaterialPlan::One(material) => {
            vec![(plan.name.clone(), Look { material: *material, emission: None }, raw)]
        }
        MaterialPlan::ByName(looks, other) => {
            let parts = mesh::obj::split_by_material(raw).into_iter();
            let unknown = Look { material: *other, emission: None };
            let look = |name: &str| looks.get(name).copied().unwrap_or(unknown);
            parts.map(|(name, part)| (format!("{}:{name}", plan.name), look(&name), part)).collect()
        }
    };
    let finish = |(name, look, raw): (String, Look, RawMesh)| {
        let placed = mesh::place(raw, &plan.placement);
        DraftMesh { name, material: look.material, emission: plan.emission.or(look.emission), ..placed }
    };
    parts.into_iter().map(finish).collect()
}

fn texture(plan: TexturePlan, decoded: Option<Picture>) -> Option<Texture> {
    let (name, picture) = match plan.image {
        Image::File { path, .. } => {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
            (name.unwrap_or_default(), decoded?)
        }
        Image::Ready(name, picture) => (name, picture),
        Image::Part { name, .. } => (name, decoded?),
    };
    let Picture { width, height, texels } = picture;
    Some(Texture { name, width, height, texels, filter: plan.filter, wrap: plan.wrap, to_uv: plan.to_uv })
}

/// Makes the map with `scale` applied; `None` if it has no light then, negative or infinite. As in Mitsuba, fewer than
/// 3 rows are padded by repeating the last.
fn environment_map(picture: Picture, scale: f32, to_world: &DMat4) -> Option<EnvironmentMap> {
    let Picture { width, height, texels } = picture;
    if !(scale >= 0.0 && texels.all(|texel| !texel.is_finite() || (texel * scale).is_finite())) {
        return None;
    }
    let mut radiance: Vec<Rgb> = texels.iter().map(|texel| texel * scale).collect();
    let last: Vec<Rgb> = radiance[radiance.len() - width..].to_vec();
    for _ in height..3 {
        radiance.extend_from_slice(&last);
    }
    // A rotation (or reflection), so that the transpose is the inverse; readers have checked that.
    let to_local = DMat3::from_mat4(*to_world).transpose().as_mat3();
    Some(EnvironmentMap { width, height: height.max(3), radiance, to_local })
}
