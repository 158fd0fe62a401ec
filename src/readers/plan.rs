//! A parsed scene description, before any mesh or image file is opened.
//!
//! All readers return a [`ScenePlan`]; [`ScenePlan::realise`] opens the files.

use crate::budget::TriangleBudget;
use crate::decode::{Channel, DecodedImage};
use crate::draft::Shot;
use crate::error::{Location, SceneError};
use crate::file::read_file;
use crate::mesh::{Placement, RawMesh, ply_header, stl};
use crate::selection::PartSelection;
use crate::sky::SkyPlan;
use base::math::Rgb;
use glam::{DMat4, DVec3, Mat3};
use scene::{
    AttributeId, AttributeTexture, DeltaLight, DistantDisc, Emission, Filter, Material, MaterialId,
    Parameter, TextureId, Wrap,
};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Content of a scene description.
#[derive(Clone, Debug)]
pub struct ScenePlan {
    pub name: String,
    /// The description's own files, main file first, and the hash of the bytes of each.
    pub sources: Vec<(PathBuf, u64)>,
    pub shot: Shot,
    pub max_depth: Option<u32>,
    pub hides_emitters: bool,
    pub motion: Motion,
    pub contents: Contents,
}

/// Animation of a model, and the part of it in a plan. The default is a plan without an animation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    /// Number of frames of the animation, if the plan has the pose of one of them; 0 at rest.
    pub frames: usize,
    /// Number of frames of the animation, as far as it can be read; 0 without one.
    pub animation_frames: usize,
    /// True if the animation moves meshes or lights.
    pub moves: bool,
}

/// Content of a description without the cameras.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    /// Meshes, each once.
    pub meshes: Vec<MeshPlan>,
    /// Meshes and groups where they are seen, in the order of the description.
    pub seen: Vec<SeenPlan>,
    /// Numbers of the meshes of each group. These meshes are seen through the group alone.
    pub groups: Vec<Vec<usize>>,
    pub materials: Vec<Material>,
    /// Location of each material's description.
    pub material_places: Vec<Location>,
    pub textures: Vec<TexturePlan>,
    /// Textures that are attributes of meshes.
    pub attribute_textures: Vec<AttributeTexture>,
    /// Names of the attributes that textures look up, by number.
    pub attribute_names: Vec<String>,
    pub lights: Vec<(DeltaLight, DVec3)>,
    pub environment: Option<EnvironmentPlan>,
    pub discs: Vec<DistantDisc>,
    pub budget: TriangleBudget,
}

impl Contents {
    /// Adds a mesh that is seen where its plan places it.
    ///
    /// # Errors
    /// If the mesh does not fit into memory.
    pub fn add_mesh(&mut self, plan: MeshPlan) -> Result<(), SceneError> {
        self.seen.push(SeenPlan::Mesh(self.meshes.len()));
        self.add_plan(plan)
    }

    /// Adds a group without meshes; returns its number.
    pub fn add_group(&mut self) -> usize {
        self.groups.push(Vec::new());
        self.groups.len() - 1
    }

    /// Adds a mesh to a group.
    ///
    /// # Errors
    /// If the mesh does not fit into memory.
    pub fn add_member(&mut self, group: usize, plan: MeshPlan) -> Result<(), SceneError> {
        self.groups[group].push(self.meshes.len());
        self.add_plan(plan)
    }

    /// Shows a group at a place. `name` is that of its meshes there, unless they keep their own.
    pub fn show_group(&mut self, group: usize, to_world: DMat4, name: Option<&str>) {
        self.seen.push(SeenPlan::Group { group, to_world, name: name.map(str::to_owned) });
    }

    fn add_plan(&mut self, plan: MeshPlan) -> Result<(), SceneError> {
        let triangles = match &plan.geometry {
            MeshSource::Ready(raw) => raw.triangles.len(),
            MeshSource::Shared(raw) => raw.triangles.len(),
            // These are counted when the file is read.
            MeshSource::Obj(..) | MeshSource::Ply(_) | MeshSource::Stl(_) | MeshSource::Serialized(..) => 0,
        };
        self.budget.take(triangles, &plan.place)?;
        self.meshes.push(plan);
        Ok(())
    }

    /// Adds a material described at `place`.
    pub fn add_material(&mut self, material: Material, place: Location) -> MaterialId {
        self.materials.push(material);
        self.material_places.push(place);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// Adds a texture. Equal textures are read and stored once.
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

    /// Adds the texture that is the attribute `name` of meshes, times an image if there is one.
    pub fn add_attribute(&mut self, name: &str, image: Option<TextureId>) -> TextureId {
        self.add_cut_attribute(name, image, None)
    }

    /// Adds a texture as [`Contents::add_attribute`], which is 1 from the value `cut` on, and 0 below it.
    pub fn add_cut_attribute(&mut self, name: &str, image: Option<TextureId>, cut: Option<f32>) -> TextureId {
        let number = index_of(&mut self.attribute_names, name.to_owned());
        let texture = AttributeTexture { attribute: AttributeId(number as u32), image, cut };
        TextureId::of_attribute(index_of(&mut self.attribute_textures, texture))
    }

    /// Returns true if a texture is an image, or the product of an image and an attribute.
    pub fn is_image(&self, texture: TextureId) -> bool {
        let of_attribute = texture.attribute_number().and_then(|number| self.attribute_textures.get(number));
        of_attribute.is_none_or(|texture| texture.image.is_some())
    }

    /// Returns a parameter times the attribute `name` of meshes.
    pub fn times_attribute<T>(&mut self, parameter: Parameter<T>, name: &str) -> Parameter<T> {
        let (image, scale) = match parameter {
            Parameter::Constant(value) => (None, value),
            Parameter::Textured { texture, scale } => (Some(texture), scale),
        };
        Parameter::Textured { texture: self.add_attribute(name, image), scale }
    }
}

/// Returns the index of `item` in `items`, and adds it if it is not among them.
fn index_of<T: PartialEq>(items: &mut Vec<T>, item: T) -> usize {
    items.iter().position(|other| *other == item).unwrap_or_else(|| {
        items.push(item);
        items.len() - 1
    })
}

/// Mesh or group at a place where it is seen.
#[derive(Clone, Debug)]
pub enum SeenPlan {
    /// Number of the mesh.
    Mesh(usize),
    Group {
        /// Number of the group.
        group: usize,
        /// Transform from the group's coordinates, to which the plans of its meshes transform.
        to_world: DMat4,
        /// Name of its meshes here, unless they keep their own.
        name: Option<String>,
    },
}

/// Plan of a mesh to read or tessellate.
#[derive(Clone, Debug)]
pub(crate) struct MeshPlan {
    pub place: Location,
    pub name: String,
    pub geometry: MeshSource,
    pub placement: Placement,
    pub material: MaterialPlan,
    pub emission: Option<Emission>,
}

/// Source of a mesh.
#[derive(Clone, Debug)]
pub enum MeshSource {
    /// File, and the objects and groups to read.
    Obj(PathBuf, PartSelection),
    Ply(PathBuf),
    Stl(PathBuf),
    /// File, and index of the mesh in it.
    Serialized(PathBuf, usize),
    Ready(RawMesh),
    /// Mesh that other plans place, too.
    Shared(Arc<RawMesh>),
}

impl MeshSource {
    /// Returns true if the file of a PLY or STL mesh, to which `from` refers, has colours of vertices or faces.
    pub fn has_colours(&self, from: &Location) -> Result<bool, SceneError> {
        Ok(match self {
            MeshSource::Ply(path) => ply_header::has_colours(&read_file(path, from)?),
            MeshSource::Stl(path) => stl::has_colours(&read_file(path, from)?),
            MeshSource::Obj(..)
            | MeshSource::Serialized(..)
            | MeshSource::Ready(_)
            | MeshSource::Shared(_) => false,
        })
    }
}

/// Material and emission of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Appearance {
    pub material: MaterialId,
    pub emission: Option<Emission>,
}

/// Materials of a mesh.
#[derive(Clone, Debug)]
pub(crate) enum MaterialPlan {
    One(MaterialId),
    /// Materials of the file's groups, and the material of unknown names.
    ByName(NamedAppearances, MaterialId),
}

/// Appearances of the groups of a file by their names.
#[derive(Clone, Debug, Default)]
pub(crate) struct NamedAppearances {
    pub appearances: BTreeMap<String, Appearance>,
    /// Names of groups whose texts in the file hold a comment, too.
    pub names: BTreeMap<String, String>,
}

/// Plan of a texture to read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TexturePlan {
    pub place: Location,
    pub image: TextureSource,
    pub filter: Filter,
    pub wrap: Wrap,
    pub to_uv: Mat3,
}

/// Source of a texture's texels.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureSource {
    File {
        path: PathBuf,
        raw: bool,
    },
    Ready(String, DecodedImage),
    /// Channels of an encoded image.
    Part {
        name: String,
        source: ImageSource,
        channel: Channel,
    },
}

/// Source of an encoded image.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ImageSource {
    File(PathBuf),
    Bytes(Arc<[u8]>),
}

/// Plan of an environment to read.
#[derive(Clone, Debug)]
pub(crate) enum EnvironmentPlan {
    Constant(Rgb),
    Map { place: Location, path: PathBuf, scale: f32, to_world: DMat4 },
    Sky(SkyPlan),
}
