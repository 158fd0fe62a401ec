//! A balanced kd-tree.
//!
//! Splatting searches points in a footprint with it, and sampling uses its cells to spread records evenly.
//!
//! Every node splits its points in halves along the longest side of their box. Node `i` of level `l` is the range of
//! points from `n·i / 2^l` to `n·(i + 1) / 2^l`. So the tree has no pointers, and points that are close in space are
//! close in memory.

use crate::progress::Control;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Maximum number of points in a leaf.
const LEAF: usize = 32;
/// Number of points up to which one thread sorts a range.
const PARALLEL: usize = 8192;

/// A bounding box; initially empty.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Minimum coordinates.
    pub min: Vec3,
    /// Maximum coordinates.
    pub max: Vec3,
}

impl Bounds {
    const EMPTY: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    fn around(items: &[(Vec3, u32)]) -> Bounds {
        items.iter().fold(Bounds::EMPTY, |b, item| b.union(Bounds { min: item.0, max: item.0 }))
    }

    fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the squared distance from a point to the box.
    #[inline]
    pub fn distance_squared(&self, p: Vec3) -> f32 {
        (self.min - p).max(p - self.max).max(Vec3::ZERO).length_squared()
    }
}

/// The tree. Points must be stored in its order.
pub struct KdTree {
    count: usize,
    depth: u32,
    /// Boxes of all nodes, level after level.
    bounds: Vec<Bounds>,
}

impl KdTree {
    /// Returns the tree over no points.
    pub fn empty() -> KdTree {
        KdTree::build(rayon::iter::empty()).0
    }

    /// Builds the tree over `positions`; returns it with the order in which to store the items.
    pub fn build(positions: impl IndexedParallelIterator<Item = Vec3>) -> (KdTree, Vec<u32>) {
        KdTree::build_unless_cancelled(positions, &Control::new())
    }

    /// Builds the tree like [`KdTree::build`] unless `control` is cancelled. Boxes are then still correct, but the
    /// order is arbitrary and boxes are large.
    pub fn build_unless_cancelled(
        positions: impl IndexedParallelIterator<Item = Vec3>,
        control: &Control,
    ) -> (KdTree, Vec<u32>) {
        let mut items: Vec<(Vec3, u32)> = positions.enumerate().map(|(i, at)| (at, i as u32)).collect();
        let count = items.len();
        let mut depth = 0;
        while count >> depth > LEAF {
            depth += 1;
        }
        sort(&mut items, count, 0, 0, depth, control);
        let mut index = KdTree { count, depth, bounds: vec![Bounds::EMPTY; 2 << depth] };
        let of_leaf = |leaf| Bounds::around(&items[range(count, depth, leaf)]);
        index.bounds[1 << depth..]
            .par_iter_mut()
            .enumerate()
            .for_each(|(leaf, bounds)| *bounds = of_leaf(leaf));
        for node in (1..1usize << depth).rev() {
            index.bounds[node] = index.bounds[2 * node].union(index.bounds[2 * node + 1]);
        }
        (index, items.par_iter().map(|item| item.1).collect())
    }

    /// Returns the level of the leaves; the root is level 0.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// Returns the number of leaves.
    pub fn leaves(&self) -> usize {
        1 << self.depth
    }

    /// Returns the points of node `i` of a level. Levels below the leaves divide leaves in storage order.
    #[inline]
    pub fn range(&self, level: u32, i: usize) -> Range<usize> {
        range(self.count, level, i)
    }

    /// Returns the points of a leaf.
    #[inline]
    pub fn leaf(&self, leaf: usize) -> Range<usize> {
        self.range(self.depth, leaf)
    }

    /// Calls `visit` for every leaf whose box is within `radius` of `p`.
    pub fn leaves_near(&self, p: Vec3, radius: f32, mut visit: impl FnMut(usize)) {
        let radius_sq = radius * radius;
        let mut stack = [0usize; 64];
        let mut height = 0;
        let mut node = 1;
        loop {
            if self.bounds[node].distance_squared(p) <= radius_sq {
                if node < 1 << self.depth {
                    stack[height] = 2 * node + 1;
                    height += 1;
                    node *= 2;
                    continue;
                }
                visit(node - (1 << self.depth));
            }
            if height == 0 {
                return;
            }
            height -= 1;
            node = stack[height];
        }
    }
}

fn range(count: usize, level: u32, i: usize) -> Range<usize> {
    let at = |i: usize| ((count as u128 * i as u128) >> level) as usize;
    at(i)..at(i + 1)
}

/// Sorts the items of node `i` of a level; `items` is the range of the node.
fn sort(items: &mut [(Vec3, u32)], count: usize, level: u32, i: usize, depth: u32, control: &Control) {
    if level == depth || control.is_cancelled() {
        return;
    }
    // Minima and maxima are the same in any order.
    let bounds = items.par_chunks(PARALLEL).map(Bounds::around).reduce(|| Bounds::EMPTY, Bounds::union);
    let size = bounds.max - bounds.min;
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let middle = range(count, level + 1, 2 * i + 1).start - range(count, level, i).start;
    match axis {
        0 => items.select_nth_unstable_by_key(middle, |item| key(item.0.x, item.1)),
        1 => items.select_nth_unstable_by_key(middle, |item| key(item.0.y, item.1)),
        _ => items.select_nth_unstable_by_key(middle, |item| key(item.0.z, item.1)),
    };
    let (left, right) = items.split_at_mut(middle);
    let mut halves = [(left, 2 * i), (right, 2 * i + 1)];
    if count >> level > PARALLEL {
        halves.par_iter_mut().for_each(|(half, i)| sort(half, count, level + 1, *i, depth, control));
    } else {
        halves.iter_mut().for_each(|(half, i)| sort(half, count, level + 1, *i, depth, control));
    }
}

/// Returns a number in the total order of the coordinate `x`. Equal coordinates are ordered by index, so that the order
/// is unique.
#[inline]
fn key(x: f32, index: u32) -> u64 {
    let bits = x.to_bits();
    // Negative numbers are in reverse order, before all others.
    let ordered = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
    u64::from(ordered) << 32 | u64::from(index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::owen_sobol_2d;

    fn points(n: u32) -> Vec<Vec3> {
        (0..n)
            .map(|i| {
                let (a, b) = (owen_sobol_2d(i, 1), owen_sobol_2d(i, 2));
                Vec3::new(a.x, a.y * 3.0, b.x * 0.5)
            })
            .collect()
    }

    #[test]
    fn leaves_share_out_all_points_and_queries_miss_none() {
        for n in [0u32, 1, 2, 31, 32, 33, 1000, 20_000] {
            let points = points(n);
            let (index, order) = KdTree::build(points.par_iter().copied());
            let mut sorted = order.clone();
            sorted.sort();
            assert!(sorted.into_iter().eq(0..n));
            let covered: Vec<usize> = (0..index.leaves()).flat_map(|leaf| index.leaf(leaf)).collect();
            assert!(covered.into_iter().eq(0..n as usize));
            for (x, radius) in [(Vec3::ZERO, 0.3), (Vec3::splat(0.4), 0.1), (Vec3::new(0.5, 2.9, 0.1), 5.0)] {
                let mut found = Vec::new();
                index.leaves_near(x, radius, |leaf| {
                    let inside = |&i: &usize| points[order[i] as usize].distance(x) <= radius;
                    found.extend(index.leaf(leaf).filter(inside));
                });
                let expected = points.iter().filter(|p| p.distance(x) <= radius).count();
                assert_eq!(found.len(), expected);
            }
        }
    }

    #[test]
    fn keys_are_in_the_total_order() {
        let numbers = [f32::NEG_INFINITY, -2.0, -1.0, -1e-40, -0.0, 0.0, 1e-40, 1.0, 2.0, f32::INFINITY];
        let numbers = [-f32::NAN].into_iter().chain(numbers).chain([f32::NAN]);
        let keys: Vec<u64> = numbers.flat_map(|x| [0, 7, u32::MAX].map(|index| key(x, index))).collect();
        assert!(keys.windows(2).all(|pair| pair[0] < pair[1]), "{keys:x?}");
    }

    #[test]
    fn coinciding_points_are_no_trouble() {
        let (index, order) = KdTree::build(vec![Vec3::ONE; 500].into_par_iter());
        assert_eq!(order.len(), 500);
        let mut found = 0;
        index.leaves_near(Vec3::ONE, 0.0, |leaf| found += index.leaf(leaf).len());
        assert_eq!(found, 500);
    }
}
