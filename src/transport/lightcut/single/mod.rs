//! A cut for a single point.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 3; Herzog et al. 2009, section 3 (one threshold for all
//! trees, relative to their common total) and Eq. 13 (weak singularities, see [`super::clamp`]).
//!
//! Deviations: the error of a cluster is not its upper bound but the one to expect under that bound (see
//! [`super::expected`]), except that a cluster that gives more than a quarter of the total is always split;
//! up to sixteen clusters are split a round; a leaf's error is 0, so it never waits to be split.

mod bound;
#[cfg(test)]
mod exhaustive;
mod geometry;
mod offenders;
mod refine;
#[cfg(test)]
mod tests;

use super::clamp::Unclamped;
use super::{CutCounts, CutSettings, Receiver, Transfer, Visibility};
use crate::light_tree::LightTrees;
use base::math::{Rgb, luminance};
use glam::DVec3;
use offenders::Offenders;
use refine::Pass;

#[cfg(test)]
pub use exhaustive::gather_all;
pub use geometry::{OffsetBox, max_cos_to_cone, max_cos_to_cone_signed};

/// A cluster of a cut.
#[derive(Clone, Copy, Debug)]
pub struct CutCluster {
    /// Number of the node.
    pub node: u32,
    /// Contribution of a representative of unit intensity, with visibility.
    pub response: Rgb,
    /// Contribution of the cluster, its intensity times `response`, unclamped.
    pub contribution: Rgb,
    /// Luminance with which the cluster counts in the running total.
    counted: f32,
}

/// A cut, and the light that its receiver gathers from it.
#[derive(Clone, Copy, Debug)]
pub struct Cut<'c> {
    /// Radiance that the receiver reflects, or its irradiance.
    pub radiance: Rgb,
    /// Luminance above which indirect leaves were clamped; infinite without clamping.
    pub limit: f32,
    /// The clusters.
    pub clusters: &'c [CutCluster],
}

/// Workspace for cuts of single points; one a thread, so that its buffers are allocated once.
#[derive(Default)]
pub struct Lightcut {
    clusters: Vec<CutCluster>,
    /// By the error to expect, luminance.
    offenders: Offenders,
    /// Places of clusters to be split this round.
    batch: Vec<u32>,
    /// Work done so far.
    pub counts: CutCounts,
}

impl Lightcut {
    /// An empty workspace.
    pub fn new() -> Lightcut {
        Lightcut::default()
    }

    /// Gathers the light of all VPLs, to within the settings' error.
    pub fn gather<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receiver: &Receiver,
        settings: &CutSettings,
    ) -> Cut<'_> {
        Pass { trees: transfer.trees, transfer, visibility, receiver, settings, total: 0.0, cut: self }.run();
        self.counts.cuts += 1;
        self.counts.clusters += self.clusters.len() as u64;
        let (radiance, limit) = self.sum(transfer.trees, settings.clamp, receiver.baseline_luminance());
        Cut { radiance, limit, clusters: &self.clusters }
    }

    /// Sum of the cut anew, in one order and without the drift of the running total, and the luminance above which
    /// leaves were clamped.
    fn sum(&mut self, trees: &LightTrees, clamp: Option<f32>, baseline: f32) -> (Rgb, f32) {
        let sum = self.clusters.iter().fold(DVec3::ZERO, |sum, c| sum + c.contribution.as_dvec3()).as_vec3();
        self.counts.luminance += f64::from(luminance(sum));
        let Some(clamp) = clamp else { return (sum, f32::INFINITY) };
        let contributions = self.clusters.iter().map(|c| (c.node, c.contribution));
        Unclamped { trees, contributions, strong: Rgb::ZERO, sum, baseline }.clamped(clamp, &mut self.counts)
    }
}
