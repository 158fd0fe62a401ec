//! Light that a packet gathers from a cut.

use super::refine::PacketRefinement;
use super::{Lightcut, PacketCut, PacketLight, ReceiverPacket};
use crate::lightcut::{CutSettings, Transfer, Visibility};
use base::math::Vec3x16;

impl Lightcut {
    /// Creates an empty workspace.
    pub fn new() -> Lightcut {
        Lightcut::default()
    }

    /// Gathers the light of all VPLs to within the error of `settings`, on average over the lanes.
    pub fn gather<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        settings: &CutSettings,
    ) -> PacketCut<'_> {
        let capped = PacketRefinement::new(self, transfer, visibility, receivers, settings).run();
        let count = receivers.len() as u64;
        self.counts.cuts += count;
        self.counts.clusters += count * self.clusters.len() as u64;
        self.counts.capped += count * u64::from(capped);
        let light = PacketLight { clusters: &self.clusters, strong: Vec3x16::ZERO };
        let sum = light.sum(transfer, receivers, settings.clamp, &mut self.counts);
        PacketCut { sum, clusters: &self.clusters, unshadowed: &self.unshadowed }
    }
}
