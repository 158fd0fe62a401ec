//! The scene model: plain data, repaired and recentred, as the crate `readers` returns it.
//!
//! Units: lengths are in the scene file's unit times [`Scene::unit`]; radiance is in W/(sr m²), linear Rec. 709.
//!
//! Positions are relative to [`Scene::centre`], which is in f64. So a scene far from its origin keeps its precision.

#![forbid(unsafe_code)]

mod attribute;
mod camera;
mod light;
mod material;
mod mesh;
mod parameter;
mod pixel_filter;
mod placed;
mod principled;
mod projector;
pub mod requirements;
mod statistics;
pub mod texture;

use glam::DVec3;
use std::path::PathBuf;

pub use attribute::{Attribute, AttributeId, AttributeValues, interpolated};
pub use camera::{Camera, Cameras, MAX_FRAMES, MAX_SIDE, Projection};
pub use light::{DeltaLight, DistantDisc, Environment, EnvironmentMap, SpotImage};
pub use material::{Blend, Coat, Distribution, Fresnel, Lobe, Material, MaterialId, Relief, ReliefRules};
pub use mesh::{Emission, Group, Mesh};
pub use parameter::{Parameter, Reflectance, Roughness, Share};
pub use pixel_filter::PixelFilter;
pub use principled::{Diffuse, Principled, Stretch, eta_of_specular};
pub use projector::{FovAxis, Projector};
pub use requirements::Requirements;
pub use texture::{AttributeTexture, Filter, Texels, Texture, TextureId, Textures, Wrap};

/// Maximum ratio of a scene's diagonal to its vicinity, the distance from the camera that contains a tenth of the
/// corners.
pub const MAX_RATIO: f64 = 1e3;

/// A scene, ready for the acceleration structure. The default is empty.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name for reports and file metadata.
    pub name: String,
    /// Files of the scene, main file first; the scene hash covers their bytes.
    pub sources: Vec<PathBuf>,
    /// Maximum path length in edges counted from the eye (1 = visible emitters only, 2 = direct light). `None` leaves
    /// termination to Russian roulette.
    pub max_depth: Option<u32>,
    /// True if the camera does not see emitters and the environment directly.
    pub hides_emitters: bool,
    /// True if the camera does not see the environment directly: the background is transparent.
    pub hides_background: bool,
    /// Triangle meshes: first those in the scene's coordinates, then the members of groups.
    pub meshes: Vec<Mesh>,
    /// Groups of meshes that are seen at several places. Their members are the last meshes, in order.
    pub groups: Vec<Group>,
    /// Materials, indexed by [`MaterialId`].
    pub materials: Vec<Material>,
    /// Textures, indexed by [`TextureId`].
    pub textures: Textures,
    /// Point, spot and directional lights, and projectors.
    pub lights: Vec<DeltaLight>,
    /// Light from infinitely far, in all directions.
    pub environment: Option<Environment>,
    /// Distant discs in front of the environment, such as the sun.
    pub discs: Vec<DistantDisc>,
    /// World position of the local origin.
    pub centre: DVec3,
    /// Binary logarithm of the local unit of length in the file's unit; 0 except for very small and very large scenes.
    pub exponent: i32,
    /// Distance from the camera that contains a tenth of all corners, if the scene is more than [`MAX_RATIO`] times
    /// larger; else 0.
    pub vicinity: f32,
}

impl Scene {
    /// Returns the local unit of length in the file's unit.
    pub fn unit(&self) -> f64 {
        f64::from(self.exponent).exp2()
    }

    /// Returns the scene extent for length-based tolerances: `diagonal`, limited to [`MAX_RATIO`] times the vicinity if
    /// there is one.
    pub fn extent(&self, diagonal: f32) -> f32 {
        if self.vicinity > 0.0 { diagonal.min(self.vicinity * MAX_RATIO as f32) } else { diagonal }
    }

    /// Returns the maximum path length in edges: `wanted` if set, else the scene's own, else no limit.
    pub fn path_limit(&self, wanted: Option<u32>) -> u32 {
        wanted.or(self.max_depth).unwrap_or(u32::MAX)
    }

    /// Returns the number of triangles of all stored meshes.
    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
    }

    /// True if the scene has no light.
    pub fn is_dark(&self) -> bool {
        let emits = self.meshes.iter().any(|mesh| mesh.emission.is_some());
        !emits && self.lights.is_empty() && self.environment.is_none() && self.discs.is_empty()
    }

    /// True if there are point, spot or directional lights, or discs as small as the sun.
    ///
    /// Eye paths rarely find the light that mirrors and glass focus from such lights.
    pub fn has_small_lights(&self) -> bool {
        // Half angle in radians up to which a disc is small.
        const SMALL_HALF_ANGLE: f32 = 0.05;
        !self.lights.is_empty() || self.discs.iter().any(|disc| disc.half_angle < SMALL_HALF_ANGLE)
    }

    /// True if solid glass may focus the light of such lights.
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
