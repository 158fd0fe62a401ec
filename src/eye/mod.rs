//! Eye samples: surfaces visible in a pixel, directly or through mirrors and glass.

mod chain;
mod index;
mod look;
mod pass;
mod points;
mod rays;
mod sharp;

pub use chain::ChainCounts;
pub use index::EyeIndex;
pub use look::{Look, eye_sampler};
pub use pass::EyePass;
pub use points::{PointGeometry, PointSurface, ShadingPoints, VisibilitySamples};
pub use rays::{EyeRays, EyeSettings, VisibleSurfaces};
