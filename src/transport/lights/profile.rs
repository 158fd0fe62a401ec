//! Directional profiles of virtual lights: intensity in a direction relative to the maximum.

use base::math::{F32x16, Vec3x16};
use glam::Vec3;
use std::f32::consts::PI;
use world::light::spot_falloff;
use world::material::LobeShape;

/// Angular profile of a spot light: 1 within `inner_angle`, falling linearly in angle to 0 at `outer_angle`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotProfile {
    /// Unit axis, away from the light.
    pub direction: Vec3,
    /// Half angle of full intensity, radians.
    pub inner_angle: f32,
    /// Half angle of the cone, radians.
    pub outer_angle: f32,
}

impl SpotProfile {
    /// Fraction of the axial intensity sent in the unit direction `away`, in [0, 1].
    pub fn falloff(&self, away: Vec3) -> f32 {
        spot_falloff(self.direction.dot(away), self.inner_angle, self.outer_angle)
    }
}

/// Half the step of differences that estimate slopes of lobes, radians: an eighth of the width of the sharpest lobe.
const STEP: f32 = 0.03;

/// Lobe of a rough surface around the mirror direction of the light that it reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeProfile {
    /// Unit normal of the surface on the side of the light.
    pub normal: Vec3,
    /// Unit vector to the light.
    pub towards_light: Vec3,
    /// Distribution of the reflected light.
    pub shape: LobeShape,
    /// Bound of the intensity over the reflected flux, 1/sr.
    pub peak: f32,
}

impl LobeProfile {
    /// Fraction of the bound sent in the unit direction `away`, in [0, 1].
    #[inline]
    pub fn share(&self, away: Vec3) -> f32 {
        self.shape.share(self.normal, self.towards_light, away)
    }

    /// Returns [`LobeProfile::share`] in all lanes.
    #[inline]
    pub fn share16(&self, away: &Vec3x16) -> F32x16 {
        self.shape.share16(self.normal, self.towards_light, away)
    }

    /// Returns [`LobeProfile::share`] and its derivative by `away`, perpendicular to `away`, from differences.
    pub fn share_and_slope(&self, away: Vec3) -> (f32, Vec3) {
        let (share, slope, _) = self.share_and_derivatives(away);
        (share, slope)
    }

    /// Returns [`LobeProfile::share_and_slope`] and the sum of the magnitudes of the second derivatives along two axes.
    pub fn share_and_derivatives(&self, away: Vec3) -> (f32, Vec3, f32) {
        let share = self.share(away);
        let (u, v) = away.any_orthonormal_pair();
        let (mut slope, mut curvature) = (Vec3::ZERO, 0.0);
        for axis in [u, v] {
            let [after, before] = [STEP, -STEP].map(|step| self.share((away + axis * step).normalize()));
            slope += axis * ((after - before) / (2.0 * STEP));
            curvature += (after + before - 2.0 * share).abs() / (STEP * STEP);
        }
        (share, slope, curvature)
    }

    /// Squared roughness for the bound [`LobeShape::max_share`].
    pub fn width_sq(&self) -> f32 {
        self.shape.width_sq()
    }

    /// Unit vector around which the light leaves.
    pub fn axis(&self) -> Vec3 {
        let axis = self.normal * (2.0 * self.normal.dot(self.towards_light)) - self.towards_light;
        axis.try_normalize().unwrap_or(self.normal)
    }

    /// Intensity per cosine of a diffuse light of the same flux, relative to the bound.
    pub fn diffuse_equivalent(&self) -> f32 {
        1.0 / (PI * self.peak)
    }
}

/// Profiles that virtual lights refer to.
#[derive(Clone, Debug, Default)]
pub struct Profiles {
    /// Profiles of spot lights among the omni VPLs.
    pub spots: Vec<SpotProfile>,
    /// Profiles of lobes.
    pub lobes: Vec<LobeProfile>,
}

impl From<Vec<SpotProfile>> for Profiles {
    fn from(spots: Vec<SpotProfile>) -> Profiles {
        Profiles { spots, lobes: Vec::new() }
    }
}
