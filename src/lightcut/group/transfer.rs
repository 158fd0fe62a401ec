//! Transfer and bounds for all points of a group at once: the formulas of the single-point versions, written as
//! loops over lanes that compile to vector code.

use super::points::{Points, Vec3Lanes, lanes_of};
use super::{LANES, Lanes, RgbLanes};
use crate::embree::Rays16;
use crate::light_tree::Node;
use crate::lightcut::{Transfer, Unoccluded};
use crate::math::{Frame, Rgb, luminance};
use crate::shadow;
use crate::vpl::{Vpl, VplKind};
use crate::world::World;
use glam::Vec3;

/// Widens boxes by more than the rounding of what is computed from them.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

impl Transfer<'_> {
    /// Upper bound of each point's luminance from a cluster of intensity `node.intensity`; 0 in lanes without a point.
    pub(super) fn bounds16(&self, points: &Points, node: &Node) -> Lanes {
        let mut bounds = [0.0; LANES];
        if points.valid & !points.general != 0 {
            self.lambert_bounds(points, node, &mut bounds);
        }
        if points.general != 0 || points.valid != u16::MAX {
            for (lane, bound) in bounds.iter_mut().enumerate() {
                if points.general >> lane & 1 != 0 {
                    *bound = luminance(self.bound(points.get(lane), node) * node.intensity);
                } else if points.valid >> lane & 1 == 0 {
                    *bound = 0.0;
                }
            }
        }
        bounds
    }

    fn lambert_bounds(&self, points: &Points, node: &Node, bounds: &mut Lanes) {
        let local = node.kind() != VplKind::Directional;
        let centre = 0.5 * (node.min + node.max);
        let rounding = ROUNDING * (centre.abs().max_element() + if local { points.reach } else { 0.0 });
        let half = 0.5 * (node.max - node.min) + rounding;
        let oriented = local && node.cos_beta > -1.0;
        let emitter = Frame::from_normal(-node.axis);
        let axes = [emitter.tangent, emitter.bitangent, emitter.normal];
        let emitter_half = axes.map(|axis| axis.abs().dot(half) + rounding);
        let at_receiver = if local { 1.0 } else { 0.0 };
        let (i, x, f, a) = (node.intensity, &points.position, &points.frame, &points.abs_frame);
        for l in 0..LANES {
            let c = [
                centre.x - x[0][l] * at_receiver,
                centre.y - x[1][l] * at_receiver,
                centre.z - x[2][l] * at_receiver,
            ];
            let along = |axis: &Vec3Lanes| c[0] * axis[0][l] + c[1] * axis[1][l] + c[2] * axis[2][l];
            let extent =
                |axis: &Vec3Lanes| half.x * axis[0][l] + half.y * axis[1][l] + half.z * axis[2][l] + rounding;
            let z = along(&f[2]) + extent(&a[2]);
            let cos_x = max_cos(along(&f[0]).abs(), extent(&a[0]), along(&f[1]).abs(), extent(&a[1]), z);

            let c = Vec3::from_array(c);
            let ez = c.dot(axes[2]) + emitter_half[2];
            let (ex, ey) = (c.dot(axes[0]).abs(), c.dot(axes[1]).abs());
            let cos_theta = max_cos(ex, emitter_half[0], ey, emitter_half[1], ez);
            let sin_theta = positive(1.0 - cos_theta * cos_theta).sqrt();
            let turned = cos_theta * node.cos_beta + sin_theta * node.sin_beta + 1e-6;
            let cos_y = if !oriented || cos_theta >= node.cos_beta { 1.0 } else { positive(turned).min(1.0) };

            let gap =
                [positive(c.x.abs() - half.x), positive(c.y.abs() - half.y), positive(c.z.abs() - half.z)];
            let dist_sq = gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
            let dist_sq = if dist_sq > self.min_dist_sq { dist_sq } else { self.min_dist_sq };
            let inv_dist_sq = if local { 1.0 / dist_sq } else { 1.0 };

            let w = &points.brdf_luminance;
            let reflected = i.x * w[0][l] + i.y * w[1][l] + i.z * w[2][l];
            bounds[l] = reflected * (positive(cos_x) * cos_y * inv_dist_sq);
        }
    }

    /// Each point's contribution from a VPL of unit intensity, if visible, and the lanes where it is not 0.
    pub(super) fn unshadowed16(
        &self,
        points: &Points,
        vpl: &Vpl,
        kind: VplKind,
        responses: &mut RgbLanes,
    ) -> u16 {
        let mut one_by_one = points.general;
        match kind {
            VplKind::Oriented => self.lambert_oriented(points, vpl.position, vpl.normal(), responses),
            VplKind::Directional => lambert_directional(points, vpl.position, responses),
            VplKind::Omni => one_by_one = points.valid,
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

    fn lambert_oriented(&self, points: &Points, y: Vec3, normal: Vec3, responses: &mut RgbLanes) {
        let (x, n) = (&points.position, &points.frame[2]);
        for l in 0..LANES {
            let (dx, dy, dz) = (y.x - x[0][l], y.y - x[1][l], y.z - x[2][l]);
            let dist_sq = dx * dx + dy * dy + dz * dz;
            let at_x = positive(dx * n[0][l] + dy * n[1][l] + dz * n[2][l]);
            let at_y = positive(-(dx * normal.x + dy * normal.y + dz * normal.z));
            let limited = if dist_sq > self.min_dist_sq { dist_sq } else { self.min_dist_sq };
            // Cosines still lack one distance each.
            let unit = if dist_sq > 0.0 { 1.0 / dist_sq } else { 0.0 };
            let geometry = at_x * at_y * unit / limited;
            for c in 0..3 {
                responses[c][l] = points.brdf[c][l] * geometry;
            }
        }
    }
}

fn lambert_directional(points: &Points, towards: Vec3, responses: &mut RgbLanes) {
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
pub trait GroupVisibility {
    /// The lanes of `lanes` that see it.
    fn visible16(&self, points: &Points, lanes: u16, vpl: &Vpl, kind: VplKind) -> u16;
}

impl GroupVisibility for Unoccluded {
    #[inline]
    fn visible16(&self, _: &Points, lanes: u16, _: &Vpl, _: VplKind) -> u16 {
        lanes
    }
}

impl GroupVisibility for World {
    #[inline]
    fn visible16(&self, points: &Points, lanes: u16, vpl: &Vpl, kind: VplKind) -> u16 {
        let mut rays = Rays16::default();
        let end_normal = if kind == VplKind::Oriented { vpl.normal() } else { Vec3::ZERO };
        for lane in lanes_of(lanes) {
            let at = |v: &Vec3Lanes| Vec3::new(v[0][lane], v[1][lane], v[2][lane]);
            let (x, normal) = (at(&points.position), at(&points.geometric_normal));
            // Rays start at the receivers: a coherent packet that fans out from the light loses hits.
            let ray = match kind {
                VplKind::Directional => shadow::ray_from(x, normal, vpl.position),
                _ => shadow::segment(x, normal, vpl.position, end_normal),
            };
            rays.set(lane, &ray);
        }
        lanes & !self.accel.occluded16(&rays, lanes, true)
    }
}

/// Luminance of each lane's colour times `intensity`.
#[inline]
pub(super) fn luminances(intensity: Rgb, responses: &RgbLanes) -> Lanes {
    let w = intensity * crate::math::LUMINANCE;
    std::array::from_fn(|l| w.x * responses[0][l] + w.y * responses[1][l] + w.z * responses[2][l])
}
