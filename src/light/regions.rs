//! Regions of the scene: the leaves of a kd-tree over points.

use glam::Vec3;

/// Axis of leaves.
const LEAF: u32 = 3;

/// A kd-tree.
#[derive(Clone, Debug)]
pub struct Regions {
    /// Nodes; the first child follows its parent.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// Coordinate from which on points are the second child's.
    plane: f32,
    /// Axis in the lowest two bits, [`LEAF`] for a leaf; above them the second child, or the region.
    word: u32,
}

impl Regions {
    /// Halves the points along the widest axis until they are `few` at most. Returns the points in each region, too.
    pub fn new(points: &[Vec3], few: usize) -> (Regions, Vec<Vec<u32>>) {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let (mut regions, mut members) = (Regions { nodes: Vec::new() }, Vec::new());
        regions.split(points, few, &mut order, &mut members);
        (regions, members)
    }

    fn split(&mut self, points: &[Vec3], few: usize, order: &mut [u32], members: &mut Vec<Vec<u32>>) {
        let at = |i: &u32| points[*i as usize];
        let low = order.iter().map(at).fold(Vec3::INFINITY, Vec3::min);
        let high = order.iter().map(at).fold(Vec3::NEG_INFINITY, Vec3::max);
        let axis = (high - low).max_position();
        let own = self.nodes.len();
        if order.len() <= few || !(high[axis] > low[axis]) {
            self.nodes.push(Node { plane: 0.0, word: LEAF | (members.len() as u32) << 2 });
            members.push(order.to_vec());
            return;
        }
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
        self.nodes.push(Node { plane: at(&order[middle])[axis], word: 0 });
        let (left, right) = order.split_at_mut(middle);
        self.split(points, few, left, members);
        self.nodes[own].word = axis as u32 | (self.nodes.len() as u32) << 2;
        self.split(points, few, right, members);
    }

    /// Region of a point.
    #[inline]
    pub fn find(&self, x: Vec3) -> usize {
        let mut node = 0;
        loop {
            let Node { plane, word } = self.nodes[node];
            if word & 3 == LEAF {
                return (word >> 2) as usize;
            }
            node = if x[(word & 3) as usize] < plane { node + 1 } else { (word >> 2) as usize };
        }
    }
}
