//! The order of a node's children, which the refinement of a cut by a single point and by a packet share.
//!
//! The loops around it are two ([`super::single`], [`super::packet`]), because a packet's are not those of a point for
//! sixteen lanes. The error of a cluster relative to a single point's total orders clusters once and for all, whatever
//! the total becomes, so the worst are split in batches. The cubic mean over a packet's lanes reorders them as the
//! lanes' totals change, so there thresholds fall round by round, and no order is kept.

use crate::lights::{LightNode, LightTrees};

/// Children of a node: the heir, which shares its representative, so that its response is known, and the other.
#[inline]
pub(super) fn heir_and_other(trees: &LightTrees, parent: &LightNode) -> Option<(u32, u32)> {
    let left = parent.children()?;
    let shares_left = trees.nodes[left as usize].representative() == parent.representative();
    Some(if shares_left { (left, left + 1) } else { (left + 1, left) })
}
