//! Cut for a single point.
//!
//! Papers: Walter et al., *Lightcuts*, 2005, section 3; Herzog et al. 2009, section 3 (one threshold for all
//! trees, relative to their common total) and Eq. 13 (weak singularities, see [`super::clamp`]).
//!
//! Deviations: the error of a cluster is its expected error ([`super::expected`]), not its upper bound. A cluster that
//! gives more than a quarter of the total is always split. Up to sixteen clusters are split per round. The error of a
//! leaf is 0.

mod bound;
mod cut;
#[cfg(test)]
mod exhaustive;
mod gather;
mod offenders;
mod refine;
#[cfg(test)]
mod tests;

pub use cut::{Cut, CutCluster, Lightcut};
#[cfg(test)]
pub use exhaustive::gather_all;
