//! The cut of a single point, and the workspace that holds it.

use super::offenders::Offenders;
use crate::lightcut::CutCounts;
use base::math::Rgb;

/// Cluster of a cut.
#[derive(Clone, Copy, Debug)]
pub struct CutCluster {
    /// Index of the node.
    pub node: u32,
    /// Contribution of a representative of unit intensity, with visibility.
    pub response: Rgb,
    /// Unclamped contribution of the cluster: its intensity times `response`.
    pub contribution: Rgb,
    /// Luminance with which the cluster counts in the running total.
    pub(super) counted: f32,
}

/// Cut, and the light that its receiver gathers from it.
#[derive(Clone, Copy, Debug)]
pub struct Cut<'c> {
    /// Radiance that the receiver reflects, or irradiance.
    pub radiance: Rgb,
    /// Luminance above which indirect leaves were clamped; infinite without clamping.
    pub limit: f32,
    /// The clusters.
    pub clusters: &'c [CutCluster],
}

/// Workspace for cuts of single points. Each thread has one, so that buffers are allocated once.
#[derive(Default)]
pub struct Lightcut {
    pub(super) clusters: Vec<CutCluster>,
    /// Clusters by expected error, as luminance.
    pub(super) offenders: Offenders,
    /// Places of the clusters that are split this round.
    pub(super) batch: Vec<u32>,
    /// Work done so far.
    pub counts: CutCounts,
}
