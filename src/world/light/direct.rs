//! Direct light at a point, sampled from one emitter.

use super::delta::delta_irradiance;
use super::environment::EnvironmentSample;
use base::math::Rgb;
use glam::Vec3;
use scene::DeltaLight;

/// Light arriving at a point from a sampled point of one emitter.
#[derive(Clone, Copy, Debug)]
pub struct DirectSample {
    /// Unit vector from the point to the emitter.
    pub direction: Vec3,
    /// Distance to the emitter; infinite for directional lights and the environment.
    pub distance: f32,
    /// Unit geometric normal of the emitting surface; zero if there is no surface.
    pub normal: Vec3,
    /// Radiance towards the point; for delta lights the irradiance on a surface that faces the light.
    pub radiance: Rgb,
    /// Density per solid angle, including the choice of the emitter; for delta lights the probability of that choice.
    pub pdf: f32,
    /// True if no other technique can sample this light.
    pub delta: bool,
}

impl DirectSample {
    /// Makes the sample of an environment that was chosen with probability `choice`.
    #[inline]
    pub(super) fn environment(sample: &EnvironmentSample, choice: f32) -> DirectSample {
        DirectSample {
            direction: sample.direction,
            distance: f32::INFINITY,
            normal: Vec3::ZERO,
            radiance: sample.radiance,
            pdf: choice * sample.pdf,
            delta: false,
        }
    }

    /// Samples the light at `x` from a delta light that was chosen with probability `choice`; `None` if none arrives.
    #[inline]
    pub(super) fn delta(light: &DeltaLight, x: Vec3, choice: f32) -> Option<DirectSample> {
        let (direction, distance, irradiance) = delta_irradiance(light, x);
        let arrives = irradiance != Rgb::ZERO && irradiance.is_finite();
        arrives.then_some(DirectSample {
            direction,
            distance,
            normal: Vec3::ZERO,
            radiance: irradiance,
            pdf: choice,
            delta: true,
        })
    }
}
