//! The beginning of a photon's path.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use base::math::Rgb;
use base::sampling::Sampler;
use embree::Ray;
use glam::Vec2;

/// The beginning of a path.
#[derive(Clone, Copy, Debug)]
pub struct EmissionSample {
    /// The first edge.
    pub ray: Ray,
    /// Flux along it.
    pub flux: Rgb,
    /// Luminance of the radiance along it; infinite of lights of points and directions.
    pub radiance: f32,
}

/// Random numbers that the beginning of a path takes, in [0, 1).
#[derive(Clone, Copy, Debug)]
pub struct EmissionNumbers {
    /// For the place on the emitter, or the line of one that is infinitely far.
    pub place: Vec2,
    /// For the direction.
    pub direction: Vec2,
    /// For the side of a part of the directions.
    pub side: f32,
}

impl EmissionNumbers {
    /// Draws them.
    pub fn new(sampler: &mut Sampler) -> EmissionNumbers {
        EmissionNumbers { place: sampler.next_2d(), direction: sampler.next_2d(), side: sampler.next_1d() }
    }
}

impl EmissionSample {
    pub(super) fn new(ray: Ray, flux: Rgb, radiance: Option<f32>) -> Option<EmissionSample> {
        let useful = flux.is_finite() && flux.max_element() > 0.0;
        useful.then(|| EmissionSample { ray, flux, radiance: radiance.unwrap_or(f32::INFINITY) })
    }
}
