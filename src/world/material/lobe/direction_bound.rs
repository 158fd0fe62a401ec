//! Bounds of the directions towards a cluster of lights.

/// Bounds of a set of directions towards light. The normal is on the side of `wo`: it is the reversed shading normal if
/// a two-sided surface is seen from behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionBound<L = f32> {
    /// Maximum cosine to the normal. If it is <= 0, nothing is reflected.
    pub cos_i_max: L,
    /// Minimum cosine to the normal. If it is <= 0, grazing light is possible.
    pub cos_i_min: L,
    /// Maximum cosine to the mirror direction of `wo`.
    pub cos_mirror_max: L,
}

impl DirectionBound {
    /// Factor that covers the rounding of the reflectance and of D at the tip of a narrow lobe.
    pub(in crate::material) const WIDER: f32 = 1.000_01;
}
