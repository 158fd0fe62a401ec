//! The beginning of a photon's path.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use base::math::Rgb;
use base::sampling::Sampler;
use embree::Ray;
use glam::Vec2;

/// The first edge of a path.
#[derive(Clone, Copy, Debug)]
pub struct EmissionSample {
    /// Ray along the edge.
    pub ray: Ray,
    /// Flux along the ray.
    pub flux: Rgb,
    /// Luminance of the radiance along the ray; infinite for point, spot and directional lights.
    pub radiance: f32,
}

/// Random numbers in [0, 1) that begin a path.
#[derive(Clone, Copy, Debug)]
pub struct EmissionNumbers {
    /// Place on the emitter; if the emitter is infinitely far, line of its light.
    pub place: Vec2,
    /// Direction.
    pub direction: Vec2,
    /// Choice between strategies or sides for the direction.
    pub side: f32,
}

impl EmissionNumbers {
    /// Takes the numbers from a sampler.
    pub fn new(sampler: &mut Sampler) -> EmissionNumbers {
        EmissionNumbers { place: sampler.next_2d(), direction: sampler.next_2d(), side: sampler.next_1d() }
    }
}

impl EmissionSample {
    /// Creates a sample; `None` if it carries no light. `radiance` is `None` for point, spot and directional lights.
    pub(super) fn new(ray: Ray, flux: Rgb, radiance: Option<f32>) -> Option<EmissionSample> {
        let useful = flux.is_finite() && flux.max_element() > 0.0;
        useful.then(|| EmissionSample { ray, flux, radiance: radiance.unwrap_or(f32::INFINITY) })
    }
}
