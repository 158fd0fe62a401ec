//! Shape of a binary tree over a row of leaves, without bounds.

use super::cost::Primitive;

/// Binary tree: leaves in order, and for each inner node, in preorder, the number of leaves of its left child.
///
/// A subtree over `n` leaves owns `n` consecutive primitives and `n - 1` consecutive entries of `left_sizes`, the first
/// of which belongs to its root. So a subtree is a pair of slices.
#[derive(Debug)]
pub struct Topology {
    /// The leaves, in the tree's order.
    pub leaves: Vec<Primitive>,
    /// Number of leaves in the left child of each inner node, in preorder.
    pub left_sizes: Vec<u32>,
}

impl Topology {
    /// Converts from inner nodes as pairs of children. Ids below `leaves.len()` are leaves, other ids inner nodes in
    /// the order of `pairs`. The last pair is the root.
    pub fn from_pairs(leaves: &[Primitive], pairs: &[[u32; 2]]) -> Topology {
        let n = leaves.len();
        // Children precede their parents, so one sweep finds every size.
        let mut sizes = vec![1u32; n + pairs.len()];
        for (i, &[a, b]) in pairs.iter().enumerate() {
            sizes[n + i] = sizes[a as usize] + sizes[b as usize];
        }
        let mut topology =
            Topology { leaves: Vec::with_capacity(n), left_sizes: Vec::with_capacity(pairs.len()) };
        let mut stack = Vec::new();
        if n > 0 {
            stack.push((n + pairs.len() - 1) as u32);
        }
        while let Some(id) = stack.pop() {
            let id = id as usize;
            if id < n {
                topology.leaves.push(leaves[id]);
            } else {
                let [left, right] = pairs[id - n];
                topology.left_sizes.push(sizes[left as usize]);
                stack.push(right);
                stack.push(left);
            }
        }
        topology
    }
}
