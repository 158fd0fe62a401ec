//! Order of a node's children, which the refinement of cuts for single points and for packets share.
//!
//! The refinement loops differ ([`super::single`], [`super::packet`]). For a single point, the order of clusters by
//! error does not depend on the total, so the worst are split in batches. For a packet, the cubic mean over the lanes
//! reorders clusters as the lanes' totals change. So thresholds fall round by round, and no order is stored.

use crate::lights::{LightNode, LightTrees};

/// Returns the children of a node: first the heir, which shares the node's representative and hence its response.
#[inline]
pub(super) fn heir_and_other(trees: &LightTrees, parent: &LightNode) -> Option<(u32, u32)> {
    let left = parent.children()?;
    let shares_left = trees.nodes[left as usize].representative() == parent.representative();
    Some(if shares_left { (left, left + 1) } else { (left + 1, left) })
}
