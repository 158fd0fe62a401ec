//! Nodes of a tree, given its shape: exact boxes and cones, f64 intensity sums, representatives.
//!
//! Paper: Walter et al. 2005: a cluster's representative is sampled from its children's in proportion to their
//! intensities. One child shares it, so a split costs at most one new shadow ray.
//! Deviations: the cone is the smallest about the centre of the normals' box that contains every member's normal. It is
//! computed from the members, since merging the children's cones would be looser at every level.

use super::cost::{Primitive, PrimitiveBounds};
use super::node::{LightNode, Topology};
use crate::lights::{Profiles, VplKind, VplSet};
use base::math::{Rgb, luminance};
use base::progress::Control;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Number of leaves above which both halves are finished in parallel.
const PARALLEL: usize = 4096;

/// Number of leaves above which all threads compute the cone of a node.
const LARGE: usize = 8 * PARALLEL;

/// Margin of cosines: more than the rounding of a dot product of unit vectors.
const COSINE_SLACK: f32 = 1e-6;

/// Values of a cluster that its parent needs and that its node does not hold.
struct Summary {
    bounds: PrimitiveBounds,
    intensity: DVec3,
    luminance: f64,
    representative: u32,
}

impl Summary {
    const NONE: Summary =
        Summary { bounds: PrimitiveBounds::EMPTY, intensity: DVec3::ZERO, luminance: 0.0, representative: 0 };
}

/// Fills the nodes of a tree over a set of VPLs.
pub struct Finisher<'a> {
    /// The VPLs.
    pub set: &'a VplSet,
    /// Profiles that the VPLs refer to.
    pub profiles: &'a Profiles,
    /// Index of the set's first VPL among the VPLs of all trees.
    pub first_vpl: u32,
    /// Cancellation.
    pub control: &'a Control,
}

/// Subtree of a topology.
struct Subtree<'a> {
    leaves: &'a [Primitive],
    left_sizes: &'a [u32],
    /// Index of the first leaf in the tree.
    first_leaf: u32,
}

/// Nodes of a subtree.
struct SubtreeNodes<'a> {
    root: &'a mut LightNode,
    /// Descendants of the root.
    below: &'a mut [LightNode],
    /// Index of the first descendant among all nodes.
    below_index: u32,
}

impl Finisher<'_> {
    /// Fills `nodes` with the nodes of a tree; `None` if building is cancelled. `first_node` is the index of `nodes[0]`
    /// among the nodes of all trees.
    ///
    /// There are two nodes per leaf: the root, a gap that keeps siblings aligned, then pairs of siblings, depth first.
    pub fn finish(&self, topology: &Topology, nodes: &mut [LightNode], first_node: u32) -> Option<()> {
        if self.control.is_cancelled() {
            return None;
        }
        if let Some((root, rest)) = nodes.split_first_mut() {
            let below = rest.get_mut(1..).unwrap_or_default();
            let subtree =
                Subtree { leaves: &topology.leaves, left_sizes: &topology.left_sizes, first_leaf: 0 };
            self.subtree(subtree, SubtreeNodes { root, below, below_index: first_node + 2 });
        }
        (!self.control.is_cancelled()).then_some(())
    }

    /// Fills the nodes of a subtree. They are undefined once building is cancelled.
    fn subtree(&self, subtree: Subtree, nodes: SubtreeNodes) -> Summary {
        let Subtree { leaves, left_sizes, first_leaf } = subtree;
        if leaves.len() > PARALLEL && self.control.is_cancelled() {
            return Summary::NONE;
        }
        let SubtreeNodes { root: node, below, below_index } = nodes;
        let Some((&left, rest)) = left_sizes.split_first() else {
            return self.leaf(&leaves[0], first_leaf, node);
        };
        let left = left as usize;
        let (left_leaves, right_leaves) = leaves.split_at(left);
        let (left_rest, right_rest) = rest.split_at(left - 1);
        let (children, below) = below.split_at_mut(2);
        let (left_below, right_below) = below.split_at_mut(2 * (left - 1));
        let (left_root, right_root) = children.split_at_mut(1);
        let (left_index, right_leaf) = (below_index + 2, first_leaf + left as u32);
        let right_index = left_index + left_below.len() as u32;
        let left_subtree = Subtree { leaves: left_leaves, left_sizes: left_rest, first_leaf };
        let right_subtree = Subtree { leaves: right_leaves, left_sizes: right_rest, first_leaf: right_leaf };
        let left_nodes = SubtreeNodes { root: &mut left_root[0], below: left_below, below_index: left_index };
        let right_nodes =
            SubtreeNodes { root: &mut right_root[0], below: right_below, below_index: right_index };
        let do_left = || self.subtree(left_subtree, left_nodes);
        let do_right = || self.subtree(right_subtree, right_nodes);
        let (a, b) =
            if leaves.len() > PARALLEL { rayon::join(do_left, do_right) } else { (do_left(), do_right()) };

        let mut bounds = a.bounds;
        bounds.add(&b.bounds);
        let luminance = a.luminance + b.luminance;
        let takes_left = unit_hash(below_index) * luminance < a.luminance;
        let representative = if takes_left { a.representative } else { b.representative };
        let intensity = a.intensity + b.intensity;
        *node = LightNode::new(rounded_up(intensity), representative, self.set.kind, self.set.origin);
        node.set_children(below_index);
        self.set_box(node, &bounds);
        if self.has_cones() {
            let centre = Vec3::from_array(std::array::from_fn(|i| bounds.min[3 + i] + bounds.max[3 + i]));
            let axis = centre.try_normalize().unwrap_or_else(|| leaves[0].normal());
            self.set_cone(node, axis, leaves);
        }
        Summary { bounds, intensity, luminance, representative }
    }

    fn leaf(&self, primitive: &Primitive, place: u32, node: &mut LightNode) -> Summary {
        let intensity = self.set.intensities[primitive.index() as usize];
        let representative = self.first_vpl + place;
        *node = LightNode::new(intensity, representative, self.set.kind, self.set.origin);
        let bounds = PrimitiveBounds::around_one(primitive);
        self.set_box(node, &bounds);
        if self.has_cones() {
            self.set_cone(node, primitive.normal(), std::slice::from_ref(primitive));
        }
        let luminance = f64::from(luminance(intensity));
        Summary { bounds, intensity: intensity.as_dvec3(), luminance, representative }
    }

    fn has_cones(&self) -> bool {
        matches!(self.set.kind, VplKind::Oriented | VplKind::Lobed)
    }

    /// Sets the cone about `axis` that contains the normals of all members, or the axes of their lobes.
    fn set_cone(&self, node: &mut LightNode, axis: Vec3, members: &[Primitive]) {
        let least = |a: f32, b: f32| if b < a { b } else { a };
        let cosine = |members: &[Primitive]| {
            members.iter().fold(1.0f32, |cos_beta, r| least(cos_beta, r.normal().dot(axis)))
        };
        let cos_beta = match members.len() > LARGE {
            true => members.par_chunks(PARALLEL).map(cosine).reduce(|| 1.0, least),
            false => cosine(members),
        };
        let lobe = |r: &Primitive| &self.profiles.lobes[self.set.vpls[r.index() as usize].lobe()];
        let width_sq = || members.iter().map(|r| lobe(r).width_sq()).fold(0.0, f32::max);
        let width_sq = (self.set.kind == VplKind::Lobed).then(width_sq);
        node.set_cone(axis, (cos_beta - COSINE_SLACK).max(-1.0), width_sq);
    }

    fn set_box(&self, node: &mut LightNode, bounds: &PrimitiveBounds) {
        let first = if self.set.kind == VplKind::Directional { 3 } else { 0 };
        node.min = Vec3::from_array(std::array::from_fn(|i| bounds.min[first + i]));
        node.max = Vec3::from_array(std::array::from_fn(|i| bounds.max[first + i]));
    }
}

/// Rounds up to f32 in every channel, so that a cluster is never dimmer than its members together.
fn rounded_up(c: DVec3) -> Rgb {
    let up = |x: f64| {
        let nearest = x.min(f64::from(f32::MAX)) as f32;
        if f64::from(nearest) < x { nearest.next_up().min(f32::MAX) } else { nearest }
    };
    Rgb::new(up(c.x), up(c.y), up(c.z))
}

/// Returns a pseudo-random number in [0, 1) that depends on the node alone.
///
/// Paper: the finaliser of Stafford's *Better Bit Mixing*, variant 13.
fn unit_hash(node: u32) -> f64 {
    let mut h = u64::from(node).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ h >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ h >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (h >> 11) as f64 / (1u64 << 53) as f64
}
