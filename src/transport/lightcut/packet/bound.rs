//! Upper bounds of a cluster's light at all receivers of a packet: the formulas of [`crate::lightcut::single`] as loops
//! over lanes, which compile to vector code.

use super::ReceiverPacket;
use super::receivers::Frames16;
use super::transfer::positive;
use crate::lightcut::Transfer;
use crate::lightcut::expected::{Outlook, expected_share, lobe_at};
use crate::lights::{LightNode, VplKind};
use base::math::{F32x16, Frame, LANES, LUMINANCE, Vec3x16, lanes_in, luminance};
use glam::Vec3;
use world::material::{DirectionBound, DirectionBounds16, LobeShape};

/// Relative margin of boxes: more than the rounding of the values computed from them.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

impl Transfer<'_> {
    /// Returns the expected error of each receiver's luminance from a cluster; 0 in lanes without a receiver.
    pub fn errors16(&self, receivers: &ReceiverPacket, node: &LightNode) -> F32x16 {
        let (mut errors, shares) = self.bounds16(receivers, node);
        for l in 0..LANES {
            errors[l] *= shares[l];
        }
        errors
    }

    /// Returns the upper bound of each receiver's luminance, 0 in lanes without a receiver, and the expected error
    /// relative to it.
    #[inline]
    pub(super) fn bounds16(&self, receivers: &ReceiverPacket, node: &LightNode) -> (F32x16, F32x16) {
        let cluster = ClusterBox::new(receivers, node);
        let GeometryBounds { geometry, cos_x, shares } = self.geometry16(&cluster, receivers, node);
        let mut bounds = [0.0; LANES];
        let (i, w) = (node.intensity, &receivers.brdf_luminance);
        for l in 0..LANES {
            let reflected = i.x * w.x[l] + i.y * w.y[l] + i.z * w.z[l];
            bounds[l] = reflected * (geometry[l] * cos_x[l]);
        }
        // Lanes whose lobes a part of the cluster may reach; many clusters have none.
        let mut lit = 0;
        for l in 0..LANES {
            lit |= u16::from(geometry[l] * cos_x[l] > 0.0) << l;
        }
        let lit = lit & receivers.general;
        match &receivers.glossy {
            _ if lit == 0 => {}
            Some(glossy) => {
                let (cos_i_min, cos_mirror_max) = cluster.lobe16(receivers);
                let reflection =
                    glossy.bound(&DirectionBounds16 { cos_i_max: cos_x, cos_i_min, cos_mirror_max });
                let w = i * LUMINANCE;
                for l in 0..LANES {
                    let reflected =
                        (w.x * reflection.x[l] + w.y * reflection.y[l] + w.z * reflection.z[l]) * geometry[l];
                    bounds[l] = if receivers.general >> l & 1 != 0 { reflected } else { bounds[l] };
                }
            }
            None => {
                let (cos_min, cos_mirror) = cluster.lobe16(receivers);
                for l in lanes_in(lit) {
                    let bound = DirectionBound {
                        cos_i_max: cos_x[l],
                        cos_i_min: cos_min[l],
                        cos_mirror_max: cos_mirror[l],
                    };
                    bounds[l] = luminance(receivers.get(l).max_reflection(&bound) * i) * geometry[l];
                }
            }
        }
        for (l, bound) in bounds.iter_mut().enumerate() {
            *bound = if receivers.valid >> l & 1 != 0 { *bound } else { 0.0 };
        }
        (bounds, shares)
    }

    /// Returns the bounds of all factors but the material.
    fn geometry16(
        &self,
        cluster: &ClusterBox,
        receivers: &ReceiverPacket,
        node: &LightNode,
    ) -> GeometryBounds {
        let &ClusterBox { local, half, rounding, .. } = cluster;
        let oriented = local && node.cos_beta > -1.0;
        let lobed = node.kind() == VplKind::Lobed;
        let (sin_beta, width_sq) = (node.sin_beta(), node.width_sq());
        let emitter = Frame::from_normal(-node.axis);
        let axes = [emitter.tangent, emitter.bitangent, emitter.normal];
        let half_along = |axis: Vec3| axis.abs().dot(half) + rounding;
        let emitter_half = [half_along(axes[0]), half_along(axes[1]), half_along(axes[2])];
        let mut all = GeometryBounds { geometry: [0.0; LANES], cos_x: [0.0; LANES], shares: [0.0; LANES] };
        let normals = receivers.frame.normal();
        for l in 0..LANES {
            let cos_x = positive(cluster.max_cos(receivers, &receivers.frame, l));
            let c = cluster.offset(receivers, l);
            let centre_z = c.dot(axes[2]);
            let z = centre_z + emitter_half[2];
            let (x, y) = (c.dot(axes[0]).abs(), c.dot(axes[1]).abs());
            let cos_theta = max_cos(x, emitter_half[0], y, emitter_half[1], z);
            let sin_theta = positive(1.0 - cos_theta * cos_theta).sqrt();
            let turned = cos_theta * node.cos_beta + sin_theta * sin_beta + 1e-6;
            let turned = if cos_theta >= node.cos_beta { 1.0 } else { turned };
            let cos_y = if !oriented { 1.0 } else { positive(turned).min(1.0) };
            let cos_y = if lobed { LobeShape::max_share(turned.min(1.0), width_sq) } else { cos_y };

            let gap =
                [positive(c.x.abs() - half.x), positive(c.y.abs() - half.y), positive(c.z.abs() - half.z)];
            let dist_sq = gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
            let dist_sq = if dist_sq > self.min_dist_sq { dist_sq } else { self.min_dist_sq };
            let centre_sq = c.length_squared();
            all.shares[l] = expected_share(Outlook {
                near_sq: if local { dist_sq } else { centre_sq },
                centre_sq,
                at_centre: [
                    c.x * normals.x[l] + c.y * normals.y[l] + c.z * normals.z[l],
                    match (lobed, oriented) {
                        (true, _) => lobe_at(centre_z, centre_sq.sqrt(), width_sq),
                        (_, true) => centre_z,
                        _ => centre_sq.sqrt(),
                    },
                ],
                largest: [cos_x, cos_y],
            });
            all.cos_x[l] = cos_x;
            all.geometry[l] = if local { cos_y / dist_sq } else { 1.0 };
        }
        all
    }
}

/// Bounds of a cluster's geometry term for each receiver.
struct GeometryBounds {
    /// Bound of the emitter's cosine over the squared distance.
    geometry: F32x16,
    /// Bound of the receiver's cosine.
    cos_x: F32x16,
    /// Expected error relative to the bound.
    shares: F32x16,
}

/// Box of a cluster, widened by the rounding of any lane.
struct ClusterBox {
    /// True for a box in space, false for one of directions.
    local: bool,
    centre: Vec3,
    half: Vec3,
    rounding: f32,
}

impl ClusterBox {
    fn new(receivers: &ReceiverPacket, node: &LightNode) -> ClusterBox {
        let local = node.kind() != VplKind::Directional;
        let centre = 0.5 * (node.min + node.max);
        let rounding = ROUNDING * (centre.abs().max_element() + if local { receivers.reach } else { 0.0 });
        ClusterBox { local, centre, half: 0.5 * (node.max - node.min) + rounding, rounding }
    }

    /// Returns the centre of the box relative to a receiver.
    #[inline(always)]
    fn offset(&self, receivers: &ReceiverPacket, l: usize) -> Vec3 {
        let origin = if self.local { 1.0 } else { 0.0 };
        self.centre - receivers.position.get(l) * origin
    }

    /// Returns the centre and half extent along a lane's `axis`.
    #[inline(always)]
    fn along(&self, c: Vec3, axis: &Vec3x16, abs_axis: &Vec3x16, l: usize) -> (f32, f32) {
        let centre = c.x * axis.x[l] + c.y * axis.y[l] + c.z * axis.z[l];
        let half = self.half.x * abs_axis.x[l] + self.half.y * abs_axis.y[l] + self.half.z * abs_axis.z[l];
        (centre, half + self.rounding)
    }

    /// Returns the centres and half extents along the three axes of a receiver's frame.
    #[inline(always)]
    fn turned(&self, receivers: &ReceiverPacket, frames: &Frames16, l: usize) -> [(f32, f32); 3] {
        let c = self.offset(receivers, l);
        let (axes, abs) = (&frames.axes, &frames.abs);
        [
            self.along(c, &axes[0], &abs[0], l),
            self.along(c, &axes[1], &abs[1], l),
            self.along(c, &axes[2], &abs[2], l),
        ]
    }

    /// Returns the maximum cosine to the z axis of a receiver's frame.
    #[inline(always)]
    fn max_cos(&self, receivers: &ReceiverPacket, frames: &Frames16, l: usize) -> f32 {
        let [(x, half_x), (y, half_y), (z, half_z)] = self.turned(receivers, frames, l);
        max_cos(x.abs(), half_x, y.abs(), half_y, z + half_z)
    }

    /// Returns the bounds for a lobe: minimum cosine to the normal, maximum cosine to the mirror direction.
    fn lobe16(&self, receivers: &ReceiverPacket) -> (F32x16, F32x16) {
        let (mut cos_min, mut cos_mirror) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let [(x, half_x), (y, half_y), (z, half_z)] = self.turned(receivers, &receivers.frame, l);
            let (far_x, far_y, low) = (x.abs() + half_x, y.abs() + half_y, z - half_z);
            let length = (far_x * far_x + far_y * far_y + low * low).sqrt();
            cos_min[l] = if low > 0.0 { low / length } else { 0.0 };
            cos_mirror[l] = self.max_cos(receivers, &receivers.mirror, l);
        }
        (cos_min, cos_mirror)
    }
}

/// Returns the maximum cosine to z over a box (see `OffsetBox::max_cos_z`) given by its distances from the z
/// axis.
#[inline(always)]
fn max_cos(x: f32, half_x: f32, y: f32, half_y: f32, z: f32) -> f32 {
    let (near_x, near_y) = (positive(x - half_x), positive(y - half_y));
    let (far_x, far_y) = (x + half_x, y + half_y);
    let near_sq = near_x * near_x + near_y * near_y;
    let far_sq = far_x * far_x + far_y * far_y;
    let length = (if z > 0.0 { near_sq } else { far_sq } + z * z).sqrt();
    z / if length > f32::MIN_POSITIVE { length } else { f32::MIN_POSITIVE }
}
