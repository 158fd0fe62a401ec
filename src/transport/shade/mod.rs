//! The shading stage: from points whose reflected radiance is wanted to that radiance, by lightcuts and
//! reconstruction cuts.
//!
//! A [`ShadingTask`] names a point and the part of its light that is wanted. Tasks are grouped into patches
//! that are shaded together ([`patches()`]); a [`Shader`], one a thread, gathers the light of one patch after
//! the other ([`Gatherers`]): a cut for each point if the patch is small, one for up to sixteen, else one for
//! sixteen anchors and reconstruction cuts between them; and short rays find again the light that clamping
//! takes. [`shade`] does so for all patches of a frame in parallel, and a [`Picture`] adds the radiance to
//! the pixels that see the points.

mod context;
mod frame;
mod gatherers;
mod patches;
mod picture;
mod shader;

pub use context::{ShadeSettings, ShadingContext, ShadingTask};
pub use frame::shade;
pub use gatherers::{Gatherers, Shaded};
pub use patches::patches;
pub use picture::Picture;
pub use shader::{Shader, ShadingCounts};
