//! A surface near a point, and the light that virtual lights on it lack.

use base::math::Rgb;
use glam::Vec3;
use world::Surface;

/// Maximum light of a lobe, relative to a diffuse surface of the same flux, that short rays account for.
pub(super) const MAX_LOBE: f32 = 4.0;

/// Light that virtual lights lack at a surface met by a short ray.
#[derive(Clone, Copy, Debug)]
pub struct Lack {
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Bound of the geometry term of virtual lights, relative to the ray's geometry term: b/G.
    pub kept: f32,
    /// True if the surface radiates by lobes.
    pub by_lobes: bool,
}

impl Lack {
    /// Returns a bound of the lacking light, up to a constant factor: for a diffuse surface, max(0, 1 - b/G); for a
    /// lobe, its maximum.
    pub fn weight(&self) -> f32 {
        let max = if self.by_lobes { MAX_LOBE } else { 1.0 };
        (1.0 - self.kept / max).max(0.0)
    }
}

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
    /// Radiance back along the ray for an irradiance of 1, times max(0, 1 - b/G); more if the surface radiates by
    /// lobes.
    pub weight: Rgb,
    /// Lacking light.
    pub lack: Lack,
    /// Radiance emitted back along the ray, times max(0, 1 - r²/A).
    pub emitted: Rgb,
}
