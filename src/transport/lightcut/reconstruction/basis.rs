//! Orthonormal functions of position over the anchors: a constant, and two that are linear in the tangent plane.

use crate::lightcut::ReceiverPacket;
use crate::lightcut::packet::halved;
use base::math::{F32x16, Frame, LANES, lanes_in};
use glam::Vec3;

/// Minimum number of anchors for a fit.
const MIN_ANCHORS: u32 = 8;

/// Minimum extent of the anchors along an axis for a slope, relative to their largest extent.
const MIN_EXTENT: f32 = 1e-3;

/// Values of the three functions, by lane.
pub(super) type BasisValues = [F32x16; 3];

/// Orthonormal functions of position.
#[derive(Clone, Copy)]
pub(super) struct LinearBasis {
    centre: Vec3,
    /// Value of the constant function.
    constant: f32,
    /// Maximum squared distance of an anchor from the centre.
    pub radius_sq: f32,
    axes: [Vec3; 2],
    /// Minimum and maximum of the linear functions at the anchors.
    ranges: [[f32; 2]; 2],
    /// Values at the anchors; 0 in lanes without an anchor.
    pub at_anchors: BasisValues,
}

impl LinearBasis {
    /// Creates the functions over these anchors; `None` if there are too few or all are in one place.
    pub fn new(anchors: &ReceiverPacket) -> Option<LinearBasis> {
        if anchors.valid.count_ones() < MIN_ANCHORS {
            return None;
        }
        let count = anchors.len() as f32;
        let at = |l: usize| anchors.get(l).position();
        let centre = (0..anchors.len()).map(at).sum::<Vec3>() / count;
        let along = |axis: Vec3| {
            let mut lanes = [0.0; LANES];
            lanes_in(anchors.valid).for_each(|l| lanes[l] = (at(l) - centre).dot(axis));
            lanes
        };
        let normal: Vec3 = (0..anchors.len()).map(|l| anchors.get(l).place().1).sum();
        let axes = axes(&Frame::from_normal(normal.normalize_or(Vec3::Z)), along)?;
        let constant = 1.0 / count.sqrt();
        let mut one = [0.0; LANES];
        lanes_in(anchors.valid).for_each(|l| one[l] = constant);
        let functions = axes.map(along);
        let ranges = functions.map(|f| {
            let low = f.into_iter().fold(f32::INFINITY, f32::min);
            [low, f.into_iter().fold(f32::NEG_INFINITY, f32::max)]
        });
        let radius_sq = (0..anchors.len()).map(|l| at(l).distance_squared(centre)).fold(0.0, f32::max);
        let at_anchors = [one, functions[0], functions[1]];
        Some(LinearBasis { centre, constant, radius_sq, axes, ranges, at_anchors })
    }

    /// Evaluates the functions at some points. Positions are limited to the anchors' extent, so nothing is
    /// extrapolated.
    pub fn at(&self, receivers: &ReceiverPacket) -> BasisValues {
        let mut values = [[0.0; LANES]; 3];
        for l in 0..LANES {
            let offset = receivers.position.get(l) - self.centre;
            values[0][l] = self.constant;
            for (f, axis) in self.axes.iter().enumerate() {
                let [low, high] = self.ranges[f];
                values[f + 1][l] = offset.dot(*axis).clamp(low, high);
            }
        }
        values
    }

    /// Returns the sum of squared residuals of `values` at the anchors, relative to their totals.
    pub fn squared_error(&self, values: &F32x16, inverse_totals: &F32x16) -> f32 {
        let k = self.at_anchors.each_ref().map(|f| dot(f, values));
        let [one, u, v] = &self.at_anchors;
        let mut squares = [0.0; LANES];
        for l in 0..LANES {
            // Functions and values are 0 in lanes without an anchor.
            let left = (values[l] - k[0] * one[l] - k[1] * u[l] - k[2] * v[l]) * inverse_totals[l];
            squares[l] = left * left;
        }
        squares.iter().sum()
    }
}

/// Returns the gradients in the tangent plane of two functions that are orthonormal over the anchors. `along` returns
/// the anchors' coordinates along an axis. The second gradient is 0 if the anchors lie on a line.
fn axes(frame: &Frame, along: impl Fn(Vec3) -> F32x16) -> Option<[Vec3; 2]> {
    let (u, v) = (along(frame.tangent), along(frame.bitangent));
    let (uu, uv, vv) = (dot(&u, &u), dot(&u, &v), dot(&v, &v));
    // The longer axis comes first, so that the remainder of the other is well conditioned.
    let (first, second, longer) =
        if uu >= vv { (frame.tangent, frame.bitangent, uu) } else { (frame.bitangent, frame.tangent, vv) };
    if !(longer > 0.0) {
        return None;
    }
    let second = second - first * (uv / longer);
    let rest = along(second);
    let shorter = dot(&rest, &rest);
    let wide = shorter > MIN_EXTENT * MIN_EXTENT * longer;
    let second = if wide { second / shorter.sqrt() } else { Vec3::ZERO };
    Some([first / longer.sqrt(), second])
}

/// Returns the inner product over the lanes.
pub(super) fn dot(a: &F32x16, b: &F32x16) -> f32 {
    halved(std::array::from_fn(|l| a[l] * b[l]), |a: f32, b| a + b)
}
