//! Steps of the refinement of a cut that single points and packets share: the queue of clusters to split, and
//! the order of a node's children.
//!
//! The loops around them are two ([`super::single`], [`super::packet`]), because a packet's are not those of
//! a point for sixteen lanes. The error of a cluster relative to a single point's total orders clusters once
//! and for all, whatever the total becomes, so the worst are split in batches against one threshold. The
//! cubic mean over a packet's lanes reorders them as the lanes' totals change: each is judged again when its
//! turn comes, one after the other, and all once more at the end. And a point's total is one number in double
//! precision, a packet's are sixteen in single precision, as wide as a vector.

use crate::light_tree::{LightTrees, Node};
use std::collections::BinaryHeap;

/// Clusters above the threshold, by their place in the cut, the worst first.
///
/// Errors as bits stand above places: non-negative floats sort as integers.
#[derive(Default)]
pub(super) struct Offenders(BinaryHeap<u64>);

impl Offenders {
    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Queues the cluster at `place` by its error, unless it cannot be wrong.
    #[inline]
    pub fn push(&mut self, error: f32, place: usize) {
        if error > 0.0 {
            self.0.push(u64::from(error.to_bits()) << 32 | place as u64);
        }
    }

    /// Error and place of the worst.
    #[inline]
    pub fn worst(&self) -> Option<(f32, usize)> {
        self.0.peek().map(|&offender| (f32::from_bits((offender >> 32) as u32), offender as u32 as usize))
    }

    /// Removes the worst.
    #[inline]
    pub fn pop(&mut self) {
        self.0.pop();
    }
}

/// Children of a node: the heir, which shares its representative, so that its response is known, and the other.
#[inline]
pub(super) fn heir_and_other(trees: &LightTrees, parent: &Node) -> Option<(u32, u32)> {
    let left = parent.children()?;
    let shares_left = trees.nodes[left as usize].representative() == parent.representative();
    Some(if shares_left { (left, left + 1) } else { (left + 1, left) })
}
