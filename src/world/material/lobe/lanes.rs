//! Data of a lobe in sixteen lanes.

use base::math::{F32x16, LANES, Rgb, Vec3x16};

/// Data of a lobe at sixteen points.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::material) struct LobeLanes {
    /// Factors; zero if nothing is reflected.
    pub scale: Vec3x16,
    /// Masking of `wo`, for lobes of facets.
    pub masking: F32x16,
}

impl LobeLanes {
    /// Adds factor · reflectance · `weight` in all lanes.
    #[inline(always)]
    pub(super) fn add(&self, sum: &mut Vec3x16, reflectance: &Vec3x16, weight: &F32x16) {
        for l in 0..LANES {
            let value: Rgb = self.scale.get(l) * reflectance.get(l) * weight[l];
            sum.set(l, sum.get(l) + value);
        }
    }
}

/// Returns the mean of the channels.
#[inline]
pub(in crate::material) fn mean(c: Rgb) -> f32 {
    (c.x + c.y + c.z) * (1.0 / 3.0)
}
