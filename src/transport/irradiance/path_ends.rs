//! Ends of eye paths at diffuse surfaces, whose light is known from photons.
//!
//! Two kinds of paths end so, since details of that light are blurred where it is seen:
//!
//! - paths behind mirrors, glass and glossy lobes that light a diffuse surface. Followed further, they would leave half
//!   of the noise of a room of metal;
//! - full paths of images that are denoised, behind a wide lobe: final gathering.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996, section 5; Christensen 1999.
//! Deviations: paths end behind at most half of the edges that they may have, and photons take three quarters. So a few
//! paths of the last quarter count that are too long. If paths may have few edges, they go on. So they do where there
//! is no photon, on surfaces much smaller than an estimate's disc, and along edges shorter than its radius.

use super::{IrradianceMap, PhotonMap};
use crate::emission::PhotonSettings;
use base::math::Rgb;
use base::progress::Control;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::World;

/// Maximum number of photons, approximately.
const MAX_PHOTONS: u64 = 500_000;

/// Minimum number of photons.
const MIN_PHOTONS: u64 = 10_000;

/// Number of eye samples per photon. The errors of photons are not noise that a denoiser takes off.
const SAMPLES_PER_PHOTON: u64 = 16;

/// Number of photons per estimate.
const NEAREST: usize = 24;

/// Minimum of the maximum number of a path's edges for paths to end.
const MIN_EDGES: u32 = 8;

/// Order for the ends of paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndsWanted {
    /// Number of photons.
    photons: u32,
    /// Maximum number of edges of a path.
    max_depth: u32,
    /// Random seed.
    seed: u32,
}

impl EndsWanted {
    /// Makes the order for paths of at most `max_depth` edges in an image of so many samples; `None` if these are too
    /// few edges for paths to end.
    pub fn new(samples: u64, max_depth: u32, seed: u32) -> Option<EndsWanted> {
        let photons = (samples / SAMPLES_PER_PHOTON).clamp(MIN_PHOTONS, MAX_PHOTONS) as u32;
        (max_depth >= MIN_EDGES).then_some(EndsWanted { photons, max_depth, seed })
    }
}

/// Edge of a path that arrives at a surface.
pub struct Arrival {
    /// Number of edges from the eye.
    pub depth: u32,
    /// Length of the last edge.
    pub length: f32,
    /// Point that it arrives at.
    pub position: Vec3,
    /// Geometric normal there, on the side that is seen.
    pub normal: Vec3,
}

/// Irradiance by which paths end.
pub struct PathEnds {
    irradiance: IrradianceMap,
    /// Maximum number of edges from the eye to an end.
    max_edges: u32,
    /// Number of photon paths.
    pub paths: u64,
    /// Number of rays traced.
    pub rays: u64,
}

impl PathEnds {
    /// Traces the photons.
    pub fn new(world: &World, wanted: EndsWanted, control: &Control) -> PathEnds {
        let EndsWanted { photons, max_depth, seed } = wanted;
        let max_edges = max_depth - max_depth / 4;
        let wanted = PhotonSettings { photons, seen: &[], max_edges, seed };
        let photons = PhotonMap::new(world, &wanted, control);
        let (irradiance, rays) = IrradianceMap::of_photons(world, &photons, NEAREST, control);
        PathEnds {
            irradiance,
            max_edges: max_depth / 2,
            paths: photons.counts.paths,
            rays: photons.counts.rays + rays,
        }
    }

    /// Returns the radiance that a surface of an `albedo` reflects along a path; `None` if the path does not end there.
    #[inline]
    pub fn reflected(&self, at: &Arrival, albedo: Rgb) -> Option<Rgb> {
        if at.depth > self.max_edges || albedo == Rgb::ZERO {
            return None;
        }
        let (irradiance, radius) = self.irradiance.at(at.position, at.normal)?;
        (at.length >= radius).then(|| albedo * irradiance * FRAC_1_PI)
    }
}
