//! Light arriving from one direction, and its derivatives as the receiver moves. Profiles of spot lights and lobes
//! attenuate it.

use crate::lights::{LobeProfile, SpotProfile};
use base::math::Frame;
use glam::Vec3;

/// Light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// Unit direction to the light.
    pub direction: [f32; 3],
    /// Inverse distance, the rate at which the direction turns as the receiver moves; 0 at infinite distance.
    pub inv_dist: f32,
    /// Irradiance on a surface that faces the light: emitter's cosine over squared distance, or 1 at infinite distance.
    pub factor: f32,
    /// Derivatives of `factor` along u and v.
    pub gradient: [f32; 2],
}

impl Incidence {
    /// Returns `share` of the light with zero gradient, since a clamped contribution does not change with the receiver.
    #[inline]
    pub fn held(self, share: f32) -> Incidence {
        Incidence { inv_dist: 0.0, gradient: [0.0; 2], factor: self.factor * share, ..self }
    }

    /// Returns the light times an attenuation `share`, whose derivatives along u and v are `slope`.
    #[inline]
    pub fn attenuated(self, share: f32, slope: [f32; 2]) -> Incidence {
        let along = |axis: usize| self.gradient[axis] * share + self.factor * slope[axis];
        Incidence { factor: self.factor * share, gradient: [along(0), along(1)], ..self }
    }

    /// Returns the derivative of the direction as the receiver moves along u (axis 0) or v (axis 1).
    #[inline]
    pub fn turning(&self, axis: usize) -> [f32; 3] {
        let omega = self.direction;
        let along = omega[axis];
        let mut turning = omega.map(|c| c * along * self.inv_dist);
        turning[axis] -= self.inv_dist;
        turning
    }
}

impl Incidence {
    /// Applies the spot profile; `None` outside the cone.
    #[inline]
    pub(super) fn through_spot(self, frame: &Frame, spot: &SpotProfile) -> Option<Incidence> {
        let away = -Vec3::from(self.direction);
        let share = spot.falloff(frame.to_world(away));
        if share <= 0.0 {
            return None;
        }
        let SpotProfile::Cone { direction, inner_angle, outer_angle } = *spot else {
            let slope = frame.to_local(spot.slope(frame.to_world(away)));
            let along = |axis: usize| -slope.dot(Vec3::from(self.turning(axis)));
            return Some(self.attenuated(share, [along(0), along(1)]));
        };
        if share >= 1.0 {
            return Some(self);
        }
        let axis = frame.to_local(direction);
        // Between the cones the falloff is linear in the angle ψ, whose cosine is axis · away.
        let cos = axis.dot(away);
        let sin = (1.0 - cos * cos).max(1e-12).sqrt();
        let per_cos = 1.0 / (sin * (outer_angle - inner_angle));
        let slope = |axis_index: usize| -axis.dot(Vec3::from(self.turning(axis_index))) * per_cos;
        Some(self.attenuated(share, [slope(0), slope(1)]))
    }

    /// Applies a lobe; `None` if it sends no light in this direction.
    #[inline]
    pub(super) fn through_lobe(self, frame: &Frame, lobe: &LobeProfile) -> Option<Incidence> {
        let (share, slope) = lobe.share_and_slope(frame.to_world(-Vec3::from(self.direction)));
        let slope = frame.to_local(slope);
        let along = |axis: usize| -slope.dot(Vec3::from(self.turning(axis)));
        (share > 0.0).then(|| self.attenuated(share, [along(0), along(1)]))
    }
}
