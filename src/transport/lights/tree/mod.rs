//! Stage 2: VPLs clustered in trees, each cluster with bounds, cone, intensity and representative.
//!
//! One tree for each kind and origin that the scene has, all in one array of nodes; the roots together
//! stand for the virtual root above them. Both families of builders produce the same kind of tree.
//!
//! The same VPLs give the same trees for any number of threads.

mod agglomerative;
mod cost;
mod divisive;
mod finish;
mod node;
#[cfg(test)]
mod tests;
mod topology;

use crate::lights::{Origin, Profiles, Vpl, VplSet};
use base::math::luminance;
use base::progress::Control;
use base::setting::{Each, Settings, Spec, choices};
use cost::Primitive;
use rayon::prelude::*;

pub use node::{LightNode, MAX_VPLS};

choices! {
    /// Way to build a tree.
    ///
    /// Seconds of processor time to build (one thread's worth) and mean uncapped cuts at ε = 2 % / 1 %, by
    /// `lightsplat bench trees SCENE`:
    ///
    /// | | nave, 300k | nave, 1M | sibenik, 300k | sibenik, 1M |
    /// |---|--:|--:|--:|--:|
    /// | divisive | 0.19 s, 1143 / 1748 | 0.72 s, 1208 / 1840 | 0.18 s, 608 / 922 | 0.71 s, 630 / 953 |
    /// | agglomerative | 0.23 s, 1291 / 1903 | 0.81 s, 1397 / 2034 | 0.23 s, 694 / 1015 | 0.81 s, 735 / 1066 |
    pub enum Family = Divisive {
        /// Top-down: binned splits in position and normal.
        Divisive = "divisive",
        /// Bottom-up: locally-ordered clustering.
        Agglomerative = "agglomerative",
    }
}

/// Declaration of the choice between them.
static TREE: Spec =
    Spec::new("tree", "Builder of the light trees", "Lightcuts").values(&["agglomerative", "divisive"]);

/// A setting by itself.
impl Settings for Family {
    fn each(&mut self, each: Each) {
        each(&TREE, self);
    }
}

/// Number of nodes that are laid out between two looks at whether building is cancelled: their memory takes longer to
/// be had than they to be written.
const LAID_OUT: usize = 1 << 18;

/// The light trees of a scene.
#[derive(Clone, Debug, Default)]
pub struct LightTrees {
    /// Nodes of all trees.
    pub nodes: Vec<LightNode>,
    /// Indices of the roots in `nodes`.
    pub roots: Vec<u32>,
    /// The VPLs in the order of the leaves, tree after tree: neighbours in a tree are neighbours in memory.
    pub vpls: Vec<Vpl>,
    /// Profiles that they refer to.
    pub profiles: Profiles,
}

impl LightTrees {
    /// Builds a tree over each of `sets`; `diagonal` of the scene sets the weight of an angle against a
    /// length.
    ///
    /// VPLs beyond [`MAX_VPLS`] in all are ignored. Trees that are not whole when `control` is cancelled are left out.
    pub fn build(
        sets: &[VplSet],
        profiles: impl Into<Profiles>,
        diagonal: f32,
        family: Family,
        control: &Control,
    ) -> LightTrees {
        let mut trees = LightTrees { profiles: profiles.into(), ..LightTrees::default() };
        for set in sets {
            let whole = trees.nodes.len();
            if trees.add(set, diagonal, family, control).is_none() {
                trees.nodes.truncate(whole);
                break;
            }
        }
        trees
    }

    /// Adds a tree over a set, unless that is empty; `None` if `control` is cancelled, with some nodes left behind.
    fn add(&mut self, set: &VplSet, diagonal: f32, family: Family, control: &Control) -> Option<()> {
        let n = set.len().min(MAX_VPLS - self.vpls.len());
        if n == 0 {
            return Some(());
        }
        let primitive = |i: usize| {
            Primitive::new(&set.vpls[i], set.kind, &self.profiles, (luminance(set.intensities[i]), i as u32))
        };
        let primitives = (0..n).into_par_iter().map(primitive).collect();
        let topology = match family {
            Family::Divisive => divisive::build(primitives, diagonal * diagonal, control)?,
            Family::Agglomerative => agglomerative::build(primitives, diagonal * diagonal, control)?,
        };
        let (first_node, first_vpl) = (self.nodes.len(), self.vpls.len());
        let blank = LightNode::new(base::math::Rgb::ZERO, 0, set.kind, set.origin);
        let end = first_node + 2 * n;
        self.nodes.reserve(2 * n);
        while self.nodes.len() < end && !control.is_cancelled() {
            self.nodes.par_extend(rayon::iter::repeat_n(blank, LAID_OUT.min(end - self.nodes.len())));
        }
        let nodes = &mut self.nodes[first_node..];
        finish::finish(&topology, (set, &self.profiles), nodes, [first_node, first_vpl], control)?;
        self.vpls.par_extend(topology.leaves.par_iter().map(|r| set.vpls[r.index() as usize]));
        self.roots.push(first_node as u32);
        Some(())
    }

    /// Returns the roots of all trees, or of those for light of one origin.
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
