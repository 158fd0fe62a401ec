//! Expected error of a cluster, given that only its upper bound is certain.
//!
//! A representative errs most by its visibility: if half the members are hidden, the error is half the cluster's
//! unshadowed contribution U, whatever the bound b. The bound overestimates U by a factor that grows with the angle
//! that the cluster fills, since minimum distance and maximum cosines rarely occur together. √(b·U) needs fewer
//! clusters than b for equal error. U itself would require a visit to every member. The geometry term at the centre of
//! the cluster's box, limited from below relative to the bound, serves almost as well:
//!
//! E = `SCALE` · b · min(1, `SPREAD` · √r), r = (d²min / d²centre) · (`FLOOR` + (1 - `FLOOR`) · cosines at
//! the centre / largest)
//!
//! `SCALE` sets the meaning of ε: the relative RMS error of the whole, over points and choices of representatives,
//! stays below 1.75 ε. All points of an image share their representatives, so the figure of one image varies more.
//!
//! The estimate must not depend on the representative. The visibility of the representative is strongly correlated with
//! the cluster's error. If refinement stopped sooner where it is hidden, visible members would be missed.

use base::math::Lane;
use world::material::LobeShape;

/// Expected error relative to a tight bound.
const SCALE: f32 = 1.7;

/// Ratio of the bound to √(bound · value at the centre) above which the expected error is lower.
const SPREAD: f32 = 1.6;

/// Minimum product of cosines at the centre, relative to their maximum.
const FLOOR: f32 = 0.1;

/// Geometry of a cluster seen from a point: squared distances and cosines at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClusterView<L = f32> {
    /// Minimum squared distance, the divisor of the bound.
    pub near_sq: L,
    /// Squared distance of the centre.
    pub centre_sq: L,
    /// Cosines of receiver and emitter towards the centre, each times the distance; negative if facing away.
    pub at_centre: [L; 2],
    /// Maximum cosines.
    pub largest: [L; 2],
}

/// Returns the expected error of a cluster relative to its upper bound.
#[inline(always)]
pub(super) fn expected_share<L: Lane>(o: ClusterView<L>) -> L {
    let one = L::from(1.0);
    // The centre is in the box, so only the limit on distances can make it nearer than the nearest point.
    let centre_sq = o.centre_sq.max(o.near_sq);
    let at_centre = o.at_centre[0].positive() * o.at_centre[1].positive();
    let largest = (o.largest[0] * o.largest[1] * centre_sq).max(L::from(1e-37));
    let cosines = (at_centre * largest.recip()).min(one);
    let nearness = o.near_sq / centre_sq;
    let share = (nearness * cosines.mul_add(L::from(1.0 - FLOOR), L::from(FLOOR))).sqrt() * SPREAD;
    share.min(one) * SCALE
}

/// Returns the bound of a lobe in the direction at `z` along its axis and at `distance`, times the distance. It takes
/// the place of the cosine in [`ClusterView::at_centre`].
#[inline(always)]
pub(super) fn lobe_at<L: Lane>(z: L, distance: L, width_sq: f32) -> L {
    distance * LobeShape::max_share(z * distance.max(L::from(1e-37)).recip(), width_sq)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEVEL: ClusterView =
        ClusterView { near_sq: 1.0, centre_sq: 1.0, at_centre: [1.0, 1.0], largest: [1.0, 1.0] };

    #[test]
    fn a_tight_bound_is_taken_whole_and_a_loose_one_in_part() {
        assert_eq!(expected_share(LEVEL), SCALE);
        let far = expected_share(ClusterView { centre_sq: 100.0, at_centre: [10.0, 10.0], ..LEVEL });
        assert!((far / SCALE - SPREAD / 10.0).abs() < 1e-6, "{far}");
        let averted = expected_share(ClusterView { at_centre: [-1.0, 1.0], ..LEVEL });
        assert!((averted / SCALE - SPREAD * FLOOR.sqrt()).abs() < 1e-6, "{averted}");
    }

    #[test]
    fn nothing_degenerate_makes_a_cluster_exact() {
        // The nearest distance is limited from below; directions are judged at the centre.
        let values: [f32; 5] = [0.0, 1e-38, 1e-20, 1.0, 1e20];
        for centre_sq in values {
            for near_sq in [centre_sq, 1e-36, 1e-20, 1.0, 1e20] {
                for cosine in [-1.0f32, 0.0, 1e-20, 1.0] {
                    let at_centre = [cosine * centre_sq.sqrt(), centre_sq.sqrt()];
                    let view = ClusterView { near_sq, centre_sq, at_centre, largest: [cosine.max(0.0), 1.0] };
                    let share = expected_share(view);
                    let farther = near_sq < 1e-10 * centre_sq;
                    assert!(share <= SCALE && (share > 0.0 || farther), "{share} {view:?}");
                }
            }
        }
    }
}
