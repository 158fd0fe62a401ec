//! Direct light at a point, sampled from one emitter, and at sixteen points.

use super::delta::DeltaEmitter;
use base::math::{F32x16, Rgb, U32x16, Vec3x16, mask_of};
use glam::Vec3;

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
    /// Samples the light at `x` from a delta light that was chosen with probability `choice`; `None` if none arrives.
    #[inline]
    pub(super) fn delta(light: &DeltaEmitter, x: Vec3, choice: f32) -> Option<DirectSample> {
        let (direction, distance, irradiance) = light.irradiance(x);
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

/// Light arriving at sixteen points; see [`DirectSample`] for the fields.
#[derive(Clone, Debug, Default)]
pub struct DirectSamples16 {
    /// Unit directions towards the light.
    pub direction: Vec3x16,
    /// Distances to the emitters' points; infinite for light from infinitely far away.
    pub distance: F32x16,
    /// Geometric normals at those points; zero if there is no surface.
    pub normal: Vec3x16,
    /// Radiances, or irradiances for delta lights.
    pub radiance: Vec3x16,
    /// Densities per solid angle; for delta lights the probabilities of their choice.
    pub pdf: F32x16,
    /// Not zero if the light is a delta light.
    pub delta: U32x16,
    /// Not zero if the sample contributes.
    pub(super) useful: U32x16,
}

impl DirectSamples16 {
    /// Returns the lanes whose samples contribute.
    #[inline]
    pub fn useful(&self) -> u16 {
        mask_of(&self.useful)
    }

    /// Sets the sample of one lane.
    pub(super) fn set(&mut self, lane: usize, sample: Option<DirectSample>) {
        self.useful[lane] = u32::from(sample.is_some());
        if let Some(s) = sample {
            self.direction.set(lane, s.direction);
            self.distance[lane] = s.distance;
            self.normal.set(lane, s.normal);
            self.radiance.set(lane, s.radiance);
            self.pdf[lane] = s.pdf;
            self.delta[lane] = u32::from(s.delta);
        }
    }
}
