//! A parsed scene description, before any mesh or picture is opened; [`ScenePlan::realise`] opens them all.
//!
//! Both readers end in a [`ScenePlan`]. Files are read in parallel, each once; results are in the order of the
//! description, and so are errors.

use crate::budget::TriangleBudget;
use crate::draft::Shot;
use crate::error::{Location, SceneError};
use crate::mesh::{Placement, RawMesh};
use crate::picture::{Channel, DecodedImage};
use crate::selection::PartSelection;
use crate::sky::SkyPlan;
use base::math::Rgb;
use glam::{DMat4, DVec3, Mat3};
use scene::{DeltaLight, DistantDisc, Emission, Filter, Material, MaterialId, TextureId, Wrap};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The whole content of a scene description.
#[derive(Clone, Debug)]
pub struct ScenePlan {
    pub name: String,
    /// The description's own files, main file first, with the hash of their bytes.
    pub sources: Vec<(PathBuf, u64)>,
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
    pub material_places: Vec<Location>,
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
            MeshSource::Ready(raw) => raw.triangles.len(),
            MeshSource::Shared(raw) => raw.triangles.len(),
            // Counted when they are read.
            MeshSource::Obj(..) | MeshSource::Ply(_) | MeshSource::Serialized(..) => 0,
        };
        self.budget.take(triangles, &plan.place)?;
        self.meshes.push(plan);
        Ok(())
    }

    /// Adds a material that is described at `place`.
    pub fn add_material(&mut self, material: Material, place: Location) -> MaterialId {
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
    /// File, and the objects and groups of it that are asked for.
    Obj(PathBuf, PartSelection),
    Ply(PathBuf),
    /// File and index of the mesh in it.
    Serialized(PathBuf, usize),
    Ready(RawMesh),
    /// One that other plans place as well.
    Shared(Arc<RawMesh>),
}

/// Light and look of surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Appearance {
    pub material: MaterialId,
    pub emission: Option<Emission>,
}

/// Choice of a mesh's materials.
#[derive(Clone, Debug)]
pub(crate) enum MaterialPlan {
    One(MaterialId),
    /// Materials by the file's own names, and the one for unknown names.
    ByName(BTreeMap<String, Appearance>, MaterialId),
}

/// A texture to be read.
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
    /// A channel of a picture, or its colour.
    Part {
        name: String,
        source: ImageSource,
        channel: Channel,
    },
}

/// Encoded picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ImageSource {
    File(PathBuf),
    Bytes(Arc<[u8]>),
}

/// An environment to be read.
#[derive(Clone, Debug)]
pub(crate) enum EnvironmentPlan {
    Constant(Rgb),
    Map { place: Location, path: PathBuf, scale: f32, to_world: DMat4 },
    Sky(SkyPlan),
}
