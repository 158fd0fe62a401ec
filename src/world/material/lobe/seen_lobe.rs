//! A lobe seen from a direction.

use base::math::{Lane, Rgb, V3};

/// Factors of a lobe that depend on the direction of view alone.
#[derive(Clone, Copy)]
pub(in crate::material) struct SeenLobe<L> {
    /// Factor on the value.
    pub masking: L,
    /// Factor on the density.
    pub density: L,
}

impl<L: Lane> SeenLobe<L> {
    /// Returns the factors of a lobe that is not seen.
    #[inline(always)]
    pub fn none() -> SeenLobe<L> {
        SeenLobe { masking: L::from(0.0), density: L::from(0.0) }
    }

    /// Returns the factors in all lanes of a wider type.
    #[inline(always)]
    pub fn widen<D: Lane + From<L>>(&self) -> SeenLobe<D> {
        SeenLobe { masking: D::from(self.masking), density: D::from(self.density) }
    }
}

/// Returns the mean of the channels.
#[inline(always)]
pub(in crate::material) fn mean(c: Rgb) -> f32 {
    means(V3::splat(c))
}

/// Returns the means of the channels.
#[inline(always)]
pub(in crate::material) fn means<L: Lane>(c: V3<L>) -> L {
    (c.x + c.y + c.z) * (1.0 / 3.0)
}
