//! Widths of Embree's packets.

/// Number of rays per query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Width {
    /// One ray: `rtcOccluded1`.
    One,
    /// Four rays: `rtcOccluded4`.
    Four,
    /// Eight rays: `rtcOccluded8`.
    Eight,
    /// Sixteen rays: `rtcOccluded16`.
    Sixteen,
}

impl Width {
    /// All widths, in ascending order.
    pub const ALL: [Width; 4] = [Width::One, Width::Four, Width::Eight, Width::Sixteen];

    /// Returns the number of rays.
    pub fn rays(self) -> usize {
        match self {
            Width::One => 1,
            Width::Four => 4,
            Width::Eight => 8,
            Width::Sixteen => 16,
        }
    }
}
