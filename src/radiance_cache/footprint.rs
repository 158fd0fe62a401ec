//! The footprint of a record: how large it is, and which way it is long.
//!
//! Paper: Herzog et al. 2009, section 5.1, Eqs. 11 and 12 (circles, and ellipses by gradients); Schwarzhaupt et
//! al. 2012 (ellipses by second derivatives that know of occlusion).
//! Units: metres.
//!
//! Deviations: footprints by second derivatives are at most twice as long as wide, those by gradients about
//! eleven times (1/0.3²).

use super::occlusion_hessian::Change;
use super::settings::{CacheSettings, Footprints};
use crate::math::Frame;
use glam::Vec3;

/// How much shorter a footprint is along the normal.
const NORMAL_SCALE: f32 = 5.0;

/// The ellipse within which a record is used.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// Unit tangent axes.
    pub axes: [Vec3; 2],
    /// Radius along each axis.
    pub radii: [f32; 2],
    /// Inverse of the root of 1 - cos of the angle at which the normals differ too much.
    pub inverse_normal_tolerance: f32,
}

impl Footprint {
    /// An ellipse along whose axes second derivatives change the luminance by half the square of `accuracy`,
    /// relatively; its half-axes are no longer than `furthest`, within `reach`, and the longer one at most twice
    /// the shorter.
    pub fn of_change(
        change: &Change,
        luminance: f32,
        accuracy: f32,
        furthest: f32,
        reach: [f32; 2],
        settings: &CacheSettings,
    ) -> Footprint {
        let radius = |curvature: f32| {
            let inverse_sq = curvature / (luminance.max(f32::MIN_POSITIVE) * accuracy * accuracy);
            1.0 / (inverse_sq + 1.0 / (furthest * furthest)).sqrt()
        };
        let [short, long] = change.curvature.map(radius);
        let short = short.clamp(reach[0], reach[1]);
        let long = long.min(2.0 * short).clamp(short, reach[1]);
        Footprint {
            axes: change.axes,
            radii: [short, long],
            inverse_normal_tolerance: 1.0 / settings.normal_tolerance,
        }
    }

    /// An ellipse of the area of a circle of `radius`, short along the gradient of the luminance; a circle unless
    /// footprints are to be anisotropic.
    pub fn of_gradient(
        normal: Vec3,
        gradient: Vec3,
        luminance: f32,
        radius: f32,
        settings: &CacheSettings,
    ) -> Footprint {
        let change = radius * gradient.length() / luminance.max(f32::MIN_POSITIVE);
        let (axis, g) = match gradient.try_normalize() {
            Some(axis) if settings.footprints == Footprints::Anisotropic => {
                let relative = change / settings.mu;
                (axis, (1.0 / (1.0 + relative * relative)).max(0.3))
            }
            _ => (Frame::from_normal(normal).tangent, 1.0),
        };
        Footprint {
            axes: [axis, normal.cross(axis)],
            radii: [radius * g, radius / g],
            inverse_normal_tolerance: 1.0 / settings.normal_tolerance,
        }
    }

    /// The largest radius.
    pub fn reach(&self) -> f32 {
        self.radii[0].max(self.radii[1])
    }

    /// Offset in units of the footprint's radii.
    pub fn scaled(&self, offset: Vec3, normal: Vec3) -> Vec3 {
        let [r0, r1] = self.radii;
        Vec3::new(
            offset.dot(self.axes[0]) / r0,
            offset.dot(self.axes[1]) / r1,
            offset.dot(normal) * NORMAL_SCALE / r0.min(r1),
        )
    }
}
