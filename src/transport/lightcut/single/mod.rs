//! A cut for a single point.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 3; Herzog et al. 2009, section 3 (one threshold for all
//! trees, relative to their common total) and Eq. 13 (weak singularities, see [`super::clamp`]).
//!
//! Deviations: the error of a cluster is not its upper bound but the one to expect under that bound (see
//! [`super::expected`]), except that a cluster that gives more than a quarter of the total is always split;
//! up to sixteen clusters are split a round; a leaf's error is 0, so it never waits to be split.

mod bound;
mod cut;
#[cfg(test)]
mod exhaustive;
mod gather;
mod geometry;
mod offenders;
mod refine;
#[cfg(test)]
mod tests;

pub use cut::{Cut, CutCluster, Lightcut};
#[cfg(test)]
pub use exhaustive::gather_all;
pub use geometry::{OffsetBox, max_cos_to_cone, max_cos_to_cone_signed};
