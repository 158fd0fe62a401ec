//! One cut for a packet of up to sixteen neighbouring points, with one vector lane per point. A packet may hold a
//! single point.
//!
//! Papers: Walter et al., *Lightcuts*, 2005, section 3; Herzog et al. 2009, section 3 (one threshold for all trees,
//! relative to their common total) and Eq. 13 (weak singularities, see [`super::clamp`]).
//!
//! Neighbours have nearly equal cuts. If they share one, bounds are evaluated for all points at once, and a cluster's
//! data is fetched once. The shadow rays of a cluster run from neighbouring points to one light: a coherent packet,
//! which traces several times as fast as unrelated rays. A cluster is split if the cubic mean over the lanes of its
//! expected error, relative to the lane's luminance, is above ε. With the cubic mean, the average error is that of
//! cuts of single points, and no lane's threshold is more than 16^(1/3) = 2.5 times ε.
//!
//! If lanes are far apart, the common cut is larger than a single point's. Once a cluster is fine enough for a lane,
//! the lane traces no shadow rays to its descendants: they count as visible if the cluster's representative is, as in a
//! cut of the lane's own.
//!
//! Deviations: the error of a cluster is its expected error ([`super::expected`]), not its upper bound; the error of a
//! leaf is 0. A cluster that gives more than a quarter of the total is always split. Where errors are judged, a lane's
//! luminance counts as at least 1/256 of the brightest lane's. Otherwise one point in the dark would drive the cut of
//! fifteen lit points to its cap.

mod bound;
mod clamps;
mod cluster_box;
mod cut;
mod gather;
#[cfg(test)]
mod point_tests;
mod receivers;
mod refine;
mod sampled;
mod sum;
#[cfg(test)]
mod tests;
mod transfer;

pub use clamps::Clamps;
pub use cut::{Lightcut, PacketCluster, PacketCut, PacketSum, Unshadowed};
pub use receivers::ReceiverPacket;
pub(super) use refine::halved;
pub use sampled::{SampledCut, SampledSettings, Samples};
pub(super) use sum::PacketLight;
pub(super) use transfer::luminances;
