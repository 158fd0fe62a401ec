//! Shading stage: computes the radiance that points reflect, by lightcuts and reconstruction cuts.
//!
//! - A [`ShadingTask`] is a point and the part of its light to gather. [`patches()`] groups tasks into patches.
//! - A [`Shader`] per thread gathers the light of patches ([`Gatherers`]). A small patch has a cut for each point, or
//!   one cut for up to sixteen points. A larger patch has one cut for sixteen anchors, and reconstruction cuts between
//!   them. Short rays find the light lost by clamping.
//! - [`shade`] shades all patches of a frame in parallel. A [`ShadedImage`] adds the radiance to the pixels that see
//!   the points.

mod bands;
mod context;
mod gatherers;
mod image;
mod patches;
mod shader;

pub use bands::Reflected;
pub use context::{ShadeSettings, ShadingContext, ShadingTask};
pub use gatherers::{Gatherers, Shaded};
pub use image::ShadedImage;
pub use patches::patches;
pub use shader::{ShadedPatch, Shader, ShadingCounts, shade};
