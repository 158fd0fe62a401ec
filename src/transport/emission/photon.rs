//! Photons, and settings and counts of tracing them.
//!
//! Units: flux in watts, to be divided by the number of paths.

use base::math::Rgb;
use glam::Vec3;
use world::SurfacePoint;
use world::material::Bsdf;

/// Counts of tracing photons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhotonCounts {
    /// Number of paths, by which flux is divided.
    pub paths: u64,
    /// Number of closest-hit queries.
    pub rays: u64,
    /// Number of unaimed paths that are as good as one aimed path; 0 if none is aimed.
    pub gain: f32,
}

/// Light arriving at a surface.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal on the side where the light arrives.
    pub normal: Vec3,
    /// Unit vector back along the path.
    pub towards_light: Vec3,
    /// Flux, to be divided by the number of paths.
    pub flux: Rgb,
    /// Diffusely reflected share of the flux; not 0.
    pub albedo: Rgb,
}

/// A photon, and how the surface reflects it.
pub struct PhotonHit<'a> {
    /// The photon.
    pub photon: Photon,
    /// Reflection of the surface.
    pub bsdf: &'a Bsdf<'a>,
    /// Direction back along the path in the shading frame.
    pub wi: Vec3,
    /// Unit shading normal on the side where the light arrives.
    pub shading_normal: Vec3,
    /// Number of edges from the emitter to the surface.
    pub edges: u32,
}

/// Settings of photon tracing.
#[derive(Clone, Copy, Debug)]
pub struct PhotonSettings<'a> {
    /// Approximate number of photons. Whole chunks of paths are traced, so there may be a few more. There are fewer if
    /// few paths hit a surface.
    pub photons: u32,
    /// Points whose indirect light is wanted; if empty, photons are not aimed.
    pub seen: &'a [SurfacePoint],
    /// Maximum number of edges of a path.
    pub max_edges: u32,
    /// Seed of the paths.
    pub seed: u32,
}
