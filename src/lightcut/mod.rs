//! Stage 3: a cut through the light trees per point, refined until every cluster's expected error is below the threshold.
//!
//! Paper: Walter et al., *Lightcuts: A Scalable Approach to Illumination*, 2005.
//!
//! A [`Receiver`] says what is gathered (reflected radiance, irradiance), [`Transfer`] what reaches it from a VPL
//! and at most from a cluster, [`expected`] how far a cluster is likely to be off, [`Lightcut`] finds the cut, [`gather_all`] is the exact sum that it approximates.

mod coherence;
pub mod expected;
#[cfg(test)]
mod fixtures;
pub mod packet;
mod receiver;
pub mod reconstruction;
mod shadow_rays;
pub mod single;
mod transfer;
mod visibility;

pub use coherence::{CoherenceLimit, MIN_SHARED, group_coherent};
pub use packet::{PacketLightcut, PacketVisibility, ReceiverPacket};
pub use receiver::Receiver;
pub use reconstruction::ReconstructionCut;
pub use shadow_rays::{to_vpl, to_vpl16};
pub use single::{CutCounts, CutEntry, CutSettings, Lightcut, OffsetBox, gather_all, max_cos_to_cone};
pub use transfer::{Bound, Transfer, Unoccluded, Visibility};
