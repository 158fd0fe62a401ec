//! Eye samples: what a pixel sees, through mirrors and glass.

mod chain;
mod window;

pub use chain::{ChainCounts, EyeSample, trace};
pub use window::{Window, primary_ray};
