//! Weak singularities: indirect leaves so close to a point that they outshine all other light.
//!
//! Paper: Herzog et al. 2009, Eq. 13: no indirect VPL contributes more than a share of the total's luminance.
//! Deviations: in the total, no single indirect leaf counts for more than a quarter ([`frozen_luminance`]). Otherwise a
//! VPL close to the receiver would set its own limit, and hide the errors of all others while the cut is refined.

use crate::lights::{LightNode, Origin};

/// Maximum share of a single indirect leaf in the total luminance that other clusters are compared with.
pub(super) const DOMINANT: f32 = 0.25;

/// [`DOMINANT`] relative to the rest of the total.
pub(super) const DOMINANT_TO_REST: f32 = DOMINANT / (1.0 - DOMINANT);

/// Maximum number of steps towards the frozen luminance of a cut.
pub const MAX_STEPS: u32 = 12;

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
