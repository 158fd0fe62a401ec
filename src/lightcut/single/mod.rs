//! A cut for a single point.

mod exhaustive;
mod geometry;
mod refine;
#[cfg(test)]
mod tests;

pub use exhaustive::gather_all;
pub use geometry::{OffsetBox, max_cos_to_cone};
pub(super) use refine::DOMINANT;
pub use refine::{CutCounts, CutEntry, CutSettings, Lightcut};
