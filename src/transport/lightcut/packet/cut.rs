//! The cut of a packet, the light gathered from it, and the workspace that holds both.

use super::Clamps;
use crate::lightcut::CutCounts;
use base::math::{F32x16, LANES, Rgb, Vec3x16};

/// Cluster of a packet's cut.
#[derive(Clone, Copy)]
pub struct PacketCluster {
    /// Index of the node.
    pub node: u32,
    /// Contribution of a representative of unit intensity to each lane, with visibility.
    pub responses: Vec3x16,
}

/// Light of a cluster of a packet's cut, before visibility.
#[derive(Clone, Copy)]
pub struct Unshadowed {
    /// Contribution of a representative of unit intensity to each lane.
    pub responses: Vec3x16,
    /// Lanes that the representative lights.
    pub lit: u16,
}

/// Light that a packet gathers from a cut.
#[derive(Clone, Copy, Debug)]
pub struct PacketSum {
    /// Radiance that each receiver reflects, or irradiance; 0 in lanes without a receiver.
    pub radiance: [Rgb; LANES],
    /// Limits of indirect leaves.
    pub clamps: Clamps,
}

impl Default for PacketSum {
    fn default() -> PacketSum {
        PacketSum { radiance: [Rgb::ZERO; LANES], clamps: Clamps::default() }
    }
}

/// Cut of a packet, and the light gathered from it.
pub struct PacketCut<'c> {
    /// The light.
    pub sum: PacketSum,
    /// The clusters.
    pub clusters: &'c [PacketCluster],
    /// Light of the clusters before visibility.
    pub unshadowed: &'c [Unshadowed],
}

/// Workspace for cuts of packets. Each thread has one, so that buffers are allocated once.
#[derive(Default)]
pub struct Lightcut {
    pub(super) clusters: Vec<PacketCluster>,
    /// Light of the clusters before visibility.
    pub(super) unshadowed: Vec<Unshadowed>,
    /// Errors and luminances of the clusters.
    pub(super) judgements: Vec<Judgement>,
    /// Work done so far.
    pub counts: CutCounts,
}

/// State of a cluster in the refinement.
#[derive(Clone, Copy)]
pub(super) struct Judgement {
    /// Expected error in each lane, as luminance; 0 for a leaf.
    pub(super) errors: F32x16,
    /// Luminance with which the cluster counts in the running totals.
    pub(super) counted: F32x16,
    /// Visibility of the representative, or of an ancestor's.
    pub(super) sight: Sight,
}

/// Visibility from each lane.
#[derive(Clone, Copy, Default)]
pub(super) struct Sight {
    /// Lanes in which visibility is known.
    pub(super) known: u16,
    /// Lanes that see the representative.
    pub(super) seen: u16,
}
