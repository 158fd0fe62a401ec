//! Bounds of the directions towards a cluster of lights.

use base::math::F32x16;

/// Bounds of a set of directions towards light. The normal is on the side of `wo`: it is the reversed shading normal if
/// a two-sided surface is seen from behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionBound {
    /// Maximum cosine to the normal. If it is <= 0, nothing is reflected.
    pub cos_i_max: f32,
    /// Minimum cosine to the normal. If it is <= 0, grazing light is possible.
    pub cos_i_min: f32,
    /// Maximum cosine to the mirror direction of `wo`.
    pub cos_mirror_max: f32,
}

impl DirectionBound {
    /// Factor that covers the rounding of the reflectance and of D at the tip of a narrow lobe.
    pub(in crate::material) const WIDER: f32 = 1.000_01;
}

/// Bounds of the directions towards light in sixteen lanes; see [`DirectionBound`].
#[derive(Clone, Copy, Debug, Default)]
pub struct DirectionBounds16 {
    /// Maximum cosine to the normal, at most 1.
    pub cos_i_max: F32x16,
    /// Minimum cosine to the normal.
    pub cos_i_min: F32x16,
    /// Maximum cosine to the mirror direction of `wo`.
    pub cos_mirror_max: F32x16,
}
