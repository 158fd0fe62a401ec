//! Branches of the emitter tree: up to eight siblings that are weighted at once.

use super::node::{ARITY, BY_POWER, EmitterNode, PointAndNormal, TreeChild};
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
    /// Shares of the branch's power.
    share: [f32; ARITY],
    children: [TreeChild; ARITY],
}

impl Branch {
    /// Builds a branch of at most [`ARITY`] nodes, each with its share of the power.
    pub fn new(nodes: &[(EmitterNode, f32, TreeChild)]) -> Branch {
        let mut branch = Branch {
            centre: [[0.0; ARITY]; 3],
            radius: [1.0; ARITY],
            axis: [[0.0; ARITY]; 3],
            cos_normals: [0.0; ARITY],
            sin_normals: [0.0; ARITY],
            cos_emission: [0.0; ARITY],
            peak: [0.0; ARITY],
            share: [0.0; ARITY],
            children: [TreeChild::emitter(0); ARITY],
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

    /// Returns the weights of the children at a point; zero for children that cannot light it. `factors` are learned
    /// factors on their importance.
    #[inline(always)]
    fn weights(&self, at: PointAndNormal, factors: Option<&[f32]>) -> [f32; ARITY] {
        let mut weights = [0.0; ARITY];
        for i in 0..ARITY {
            let node = EmitterNode {
                centre: Vec3::new(self.centre[0][i], self.centre[1][i], self.centre[2][i]),
                radius: self.radius[i],
                axis: Vec3::new(self.axis[0][i], self.axis[1][i], self.axis[2][i]),
                cos_normals: self.cos_normals[i],
                sin_normals: self.sin_normals[i],
                cos_emission: self.cos_emission[i],
                peak: self.peak[i],
            };
            weights[i] = node.importance(at);
        }
        for (weight, factor) in weights.iter_mut().zip(factors.into_iter().flatten()) {
            *weight *= factor;
        }
        let sum = sum(&weights);
        let scale = if sum > 0.0 { (1.0 - BY_POWER) / sum } else { 0.0 };
        for i in 0..ARITY {
            let weight = weights[i] * scale + BY_POWER * self.share[i];
            weights[i] = if weights[i] > 0.0 { weight } else { 0.0 };
        }
        weights
    }

    /// Chooses a child. Returns the child, its probability, and `u` rescaled within it; `None` if no child lights the
    /// point.
    #[inline]
    pub fn sample(
        &self,
        at: PointAndNormal,
        factors: Option<&[f32]>,
        u: f32,
    ) -> Option<(TreeChild, f32, f32)> {
        let weights = self.weights(at, factors);
        let (mut ends, mut total) = ([0.0; ARITY], 0.0);
        for i in 0..ARITY {
            total += weights[i];
            ends[i] = total;
        }
        if total == 0.0 {
            return None;
        }
        // The value stays below the last end despite rounding, so that a child of positive weight is chosen.
        let place = (u * total).min(total * (1.0 - f32::EPSILON));
        let mut slot = 0;
        for end in ends {
            slot += usize::from(end <= place);
        }
        let start = if slot > 0 { ends[slot - 1] } else { 0.0 };
        let rest = ((place - start) / weights[slot]).min(1.0 - f32::EPSILON);
        Some((self.children[slot], weights[slot] / total, rest))
    }

    /// Returns the probability with which [`Branch::sample`] chooses child `slot`.
    #[inline]
    pub fn probability(&self, at: PointAndNormal, factors: Option<&[f32]>, slot: usize) -> f32 {
        let weights = self.weights(at, factors);
        let total = sum(&weights);
        if total > 0.0 { weights[slot] / total } else { 0.0 }
    }
}

/// Returns the sum of numbers, by halves, which compiles to vector code.
#[inline(always)]
fn sum(numbers: &[f32; ARITY]) -> f32 {
    let [a, b, c, d] = std::array::from_fn(|i| numbers[i] + numbers[i + ARITY / 2]);
    (a + c) + (b + d)
}
