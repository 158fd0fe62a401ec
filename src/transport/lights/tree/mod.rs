//! Light trees: VPLs clustered in binary trees. Each cluster has bounds, cone, intensity and representative.
//!
//! There is one tree for each kind and origin of VPLs. All trees share one array of nodes, and the roots together stand
//! for the virtual root above them. Trees are equal for any number of threads.

mod cost;
mod divisive;
mod finish;
mod node;
mod partition;
#[cfg(test)]
mod tests;

use crate::lights::{Origin, Profiles, Vpl, VplSet};
use base::progress::Control;
use cost::Primitive;
use finish::Finisher;
use rayon::prelude::*;

pub use node::{LightNode, MAX_VPLS};

/// Number of nodes allocated between two tests for cancellation. Allocation takes most of the time.
const NODES_PER_TEST: usize = 1 << 18;

/// The light trees of a scene.
#[derive(Clone, Debug, Default)]
pub struct LightTrees {
    /// Nodes of all trees.
    pub nodes: Vec<LightNode>,
    /// Indices of the roots in `nodes`.
    pub roots: Vec<u32>,
    /// The VPLs in the order of the leaves, tree after tree: neighbours in a tree are neighbours in memory.
    pub vpls: Vec<Vpl>,
    /// Number of edges from the emitter to each VPL, at most 255; 0 beyond the end.
    edges: Vec<u8>,
    /// Profiles that the VPLs refer to.
    pub profiles: Profiles,
}

impl LightTrees {
    /// Builds a tree over each of `sets`. The scene's `diagonal` sets the weight of an angle against a length.
    ///
    /// VPLs beyond [`MAX_VPLS`] in total are ignored. Incomplete trees are left out if `control` is cancelled.
    pub fn build(
        sets: &[VplSet],
        profiles: impl Into<Profiles>,
        diagonal: f32,
        control: &Control,
    ) -> LightTrees {
        let mut trees = LightTrees { profiles: profiles.into(), ..LightTrees::default() };
        for set in sets {
            let whole = trees.nodes.len();
            if trees.add(set, diagonal, control).is_none() {
                trees.nodes.truncate(whole);
                break;
            }
        }
        trees
    }

    /// Adds a tree over a set, unless the set is empty. Returns `None` if `control` is cancelled, and then leaves some
    /// nodes behind.
    fn add(&mut self, set: &VplSet, diagonal: f32, control: &Control) -> Option<()> {
        let n = set.len().min(MAX_VPLS - self.vpls.len());
        if n == 0 {
            return Some(());
        }
        let primitive = |i: usize| Primitive::new(set, &self.profiles, i as u32);
        let primitives = (0..n).into_par_iter().map(primitive).collect();
        let build = || divisive::build(primitives, diagonal * diagonal, control);
        let (first_node, first_vpl) = (self.nodes.len(), self.vpls.len());
        let nodes = &mut self.nodes;
        let blank = LightNode::new(base::math::Rgb::ZERO, 0, set.kind, set.origin);
        let end = first_node + 2 * n;
        let allocate = || {
            nodes.reserve(2 * n);
            while nodes.len() < end && !control.is_cancelled() {
                nodes.par_extend(rayon::iter::repeat_n(blank, NODES_PER_TEST.min(end - nodes.len())));
            }
        };
        // The first splits of a tree leave threads idle.
        let topology = rayon::join(build, allocate).0?;
        let nodes = &mut self.nodes[first_node..];
        let finisher = Finisher { set, profiles: &self.profiles, first_vpl: first_vpl as u32, control };
        finisher.finish(&topology, nodes, first_node as u32)?;
        self.vpls.par_extend(topology.leaves.par_iter().map(|r| set.vpls[r.index() as usize]));
        if !set.edges.is_empty() {
            self.edges.resize(first_vpl, 0);
            self.edges.par_extend(topology.leaves.par_iter().map(|r| set.edges[r.index() as usize]));
        }
        self.roots.push(first_node as u32);
        Some(())
    }

    /// Returns the VPL that represents a node, and the number of edges from the emitter to it.
    #[inline]
    pub fn representative(&self, node: &LightNode) -> (&Vpl, u8) {
        let index = node.representative();
        (&self.vpls[index], self.edges.get(index).copied().unwrap_or(0))
    }

    /// Returns the roots of all trees, or of the trees for light of one `origin`.
    pub fn roots_of(&self, origin: Option<Origin>) -> impl Iterator<Item = u32> + '_ {
        let wanted = move |&root: &u32| origin.is_none_or(|o| self.nodes[root as usize].origin() == o);
        self.roots.iter().copied().filter(wanted)
    }

    /// Returns the leaves, in order of their VPLs within each tree.
    pub fn leaves(&self) -> impl Iterator<Item = &LightNode> {
        let mut stack: Vec<u32> = self.roots.iter().rev().copied().collect();
        std::iter::from_fn(move || {
            loop {
                let node = &self.nodes[stack.pop()? as usize];
                match node.children() {
                    None => return Some(node),
                    Some(left) => stack.extend([left + 1, left]),
                }
            }
        })
    }
}
