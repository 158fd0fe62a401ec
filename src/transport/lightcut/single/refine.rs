//! Refinement of a single point's cut: starts from the roots, and splits the clusters with the largest expected errors
//! until none is above the threshold.

use super::{CutCluster, Lightcut};
use crate::lightcut::clamp::{DOMINANT, DOMINANT_TO_REST, is_weak};
use crate::lightcut::refinement::heir_and_other;
use crate::lightcut::{CutSettings, Receiver, Transfer, Visibility};
use crate::lights::LightTrees;
use base::math::{Rgb, luminance};

/// Number of clusters split before the threshold is updated.
const BATCH: usize = 16;

/// Refinement of one cut.
pub(super) struct PointRefinement<'a, 't, 'm, V> {
    pub trees: &'a LightTrees,
    pub transfer: &'a Transfer<'t>,
    pub visibility: &'a V,
    pub receiver: &'a Receiver<'m>,
    pub settings: &'a CutSettings,
    /// Luminance of the cut, with limited weak singularities.
    pub total: f64,
    pub cut: &'a mut Lightcut,
}

impl<V: Visibility> PointRefinement<'_, '_, '_, V> {
    /// Refines the cut.
    pub fn run(mut self) {
        self.start();
        while self.choose() {
            for i in 0..self.cut.batch.len() {
                self.split(self.cut.batch[i] as usize);
            }
        }
    }

    fn start(&mut self) {
        self.cut.clusters.clear();
        self.cut.offenders.clear();
        self.total = f64::from(self.receiver.baseline_luminance());
        for root in self.trees.roots_of(self.settings.origin) {
            let response = self.representative_response(root);
            let cluster = self.cluster(root, response, f64::MAX);
            self.total += f64::from(cluster.counted);
            let place = self.cut.clusters.len();
            self.cut.clusters.push(cluster);
            self.watch(place);
        }
    }

    /// Chooses the clusters to split this round; returns false if there are none.
    fn choose(&mut self) -> bool {
        let threshold = (f64::from(self.settings.epsilon) * self.total.max(0.0)) as f32;
        let room = self.settings.max_cut.saturating_sub(self.cut.clusters.len());
        self.cut.batch.clear();
        while let Some((error, place)) = self.cut.offenders.worst() {
            if error <= threshold || self.cut.batch.len() == BATCH {
                break;
            }
            if room == self.cut.batch.len() {
                self.cut.counts.capped += u64::from(room == 0);
                break;
            }
            self.cut.offenders.pop();
            self.cut.batch.push(place as u32);
        }
        !self.cut.batch.is_empty()
    }

    /// Replaces a cluster by its children.
    fn split(&mut self, place: usize) {
        let parent = self.cut.clusters[place];
        let Some((heir, other)) = heir_and_other(self.trees, &self.trees.nodes[parent.node as usize]) else {
            return;
        };
        let response = self.representative_response(other);
        let rest = (self.total - f64::from(parent.counted)).max(0.0);
        let heir = self.cluster(heir, parent.response, rest);
        let other = self.cluster(other, response, rest);
        self.total = rest + f64::from(heir.counted) + f64::from(other.counted);
        self.cut.clusters[place] = heir;
        self.watch(place);
        let place = self.cut.clusters.len();
        self.cut.clusters.push(other);
        self.watch(place);
    }

    /// Creates the cluster of a node whose representative contributes `response`. The other clusters sum up to `rest`.
    fn cluster(&self, node: u32, response: Rgb, rest: f64) -> CutCluster {
        let n = &self.trees.nodes[node as usize];
        let contribution = n.intensity * response;
        let mut counted = luminance(contribution);
        if self.settings.clamp.is_some() && rest > 0.0 && is_weak(n) {
            counted = counted.min((f64::from(DOMINANT_TO_REST) * rest) as f32);
        }
        CutCluster { node, response, contribution, counted }
    }

    /// Contribution of a node's representative at unit intensity.
    fn representative_response(&mut self, node: u32) -> Rgb {
        let node = &self.trees.nodes[node as usize];
        let vpl = &self.trees.vpls[node.representative()];
        let response = self.transfer.unshadowed(self.receiver, vpl, node.kind());
        if response == Rgb::ZERO {
            return Rgb::ZERO;
        }
        self.cut.counts.rays += 1;
        let (x, normal) = (self.receiver.position(), self.receiver.geometric_normal());
        match self.visibility.visible(x, normal, vpl, node) {
            true => response * self.visibility.transmittance(self.receiver, self.trees, node),
            false => Rgb::ZERO,
        }
    }

    /// Queues the cluster at `place` by its expected error.
    fn watch(&mut self, place: usize) {
        let cluster = &self.cut.clusters[place];
        let node = &self.trees.nodes[cluster.node as usize];
        if node.is_leaf() {
            return;
        }
        self.cut.counts.bounds += 1;
        let bound = self.transfer.bound(self.receiver, node);
        // A representative next to the receiver makes the whole cluster look near. So a cluster that gives more than a
        // quarter of the total is split, whatever its expected error.
        let doubt = self.settings.epsilon / DOMINANT * cluster.counted;
        let error = (luminance(bound.most * node.intensity) * bound.share).max(doubt);
        self.cut.offenders.push(error, place);
    }
}
