//! Nearest-neighbour search with nodes of sixteen boxes, tested at once.
//!
//! Paper: Wald, Benthin and Boulos, *Getting Rid of Packets*, 2008 (sixteen children per node, for rays).
//!
//! The nodes are every fourth level of a [`KdTree`], from the leaves up. The latency of consecutive nodes bounds a
//! query, and three or four nodes replace twelve to sixteen.

use super::KdTree;
use crate::math::{F32x16, LANES, U32x16, lanes_in, mask_of};
use glam::Vec3;

/// Levels of the binary tree per node.
const BITS: u32 = LANES.trailing_zeros();

/// Size of the stack of nodes to visit: fifteen per level, and eight levels for 2³² leaves.
const STACK: usize = 15 * 8;

/// Boxes of sixteen children. Missing ones are at infinite distance.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct WideNode {
    min: [F32x16; 3],
    max: [F32x16; 3],
}

impl WideNode {
    const EMPTY: WideNode =
        WideNode { min: [[f32::INFINITY; LANES]; 3], max: [[f32::NEG_INFINITY; LANES]; 3] };

    /// Returns the squared distances from a point to the boxes.
    #[inline(always)]
    fn distances_sq(&self, p: [f32; 3]) -> F32x16 {
        let mut sum = [0.0; LANES];
        for ((min, max), p) in self.min.iter().zip(&self.max).zip(p) {
            for i in 0..LANES {
                let below = min[i] - p;
                let above = p - max[i];
                let out = if below > above { below } else { above };
                let out = if out > 0.0 { out } else { 0.0 };
                sum[i] += out * out;
            }
        }
        sum
    }
}

/// Returns the first lane with the least of sixteen numbers that are not negative, and the number.
#[inline(always)]
pub fn least_lane(numbers: &F32x16) -> (usize, f32) {
    // The bits of such numbers have their order. Minima of integers need no order of evaluation.
    let bits: U32x16 = std::array::from_fn(|i| numbers[i].to_bits());
    let least = bits.iter().fold(u32::MAX, |least, bits| least.min(*bits));
    let is_least = std::array::from_fn(|i| u32::from(bits[i] == least));
    (mask_of(&is_least).trailing_zeros() as usize, f32::from_bits(least))
}

/// The tree.
pub struct WideKdTree {
    /// Nodes by level from the root, which has 2^first children.
    nodes: Vec<WideNode>,
    /// Index in `nodes` of the first node of each level.
    levels: Vec<usize>,
}

impl WideKdTree {
    /// Builds the tree over the leaves of a binary tree, whose points are at `positions`.
    pub fn new(index: &KdTree, positions: &[Vec3]) -> WideKdTree {
        let first = match index.depth() % BITS {
            0 if index.depth() > 0 => BITS,
            rest => rest,
        };
        let (mut nodes, mut levels) = (Vec::new(), Vec::new());
        for level in (first..=index.depth()).step_by(BITS as usize) {
            levels.push(nodes.len());
            nodes.resize(nodes.len() + (1usize << level).div_ceil(LANES), WideNode::EMPTY);
            let added = &mut nodes[levels[levels.len() - 1]..];
            for child in 0..1usize << level {
                let (node, lane) = (&mut added[child / LANES], child % LANES);
                for p in &positions[index.range(level, child)] {
                    for (axis, &x) in p.as_ref().iter().enumerate() {
                        node.min[axis][lane] = node.min[axis][lane].min(x);
                        node.max[axis][lane] = node.max[axis][lane].max(x);
                    }
                }
            }
        }
        WideKdTree { nodes, levels }
    }

    /// Returns a leaf whose box is about the nearest to `p`, without a search; there is one.
    #[inline]
    pub fn near_leaf(&self, p: Vec3) -> usize {
        let (p, mut node) = (p.to_array(), 0);
        for first in &self.levels {
            let distances = self.nodes[first + node].distances_sq(p);
            node = LANES * node + least_lane(&distances).0;
        }
        node
    }

    /// Calls `visit` for leaves whose boxes are within a radius of `p`: the nearest first, then roughly by distance.
    ///
    /// `visit` takes the leaf and the squared radius, and returns the reduced squared radius.
    #[inline]
    pub fn leaves(&self, p: Vec3, mut radius_sq: f32, mut visit: impl FnMut(usize, f32) -> f32) {
        let p = p.to_array();
        let mut stack = [(0.0f32, 0u32, 0u32); STACK];
        let mut height = 0;
        let mut next = (0, 0);
        loop {
            let (level, node) = next;
            match self.levels.get(level as usize) {
                None => radius_sq = visit(node as usize, radius_sq),
                Some(first) => {
                    let distances = self.nodes[first + node as usize].distances_sq(p);
                    let mut inside: U32x16 = [0; LANES];
                    for i in 0..LANES {
                        inside[i] = u32::from(distances[i] < radius_sq);
                    }
                    let mut nearest = (f32::INFINITY, 0, 0);
                    for lane in lanes_in(mask_of(&inside)) {
                        let child = (distances[lane], level + 1, LANES as u32 * node + lane as u32);
                        let later =
                            if child.0 < nearest.0 { std::mem::replace(&mut nearest, child) } else { child };
                        if later.0 < f32::INFINITY {
                            stack[height] = later;
                            height += 1;
                        }
                    }
                    if nearest.0 < radius_sq {
                        next = (nearest.1, nearest.2);
                        continue;
                    }
                }
            }
            next = loop {
                if height == 0 {
                    return;
                }
                height -= 1;
                let (distance_sq, level, node) = stack[height];
                if distance_sq < radius_sq {
                    break (level, node);
                }
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::owen_sobol_2d;
    use rayon::prelude::*;

    #[test]
    fn the_nearest_is_found_among_all_in_few_leaves() {
        for n in [0u32, 1, 40, 100, 600, 5000, 70_000] {
            let at = |i: u32| owen_sobol_2d(i, 1).extend(owen_sobol_2d(i, 2).x);
            let (index, order) = KdTree::build((0..n).map(at).collect::<Vec<_>>().into_par_iter());
            let points: Vec<Vec3> = order.iter().map(|&i| at(i)).collect();
            let nearest_index = WideKdTree::new(&index, &points);
            for x in [
                Vec3::ZERO,
                Vec3::new(0.3, 0.9, 0.2),
                Vec3::splat(9.0),
                points.first().map_or(Vec3::ONE, |p| *p),
            ] {
                let distances = || points.iter().map(|p| p.distance_squared(x));
                let expected = distances().fold(f32::INFINITY, f32::min);
                for radius_sq in [f32::INFINITY, 1.01 * expected + 1e-30, 0.5 * expected] {
                    let (mut nearest, mut visits) = (radius_sq, 0);
                    nearest_index.leaves(x, radius_sq, |leaf, radius_sq| {
                        assert_eq!(radius_sq, nearest);
                        visits += 1;
                        for i in index.leaf(leaf) {
                            nearest = nearest.min(points[i].distance_squared(x));
                        }
                        nearest
                    });
                    assert_eq!(nearest, expected.min(radius_sq), "{n} points, {x}");
                    assert!(visits < 16, "{visits} of {} leaves", index.leaves());
                }
            }
        }
    }
}
