//! A shared cut lent to the points in between.
//!
//! Where the sixteen points of a group are spread over a patch of surface, points among them have nearly the same cut,
//! and what all sixteen see, or none of them, they most likely see too, or do not. So the cut is not refined again,
//! and a shadow ray is traced only to clusters about which the sixteen disagree.
//!
//! Deviations: this is not part of any paper's lightcuts. It misses what is hidden by, or seen through, something that
//! none of the sixteen is aware of.

use super::points::{Points, lanes_of};
use super::refine::{Entry, GroupLightcut};
use super::transfer::GroupVisibility;
use super::{LANES, Lanes};
use crate::light_tree::LightTrees;
use crate::lightcut::{CutSettings, Transfer};
use crate::math::Rgb;
use crate::vpl::Origin;

/// What a group's points say of a cluster's representative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seen {
    ByAll,
    ByNone,
    Mixed,
}

/// A cut and what its makers saw.
#[derive(Clone, Debug, Default)]
pub struct LentCut {
    clusters: Vec<(u32, Seen)>,
}

impl LentCut {
    /// Keeps the last cut of `group`, made for `points`.
    pub fn keep(&mut self, group: &GroupLightcut, trees: &LightTrees, transfer: &Transfer, points: &Points) {
        self.clusters.clear();
        let mut unshadowed = [[0.0; LANES]; 3];
        for (node, responses) in group.entries() {
            let n = &trees.nodes[node as usize];
            let vpl = &trees.vpls[n.representative()];
            let lit = transfer.unshadowed16(points, vpl, n.kind(), &mut unshadowed);
            let reached = |&l: &usize| responses[0][l] + responses[1][l] + responses[2][l] > 0.0;
            let seen = lanes_of(lit).filter(reached).count() as u32;
            let seen = match seen {
                _ if lit.count_ones() * 2 < points.valid.count_ones() => Seen::Mixed,
                0 => Seen::ByNone,
                n if n == lit.count_ones() => Seen::ByAll,
                _ => Seen::Mixed,
            };
            self.clusters.push((node, seen));
        }
    }

    /// How many clusters.
    pub fn size(&self) -> usize {
        self.clusters.len()
    }
}

impl GroupLightcut {
    /// Reflected radiance of points among those that `cut` was made for.
    #[allow(clippy::too_many_arguments)]
    pub fn gather_lent<V: GroupVisibility>(
        &mut self,
        cut: &LentCut,
        trees: &LightTrees,
        transfer: &Transfer,
        visibility: &V,
        points: &Points,
        settings: &CutSettings,
        radiance: &mut [Rgb; LANES],
    ) {
        const ZERO: Lanes = [0.0; LANES];
        self.entries.clear();
        // What is never clamped needs no second look.
        let mut strong = [ZERO; 3];
        for &(node, seen) in &cut.clusters {
            if seen == Seen::ByNone {
                continue;
            }
            let n = &trees.nodes[node as usize];
            let vpl = &trees.vpls[n.representative()];
            let mut responses = [ZERO; 3];
            let lit = transfer.unshadowed16(points, vpl, n.kind(), &mut responses);
            if lit == 0 {
                continue;
            }
            if seen == Seen::Mixed {
                self.counts.rays += u64::from(lit.count_ones());
                self.packets += 1;
                let seen = visibility.visible16(points, lit, vpl, n);
                for row in &mut responses {
                    for (l, r) in row.iter_mut().enumerate() {
                        *r = if seen >> l & 1 != 0 { *r } else { 0.0 };
                    }
                }
            }
            if n.is_leaf() && n.origin() == Origin::Indirect {
                self.entries.push(Entry { node, weak: true, responses, errors: ZERO, counted: ZERO });
                continue;
            }
            for (c, sum) in strong.iter_mut().enumerate() {
                for (s, r) in sum.iter_mut().zip(&responses[c]) {
                    *s += n.intensity[c] * r;
                }
            }
        }
        let count = points.len() as u64;
        self.counts.cuts += count;
        self.counts.clusters += count * cut.size() as u64;
        self.sum(trees, points, settings.clamp, &strong, radiance);
    }
}
