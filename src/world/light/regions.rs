//! Regions of the scene: the leaves of a kd-tree over points.

use base::math::{LANES, Vec3x16};
use glam::Vec3;

/// Axis of leaves.
const LEAF: u32 = 3;

/// Minimum distance between points on both sides of a plane over the extent of all points. Origins of rays are much
/// closer to their surfaces.
const MIN_GAP: f32 = 3e-5;

/// A kd-tree.
#[derive(Clone, Debug)]
pub struct Regions {
    /// Nodes. The first child follows its parent.
    nodes: Vec<RegionNode>,
    /// Number of branches on the way to the deepest leaf.
    depth: u32,
}

#[derive(Clone, Copy, Debug)]
struct RegionNode {
    /// Coordinate at and above which points belong to the second child.
    plane: f32,
    /// Axis in the lowest two bits, [`LEAF`] for a leaf. The other bits hold the second child, or the region of a leaf.
    word: u32,
}

impl Regions {
    /// Halves the points along the widest axis until regions hold at most `most` points. Returns the points in each
    /// region, too.
    pub fn new(points: &[Vec3], most: usize) -> (Regions, Vec<Vec<u32>>) {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let (mut regions, mut members) = (Regions { nodes: Vec::new(), depth: 0 }, Vec::new());
        let [low, high] = bounds(points, &order);
        let gap = MIN_GAP * (high - low).max_element();
        regions.split(&Splitting { points, most, gap }, &mut order, 0, &mut members);
        (regions, members)
    }

    /// Adds the nodes over the points in `order`, which lie `depth` branches below the root, and their `members`.
    fn split(&mut self, by: &Splitting, order: &mut [u32], depth: u32, members: &mut Vec<Vec<u32>>) {
        let own = self.nodes.len();
        let Some((axis, middle, plane)) = by.plane(order) else {
            self.nodes.push(RegionNode { plane: 0.0, word: LEAF | (members.len() as u32) << 2 });
            self.depth = self.depth.max(depth);
            members.push(order.to_vec());
            return;
        };
        let (left, right) = order.split_at_mut(middle);
        self.nodes.push(RegionNode { plane, word: 0 });
        self.split(by, left, depth + 1, members);
        self.nodes[own].word = axis as u32 | (self.nodes.len() as u32) << 2;
        self.split(by, right, depth + 1, members);
    }

    /// Returns the region of a point.
    #[inline]
    pub fn of(&self, x: Vec3) -> usize {
        let mut node = 0;
        loop {
            let RegionNode { plane, word } = self.nodes[node];
            match word & LEAF {
                LEAF => return (word >> 2) as usize,
                axis if x[axis as usize] < plane => node += 1,
                _ => node = (word >> 2) as usize,
            }
        }
    }

    /// Returns the regions of sixteen points.
    ///
    /// Points that are close together descend together. Then all lanes descend to the depth of the deepest leaf, so
    /// that they wait for memory together.
    #[inline]
    pub fn find(&self, x: &Vec3x16) -> [usize; LANES] {
        let rows = x.rows();
        let bounds = rows.map(|row| {
            row.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
        });
        let (mut first, mut passed) = (0, 0);
        loop {
            let RegionNode { plane, word } = self.nodes[first];
            let axis = word & LEAF;
            if axis == LEAF {
                return [(word >> 2) as usize; LANES];
            }
            let [low, high] = bounds[axis as usize];
            match high < plane {
                true => first += 1,
                false if low >= plane => first = (word >> 2) as usize,
                false => break,
            }
            passed += 1;
        }
        let mut node = [first; LANES];
        for _ in passed..self.depth {
            for lane in 0..LANES {
                let RegionNode { plane, word } = self.nodes[node[lane]];
                let axis = word & LEAF;
                let inner = if rows[axis.min(2) as usize][lane] < plane {
                    node[lane] + 1
                } else {
                    (word >> 2) as usize
                };
                node[lane] = if axis == LEAF { node[lane] } else { inner };
            }
        }
        node.map(|node| (self.nodes[node].word >> 2) as usize)
    }

    /// Estimates means by region and slot. `add` adds the sums and counts of a region's samples. A node's mean is that
    /// of its samples and of `prior` more, which have the mean of the node above. Above the root it is `above`.
    pub fn means<A: Fn(usize, &mut [[f32; 2]]) + Sync>(
        &self,
        add: A,
        prior: f32,
        above: &[f32],
    ) -> Vec<Vec<f32>> {
        let regions = self.nodes.iter().filter(|node| node.word & LEAF == LEAF).count();
        let mut found = vec![Vec::new(); regions];
        self.shrink(0, 0, &mut found, &Shrinkage { add, prior }, above);
        found
    }

    /// Writes the means of the regions below a node, of which `first` is the first.
    fn shrink<A: Fn(usize, &mut [[f32; 2]]) + Sync>(
        &self,
        node: usize,
        first: usize,
        found: &mut [Vec<f32>],
        by: &Shrinkage<A>,
        above: &[f32],
    ) {
        let mut sums = vec![[0.0; 2]; above.len()];
        (first..first + found.len()).for_each(|region| (by.add)(region, &mut sums));
        let shrunk = |([sum, count], above): (&[f32; 2], &f32)| (sum + by.prior * above) / (count + by.prior);
        let means: Vec<f32> = sums.iter().zip(above).map(shrunk).collect();
        let at = self.nodes[node];
        if at.word & LEAF == LEAF {
            found[0] = means;
            return;
        }
        let second = (at.word >> 2) as usize;
        let leaves = self.nodes[node + 1..second].iter().filter(|node| node.word & LEAF == LEAF).count();
        let (left, right) = found.split_at_mut(leaves);
        rayon::join(
            || self.shrink(node + 1, first, left, by, &means),
            || self.shrink(second, first + leaves, right, by, &means),
        );
    }
}

/// Rule for the planes between regions.
struct Splitting<'a> {
    points: &'a [Vec3],
    /// Maximum number of points in a region.
    most: usize,
    /// Minimum distance between points on both sides of a plane.
    gap: f32,
}

impl Splitting<'_> {
    /// Sorts points along an axis and returns the plane that halves them best: its axis, the number of points before
    /// it and its coordinate; `None` if the points are to stay together.
    ///
    /// A plane lies midway in a gap. A wall along it would else be divided by rounding: the origins of rays from it
    /// would have other regions than the wall itself.
    fn plane(&self, order: &mut [u32]) -> Option<(usize, usize, f32)> {
        if order.len() <= self.most {
            return None;
        }
        let at = |i: &u32, axis: usize| self.points[*i as usize][axis];
        let [low, high] = bounds(self.points, order);
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| (high - low)[*b].total_cmp(&(high - low)[*a]));
        for axis in axes {
            order.sort_unstable_by(|a, b| at(a, axis).total_cmp(&at(b, axis)).then(a.cmp(b)));
            let gap = |i: &usize| at(&order[*i], axis) - at(&order[i - 1], axis);
            let wide = (1..order.len()).filter(|i| gap(i) > self.gap);
            if let Some(middle) = wide.min_by_key(|i| i.abs_diff(order.len() / 2)) {
                return Some((axis, middle, at(&order[middle], axis) - 0.5 * gap(&middle)));
            }
        }
        None
    }
}

/// Returns the corners of a box around some of the points.
fn bounds(points: &[Vec3], order: &[u32]) -> [Vec3; 2] {
    let some = || order.iter().map(|i| points[*i as usize]);
    [some().fold(Vec3::INFINITY, Vec3::min), some().fold(Vec3::NEG_INFINITY, Vec3::max)]
}

/// Samples of regions, and the weight of a node's mean in those below it, in samples.
struct Shrinkage<A> {
    add: A,
    prior: f32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;

    #[test]
    fn sixteen_points_have_the_regions_of_single_points_wherever_they_are() {
        let point = |i: u32, size: f32| {
            let (a, b) = (owen_sobol_2d(i, 1), owen_sobol_2d(i, 2));
            Vec3::new(a.x, a.y, b.x) * size
        };
        let points: Vec<Vec3> = (0..3000).map(|i| point(i, 1.0)).collect();
        let (regions, members) = Regions::new(&points, 20);
        assert!(members.len() > 100);
        for size in [1.0, 0.1, 0.01, 1e-4] {
            for packet in 0..200 {
                let mut x = Vec3x16::default();
                (0..LANES).for_each(|lane| {
                    x.set(lane, points[packet] + point((packet * LANES + lane) as u32, size));
                });
                let expected: [usize; LANES] = std::array::from_fn(|lane| regions.of(x.get(lane)));
                assert_eq!(regions.find(&x), expected, "{size}");
            }
        }
    }

    #[test]
    fn origins_of_rays_have_the_regions_of_their_surfaces() {
        // A table whose height is rounded, below a wall.
        let point = |i: u32| {
            let (a, b) = (owen_sobol_2d(i, 1), owen_sobol_2d(i, 2));
            let table = Vec3::new(a.x, 0.9 + 1e-7 * (b.x - 0.5), a.y);
            if i.is_multiple_of(4) { Vec3::new(a.x, 0.9 + a.y, 1.0) } else { table }
        };
        let points: Vec<Vec3> = (0..8000).map(point).collect();
        let (regions, members) = Regions::new(&points, 16);
        assert!(members.len() > 300);
        for x in &points {
            let origin = crate::shadow::ray_from(*x, Vec3::Y, Vec3::ONE).origin;
            assert_eq!(regions.of(origin), regions.of(*x), "{x}");
        }
    }
}
