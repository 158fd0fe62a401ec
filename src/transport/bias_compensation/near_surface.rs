//! A surface near a point, and the light that virtual lights on it lack.

use base::math::Rgb;
use glam::Vec3;
use world::Surface;

/// Luminance that a virtual light may give over the limit where geometry terms are limited: one much brighter than
/// those around would leave a spot.
pub const BRIGHTER: f32 = 2.0;

/// Light that a lobe may give, over a diffuse surface of its flux, as far as short rays look.
pub(super) const MOST: f32 = 4.0;

/// Most of an indirect virtual light; none is limited where it is not positive and finite.
#[derive(Clone, Copy, Debug)]
pub enum Limit {
    /// The geometry term.
    Geometry(f32),
    /// The luminance of the irradiance.
    Irradiance(f32),
}

/// How much a surface met by a short ray gives of what virtual lights lack.
#[derive(Clone, Copy, Debug)]
pub struct Lack {
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Geometry term that virtual lights have kept, over the ray's.
    pub kept: f32,
    /// Limit of the virtual lights.
    pub limit: Limit,
    /// True if the surface radiates by lobes.
    pub by_lobes: bool,
}

impl Lack {
    /// Returns a bound of what is lacking, up to a constant factor: that of a diffuse surface, max(0, 1 - b/G), or that
    /// of a lobe at its greatest.
    pub fn weight(&self) -> f32 {
        let most = if self.by_lobes { MOST } else { 1.0 };
        (1.0 - self.kept / most).max(0.0)
    }
}

/// A surface that a ray met, and the weight of its light.
#[derive(Clone, Copy)]
pub struct NearSurface {
    /// The surface.
    pub surface: Surface,
    /// Distance along the ray.
    pub distance: f32,
    /// Cosine of the ray to the normal it started at.
    pub cos: f32,
    /// Unit shading normal on the side of the ray.
    pub normal: Vec3,
    /// Radiance back along the ray for an irradiance of 1, times max(0, 1 - b/G), or more where lobes radiate.
    pub weight: Rgb,
    /// How it gives that light.
    pub lack: Lack,
    /// Radiance emitted back along the ray, times max(0, 1 - r²/A).
    pub emitted: Rgb,
}
