//! Ends of eye paths at diffuse surfaces behind mirrors, glass and glossy lobes, whose light is known from photons.
//!
//! Such light comes by a specular lobe to a diffuse surface that is seen, so its details are blurred. Followed further,
//! paths would leave half of the noise of a room of metal.
//!
//! Paper: Jensen, *Global Illumination using Photon Maps*, 1996, section 5.
//! Deviations: paths end behind at most half of the edges that they may have, and photons take three quarters. So a few
//! paths of the last quarter count that are too long. If paths may have few edges, they go on. So they do where there
//! is no photon.

use super::{IrradianceMap, PhotonMap};
use crate::emission::PhotonSettings;
use base::math::Rgb;
use base::progress::Control;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::World;

/// Approximate number of photons.
const PHOTONS: u32 = 50_000;

/// Number of photons per estimate.
const NEAREST: usize = 24;

/// Minimum of the maximum number of a path's edges for paths to end.
const MIN_EDGES: u32 = 12;

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
    /// Returns true if paths of at most `max_depth` edges have such ends.
    pub fn exist(world: &World, max_depth: u32) -> bool {
        world.specular.bends_light() && max_depth >= MIN_EDGES
    }

    /// Traces the photons for paths of at most `max_depth` edges.
    pub fn new(world: &World, max_depth: u32, seed: u32, control: &Control) -> PathEnds {
        let max_edges = max_depth - max_depth / 4;
        let wanted = PhotonSettings { photons: PHOTONS, seen: &[], max_edges, seed };
        let photons = PhotonMap::new(world, &wanted, control);
        let (irradiance, rays) = IrradianceMap::of_photons(world, &photons, NEAREST, control);
        PathEnds {
            irradiance,
            max_edges: max_depth / 2,
            paths: photons.counts.paths,
            rays: photons.counts.rays + rays,
        }
    }

    /// Returns the radiance that a surface of an `albedo` reflects, `depth` edges from the eye. `normal` is geometric,
    /// on the side that is seen. `None` if the path does not end there.
    #[inline]
    pub fn reflected(&self, depth: u32, position: Vec3, normal: Vec3, albedo: Rgb) -> Option<Rgb> {
        if depth > self.max_edges || albedo == Rgb::ZERO {
            return None;
        }
        self.irradiance.at(position, normal).map(|(irradiance, _)| albedo * irradiance * FRAC_1_PI)
    }
}
