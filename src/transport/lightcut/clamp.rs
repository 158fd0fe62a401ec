//! Weak singularities: indirect leaves so close to a point that they outshine all other light.
//!
//! Paper: Herzog et al. 2009, Eq. 13: no indirect VPL contributes more than a share of the total's luminance.
//! Deviations: in the total, no single indirect leaf counts for more than a quarter ([`frozen_luminance`]). Otherwise a
//! VPL close to the receiver would set its own limit, and hide the errors of all others while the cut is refined.

use super::CutCounts;
use crate::lights::{LightNode, LightTrees, Origin};
use base::math::{Rgb, luminance};

/// Maximum share of a single indirect leaf in the total luminance that other clusters are compared with.
pub(super) const DOMINANT: f32 = 0.25;

/// [`DOMINANT`] relative to the rest of the total.
pub(super) const DOMINANT_TO_REST: f32 = DOMINANT / (1.0 - DOMINANT);

/// Maximum number of steps towards the frozen luminance of a cut.
pub(super) const MAX_STEPS: u32 = 12;

/// True for an indirect leaf; only indirect leaves are clamped.
#[inline]
pub fn is_weak(node: &LightNode) -> bool {
    node.is_leaf() && node.origin() == Origin::Indirect
}

/// Returns the luminance of a sum whose dominant summands are limited to a share of that luminance, to within 1 %.
///
/// `limited` returns the sum's luminance if summands are limited to their share of a given luminance. The fixed point
/// is approached from above, from the luminance without limits, in at most `max_steps` steps. With a single dominant
/// summand, each step leaves its share of the excess. Convergence is slower only if dominant summands together are the
/// whole.
pub fn frozen_luminance(unlimited: f32, max_steps: u32, mut limited: impl FnMut(f32) -> f32) -> f32 {
    let mut frozen = unlimited;
    for _ in 0..max_steps {
        let next = limited(frozen);
        // Random corrections may make the sum of the other summands negative.
        if next > 0.99 * frozen || next <= 0.0 {
            break;
        }
        frozen = next;
    }
    frozen
}

/// Light that one point gathers from a cut, before weak singularities are clamped.
pub(super) struct Unclamped<'a, I> {
    pub trees: &'a LightTrees,
    /// Nodes and their contributions.
    pub contributions: I,
    /// Further light, which is not clamped.
    pub strong: Rgb,
    /// Sum of contributions and further light.
    pub sum: Rgb,
    /// Luminance of other light that the point reflects.
    pub baseline: f32,
}

impl<I: Iterator<Item = (u32, Rgb)> + Clone> Unclamped<'_, I> {
    /// Returns the sum in which no weak singularity has more than the share `clamp` of the frozen luminance, and the
    /// luminance of that share.
    pub fn clamped(&self, clamp: f32, counts: &mut CutCounts) -> (Rgb, f32) {
        let unclamped = luminance(self.sum) + self.baseline;
        let frozen = frozen_luminance(unclamped, MAX_STEPS, |frozen| {
            luminance(self.limited(DOMINANT * frozen).0) + self.baseline
        });
        let limit = clamp * frozen;
        let (sum, clamped) = self.limited(limit);
        counts.clamped += clamped;
        counts.lost += f64::from(luminance(self.sum) - luminance(sum));
        (sum, limit)
    }

    /// Returns the sum with the luminance of weak singularities limited, and the number of limited ones.
    fn limited(&self, limit: f32) -> (Rgb, u64) {
        let (sum, clamped) = self.contributions.clone().fold(
            (self.strong.as_dvec3(), 0),
            |(sum, clamped), (node, contribution)| {
                let y = luminance(contribution);
                if y > limit && is_weak(&self.trees.nodes[node as usize]) {
                    (sum + (contribution * (limit / y)).as_dvec3(), clamped + 1)
                } else {
                    (sum + contribution.as_dvec3(), clamped)
                }
            },
        );
        (sum.as_vec3(), clamped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Luminance of `dominant` summands of 100 each besides a sum of 1, limited to a quarter each.
    fn frozen(dominant: usize) -> f32 {
        let limited = |total: f32| 1.0 + dominant as f32 * (0.25 * total).min(100.0);
        frozen_luminance(1.0 + 100.0 * dominant as f32, 100, limited)
    }

    #[test]
    fn the_fixed_point_is_that_of_the_limited_sum() {
        // x = 1 + n x / 4.
        for (dominant, expected) in [(0, 1.0), (1, 4.0 / 3.0), (2, 2.0), (3, 4.0)] {
            let x = frozen(dominant);
            assert!(x >= expected && x < 1.05 * expected, "{dominant}: {x}");
        }
        assert_eq!(frozen(4), 401.0, "four together have the whole: nothing is limited");
        assert_eq!(frozen_luminance(3.0, 12, |_| -1.0), 3.0);
        assert_eq!(frozen_luminance(0.0, 12, |_| 0.0), 0.0);
    }
}
