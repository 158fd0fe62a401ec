//! Cones around rays, for the part of a surface that a ray represents.
//!
//! Paper: T. Akenine-Möller, C. Crassin, J. Boksansky, L. Belcour, A. Panteleev, O. Wright, *Improved Shader and
//! Texture Level of Detail Using Ray Cones*, 2021.
//! Deviations: cones keep their spread at mirrors, glass and sharp lobes, also at curved ones. They end at other
//! surfaces.

/// Cone around a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cone {
    /// Width at the start of the ray.
    pub width: f32,
    /// Growth of the width per unit of length.
    pub spread: f32,
}

impl Cone {
    /// Returns the width at a distance from the start.
    #[inline]
    pub fn width_at(&self, distance: f32) -> f32 {
        self.width + self.spread * distance
    }
}
