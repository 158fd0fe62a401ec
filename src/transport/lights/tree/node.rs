//! Nodes of a light tree in the layout of a lightcut: one cache line each. Siblings are neighbours, so that a split
//! touches two adjacent lines. A topology is the order of leaves from which they are made.

use super::cost::Primitive;
use crate::lights::{Origin, VplKind};
use base::math::Rgb;
use glam::Vec3;

const INDEX_BITS: u32 = 29;
const INDEX_MASK: u32 = (1 << INDEX_BITS) - 1;
const INDIRECT: u32 = 1 << INDEX_BITS;
const KIND_SHIFT: u32 = INDEX_BITS + 1;

/// Maximum number of VPLs in a [`super::LightTrees`].
pub const MAX_VPLS: usize = 1 << INDEX_BITS;

/// Cluster of VPLs, or a single VPL.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct LightNode {
    /// Corner of the box around the positions; for directional VPLs, around the unit directions to the light.
    pub min: Vec3,
    /// Cosine of the half angle β of the cone around the normals; -1 for omni VPLs. For lobed VPLs the cone is around
    /// the axes of the lobes.
    pub cos_beta: f32,
    /// The opposite corner.
    pub max: Vec3,
    /// Sine of β; for lobed VPLs, the maximum squared width of the lobes.
    sine_or_width: f32,
    /// Unit axis of the cone.
    pub axis: Vec3,
    /// Index of the left child, which the right child follows; 0 for a leaf (no child has the index 0).
    children: u32,
    /// Sum of the members' intensities.
    pub intensity: Rgb,
    /// Representative, origin and kind.
    tag: u32,
}

impl LightNode {
    /// Creates a node without bounds.
    pub(super) fn new(intensity: Rgb, representative: u32, kind: VplKind, origin: Origin) -> LightNode {
        let kind = match kind {
            VplKind::Oriented => 0,
            VplKind::Omni => 1,
            VplKind::Directional => 2,
            VplKind::Lobed => 3,
        };
        let indirect = if origin == Origin::Indirect { INDIRECT } else { 0 };
        LightNode {
            min: Vec3::ZERO,
            cos_beta: -1.0,
            max: Vec3::ZERO,
            sine_or_width: 0.0,
            axis: Vec3::Z,
            children: 0,
            intensity,
            tag: kind << KIND_SHIFT | indirect | (representative & INDEX_MASK),
        }
    }

    /// Sets the cone; for lobed VPLs, also the maximum of [`crate::lights::LobeProfile::width_sq`].
    pub(super) fn set_cone(&mut self, axis: Vec3, cos_beta: f32, width_sq: Option<f32>) {
        (self.axis, self.cos_beta) = (axis, cos_beta);
        self.sine_or_width = width_sq.unwrap_or_else(|| sine(cos_beta));
    }

    /// Sine of β.
    #[inline]
    pub fn sin_beta(&self) -> f32 {
        if self.kind() == VplKind::Lobed { sine(self.cos_beta) } else { self.sine_or_width }
    }

    /// Maximum squared width of the members' lobes; defined only for lobed VPLs.
    #[inline]
    pub fn width_sq(&self) -> f32 {
        self.sine_or_width
    }

    pub(super) fn set_children(&mut self, left: u32) {
        self.children = left;
    }

    /// Index of the left child, which the right child follows; `None` for a leaf.
    #[inline]
    pub fn children(&self) -> Option<u32> {
        (self.children != 0).then_some(self.children)
    }

    /// True if this is a single VPL.
    #[inline]
    pub fn is_leaf(&self) -> bool {
        self.children == 0
    }

    /// Index of the VPL that represents the cluster.
    #[inline]
    pub fn representative(&self) -> usize {
        (self.tag & INDEX_MASK) as usize
    }

    /// Kind of the members.
    #[inline]
    pub fn kind(&self) -> VplKind {
        match self.tag >> KIND_SHIFT {
            0 => VplKind::Oriented,
            1 => VplKind::Omni,
            2 => VplKind::Directional,
            _ => VplKind::Lobed,
        }
    }

    /// Origin of the members' light.
    #[inline]
    pub fn origin(&self) -> Origin {
        if self.tag & INDIRECT != 0 { Origin::Indirect } else { Origin::Direct }
    }
}

#[inline]
fn sine(cos: f32) -> f32 {
    (1.0 - cos * cos).max(0.0).sqrt()
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_is_one_cache_line() {
        assert_eq!((size_of::<LightNode>(), align_of::<LightNode>()), (64, 64));
    }

    #[test]
    fn the_tag_keeps_kind_origin_and_representative_apart() {
        for kind in [VplKind::Omni, VplKind::Oriented, VplKind::Directional, VplKind::Lobed] {
            for origin in [Origin::Direct, Origin::Indirect] {
                let node = LightNode::new(Rgb::ONE, MAX_VPLS as u32 - 1, kind, origin);
                assert_eq!((node.kind(), node.origin()), (kind, origin));
                assert_eq!(node.representative(), MAX_VPLS - 1);
                assert!(node.is_leaf() && node.children().is_none());
            }
        }
    }
}
