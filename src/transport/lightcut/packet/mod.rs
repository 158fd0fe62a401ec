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
mod receivers;
mod refine;
mod sampled;
mod sum;
#[cfg(test)]
mod tests;
mod transfer;

use super::{CutCounts, CutSettings, PacketVisibility, Transfer};
use base::math::{F32x16, LANES, Rgb, Vec3x16};
use refine::{Judgement, Pass};

pub use receivers::ReceiverPacket;
pub(super) use refine::halved;
pub use sampled::{SampledCut, Samples};
pub(super) use sum::{PacketLight, luminances};

/// A cluster of a packet's cut.
#[derive(Clone, Copy)]
pub struct PacketCluster {
    /// Number of the node.
    pub node: u32,
    /// Contribution of a representative of unit intensity to each lane, with visibility.
    pub responses: Vec3x16,
}

/// The light of a cluster of a packet's cut before visibility.
#[derive(Clone, Copy)]
pub struct Unshadowed {
    /// Contribution of a representative of unit intensity to each lane.
    pub responses: Vec3x16,
    /// Lanes that it lights.
    pub lit: u16,
}

/// The light that a packet gathers from a cut.
#[derive(Clone, Copy, Debug)]
pub struct PacketSum {
    /// Radiance that each receiver reflects, or its irradiance; 0 in lanes without a receiver.
    pub radiance: [Rgb; LANES],
    /// Luminance above which indirect leaves were clamped; infinite without clamping.
    pub limits: F32x16,
}

impl Default for PacketSum {
    fn default() -> PacketSum {
        PacketSum { radiance: [Rgb::ZERO; LANES], limits: [f32::INFINITY; LANES] }
    }
}

/// A packet's cut, and the light gathered from it.
pub struct PacketCut<'c> {
    /// The light.
    pub sum: PacketSum,
    /// The clusters.
    pub clusters: &'c [PacketCluster],
    /// Their light before visibility.
    pub unshadowed: &'c [Unshadowed],
}

/// Workspace for cuts of packets; one a thread, so that its buffers are allocated once.
#[derive(Default)]
pub struct PacketLightcut {
    clusters: Vec<PacketCluster>,
    /// Their light before visibility.
    unshadowed: Vec<Unshadowed>,
    /// The clusters' errors and shares of the total.
    judgements: Vec<Judgement>,
    /// Work done so far.
    pub counts: CutCounts,
}

impl PacketLightcut {
    /// An empty workspace.
    pub fn new() -> PacketLightcut {
        PacketLightcut::default()
    }

    /// Gathers the light of all VPLs, on average over the lanes to within the settings' error.
    pub fn gather<V: PacketVisibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        settings: &CutSettings,
    ) -> PacketCut<'_> {
        let capped = Pass::new(self, transfer, visibility, receivers, settings).run();
        let count = receivers.len() as u64;
        self.counts.cuts += count;
        self.counts.clusters += count * self.clusters.len() as u64;
        self.counts.capped += count * u64::from(capped);
        let light = PacketLight { clusters: &self.clusters, strong: Vec3x16::ZERO };
        let sum = light.sum(transfer.trees, receivers, settings.clamp, &mut self.counts);
        PacketCut { sum, clusters: &self.clusters, unshadowed: &self.unshadowed }
    }
}
