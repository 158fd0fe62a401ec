//! One cut for up to sixteen neighbouring points, a vector lane each.
//!
//! Neighbours have nearly the same cut. Sharing it, every bound is evaluated for all points at once, a cluster's
//! data is fetched once, and the shadow rays of one cluster run from neighbouring points to one light: a coherent
//! packet, which traces several times as fast as unrelated rays. A cluster is split if the cubic mean over the lanes
//! of the error to expect, relative to the lane's luminance, is above ε. To split as soon as *any* lane's is would make each
//! lane as accurate as by itself, and more so on average, at the price of a sixth to a third more clusters; with
//! the cubic mean the average is that of single cuts, and no lane's threshold more than 16^(1/3) = 2.5 times ε.
//!
//! Deviations: a lane's luminance counts as at least 1/256 of the brightest lane's where errors are judged, so
//! that one point in the dark does not drive the cut of fifteen in the light to its cap.

pub(super) mod receivers;
pub(super) mod refine;
#[cfg(test)]
mod tests;
pub(super) mod transfer;

pub use receivers::ReceiverPacket;
pub use refine::PacketLightcut;
pub use transfer::PacketVisibility;

/// Points in a group.
pub const LANES: usize = 16;

/// One number for each point.
pub type Lanes = [f32; LANES];

/// A colour for each point, by channel.
pub type RgbLanes = [Lanes; 3];
