//! Directional profiles of virtual lights: intensity in a direction relative to the maximum.

use base::math::{Lane, V3};
use glam::Vec3;
use std::f32::consts::PI;
use std::sync::Arc;
use world::light::{ImageLight, spot_falloff};
use world::material::LobeShape;

/// Angular profile of a spot light or a projector.
#[derive(Clone, Debug)]
pub enum SpotProfile {
    /// 1 within `inner_angle`, falling linearly in angle to 0 at `outer_angle`.
    Cone {
        /// Unit axis, away from the light.
        direction: Vec3,
        /// Half angle of full intensity, radians.
        inner_angle: f32,
        /// Half angle of the cone, radians.
        outer_angle: f32,
    },
    /// One channel of a projected image.
    Image {
        /// The image.
        image: Arc<ImageLight>,
        /// Index of the channel.
        channel: usize,
    },
}

impl SpotProfile {
    /// Fraction of the maximum intensity sent in the unit direction `away`, in [0, 1].
    pub fn falloff(&self, away: Vec3) -> f32 {
        match self {
            SpotProfile::Cone { direction, inner_angle, outer_angle } => {
                spot_falloff(direction.dot(away), *inner_angle, *outer_angle)
            }
            SpotProfile::Image { image, channel } => {
                let share = image.intensity(away)[*channel] / image.peak[*channel];
                if share < 1.0 { share } else { 1.0 }
            }
        }
    }

    /// Returns the derivative of [`SpotProfile::falloff`] by `away`, perpendicular to `away`, from differences.
    pub fn slope(&self, away: Vec3) -> Vec3 {
        let along = |(axis, [after, before]): (Vec3, [f32; 2])| axis * ((after - before) / (2.0 * STEP));
        around(away, |away| self.falloff(away)).map(along).into_iter().sum()
    }
}

/// Half the step of differences that estimate slopes of lobes and images, radians: an eighth of the width of the
/// sharpest lobe.
const STEP: f32 = 0.03;

/// Returns two axes across `away`, each with the shares a step along the axis and a step back.
fn around(away: Vec3, share: impl Fn(Vec3) -> f32) -> [(Vec3, [f32; 2]); 2] {
    let (u, v) = away.any_orthonormal_pair();
    [u, v].map(|axis| (axis, [STEP, -STEP].map(|step| share((away + axis * step).normalize()))))
}

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
        self.shares(V3::splat(away))
    }

    /// Returns [`LobeProfile::share`] of one or sixteen directions.
    #[inline(always)]
    pub fn shares<L: Lane>(&self, away: V3<L>) -> L {
        self.shape.share(self.normal, self.towards_light, away)
    }

    /// Returns [`LobeProfile::share`] and its derivative by `away`, perpendicular to `away`, from differences.
    pub fn share_and_slope(&self, away: Vec3) -> (f32, Vec3) {
        let (share, slope, _) = self.share_and_derivatives(away);
        (share, slope)
    }

    /// Returns [`LobeProfile::share_and_slope`] and the sum of the magnitudes of the second derivatives along two axes.
    pub fn share_and_derivatives(&self, away: Vec3) -> (f32, Vec3, f32) {
        let share = self.share(away);
        let (mut slope, mut curvature) = (Vec3::ZERO, 0.0);
        for (axis, [after, before]) in around(away, |away| self.share(away)) {
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
