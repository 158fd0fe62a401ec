//! Opening of all files of a plan, in parallel.
//!
//! Each file is read once. Results are in the order of the description, and so are errors.

use crate::budget::{TriangleBudget, lacking};
use crate::colour_profile;
use crate::decode::{self, Channel, DecodedImage};
use crate::draft::Draft;
use crate::error::{Location, Log, SceneError, Warning};
use crate::file::{fnv1a, read_file};
use crate::instances::{self, ReadPlan};
use crate::lacking_uvs;
use crate::mend::decode_mended;
use crate::mesh::{self, RawMesh};
use crate::plan::{
    Contents, EnvironmentPlan, ImageSource, MeshPlan, MeshSource, ScenePlan, TexturePlan, TextureSource,
};
use crate::stand_in::{self, MissingImages};
use base::file_kind::file_kind;
use base::math::Rgb;
use glam::{DMat3, DMat4};
use rayon::prelude::*;
use scene::requirements::ENVIRONMENT_TEXEL_BYTES;
use scene::{Environment, EnvironmentMap, Scene, Texture, Textures};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Bytes per texel that are copied while an environment is built.
const COPY_BYTES: u64 = 12;

/// Use of a file's bytes.
enum Task<'a> {
    /// Number and plan of a mesh, and whether it is in a group.
    Mesh(usize, &'a MeshPlan, bool),
    Texture(usize, &'a TexturePlan, Channel),
    Environment(&'a Location),
}

enum Realised {
    /// Meshes of a plan, and warnings about them.
    Meshes(usize, ReadPlan, Vec<Warning>),
    Texture(usize, DecodedImage),
    /// A texture that cannot be read.
    MissingTexture(usize, Warning),
    Environment(DecodedImage),
    /// A warning about the file's colours, texels or end.
    Remark(Warning),
}

/// Hash of a file's bytes, if it was read, and its content.
type UsedFile = (Option<u64>, Vec<Realised>);

/// Content of all files of a plan.
struct ReadFiles {
    /// Files read, in the order of the description.
    sources: Vec<PathBuf>,
    /// Hashes of the files' bytes.
    hashes: Vec<u64>,
    /// Meshes of each mesh plan.
    meshes: Vec<ReadPlan>,
    /// Warnings about each mesh plan, and then about each image.
    remarks: Vec<Vec<Warning>>,
    /// Image of each texture plan.
    images: Vec<Option<DecodedImage>>,
    /// Textures that cannot be read.
    missing: MissingImages,
    environment: Option<DecodedImage>,
}

impl ScenePlan {
    /// Opens every file; returns the draft, and the hash over the bytes of all files.
    ///
    /// `most_copied` is the number of triangles up to which instances are copies.
    pub fn realise(self, most_copied: u64, log: &mut Log) -> Result<(Draft, u64), SceneError> {
        let read = self.read_files()?;
        let ReadFiles { sources, hashes, mut meshes, remarks, mut images, mut missing, environment } = read;
        let mut contents = self.contents;
        contents.place_meshes(&mut meshes, log)?;
        remarks.into_iter().flatten().try_for_each(|remark| log.add(remark))?;
        contents.decode_embedded(&mut images, &mut missing, log)?;
        stand_in::replace(missing, &mut images, &mut contents.materials, log)?;
        lacking_uvs::report(&contents, &meshes, &images, log)?;
        let (meshes, groups) = instances::assemble(&contents, meshes, most_copied)?;
        let textures: Textures =
            contents.textures.into_iter().zip(images).filter_map(|(t, p)| texture(t, p)).collect();
        let environment = match contents.environment {
            Some(plan) => plan.realise(environment)?,
            None => None,
        };
        let scene = Scene {
            name: self.name,
            sources,
            max_depth: self.max_depth,
            hides_emitters: self.hides_emitters,
            materials: contents.materials,
            textures: textures.with_attributes(contents.attribute_textures),
            environment,
            discs: contents.discs,
            ..Scene::default()
        };
        let draft = Draft {
            scene,
            shot: self.shot,
            meshes,
            groups,
            lights: contents.lights,
            material_places: contents.material_places,
            attribute_names: contents.attribute_names,
        };
        let bytes: Vec<u8> = hashes.iter().flat_map(|h| h.to_le_bytes()).collect();
        Ok((draft, fnv1a(&bytes)))
    }

    fn read_files(&self) -> Result<ReadFiles, SceneError> {
        let files = self.contents.tasks();
        let outcomes: Vec<Result<UsedFile, SceneError>> =
            files.par_iter().map(|(path, tasks)| use_file(path, tasks, &self.contents.budget)).collect();
        let mut read = ReadFiles {
            sources: self.sources.iter().map(|s| s.0.clone()).collect(),
            hashes: self.sources.iter().map(|s| s.1).collect(),
            meshes: vec![ReadPlan::default(); self.contents.meshes.len()],
            remarks: vec![Vec::new(); self.contents.meshes.len()],
            images: vec![None; self.contents.textures.len()],
            missing: MissingImages::default(),
            environment: None,
        };
        let mut errors = Vec::new();
        for ((path, _), outcome) in files.iter().zip(outcomes) {
            match outcome {
                Ok((hash, done)) => {
                    if let Some(hash) = hash {
                        read.sources.push(path.to_path_buf());
                        read.hashes.push(hash);
                    }
                    done.into_iter().for_each(|done| read.take(done));
                }
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() { Ok(read) } else { Err(SceneError::all(errors)) }
    }
}

impl ReadFiles {
    fn take(&mut self, done: Realised) {
        match done {
            Realised::Meshes(i, meshes, remarks) => (self.meshes[i], self.remarks[i]) = (meshes, remarks),
            Realised::Texture(i, image) => self.images[i] = Some(image),
            Realised::MissingTexture(i, warning) => _ = self.missing.insert(i, warning),
            Realised::Environment(image) => self.environment = Some(image),
            Realised::Remark(warning) => self.remarks.push(vec![warning]),
        }
    }
}

impl EnvironmentPlan {
    /// Returns the environment; `image` is the decoded image of a map.
    fn realise(self, image: Option<DecodedImage>) -> Result<Option<Environment>, SceneError> {
        Ok(match (self, image) {
            (EnvironmentPlan::Constant(radiance), _) => Some(Environment::Constant(radiance)),
            (EnvironmentPlan::Map { place, scale, to_world, .. }, Some(image)) => {
                let map = environment_map(image, scale, &to_world);
                let map = map.ok_or_else(|| {
                    let remedy = "give a factor of 0 or more that leaves the image's values finite";
                    place.wrong(format!("the environment's scale is {scale}"), remedy)
                })?;
                Some(Environment::Map(map))
            }
            (EnvironmentPlan::Map { .. }, None) => None,
            (EnvironmentPlan::Sky(sky), _) => sky.map().map(Environment::Map),
        })
    }
}

impl Contents {
    /// Returns the tasks of each file; files are in the order of their first mention.
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
        let is_member = self.are_members();
        for (i, mesh) in self.meshes.iter().enumerate() {
            match &mesh.geometry {
                MeshSource::Obj(path, _)
                | MeshSource::Ply(path)
                | MeshSource::Stl(path)
                | MeshSource::Serialized(path, _) => {
                    add(path, Task::Mesh(i, mesh, is_member[i]));
                }
                MeshSource::Ready(_) | MeshSource::Shared(_) => {}
            }
        }
        for (i, texture) in self.textures.iter().enumerate() {
            match &texture.image {
                TextureSource::File { path, raw } => {
                    let channel = if *raw { Channel::Data } else { Channel::Colour };
                    add(path, Task::Texture(i, texture, channel));
                }
                TextureSource::Part { source: ImageSource::File(path), channel, .. } => {
                    add(path, Task::Texture(i, texture, *channel));
                }
                TextureSource::Ready(..) | TextureSource::Part { .. } => {}
            }
        }
        if let Some(EnvironmentPlan::Map { place, path, .. }) = &self.environment {
            add(path, Task::Environment(place));
        }
        files
    }

    /// Places the meshes that no file holds, and warns of files without triangles.
    fn place_meshes(&self, meshes: &mut [ReadPlan], log: &mut Log) -> Result<(), SceneError> {
        let is_member = self.are_members();
        for ((plan, made), is_member) in self.meshes.iter().zip(meshes).zip(is_member) {
            let ready = |raw: &RawMesh| ReadPlan::new(plan, raw.clone(), is_member, &mut Vec::new());
            match &plan.geometry {
                MeshSource::Ready(raw) => *made = ready(raw),
                MeshSource::Shared(raw) => *made = ready(raw),
                MeshSource::Obj(path, _)
                | MeshSource::Ply(path)
                | MeshSource::Stl(path)
                | MeshSource::Serialized(path, _) => {
                    if made.meshes.iter().all(|mesh| mesh.triangles.is_empty()) {
                        // The mesh is the scene.
                        if plan.place == Location::file(path) {
                            return Err(SceneError::mesh(
                                plan.place.clone(),
                                "there are no triangles or polygons",
                            ));
                        }
                        let what = format!("there are no triangles or polygons in {}", path.display());
                        let remedy = "make a mesh of its points or curves, or export it with its faces";
                        if plan.place.path == *path {
                            return Err(plan.place.wrong(what, remedy));
                        }
                        log.warn(&plan.place, what, format!("the mesh is left out; {remedy}"))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Decodes the images that are part of a description.
    fn decode_embedded(
        &self,
        images: &mut [Option<DecodedImage>],
        missing: &mut MissingImages,
        log: &mut Log,
    ) -> Result<(), SceneError> {
        let decode = |(i, (plan, image)): (usize, (&TexturePlan, &mut Option<DecodedImage>))| {
            let TextureSource::Part { source: ImageSource::Bytes(bytes), channel, name } = &plan.image else {
                return Ok((None, [None, None]));
            };
            let path = Path::new(name);
            let decoded = match file_kind(bytes).filter(|kind| !kind.is_read_as("")) {
                Some(kind) => {
                    Err(SceneError::Foreign { path: path.to_owned(), from: plan.place.clone(), kind })
                }
                None => decode_mended(bytes, *channel, path, &plan.place, false),
            };
            match decoded {
                Ok((decoded, remark)) => {
                    *image = Some(decoded);
                    Ok((None, [remark, cut_jpeg(bytes, path, &plan.place)]))
                }
                Err(error) => {
                    stand_in::warning(error, &plan.place).map(|warning| (Some((i, warning)), [None, None]))
                }
            }
        };
        let undecoded: Result<Vec<_>, SceneError> =
            self.textures.par_iter().zip(images).enumerate().map(decode).collect();
        for (undecoded, remarks) in undecoded? {
            missing.extend(undecoded);
            remarks.into_iter().flatten().try_for_each(|remark| log.add(remark))?;
        }
        Ok(())
    }
}

/// Performs the tasks of a file; returns the hash of its bytes, unless only textures need the file and it cannot be
/// read.
fn use_file(path: &Path, tasks: &[Task], budget: &TriangleBudget) -> Result<UsedFile, SceneError> {
    let is_texture = |task: &Task| matches!(task, Task::Texture(..));
    // A mesh or an environment that is not there is an error, so its place counts.
    let from = match tasks.iter().find(|task| !is_texture(task)).or(tasks.first()) {
        Some(Task::Mesh(_, plan, _)) => &plan.place,
        Some(Task::Texture(_, plan, _)) => &plan.place,
        Some(Task::Environment(place)) => place,
        None => return Ok((None, Vec::new())),
    };
    let bytes = match read_file(path, from) {
        Ok(bytes) => bytes,
        Err(error) if tasks.iter().all(is_texture) => {
            let missing = stand_in::warning(error, from)?;
            let of_task = |task: &Task| match task {
                Task::Texture(i, plan, _) => Some(Realised::MissingTexture(
                    *i,
                    Warning { place: plan.place.clone(), ..missing.clone() },
                )),
                Task::Mesh(..) | Task::Environment(_) => None,
            };
            return Ok((None, tasks.iter().filter_map(of_task).collect()));
        }
        Err(error) => return Err(error),
    };
    let hash = Some(fnv1a(&bytes));
    let done: Vec<Result<(Realised, Option<Warning>), SceneError>> =
        tasks.par_iter().map(|task| perform(task, &bytes, path, budget)).collect();
    let done = done.into_iter().collect::<Result<Vec<_>, _>>()?;
    let (mut done, remarks): (Vec<Realised>, Vec<Option<Warning>>) = done.into_iter().unzip();
    done.extend(remarks.into_iter().flatten().map(Realised::Remark));
    let place_of_colours = tasks.iter().find_map(|task| match task {
        Task::Texture(_, plan, Channel::Colour) => Some(&plan.place),
        Task::Environment(place) => Some(*place),
        Task::Mesh(..) | Task::Texture(..) => None,
    });
    let profile = place_of_colours.and_then(|place| colour_profile::warning(&bytes, path, place));
    done.extend(profile.map(Realised::Remark));
    if !tasks.iter().any(|task| matches!(task, Task::Mesh(..))) {
        done.extend(cut_jpeg(&bytes, path, from).map(Realised::Remark));
    }
    Ok((hash, done))
}

/// Returns a warning about a JPEG image without the mark of its end behind the start of its last scan.
fn cut_jpeg(bytes: &[u8], path: &Path, place: &Location) -> Option<Warning> {
    let last = |mark: u8| bytes.windows(2).rposition(|pair| pair == [0xFF, mark]);
    let is_cut = bytes.starts_with(&[0xFF, 0xD8, 0xFF]) && last(0xD9) < last(0xDA);
    let what = format!("the JPEG image {} ends too early", path.display());
    is_cut.then(|| Warning::new(place.clone(), what, "its rest is grey; download or export it again"))
}

/// Performs a task; returns what it gives, and a warning about its texels.
fn perform(
    task: &Task,
    bytes: &[u8],
    path: &Path,
    budget: &TriangleBudget,
) -> Result<(Realised, Option<Warning>), SceneError> {
    Ok(match task {
        Task::Mesh(i, plan, is_member) => {
            let mut remarks = Vec::new();
            let raw = match &plan.geometry {
                MeshSource::Obj(_, selection) => mesh::obj::read(bytes, path, selection, &mut remarks)?,
                MeshSource::Ply(_) => mesh::ply::read(bytes, path, &mut remarks)?,
                MeshSource::Stl(_) => mesh::stl::read(bytes, path, &mut remarks)?,
                MeshSource::Serialized(_, index) => {
                    mesh::serialized::read(bytes, *index, path, &mut remarks)?
                }
                MeshSource::Ready(raw) => raw.clone(),
                MeshSource::Shared(raw) => RawMesh::clone(raw),
            };
            budget.take(raw.triangles.len(), &plan.place)?;
            let read = ReadPlan::new(plan, raw, *is_member, &mut remarks);
            (Realised::Meshes(*i, read, remarks), None)
        }
        Task::Texture(i, plan, channel) => match decode_mended(bytes, *channel, path, &plan.place, false) {
            Ok((image, remark)) => (Realised::Texture(*i, image), remark),
            Err(error) => (Realised::MissingTexture(*i, stand_in::warning(error, &plan.place)?), None),
        },
        Task::Environment(place) => {
            let (image, remark) = decode_mended(bytes, Channel::Colour, path, place, true)?;
            let DecodedImage { width, height, .. } = image;
            if let Some(lack) = lacking((width * height) as u64 * (ENVIRONMENT_TEXEL_BYTES + COPY_BYTES)) {
                let what = format!("{}: light of its {width} x {height} texels takes {lack}", path.display());
                return Err(place.wrong(what, decode::SMALLER));
            }
            (Realised::Environment(image), remark)
        }
    })
}

fn texture(plan: TexturePlan, decoded: Option<DecodedImage>) -> Option<Texture> {
    let (name, image) = match plan.image {
        TextureSource::File { path, .. } => {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
            (name.unwrap_or_default(), decoded?)
        }
        TextureSource::Ready(name, image) => (name, image),
        TextureSource::Part { name, .. } => (name, decoded?),
    };
    let DecodedImage { width, height, texels } = image;
    Some(Texture { name, width, height, texels, filter: plan.filter, wrap: plan.wrap, to_uv: plan.to_uv })
}

/// Returns the map times `scale`; `None` if its values become negative or infinite.
///
/// As in Mitsuba, the last row is repeated until there are 3 rows.
fn environment_map(image: DecodedImage, scale: f32, to_world: &DMat4) -> Option<EnvironmentMap> {
    let DecodedImage { width, height, texels } = image;
    if !(scale >= 0.0 && texels.all(|texel| (texel * scale).is_finite())) {
        return None;
    }
    let mut radiance: Vec<Rgb> = texels.iter().map(|texel| texel * scale).collect();
    let last: Vec<Rgb> = radiance[radiance.len() - width..].to_vec();
    for _ in height..3 {
        radiance.extend_from_slice(&last);
    }
    // Readers have checked that the matrix is a rotation or reflection, so the transpose is the inverse.
    let to_local = DMat3::from_mat4(*to_world).transpose().as_mat3();
    Some(EnvironmentMap { width, height: height.max(3), radiance, to_local })
}
