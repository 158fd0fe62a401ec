//! The cut of a single point, and the workspace that holds it.

use super::offenders::Offenders;
use crate::lightcut::CutCounts;
use base::math::Rgb;

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
    pub(super) counted: f32,
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
    pub(super) clusters: Vec<CutCluster>,
    /// By the error to expect, luminance.
    pub(super) offenders: Offenders,
    /// Places of clusters to be split this round.
    pub(super) batch: Vec<u32>,
    /// Work done so far.
    pub counts: CutCounts,
}
