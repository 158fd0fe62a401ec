//! Sampled directions towards the environment.

use base::math::{F32x16, Rgb, Vec3x16};
use glam::Vec3;

/// A sampled direction towards the environment.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentSample {
    /// Unit world direction towards the environment.
    pub direction: Vec3,
    /// Radiance arriving from that direction.
    pub radiance: Rgb,
    /// Density per solid angle.
    pub pdf: f32,
}

/// Sixteen sampled directions towards the environment; see [`EnvironmentSample`].
#[derive(Clone, Copy, Debug, Default)]
pub struct EnvironmentSamples16 {
    /// Unit world directions towards the environment.
    pub direction: Vec3x16,
    /// Radiances arriving from those directions.
    pub radiance: Vec3x16,
    /// Densities per solid angle; 0 if there is no sample.
    pub pdf: F32x16,
}

impl EnvironmentSamples16 {
    /// Sets the sample of one lane.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, direction: Vec3, radiance: Rgb, pdf: f32) {
        self.direction.set(lane, direction);
        self.radiance.set(lane, radiance);
        self.pdf[lane] = pdf;
    }
}
