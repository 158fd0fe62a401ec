//! The lights of a scene: virtual point lights (VPLs), trees over them, and their intensities by region.
//!
//! - [`light_pass`] makes VPLs of emitters and of photon paths ([`crate::emission`]);
//! - [`LightTrees`] cluster them; [`Intensities`] tell how bright indirect VPLs are around a point;
//! - [`Lights`] holds all of it for a scene.

mod direct;
#[cfg(test)]
mod image_tests;
mod indirect;
mod intensities;
mod octahedral;
mod origin;
mod profile;
mod scene_lights;
mod settings;
#[cfg(test)]
mod tests;
pub mod tree;
mod vpl;

pub use intensities::{Intensities, IntensitySamples};
pub use origin::{DirectIndirect, Origin};
pub use profile::{LobeProfile, Profiles, SpotProfile};
pub use scene_lights::{LightPass, Lights, LightsWanted, light_pass};
pub use settings::LightPassSettings;
pub use tree::{LightNode, LightTrees, MAX_VPLS};
pub use vpl::{MIN_DISTANCE, Vpl, VplKind, VplSet, min_dist_sq, near_sq_of_size, size_of_area};
