//! One cut for a packet of up to sixteen neighbouring points, a vector lane each.
//!
//! Neighbours have nearly the same cut. Sharing it, every bound is evaluated for all points at once, a
//! cluster's data is fetched once, and the shadow rays of one cluster run from neighbouring points to one
//! light: a coherent packet, which traces several times as fast as unrelated rays. A cluster is split if the
//! cubic mean over the lanes of the error to expect, relative to the lane's luminance, is above ε. To split
//! as soon as *any* lane's is would make each lane as accurate as by itself, and more so on average, at the
//! price of a sixth to a third more clusters; with the cubic mean the average is that of single cuts, and no
//! lane's threshold more than 16^(1/3) = 2.5 times ε.
//!
//! Lanes that are far apart make the common cut up to three times as large as each one's own. A lane for which a
//! cluster was fine enough by itself needs no shadow rays to its descendants: they are seen where the cluster's
//! representative is, as in a cut of the lane's own. Half as many rays remain, no more than such cuts have.
//!
//! Deviations: a lane's luminance counts as at least 1/256 of the brightest lane's where errors are judged,
//! so that one point in the dark does not drive the cut of fifteen in the light to its cap.

mod bound;
mod cut;
mod gather;
mod receivers;
mod refine;
mod sampled;
mod sum;
#[cfg(test)]
mod tests;
mod transfer;

pub use cut::{PacketCluster, PacketCut, PacketLightcut, PacketSum, Unshadowed};
pub use receivers::ReceiverPacket;
pub(super) use refine::halved;
pub use sampled::{SampledCut, Samples};
pub(super) use sum::{PacketLight, luminances};
