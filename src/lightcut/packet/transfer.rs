//! Transfer and bounds for all points of a group at once: the formulas of the single-point versions, written as
//! loops over lanes that compile to vector code.

use super::receivers::{ReceiverPacket, Vec3Lanes, lanes_of};
use super::{LANES, Lanes, RgbLanes};
use crate::light_tree::Node;
use crate::lightcut::expected::{Outlook, expected_share};
use crate::lightcut::{Transfer, Unoccluded};
use crate::material::{AlikeBsdfs16, DirectionBound, DirectionBounds16};
use crate::math::{Frame, LUMINANCE, Rgb, Vec3x16, luminance};
use crate::vpl::{Vpl, VplKind};
use glam::Vec3;

/// Widens boxes by more than the rounding of what is computed from them.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

impl Transfer<'_> {
    /// Error to expect of each point's luminance from a cluster of intensity `node.intensity`; 0 in lanes without a point.
    pub fn errors16(&self, points: &ReceiverPacket, node: &Node) -> Lanes {
        let (bounds, shares) = self.bounds16(points, node);
        std::array::from_fn(|l| bounds[l] * shares[l])
    }

    /// Upper bound of each point's luminance, 0 in lanes without a point, and the error to expect relative to it.
    #[inline]
    pub(in crate::lightcut) fn bounds16(&self, points: &ReceiverPacket, node: &Node) -> (Lanes, Lanes) {
        let cluster = Cluster::new(points, node);
        let Geometry { geometry, cos_x, shares } = self.geometry16(&cluster, points, node);
        let mut bounds = [0.0; LANES];
        let (i, w) = (node.intensity, &points.brdf_luminance);
        for l in 0..LANES {
            let reflected = i.x * w[0][l] + i.y * w[1][l] + i.z * w[2][l];
            bounds[l] = reflected * (geometry[l] * cos_x[l]);
        }
        if let Some(glossy) = &points.glossy {
            let (cos_i_min, cos_mirror_max) = cluster.lobe16(points);
            let most = glossy.bound(&DirectionBounds16 { cos_i_max: cos_x, cos_i_min, cos_mirror_max });
            let w = i * LUMINANCE;
            for l in 0..LANES {
                let reflected = (w.x * most.x[l] + w.y * most.y[l] + w.z * most.z[l]) * geometry[l];
                bounds[l] = if points.general >> l & 1 != 0 { reflected } else { bounds[l] };
            }
        } else if points.general != 0 {
            let (cos_min, cos_mirror) = cluster.lobe16(points);
            for l in lanes_of(points.general) {
                if geometry[l] * cos_x[l] > 0.0 {
                    let bound = DirectionBound {
                        cos_i_max: cos_x[l],
                        cos_i_min: cos_min[l],
                        cos_mirror_max: cos_mirror[l],
                    };
                    bounds[l] = luminance(points.get(l).max_reflection(&bound) * i) * geometry[l];
                }
            }
        }
        for (l, bound) in bounds.iter_mut().enumerate() {
            *bound = if points.valid >> l & 1 != 0 { *bound } else { 0.0 };
        }
        (bounds, shares)
    }

    /// Bounds of everything but the material.
    fn geometry16(&self, cluster: &Cluster, points: &ReceiverPacket, node: &Node) -> Geometry {
        let &Cluster { local, half, rounding, .. } = cluster;
        let oriented = local && node.cos_beta > -1.0;
        let emitter = Frame::from_normal(-node.axis);
        let axes = [emitter.tangent, emitter.bitangent, emitter.normal];
        let emitter_half = axes.map(|axis| axis.abs().dot(half) + rounding);
        let mut all = Geometry { geometry: [0.0; LANES], cos_x: [0.0; LANES], shares: [0.0; LANES] };
        let normals = &points.frame[2];
        for l in 0..LANES {
            let cos_x = positive(cluster.max_cos(points, &points.frame, &points.abs_frame, l));
            let c = cluster.offset(points, l);
            let centre_z = c.dot(axes[2]);
            let z = centre_z + emitter_half[2];
            let (x, y) = (c.dot(axes[0]).abs(), c.dot(axes[1]).abs());
            let cos_theta = max_cos(x, emitter_half[0], y, emitter_half[1], z);
            let sin_theta = positive(1.0 - cos_theta * cos_theta).sqrt();
            let turned = cos_theta * node.cos_beta + sin_theta * node.sin_beta + 1e-6;
            let cos_y = if !oriented || cos_theta >= node.cos_beta { 1.0 } else { positive(turned).min(1.0) };

            let gap =
                [positive(c.x.abs() - half.x), positive(c.y.abs() - half.y), positive(c.z.abs() - half.z)];
            let dist_sq = gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
            let dist_sq = if dist_sq > self.min_dist_sq { dist_sq } else { self.min_dist_sq };
            let centre_sq = c.length_squared();
            all.shares[l] = expected_share(Outlook {
                near_sq: if local { dist_sq } else { centre_sq },
                centre_sq,
                at_centre: [
                    c.x * normals[0][l] + c.y * normals[1][l] + c.z * normals[2][l],
                    if oriented { centre_z } else { centre_sq.sqrt() },
                ],
                largest: [cos_x, cos_y],
            });
            all.cos_x[l] = cos_x;
            all.geometry[l] = if local { cos_y / dist_sq } else { 1.0 };
        }
        all
    }

    /// Each point's contribution from a VPL of unit intensity, if visible, and the lanes where it is not 0.
    pub fn unshadowed16(
        &self,
        points: &ReceiverPacket,
        vpl: &Vpl,
        kind: VplKind,
        responses: &mut RgbLanes,
    ) -> u16 {
        let mut one_by_one = points.general;
        match kind {
            VplKind::Oriented => self.lambert_oriented(points, vpl, responses),
            VplKind::Directional => lambert_directional(points, vpl.position, responses),
            VplKind::Omni => one_by_one = points.valid,
        }
        if let (Some(glossy), false) = (&points.glossy, kind == VplKind::Omni) {
            self.respond(glossy, points, vpl, kind, responses);
            one_by_one = 0;
        }
        for lane in lanes_of(one_by_one) {
            let response = self.unshadowed(points.get(lane), vpl, kind);
            for c in 0..3 {
                responses[c][lane] = response[c];
            }
        }
        let mut lit = 0;
        for l in 0..LANES {
            lit |= u16::from(responses[0][l] + responses[1][l] + responses[2][l] > 0.0) << l;
        }
        lit & points.valid
    }

    /// What alike materials reflect from a VPL that is no spot, in the lanes where they are.
    fn respond(
        &self,
        glossy: &AlikeBsdfs16,
        points: &ReceiverPacket,
        vpl: &Vpl,
        kind: VplKind,
        responses: &mut RgbLanes,
    ) {
        let (mut wi, mut emitted) = (Vec3x16::default(), [1.0; LANES]);
        let frame = &points.frame;
        let (distant, normal) = (kind == VplKind::Directional, vpl.normal());
        let near_sq = self.near_sq(vpl, kind);
        for l in 0..LANES {
            let x = Vec3::new(points.position[0][l], points.position[1][l], points.position[2][l]);
            let offset = if distant { vpl.position } else { vpl.position - x };
            let dist_sq = offset.length_squared();
            let towards = offset * if dist_sq > 0.0 { 1.0 / dist_sq.sqrt() } else { 0.0 };
            let limited = if dist_sq > near_sq { dist_sq } else { near_sq };
            let local = |f: &Vec3Lanes| f[0][l] * towards.x + f[1][l] * towards.y + f[2][l] * towards.z;
            wi.set(l, Vec3::new(local(&frame[0]), local(&frame[1]), local(&frame[2])));
            emitted[l] = if distant { 1.0 } else { positive(-normal.dot(towards)) / limited };
        }
        let response = glossy.response(&wi);
        for l in 0..LANES {
            let general = points.general >> l & 1 != 0;
            for (c, row) in [&response.x, &response.y, &response.z].into_iter().enumerate() {
                responses[c][l] = if general { row[l] * emitted[l] } else { responses[c][l] };
            }
        }
    }

    /// Irradiance vector at each point from a VPL of unit intensity, if visible; 0 where it is below the horizon.
    pub(in crate::lightcut) fn incidence16(
        &self,
        points: &ReceiverPacket,
        vpl: &Vpl,
        kind: VplKind,
    ) -> Vec3Lanes {
        let mut vector = [[0.0; LANES]; 3];
        let n = &points.frame[2];
        let near_sq = self.near_sq(vpl, kind);
        for l in 0..LANES {
            let x = Vec3::from_array(std::array::from_fn(|c| points.position[c][l]));
            let offset = if kind == VplKind::Directional { vpl.position } else { vpl.position - x };
            let dist_sq = offset.length_squared();
            let limited = if dist_sq > near_sq { dist_sq } else { near_sq };
            let unit = if dist_sq > 0.0 { 1.0 / dist_sq } else { 0.0 };
            let scale = match kind {
                VplKind::Directional => 1.0,
                VplKind::Oriented => positive(-offset.dot(vpl.normal())) * unit / limited,
                VplKind::Omni => unit.sqrt() / limited,
            };
            let above = offset.x * n[0][l] + offset.y * n[1][l] + offset.z * n[2][l] > 0.0;
            let scale = if above { scale } else { 0.0 };
            for c in 0..3 {
                vector[c][l] = offset[c] * scale;
            }
        }
        if let (VplKind::Omni, Some(profile)) = (kind, vpl.spot_profile()) {
            for l in lanes_of(points.valid) {
                let offset = vpl.position - points.get(l).position();
                let falloff = self.trees.spots[profile].falloff(-offset.normalize_or_zero());
                vector.iter_mut().for_each(|row| row[l] *= falloff);
            }
        }
        vector
    }

    fn lambert_oriented(&self, points: &ReceiverPacket, vpl: &Vpl, responses: &mut RgbLanes) {
        let (y, normal) = (vpl.position, vpl.normal());
        let near_sq = self.near_sq(vpl, VplKind::Oriented);
        let (x, n) = (&points.position, &points.frame[2]);
        for l in 0..LANES {
            let (dx, dy, dz) = (y.x - x[0][l], y.y - x[1][l], y.z - x[2][l]);
            let dist_sq = dx * dx + dy * dy + dz * dz;
            let at_x = positive(dx * n[0][l] + dy * n[1][l] + dz * n[2][l]);
            let at_y = positive(-(dx * normal.x + dy * normal.y + dz * normal.z));
            let limited = if dist_sq > near_sq { dist_sq } else { near_sq };
            // Cosines still lack one distance each.
            let unit = if dist_sq > 0.0 { 1.0 / dist_sq } else { 0.0 };
            let geometry = at_x * at_y * unit / limited;
            for c in 0..3 {
                responses[c][l] = points.brdf[c][l] * geometry;
            }
        }
    }
}

/// A cluster's geometry term for each point.
struct Geometry {
    /// Bound of the emitter's cosine over squared distance.
    geometry: Lanes,
    /// Bound of the receiver's cosine.
    cos_x: Lanes,
    /// Error to expect relative to the bound.
    shares: Lanes,
}

/// A cluster's box, widened by what rounding may lose in any lane.
struct Cluster {
    /// Whether the box is in space, not a box of directions.
    local: bool,
    centre: Vec3,
    half: Vec3,
    rounding: f32,
}

impl Cluster {
    fn new(points: &ReceiverPacket, node: &Node) -> Cluster {
        let local = node.kind() != VplKind::Directional;
        let centre = 0.5 * (node.min + node.max);
        let rounding = ROUNDING * (centre.abs().max_element() + if local { points.reach } else { 0.0 });
        Cluster { local, centre, half: 0.5 * (node.max - node.min) + rounding, rounding }
    }

    /// Centre of the box as seen from a point.
    #[inline(always)]
    fn offset(&self, points: &ReceiverPacket, l: usize) -> Vec3 {
        let origin = if self.local { 1.0 } else { 0.0 };
        let x = &points.position;
        self.centre - Vec3::new(x[0][l], x[1][l], x[2][l]) * origin
    }

    /// Centre and half extent along an axis of a point's own.
    #[inline(always)]
    fn along(&self, c: Vec3, axis: &Vec3Lanes, abs_axis: &Vec3Lanes, l: usize) -> (f32, f32) {
        let centre = c.x * axis[0][l] + c.y * axis[1][l] + c.z * axis[2][l];
        let half = self.half.x * abs_axis[0][l] + self.half.y * abs_axis[1][l] + self.half.z * abs_axis[2][l];
        (centre, half + self.rounding)
    }

    /// Largest cosine to the z axis of a point's frame.
    #[inline(always)]
    fn max_cos(
        &self,
        points: &ReceiverPacket,
        axes: &[Vec3Lanes; 3],
        abs_axes: &[Vec3Lanes; 3],
        l: usize,
    ) -> f32 {
        let c = self.offset(points, l);
        let (x, half_x) = self.along(c, &axes[0], &abs_axes[0], l);
        let (y, half_y) = self.along(c, &axes[1], &abs_axes[1], l);
        let (z, half_z) = self.along(c, &axes[2], &abs_axes[2], l);
        max_cos(x.abs(), half_x, y.abs(), half_y, z + half_z)
    }

    /// What a lobe's bound needs besides: least cosine to the normal, largest to the mirror direction.
    fn lobe16(&self, points: &ReceiverPacket) -> (Lanes, Lanes) {
        let (mut cos_min, mut cos_mirror) = ([0.0; LANES], [0.0; LANES]);
        let (f, a) = (&points.frame, &points.abs_frame);
        for l in 0..LANES {
            let c = self.offset(points, l);
            let (x, half_x) = self.along(c, &f[0], &a[0], l);
            let (y, half_y) = self.along(c, &f[1], &a[1], l);
            let (z, half_z) = self.along(c, &f[2], &a[2], l);
            let (far_x, far_y, low) = (x.abs() + half_x, y.abs() + half_y, z - half_z);
            let length = (far_x * far_x + far_y * far_y + low * low).sqrt();
            cos_min[l] = if low > 0.0 { low / length } else { 0.0 };
            cos_mirror[l] = self.max_cos(points, &points.mirror, &points.abs_mirror, l);
        }
        (cos_min, cos_mirror)
    }
}

fn lambert_directional(points: &ReceiverPacket, towards: Vec3, responses: &mut RgbLanes) {
    let n = &points.frame[2];
    for l in 0..LANES {
        let cos = positive(towards.x * n[0][l] + towards.y * n[1][l] + towards.z * n[2][l]);
        for c in 0..3 {
            responses[c][l] = points.brdf[c][l] * cos;
        }
    }
}

/// Largest cosine to z over a box (see `OffsetBox::max_cos_z`) given by its distances from the z axis.
#[inline(always)]
fn max_cos(x: f32, half_x: f32, y: f32, half_y: f32, z: f32) -> f32 {
    let (near_x, near_y) = (positive(x - half_x), positive(y - half_y));
    let (far_x, far_y) = (x + half_x, y + half_y);
    let near_sq = near_x * near_x + near_y * near_y;
    let far_sq = far_x * far_x + far_y * far_y;
    let length = (if z > 0.0 { near_sq } else { far_sq } + z * z).sqrt();
    z / if length > f32::MIN_POSITIVE { length } else { f32::MIN_POSITIVE }
}

/// The positive part; a plain comparison, which is one instruction where `f32::max` is three.
#[inline(always)]
fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// Which points of a group see a VPL.
pub trait PacketVisibility {
    /// The lanes of `lanes` that see it.
    fn visible16(&self, points: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16;
}

impl PacketVisibility for Unoccluded {
    #[inline]
    fn visible16(&self, _: &ReceiverPacket, lanes: u16, _: &Vpl, _: &Node) -> u16 {
        lanes
    }
}

/// Luminance of each lane's colour times `intensity`.
#[inline]
pub(in crate::lightcut) fn luminances(intensity: Rgb, responses: &RgbLanes) -> Lanes {
    let w = intensity * crate::math::LUMINANCE;
    std::array::from_fn(|l| w.x * responses[0][l] + w.y * responses[1][l] + w.z * responses[2][l])
}
