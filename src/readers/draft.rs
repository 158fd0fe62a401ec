//! A scene as described by its files: world coordinates in f64, not yet sanitised or recentred.
//!
//! Every reader ends in a [`Draft`]; [`super::sanitize`] and [`super::recentre`] make the
//! [`Scene`](super::Scene) of it.

use crate::Place;
use glam::{DVec3, Vec2, Vec3};
use scene::{
    DeltaLight, DistantDisc, Emission, Environment, Material, MaterialId, PixelFilter, Projection, Texture,
};
use std::path::PathBuf;

/// Film of scenes that name no size, in pixels.
pub(crate) const DEFAULT_RESOLUTION: [u32; 2] = [960, 540];

/// A camera in world coordinates; fields as in [`super::Camera`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct DraftCamera {
    pub origin: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub tan_half_x: f64,
    pub near: f64,
    pub far: f64,
    pub projection: Projection,
    pub filter: PixelFilter,
}

/// At the origin, looking along -z with y up.
impl Default for DraftCamera {
    fn default() -> DraftCamera {
        DraftCamera {
            origin: DVec3::ZERO,
            forward: DVec3::NEG_Z,
            right: DVec3::X,
            up: DVec3::Y,
            tan_half_x: 22.5f64.to_radians().tan(),
            near: 0.0,
            far: f64::INFINITY,
            projection: Projection::default(),
            filter: PixelFilter::default(),
        }
    }
}

/// Cameras, and the size of their film.
#[derive(Clone, Debug)]
pub(crate) struct Shot {
    pub camera: DraftCamera,
    /// True if the camera is to be moved so that it sees all surfaces.
    pub fits: bool,
    pub path: Vec<DraftCamera>,
    pub resolution: [u32; 2],
    /// Offset and size of the only part of the film that is wanted.
    pub crop: Option<[[u32; 2]; 2]>,
}

/// A mesh in world coordinates.
#[derive(Clone, Debug, Default)]
pub(crate) struct DraftMesh {
    pub name: String,
    pub positions: Vec<DVec3>,
    /// Normals by vertex, or empty; may hold zeros or NaN until sanitised.
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex, v up, or empty.
    pub uvs: Vec<Vec2>,
    pub triangles: Vec<[u32; 3]>,
    pub material: MaterialId,
    pub emission: Option<Emission>,
    /// Number of triangles whose winding was reversed to agree with their vertex normals.
    pub turned: usize,
}

/// A scene in world coordinates.
#[derive(Clone, Debug)]
pub struct Draft {
    pub name: String,
    pub sources: Vec<PathBuf>,
    pub shot: Shot,
    pub max_depth: Option<u32>,
    pub hides_emitters: bool,
    pub meshes: Vec<DraftMesh>,
    pub materials: Vec<Material>,
    /// Place in the files where each material is described.
    pub material_places: Vec<Place>,
    pub textures: Vec<Texture>,
    /// Lights with their world positions, which replace the positions inside.
    pub lights: Vec<(DeltaLight, DVec3)>,
    pub environment: Option<Environment>,
    pub discs: Vec<DistantDisc>,
}
