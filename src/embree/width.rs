//! Widths of Embree's packets.

/// Number of rays that a query takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Width {
    /// One: `rtcOccluded1`.
    One,
    /// `rtcOccluded4`.
    Four,
    /// `rtcOccluded8`.
    Eight,
    /// `rtcOccluded16`.
    Sixteen,
}

impl Width {
    /// All widths, the narrowest first.
    pub const ALL: [Width; 4] = [Width::One, Width::Four, Width::Eight, Width::Sixteen];

    /// Number of rays.
    pub fn rays(self) -> usize {
        match self {
            Width::One => 1,
            Width::Four => 4,
            Width::Eight => 8,
            Width::Sixteen => 16,
        }
    }
}
