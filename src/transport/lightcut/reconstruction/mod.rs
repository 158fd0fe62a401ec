//! Reconstruction cuts: the cut of a few anchor points of a patch of surface, evaluated at the points in
//! between.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 5 (reconstruction cuts: clusters on whose light and
//! visibility the anchors agree are interpolated, others evaluated); cf. Rehfeld and Dachsbacher, *Lightcut
//! Interpolation*, HPG 2016 (cuts, and per cluster visibility, interpolated from cache records).
//!
//! The anchors share one packet's cut, which is not refined again for the interpolated points, except for
//! clusters much brighter at such a point than at any anchor. Each of its clusters is classified once for the
//! patch ([`classify`]):
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
//! - One cut for all anchors, where the papers have one each: points in between have no cut to be
//!   interpolated or traversed.
//! - A function linear in position is fitted to each cluster's light at all anchors by least squares, and the
//!   sum of the fits is evaluated once a point; Walter et al. interpolate each cluster between the nearest
//!   anchors.
//! - The light of clusters that anchors disagree about is corrected stochastically: one is evaluated with a
//!   probability in proportion to its error, and the error found is divided by the probability, so that the
//!   radiance is right on average. Walter et al. evaluate every such cluster.
//! - A correction is capped, which is biased, lest it be visible as a firefly.
//! - As in both papers, light and shadow that reach none of the anchors are missed: those of a small cluster
//!   through a gap, for example.

mod basis;
mod classify;
mod fit;
mod gather;
#[cfg(test)]
mod tests;

use super::packet::{PacketCluster, PacketLight};
use super::{CutCounts, CutSettings, PacketCut, PacketSum, PacketVisibility, ReceiverPacket, Transfer};
use base::math::Rgb;
use classify::{Anchors, Class, Evaluated, Sampled};
use fit::Interpolant;
use gather::Gathering;

/// A cut, classified by the light that its anchors gather from it, and a workspace for its use; one a thread,
/// so that its buffers are allocated once.
#[derive(Default)]
pub struct ReconstructionCut {
    evaluated: Vec<Evaluated>,
    sampled: Vec<Sampled>,
    interpolant: Interpolant,
    /// Settings of the anchors' cut.
    settings: CutSettings,
    /// Mean luminance of the anchors.
    luminance: f32,
    /// Clusters in the anchors' cut.
    size: usize,
    /// Weak singularities at the points in question.
    weak: Vec<PacketCluster>,
    /// Work done so far; a packet's sum counts as a cut for each of its points.
    pub counts: CutCounts,
}

impl ReconstructionCut {
    /// Replaces the cut by that of `anchors`, found with `settings`.
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
        // Neighbours in the tree are drawn in turn, so that the draws are spread over the lights.
        self.sampled.sort_unstable_by_key(|sampled| sampled.node);
    }

    /// Gathers the light of all VPLs at points among the anchors; `start` (in [0, 1)) is the random number that
    /// chooses the clusters to be corrected.
    pub fn gather<V: PacketVisibility>(
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
        let mut sum = light.sum(transfer.trees, receivers, self.settings.clamp, &mut self.counts);
        sum.radiance.iter_mut().for_each(|radiance| *radiance = radiance.max(Rgb::ZERO));
        sum
    }
}
