//! Branches of the emitter tree: up to eight siblings, chosen between at once.

use super::node::{ARITY, BY_POWER, Child, Node};
use base::math::F32x8;
use glam::Vec3;

/// Siblings, as a structure of arrays.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Branch {
    centre: [[f32; ARITY]; 3],
    radius: [f32; ARITY],
    axis: [[f32; ARITY]; 3],
    cos_normals: [f32; ARITY],
    sin_normals: [f32; ARITY],
    cos_emission: [f32; ARITY],
    peak: [f32; ARITY],
    /// Shares of the power.
    share: [f32; ARITY],
    children: [Child; ARITY],
}

impl Branch {
    /// Branch of at most [`ARITY`] nodes, each with its share of the power.
    pub fn new(nodes: &[(Node, f32, Child)]) -> Branch {
        let mut branch = Branch {
            centre: [[0.0; ARITY]; 3],
            radius: [1.0; ARITY],
            axis: [[0.0; ARITY]; 3],
            cos_normals: [0.0; ARITY],
            sin_normals: [0.0; ARITY],
            cos_emission: [0.0; ARITY],
            peak: [0.0; ARITY],
            share: [0.0; ARITY],
            children: [Child::emitter(0); ARITY],
        };
        for (i, (node, share, child)) in nodes.iter().enumerate() {
            for k in 0..3 {
                (branch.centre[k][i], branch.axis[k][i]) = (node.centre[k], node.axis[k]);
            }
            branch.radius[i] = node.radius;
            branch.cos_normals[i] = node.cos_normals;
            branch.sin_normals[i] = node.sin_normals;
            branch.cos_emission[i] = node.cos_emission;
            branch.peak[i] = node.peak;
            (branch.share[i], branch.children[i]) = (*share, *child);
        }
        branch
    }

    /// Weights of the children at a point with its normal, zero for those that do not shine there; `factors` on their
    /// importance are those that have been learned.
    #[inline(always)]
    fn weights(&self, (x, n): (Vec3, Vec3), factors: Option<&[f32]>) -> [f32; ARITY] {
        let mut weights = [0.0; ARITY];
        for i in 0..ARITY {
            let node = Node {
                centre: Vec3::new(self.centre[0][i], self.centre[1][i], self.centre[2][i]),
                radius: self.radius[i],
                axis: Vec3::new(self.axis[0][i], self.axis[1][i], self.axis[2][i]),
                cos_normals: self.cos_normals[i],
                sin_normals: self.sin_normals[i],
                cos_emission: self.cos_emission[i],
                peak: self.peak[i],
            };
            weights[i] = node.importance(x, n);
        }
        for (weight, factor) in weights.iter_mut().zip(factors.into_iter().flatten()) {
            *weight *= factor;
        }
        let sum = F32x8(weights).sum();
        let scale = if sum > 0.0 { (1.0 - BY_POWER) / sum } else { 0.0 };
        for i in 0..ARITY {
            let weight = weights[i] * scale + BY_POWER * self.share[i];
            weights[i] = if weights[i] > 0.0 { weight } else { 0.0 };
        }
        weights
    }

    /// Chooses a child; returns it, its probability and the number stretched within it. `None` where no child
    /// shines.
    #[inline]
    pub fn sample(&self, at: (Vec3, Vec3), factors: Option<&[f32]>, u: f32) -> Option<(Child, f32, f32)> {
        let weights = self.weights(at, factors);
        let (mut ends, mut total) = ([0.0; ARITY], 0.0);
        for i in 0..ARITY {
            total += weights[i];
            ends[i] = total;
        }
        if total == 0.0 {
            return None;
        }
        // Less than the last end, whatever the rounding: so a child of positive weight is found.
        let place = (u * total).min(total * (1.0 - f32::EPSILON));
        let mut slot = 0;
        for end in ends {
            slot += usize::from(end <= place);
        }
        let start = if slot > 0 { ends[slot - 1] } else { 0.0 };
        let rest = ((place - start) / weights[slot]).min(1.0 - f32::EPSILON);
        Some((self.children[slot], weights[slot] / total, rest))
    }

    /// Probability of [`Branch::sample`] choosing child `slot`.
    #[inline]
    pub fn probability(&self, at: (Vec3, Vec3), factors: Option<&[f32]>, slot: usize) -> f32 {
        let weights = self.weights(at, factors);
        let total = F32x8(weights).sum();
        if total > 0.0 { weights[slot] / total } else { 0.0 }
    }
}
