//! Regions of the scene: the leaves of a kd-tree over points.

use base::math::{LANES, Vec3x16};
use glam::Vec3;

/// Axis of leaves.
const LEAF: u32 = 3;

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
        regions.split(points, most, &mut order, 0, &mut members);
        (regions, members)
    }

    /// Adds the nodes over the points in `order`, which lie `depth` branches below the root, and their `members`.
    fn split(
        &mut self,
        points: &[Vec3],
        most: usize,
        order: &mut [u32],
        depth: u32,
        members: &mut Vec<Vec<u32>>,
    ) {
        let at = |i: &u32| points[*i as usize];
        let low = order.iter().map(at).fold(Vec3::INFINITY, Vec3::min);
        let high = order.iter().map(at).fold(Vec3::NEG_INFINITY, Vec3::max);
        let axis = (high - low).max_position();
        let own = self.nodes.len();
        if order.len() <= most || !(high[axis] > low[axis]) {
            self.nodes.push(RegionNode { plane: 0.0, word: LEAF | (members.len() as u32) << 2 });
            self.depth = self.depth.max(depth);
            members.push(order.to_vec());
            return;
        }
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
        let (left, right) = order.split_at_mut(middle);
        // The plane is midway between points, so that rounding moves no point of a wall into another region.
        let [below, above] = [left.iter().map(at).fold(low, Vec3::max)[axis], at(&right[0])[axis]];
        let midway = below + 0.5 * (above - below);
        self.nodes.push(RegionNode { plane: if midway > below { midway } else { above }, word: 0 });
        self.split(points, most, left, depth + 1, members);
        self.nodes[own].word = axis as u32 | (self.nodes.len() as u32) << 2;
        self.split(points, most, right, depth + 1, members);
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
}
