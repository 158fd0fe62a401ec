//! Upper bounds of a cluster's geometry over its box, at sixteen receivers.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1: the box is turned into the frame of the axis, where the
//! maximum cosine to the axis is at its highest z and minimum distance from the axis.

use super::ReceiverPacket;
use crate::lightcut::Transfer;
use crate::lightcut::expected::{ClusterView, expected_share, lobe_at};
use crate::lights::{LightNode, VplKind};
use base::math::{Frame, Lane, Mask, V3, f32x16};
use glam::Vec3;
use world::material::{DirectionBound, LobeShape};

/// Relative margin of boxes: more than the rounding of the values computed from them.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

/// Bounds of all factors but the material.
pub(super) struct GeometryBound {
    /// Bound of the emitter's cosine over the squared distance.
    pub geometry: f32x16,
    /// Bound of the receiver's cosine.
    pub cos_x: f32x16,
    /// Expected error relative to the bound.
    pub share: f32x16,
}

/// Box of a cluster, widened by the rounding of any receiver.
pub(super) struct ClusterBox {
    /// True for a box in space, false for one of directions.
    local: bool,
    centre: Vec3,
    half: Vec3,
    rounding: f32,
}

impl Transfer<'_> {
    /// Returns the bounds of all factors but the material.
    #[inline(always)]
    pub(super) fn geometry(
        &self,
        cluster: &ClusterBox,
        at: &ReceiverPacket,
        node: &LightNode,
    ) -> GeometryBound {
        let (frame, c) = (at.frame.load(), cluster.offset(at));
        let cos_x = cluster.max_cos(c, &frame).positive();
        if !cos_x.is_positive().any() {
            return GeometryBound { geometry: f32x16::from(0.0), cos_x, share: f32x16::from(0.0) };
        }
        let centre_sq = c.length_sq();
        let (cos_y, centre_y) = cluster.emitted(c, centre_sq.sqrt(), node);
        let near_sq =
            if cluster.local { cluster.gap_sq(c).max(f32x16::from(self.min_dist_sq)) } else { centre_sq };
        let share = expected_share(ClusterView {
            near_sq,
            centre_sq,
            at_centre: [c.dot(frame[2]), centre_y],
            largest: [cos_x, cos_y],
        });
        let geometry = if cluster.local { cos_y * near_sq.recip() } else { cos_y };
        GeometryBound { geometry, cos_x, share }
    }
}

impl ClusterBox {
    /// Widens the box of a cluster for receivers whose coordinates are at most `reach`.
    #[inline]
    pub fn new(reach: f32, node: &LightNode) -> ClusterBox {
        let local = node.kind() != VplKind::Directional;
        let centre = 0.5 * (node.min + node.max);
        let rounding = ROUNDING * (centre.abs().max_element() + if local { reach } else { 0.0 });
        ClusterBox { local, centre, half: 0.5 * (node.max - node.min) + rounding, rounding }
    }

    /// Bounds the directions to the cluster, for a lobe.
    #[inline(always)]
    pub fn directions(&self, at: &ReceiverPacket, cos_x: f32x16) -> DirectionBound<f32x16> {
        let c = self.offset(at);
        let [x, y, (z, half_z)] = self.turned(c, &at.frame.load());
        let low = z - half_z;
        let far_sq = (x.0.abs() + x.1).sq() + (y.0.abs() + y.1).sq() + low.sq();
        let cos_i_min = (low * far_sq.max(f32x16::from(1e-37)).rsqrt()).positive();
        let cos_mirror_max = self.max_cos(c, &at.mirror.load());
        DirectionBound { cos_i_max: cos_x.min(f32x16::from(1.0)), cos_i_min, cos_mirror_max }
    }

    /// Returns the centre of the box relative to a receiver.
    #[inline(always)]
    fn offset(&self, at: &ReceiverPacket) -> V3<f32x16> {
        let centre = V3::splat(self.centre);
        if self.local { centre - at.position.load() } else { centre }
    }

    /// Returns the squared distance of the box from a receiver.
    #[inline(always)]
    fn gap_sq(&self, c: V3<f32x16>) -> f32x16 {
        (c.abs() - V3::splat(self.half)).map(f32x16::positive).length_sq()
    }

    /// Returns the centres and half extents along three axes.
    #[inline(always)]
    fn turned(&self, c: V3<f32x16>, axes: &[V3<f32x16>; 3]) -> [(f32x16, f32x16); 3] {
        let along =
            |axis: V3<f32x16>| (c.dot(axis), axis.abs().along(self.half) + f32x16::from(self.rounding));
        [along(axes[0]), along(axes[1]), along(axes[2])]
    }

    /// Returns the maximum cosine to the last of three axes.
    #[inline(always)]
    fn max_cos(&self, c: V3<f32x16>, axes: &[V3<f32x16>; 3]) -> f32x16 {
        let [x, y, (z, half_z)] = self.turned(c, axes);
        max_cos(x, y, z + half_z)
    }

    /// Returns the most that a member emits towards a receiver, relative to its intensity; and what the centre emits,
    /// times the distance.
    #[inline(always)]
    fn emitted(&self, c: V3<f32x16>, distance: f32x16, node: &LightNode) -> (f32x16, f32x16) {
        let (one, lobed) = (f32x16::from(1.0), node.kind() == VplKind::Lobed);
        if !self.local || node.cos_beta <= -1.0 && !lobed {
            return (one, distance);
        }
        let axes = Frame::from_normal(-node.axis);
        let along = |axis: Vec3| (c.along(axis), f32x16::from(axis.abs().dot(self.half) + self.rounding));
        let (x, y, z) = (along(axes.tangent), along(axes.bitangent), along(axes.normal));
        let cos_theta = max_cos(x, y, z.0 + z.1);
        let sin_theta = cos_theta.sq().rest().positive().sqrt();
        // The margin covers the rounding of sin θ where cos θ is near 1.
        let turned = cos_theta * node.cos_beta + sin_theta * node.sin_beta() + f32x16::from(1e-6);
        let most = f32x16::pick(cos_theta.gt(f32x16::from(node.cos_beta)), one, turned.min(one));
        if lobed {
            (LobeShape::max_share(most, node.width_sq()), lobe_at(z.0, distance, node.width_sq()))
        } else {
            (most.positive(), z.0)
        }
    }
}

/// Returns the maximum cosine to z over a box given by centre and half extent along x and y, and its highest `z`.
#[inline(always)]
fn max_cos((x, half_x): (f32x16, f32x16), (y, half_y): (f32x16, f32x16), z: f32x16) -> f32x16 {
    let (x, y) = (x.abs(), y.abs());
    let near_sq = (x - half_x).positive().sq() + (y - half_y).positive().sq();
    let far_sq = (x + half_x).sq() + (y + half_y).sq();
    let across_sq = f32x16::pick(z.is_positive(), near_sq, far_sq);
    z * z.mul_add(z, across_sq).max(f32x16::from(1e-37)).rsqrt()
}
