//! The scene model: plain data, sanitised and recentred, as the crate `readers` returns it.
//!
//! Units: lengths are the scene file's, but for the factor [`Scene::unit`]; radiance W/(sr m²) in linear Rec. 709; all
//! positions are relative to [`Scene::centre`], which is kept in f64 so that a scene far from its origin keeps its
//! precision.

#![forbid(unsafe_code)]

mod camera;
mod light;
mod material;
mod mesh;
mod pixel_filter;
mod principled;
mod relief;
pub mod requirements;
mod texels;
mod texture;

use glam::DVec3;
use std::path::PathBuf;

pub use camera::{Camera, Cameras, MAX_FRAMES, MAX_SIDE, Projection};
pub use light::{DeltaLight, DistantDisc, Environment, EnvironmentMap};
pub use material::{
    Blend, Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Parameter, Reflectance, Roughness, Share,
};
pub use mesh::{Emission, Mesh};
pub use pixel_filter::PixelFilter;
pub use principled::{Principled, eta_of_specular};
pub use relief::Relief;
pub use requirements::Requirements;
pub use texels::Texels;
pub use texture::{Filter, Texture, TextureId, Wrap};

/// Maximum ratio of a scene's diagonal to the distance within which its camera has a tenth of it.
pub const MAX_RATIO: f64 = 1e3;

/// A scene, ready for the acceleration structure. The default is an empty one.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name for reports and file metadata.
    pub name: String,
    /// Files the scene was read from, main file first; the scene hash covers their bytes.
    pub sources: Vec<PathBuf>,
    /// Maximum path length in edges counted from the eye (1 = emitters in view only, 2 = direct light);
    /// `None` leaves termination to Russian roulette.
    pub max_depth: Option<u32>,
    /// True if the camera does not see emitters, nor the environment, but by way of other surfaces.
    pub hides_emitters: bool,
    /// Triangle meshes; a mesh's index is its geometry id.
    pub meshes: Vec<Mesh>,
    /// Materials, indexed by [`MaterialId`].
    pub materials: Vec<Material>,
    /// Textures, indexed by [`TextureId`].
    pub textures: Vec<Texture>,
    /// Point, spot and directional lights.
    pub lights: Vec<DeltaLight>,
    /// Light from infinitely far in every direction.
    pub environment: Option<Environment>,
    /// Discs before it, such as the sun.
    pub discs: Vec<DistantDisc>,
    /// World position of the local origin.
    pub centre: DVec3,
    /// The local unit of length is two to this power in the file's; 0 but for very small and very large scenes.
    pub exponent: i32,
    /// Distance from the camera within which it has a tenth of all triangles' corners, where everything reaches very
    /// much farther; else 0.
    pub vicinity: f32,
}

impl Scene {
    /// Local unit of length, in the file's.
    pub fn unit(&self) -> f64 {
        f64::from(self.exponent).exp2()
    }

    /// Diagonal of what lengths derive from, where that of all surfaces is `diagonal`: where these reach very far
    /// beyond what is around the camera, a thousand times the distance of that.
    pub fn extent(&self, diagonal: f32) -> f32 {
        if self.vicinity > 0.0 { diagonal.min(self.vicinity * MAX_RATIO as f32) } else { diagonal }
    }

    /// Maximum path length in edges: `wanted` if set, else the scene's own, else no limit.
    pub fn path_limit(&self, wanted: Option<u32>) -> u32 {
        wanted.or(self.max_depth).unwrap_or(u32::MAX)
    }

    /// Number of triangles of all meshes.
    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
    }

    /// True if nothing in the scene gives light.
    pub fn is_dark(&self) -> bool {
        let emits = self.meshes.iter().any(|mesh| mesh.emission.is_some());
        !emits && self.lights.is_empty() && self.environment.is_none() && self.discs.is_empty()
    }

    /// True if there are lights of points and directions, or discs as small as the sun: paths from the eye hardly find
    /// the light that mirrors and glass throw from these onto surfaces.
    pub fn has_small_lights(&self) -> bool {
        const SMALL: f32 = 0.05;
        !self.lights.is_empty() || self.discs.iter().any(|disc| disc.half_angle < SMALL)
    }

    /// True if such light may come to surfaces through solid glass.
    pub fn focuses_lights(&self) -> bool {
        self.has_small_lights() && self.has_solid_glass()
    }

    fn has_solid_glass(&self) -> bool {
        let is_solid = |lobe: &Lobe| match *lobe {
            Lobe::Dielectric { eta, thin, .. } => !thin && eta != 1.0,
            _ => false,
        };
        let material = |mesh: &Mesh| self.materials.get(mesh.material.0 as usize);
        let mut lobes =
            self.meshes.iter().filter_map(material).flat_map(Material::parts).flat_map(|part| &part.lobes);
        lobes.any(is_solid)
    }
}
