//! Settings of cuts, and counts of the work they took.

use crate::lights::Origin;
use base::setting::{DOWN, JudgedBy, UP, settings};
use base::stats::add_fields;

settings! {
    /// Settings of a cut.
    pub struct CutSettings in "Lightcuts" {
        /// Maximum expected error of a cluster, relative to the luminance of the sample.
        ///
        /// See [`super::expected`].
        epsilon: f32 = 0.02 => [.fraction().scaled(&DOWN)];
        /// Maximum number of clusters in a cut.
        max_cut: usize = 5000 => [.at_least(1.0).scaled(&UP)];
        /// Maximum contribution of one indirect virtual point light, relative to the luminance of the sample. 0
        /// disables clamping.
        ///
        /// If compensated, VPLs of the mean intensity around the point have this share where they are clamped (see
        /// [`super::Clamps`]). `None` leaves weak singularities unclamped. Shares below 0.001 are refused, since
        /// compensation restores the light of single VPLs only, and clusters of that brightness are not refined.
        clamp: Option<f32> = Some(0.02) => [.fraction().scaled(&UP).judged_by(JudgedBy::Light)];
        /// Origin of the light whose trees are cut; `None` for all trees.
        origin: Option<Origin> = None;
    }
}

/// Work of cuts. A packet's cut counts once for each of its points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutCounts {
    /// Number of cuts.
    pub cuts: u64,
    /// Sum of the sizes of cuts.
    pub clusters: u64,
    /// Number of cuts that ended at the cap with an error above the threshold.
    pub capped: u64,
    /// Number of shadow rays.
    pub rays: u64,
    /// Number of packets of shadow rays.
    pub packets: u64,
    /// Number of bounds evaluated.
    pub bounds: u64,
    /// Number of leaves whose contribution was clamped.
    pub clamped: u64,
    /// Sum of the luminances of cuts before clamping.
    pub luminance: f64,
    /// Luminance lost by clamping.
    pub lost: f64,
}
add_fields!(CutCounts { cuts, clusters, capped, rays, packets, bounds, clamped, luminance, lost });
