//! Attenuation by profiles of spot lights and lobes, with its derivatives as the receiver moves.

use super::incidence::Incidence;
use crate::lights::{LobeProfile, SpotProfile};
use base::math::Frame;
use glam::Vec3;

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
