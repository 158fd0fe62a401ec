//! A surface near a point.

use base::math::Rgb;
use glam::Vec3;
use world::Surface;

/// Surface that a ray met, and the weight of its light.
#[derive(Clone, Copy)]
pub struct NearSurface {
    /// The surface.
    pub surface: Surface,
    /// Distance along the ray.
    pub distance: f32,
    /// Cosine of the ray to the normal at its origin.
    pub cos: f32,
    /// Unit shading normal on the side of the ray.
    pub normal: Vec3,
    /// Radiance back along the ray for an irradiance of 1, times max(0, 1 - b/G).
    pub weight: Rgb,
    /// Radiance emitted back along the ray, times max(0, 1 - r²/A).
    pub emitted: Rgb,
}
