//! Eye samples: what a pixel sees, through mirrors and glass.

mod chain;
mod index;
mod samples;
mod window;

pub use chain::{ChainCounts, EyeSample, trace};
pub use index::{Bounds, EyeIndex};
pub use samples::{EyePoint, EyeSamples, EyeSettings, EyeSurface};
pub use window::{Window, primary_ray};
