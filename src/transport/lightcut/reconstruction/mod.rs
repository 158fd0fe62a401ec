//! Reconstruction cuts: the cut of a few anchor points of a patch of surface, evaluated at the points between them.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 5 (reconstruction cuts: clusters on whose light and
//! visibility the anchors agree are interpolated, others evaluated); Rehfeld and Dachsbacher, *Lightcut
//! Interpolation*, HPG 2016 (cuts, and per cluster visibility, interpolated from cache records).
//!
//! The anchors share one packet's cut. At interpolated points, only clusters much brighter there than at any anchor are
//! refined. Each cluster is classified once per patch ([`classify`]):
//!
//! | class | clusters | at an interpolated point |
//! |---|---|---|
//! | dropped | all anchors are in their shadow | nothing |
//! | fitted | visible from all anchors, and smooth over the anchors | a linear function ([`fit`]) |
//! | evaluated | large, or visible from some anchors only, or not smooth | transfer, and in most cases a shadow ray |
//! | sampled | small, and visible from some anchors only | the linear function, corrected at random ([`gather`]) |
//!
//! A small evaluated cluster on whose visibility the anchors agree needs no shadow ray.
//!
//! Deviations:
//! - All anchors share one cut, while in the papers each has its own. Points between them need no cut.
//! - A function linear in position is fitted to each cluster's light at all anchors by least squares. The sum of the
//!   fits is evaluated once per point. Walter et al. interpolate each cluster between the nearest anchors.
//! - The light of clusters on which anchors disagree is corrected stochastically. A cluster is evaluated with a
//!   probability in proportion to its error, and its correction is divided by the probability. Walter et al. evaluate
//!   every such cluster.
//! - A correction is capped, so that it cannot become a firefly; this is biased.
//! - As in both papers, light and shadow that reach none of the anchors are missed, for example the light of a small
//!   cluster through a gap.

mod basis;
mod classify;
mod fit;
mod gather;
#[cfg(test)]
mod tests;

use super::packet::{PacketCluster, PacketLight};
use super::{CutCounts, CutSettings, PacketCut, PacketSum, ReceiverPacket, Transfer, Visibility};
use base::math::Rgb;
use classify::{Anchors, Class, EvaluatedCluster, SampledCluster};
use fit::Interpolant;
use gather::Gathering;

/// Cut, classified by the light that its anchors gather from it, and a workspace. Each thread has one, so that buffers
/// are allocated once.
#[derive(Default)]
pub struct ReconstructionCut {
    evaluated: Vec<EvaluatedCluster>,
    sampled: Vec<SampledCluster>,
    interpolant: Interpolant,
    /// Settings of the anchors' cut.
    settings: CutSettings,
    /// Mean luminance of the anchors.
    luminance: f32,
    /// Number of clusters in the anchors' cut.
    size: usize,
    /// Weak singularities at the points that are gathered.
    weak: Vec<PacketCluster>,
    /// Work done so far. A packet's sum counts as one cut per point.
    pub counts: CutCounts,
}

impl ReconstructionCut {
    /// Replaces the cut by the `cut` of `anchors`, which was gathered with `settings`.
    pub fn set(
        &mut self,
        transfer: &Transfer,
        anchors: &ReceiverPacket,
        cut: &PacketCut,
        settings: &CutSettings,
    ) {
        let a = Anchors::new(transfer, anchors, &cut.sum, settings.epsilon);
        self.interpolant.begin(anchors);
        self.evaluated.clear();
        self.sampled.clear();
        (self.settings, self.luminance, self.size) = (*settings, a.luminance, cut.clusters.len());
        for (cluster, unshadowed) in cut.clusters.iter().zip(cut.unshadowed) {
            let node = &transfer.trees.nodes[cluster.node as usize];
            match a.classify(cluster, unshadowed, &self.interpolant) {
                Class::Dropped => {}
                Class::Fitted(fit) => self.interpolant.add(node, &fit),
                Class::Evaluated(evaluated) => self.evaluated.push(evaluated),
                Class::Sampled(sampled) => {
                    self.interpolant.add(node, &sampled.fit);
                    self.sampled.push(sampled);
                }
            }
        }
        // In the order of the tree, systematic sampling spreads the samples over the lights.
        self.sampled.sort_unstable_by_key(|sampled| sampled.node);
    }

    /// Gathers the light of all VPLs at points among the anchors. `start`, in [0, 1), is the random number that chooses
    /// the clusters to correct.
    pub fn gather<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        start: f32,
    ) -> PacketSum {
        let basis = self.interpolant.basis_at(receivers);
        let strong = self.interpolant.reflected(receivers, &basis);
        self.weak.clear();
        let mut gathering = Gathering {
            transfer,
            visibility,
            receivers,
            strong,
            weak: &mut self.weak,
            counts: &mut self.counts,
        };
        gathering.evaluate(&self.evaluated, self.settings.epsilon * self.luminance);
        gathering.correct(&self.sampled, &basis, start, self.luminance);
        let light = PacketLight { strong: gathering.strong, clusters: &self.weak };
        let count = receivers.len() as u64;
        self.counts.cuts += count;
        self.counts.clusters += count * self.size as u64;
        let mut sum = light.sum(transfer, receivers, self.settings.clamp, &mut self.counts);
        sum.radiance.iter_mut().for_each(|radiance| *radiance = radiance.max(Rgb::ZERO));
        sum
    }
}
