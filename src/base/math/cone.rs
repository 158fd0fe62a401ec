//! Cones around rays: the part of a surface for which a ray stands.
//!
//! Paper: T. Akenine-Möller, C. Crassin, J. Boksansky, L. Belcour, A. Panteleev, O. Wright, *Improved Shader and
//! Texture Level of Detail Using Ray Cones*, 2021.
//! Deviations: cones keep their spread at mirrors, glass and sharp lobes, curved ones too, and are not followed beyond
//! others. Wide ones after diffuse reflection (.2 rad) would save paths among textured walls 5 % of their time and
//! 1.5 % of their mean square error, but mix in what lies unseen beside a surface's own part of a texture.

/// Cone around a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cone {
    /// Width where the ray starts.
    pub width: f32,
    /// Growth of the width a unit of length.
    pub spread: f32,
}

impl Cone {
    /// Width at a distance from the start.
    #[inline]
    pub fn width_at(&self, distance: f32) -> f32 {
        self.width + self.spread * distance
    }
}
