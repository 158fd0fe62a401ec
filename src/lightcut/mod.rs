//! Stage 3: a cut through the light trees per point, refined until every cluster's expected error is below the threshold.
//!
//! Paper: Walter et al., *Lightcuts: A Scalable Approach to Illumination*, 2005.
//!
//! A [`Reflector`] says what is gathered (reflected radiance, irradiance), [`Transfer`] what reaches it from a VPL
//! and at most from a cluster, [`expected`] how far a cluster is likely to be off, [`Lightcut`] finds the cut, [`gather_all`] is the exact sum that it approximates.

mod exhaustive;
pub mod expected;
mod geometry;
pub mod group;
mod receiver;
mod refine;
mod shadow_rays;
mod transfer;
mod visibility;

#[cfg(test)]
mod tests;

pub use exhaustive::gather_all;
pub use geometry::{OffsetBox, max_cos_to_cone};
pub use receiver::Reflector;
pub use refine::{CutCounts, CutEntry, CutSettings, Lightcut};
pub use shadow_rays::{to_vpl, to_vpl16};
pub use transfer::{Bound, Transfer, Unoccluded, Visibility};
