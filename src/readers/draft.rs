//! A scene as its files describe it: world coordinates in f64, not yet repaired or recentred.
//!
//! [`crate::finish`] turns a [`Draft`] into a [`Scene`].

use crate::Location;
use crate::attributes::NamedAttribute;
use crate::local::LocalCoordinates;
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use scene::{AttributeValues, DeltaLight, Emission, MaterialId, PixelFilter, Projection, Scene};

/// Width and height in pixels of films without a size.
pub(crate) const DEFAULT_RESOLUTION: [u32; 2] = [960, 540];

/// A camera in world coordinates; for the fields see [`scene::Camera`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct DraftCamera {
    pub origin: DVec3,
    pub forward: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub tan_half_x: f64,
    pub shift: [f64; 2],
    pub pixel_height: f64,
    pub near: f64,
    pub far: f64,
    pub projection: Projection,
    pub filter: PixelFilter,
}

/// The camera at the origin, looking along -z, with y up.
impl Default for DraftCamera {
    fn default() -> DraftCamera {
        DraftCamera {
            origin: DVec3::ZERO,
            forward: DVec3::NEG_Z,
            right: DVec3::X,
            up: DVec3::Y,
            tan_half_x: 22.5f64.to_radians().tan(),
            shift: [0.0; 2],
            pixel_height: 1.0,
            near: 0.0,
            far: f64::INFINITY,
            projection: Projection::default(),
            filter: PixelFilter::default(),
        }
    }
}

/// Cameras, and their film.
#[derive(Clone, Debug)]
pub(crate) struct Shot {
    pub camera: DraftCamera,
    /// Names of the cameras among which users may choose, in their order; empty names for cameras without one.
    pub names: Vec<String>,
    /// True if the camera has to be moved until it sees all surfaces.
    pub fits: bool,
    pub path: Vec<DraftCamera>,
    pub resolution: [u32; 2],
    /// Offset and size of the part of the film to render, if not all of it.
    pub crop: Option<[[u32; 2]; 2]>,
}

/// A mesh in world coordinates.
#[derive(Clone, Debug, Default)]
pub(crate) struct DraftMesh {
    pub name: String,
    pub positions: Vec<DVec3>,
    /// Normal of each vertex, or empty; may hold zeros or NaN until repaired.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of each vertex, v upwards, or empty.
    pub uvs: Vec<Vec2>,
    /// Tangent of each vertex (see [`scene::Mesh::tangents`]), or empty.
    pub tangents: Vec<Vec4>,
    pub triangles: Vec<[u32; 3]>,
    pub material: MaterialId,
    pub emission: Option<Emission>,
    /// Number of triangles whose winding was reversed to agree with their vertex normals.
    pub turned: usize,
    /// True if the file has no texture coordinates for some triangles.
    pub lacks_uvs: bool,
    pub attributes: Vec<NamedAttribute>,
    /// Number of the group in whose coordinates the mesh is; `None` for world coordinates.
    pub group: Option<usize>,
}

impl DraftMesh {
    /// Drops triangles, with the attributes of their faces. `is_kept` gets all positions and the corners' numbers.
    pub fn retain_triangles(&mut self, mut is_kept: impl FnMut(&[DVec3], &[u32; 3]) -> bool) {
        let (positions, triangles) = (&self.positions, &mut self.triangles);
        let is_of_faces =
            |attribute: &NamedAttribute| matches!(attribute.values, AttributeValues::Triangles(_));
        if !self.attributes.iter().any(is_of_faces) {
            return triangles.retain(|triangle| is_kept(positions, triangle));
        }
        let kept: Vec<bool> = triangles.iter().map(|triangle| is_kept(positions, triangle)).collect();
        keep(triangles, &kept);
        for attribute in &mut self.attributes {
            if let AttributeValues::Triangles(values) = &mut attribute.values {
                keep(values, &kept);
            }
        }
    }
}

/// Keeps the values whose entry of `kept` is true.
fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    values.retain(|_| kept.next().copied().unwrap_or(false));
}

/// Places of meshes that are stored once.
#[derive(Clone, Debug, Default)]
pub(crate) struct DraftGroup {
    /// Transforms to world coordinates.
    pub placements: Vec<DMat4>,
    /// Local coordinates of the group's meshes, once they are known.
    pub coordinates: LocalCoordinates,
}

/// A scene whose positions are still in world coordinates.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Parts that have no position; `meshes` and `lights` in it are empty until recentred.
    pub scene: Scene,
    pub shot: Shot,
    /// Meshes in world coordinates, and then those of groups in their order.
    pub meshes: Vec<DraftMesh>,
    pub groups: Vec<DraftGroup>,
    /// Lights and their world positions; the positions inside the lights are not used.
    pub lights: Vec<(DeltaLight, DVec3)>,
    /// Location of each material's description.
    pub material_places: Vec<Location>,
    /// Names of the attributes that textures look up, by number.
    pub attribute_names: Vec<String>,
}

impl Draft {
    /// Returns the location of the description's main file.
    pub fn main_file(&self) -> Location {
        Location { path: self.scene.sources.first().cloned().unwrap_or_default(), line: None }
    }
}

/// A camera of a list, in world coordinates.
#[derive(Clone, Debug)]
pub(crate) struct DraftView {
    /// Name of the camera or path of the image; may be empty.
    pub name: String,
    /// True if the name is the path of an image.
    pub is_path: bool,
    pub camera: DraftCamera,
    /// Width and height of the film in pixels; `None` for the size of the scene's film.
    pub resolution: Option<[u32; 2]>,
}
