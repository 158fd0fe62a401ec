//! Settings of cuts, and counts of the work they took.

use crate::lights::Origin;
use base::setting::{DOWN, JudgedBy, UP, settings};
use base::stats::add_fields;

settings! {
    /// Settings of a cut.
    pub struct CutSettings in "Lightcuts" {
        /// Largest error to expect of a cluster, relative to the sample's luminance.
        ///
        /// See [`super::expected`].
        epsilon: f32 = 0.02 => [.fraction().scaled(&DOWN)];
        /// Most clusters in a cut.
        max_cut: usize = 5000 => [.at_least(1.0).scaled(&UP)];
        /// Most that one indirect virtual point light may give, relative to the sample's luminance; 0 does not clamp.
        ///
        /// `None` leaves weak singularities unclamped. Shares below a thousandth are refused: compensation gives back
        /// what is taken of single lights, and clusters as bright as that are not taken apart.
        clamp: Option<f32> = Some(0.02) => [.fraction().scaled(&UP).judged_by(JudgedBy::Light)];
        /// Origin of the light whose trees alone are cut; `None` for all trees.
        origin: Option<Origin> = None;
    }
}

/// Work done over any number of cuts; a packet's cut counts once for each of its points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutCounts {
    /// Cuts computed.
    pub cuts: u64,
    /// Sum of their sizes.
    pub clusters: u64,
    /// Cuts that ended at the cap with an error above the threshold.
    pub capped: u64,
    /// Shadow rays.
    pub rays: u64,
    /// Packets of shadow rays.
    pub packets: u64,
    /// Bounds evaluated.
    pub bounds: u64,
    /// Leaves whose contribution was clamped.
    pub clamped: u64,
    /// Luminance of all cuts' sums before clamping.
    pub luminance: f64,
    /// Luminance taken away by clamping.
    pub lost: f64,
}
add_fields!(CutCounts { cuts, clusters, capped, rays, packets, bounds, clamped, luminance, lost });
