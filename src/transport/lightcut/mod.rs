//! Lightcuts: a cut through the light trees for a point, refined until every cluster's expected error is below the
//! threshold.
//!
//! Paper: Walter et al., *Lightcuts: A Scalable Approach to Illumination*, 2005.
//!
//! A [`Receiver`] defines the quantity that is gathered (reflected radiance or irradiance), [`Transfer`] the
//! contribution of one VPL, and [`expected`] the expected error of a cluster. Three workspaces gather the light of all
//! VPLs:
//!
//! - [`Lightcut`] at a point, or at up to sixteen neighbours, which share a cut ([`packet`]);
//! - [`ReconstructionCut`] at points between such neighbours ([`reconstruction`]);
//! - [`SampledCut`] at up to sixteen points, by samples of a coarse cut.
//!
//! `gather_all` is the exact sum that they approximate.

mod clamp;
mod coherence;
pub mod expected;
#[cfg(test)]
pub(crate) mod fixtures;
pub mod packet;
mod receiver;
pub mod reconstruction;
mod settings;
#[cfg(test)]
mod tests;
mod transfer;
mod visibility;

pub use clamp::{MAX_STEPS, frozen_luminance};
pub use coherence::{CoherenceLimit, OrientedPoint, group_coherent, group_compact};
#[cfg(test)]
pub use fixtures::gather_all;
pub use packet::{
    Clamps, Lightcut, PacketCluster, PacketCut, PacketSum, ReceiverPacket, SampledCut, SampledSettings,
    Samples,
};
pub use receiver::Receiver;
pub use reconstruction::ReconstructionCut;
pub use settings::{CutCounts, CutSettings};
pub use transfer::Transfer;
pub use visibility::{Visibility, to_vpl};
