//! Settings of cuts, and counts of the work they took.

use crate::stats::add_fields;
use crate::vpl::Origin;

/// Settings of a cut.
#[derive(Clone, Copy, Debug)]
pub struct CutSettings {
    /// Largest error to expect of one cluster (see [`super::expected`]), relative to the total's luminance.
    pub epsilon: f32,
    /// Most clusters in a cut.
    pub max_cut: usize,
    /// Largest share of the luminance that a single indirect VPL may contribute; `None` leaves weak singularities
    /// unclamped.
    pub clamp: Option<f32>,
    /// Origin of the light whose trees alone are cut; `None` for all trees.
    pub origin: Option<Origin>,
}

impl Default for CutSettings {
    fn default() -> CutSettings {
        CutSettings { epsilon: 0.02, max_cut: 5000, clamp: Some(0.02), origin: None }
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
