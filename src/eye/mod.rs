//! Eye samples: what a pixel sees, through mirrors and glass.

mod chain;
mod index;
mod look;
mod samples;
mod sharing;
mod sharp;

pub use chain::{ChainCounts, EyeSample, trace};
pub use index::{Bounds, EyeIndex};
pub use look::{Look, eye_sampler};
pub use samples::{EyePoint, EyeSamples, EyeSettings, EyeSurface};
pub use sharing::Sharing;
