//! A tree over many emitters. The choice of an emitter descends it by the importance of its nodes at the point.
//!
//! Papers: Conty Estevez & Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, 2018; Yuksel,
//! *Stochastic Lightcuts*, 2019.
//!
//! Deviations: the choice starts among the nodes of a cut (all emitters, if there are few), which are weighted at
//! sixteen points at once, and continues through branches of up to eight children. Part of the choice is by power, as a
//! safeguard against poor estimates. Directional lights are represented by distant points. The angle that a node
//! subtends enters by its sine alone, which bounds the cosines and saves roots.

mod bounds;
mod branch;
mod build;
mod cone;
mod learned;
mod node;

use super::area::AreaLight;
use super::delta::DeltaEmitter;
use base::math::{F32x16, LANES, Vec3x16};
pub use bounds::EmitterBounds;
use branch::Branch;
use build::{BinaryNode, Content, build};
pub use learned::{LearnedEmitters, MAX_FACTORS};
pub(super) use node::PointAndNormal;
use node::{ARITY, EmitterNode, TreeChild};

pub(super) use node::BY_POWER;

/// A tree over area and delta lights, whose indices count in this order.
#[derive(Clone, Debug)]
pub(super) struct EmitterTree {
    /// Nodes of the cut, among which the choice starts.
    top: Vec<(EmitterNode, TreeChild)>,
    branches: Vec<Branch>,
    /// Position of each emitter in the tree.
    emitters: Vec<TreePlace>,
    /// Position of each branch in the tree.
    parents: Vec<TreePlace>,
}

/// Position of an emitter or a branch in the tree.
#[derive(Clone, Copy, Debug)]
enum TreePlace {
    /// Node of the cut.
    Top(u32),
    /// Child of a branch.
    Below { branch: u32, slot: u32 },
}

impl EmitterTree {
    /// Builds the tree with a cut of at most `top` nodes. The diagonals are those of all surfaces and of the extent
    /// that determines the precision of positions ([`scene::Scene::extent`]). Returns the tree and the powers of the
    /// cut's nodes.
    pub fn new(
        areas: &[AreaLight],
        deltas: &[DeltaEmitter],
        [diagonal, extent]: [f32; 2],
        top: usize,
    ) -> (EmitterTree, Vec<f32>) {
        let areas = areas.iter().map(EmitterBounds::of_area);
        let deltas = deltas.iter().map(|light| EmitterBounds::of_delta(light, diagonal));
        let emitters: Vec<EmitterBounds> = areas.chain(deltas).collect();
        let binary = build(&emitters);
        let cut = binary.len().checked_sub(1).map_or(Vec::new(), |root| cut(&binary, root, top));
        let mut tree = EmitterTree {
            top: Vec::new(),
            branches: Vec::new(),
            emitters: vec![TreePlace::Top(0); emitters.len()],
            parents: Vec::new(),
        };
        for (i, node) in cut.iter().enumerate() {
            let child = tree.add(&binary, *node, TreePlace::Top(i as u32), extent);
            tree.top.push((EmitterNode::new(&binary[*node].bounds, extent), child));
        }
        (tree, cut.iter().map(|node| binary[*node].bounds.power).collect())
    }

    /// Adds a binary node and the nodes below it to the branches.
    fn add(&mut self, binary: &[BinaryNode], node: usize, place: TreePlace, extent: f32) -> TreeChild {
        if let Content::Emitter(emitter) = binary[node].content {
            self.emitters[emitter] = place;
            return TreeChild::emitter(emitter);
        }
        let members = cut(binary, node, ARITY);
        let index = self.branches.len();
        self.branches.push(Branch::new(&[]));
        self.parents.push(place);
        let total: f64 = members.iter().map(|m| f64::from(binary[*m].bounds.power)).sum();
        let children: Vec<(EmitterNode, f32, TreeChild)> = (0u32..)
            .zip(&members)
            .map(|(slot, member)| {
                let bounds = &binary[*member].bounds;
                let share = f64::from(bounds.power) / total;
                let share = if share.is_finite() { share as f32 } else { 0.0 };
                let place = TreePlace::Below { branch: index as u32, slot };
                (EmitterNode::new(bounds, extent), share, self.add(binary, *member, place, extent))
            })
            .collect();
        self.branches[index] = Branch::new(&children);
        TreeChild::branch(index)
    }

    /// Writes the importances of the cut's nodes.
    #[inline]
    pub fn weigh(&self, x: &Vec3x16, n: &Vec3x16, weights: &mut [F32x16]) {
        for (w, (node, _)) in weights.iter_mut().zip(&self.top) {
            for i in 0..LANES {
                w[i] = node.importance(PointAndNormal { x: x.get(i), n: n.get(i) });
            }
        }
    }

    /// Returns the emitters of the cut's nodes; `None` for nodes above several emitters.
    pub fn top_emitters(&self) -> impl Iterator<Item = Option<u32>> {
        self.top.iter().map(|(_, child)| child.get().err())
    }

    /// Returns the number of nodes in the cut.
    pub fn len(&self) -> usize {
        self.top.len()
    }

    /// Chooses an emitter below node `top` of the cut. Returns the emitter and its probability below that node; `None`
    /// if no emitter lights the point.
    #[inline]
    pub fn sample(
        &self,
        top: usize,
        at: PointAndNormal,
        factors: Option<&[f32]>,
        mut u: f32,
    ) -> Option<(u32, f32)> {
        let (mut child, mut probability) = (self.top[top].1, 1.0);
        loop {
            let branch = match child.get() {
                Ok(branch) => branch,
                Err(emitter) => return Some((emitter, probability)),
            };
            let factors = factors.map(|factors| &factors[self.slot(branch, 0)..][..ARITY]);
            let (chosen, share, rest) = self.branches[branch].sample(at, factors, u)?;
            (child, u) = (chosen, rest);
            probability *= share;
        }
    }

    /// Returns the node of the cut above an emitter, and the probability with which [`EmitterTree::sample`] chooses the
    /// emitter below that node.
    #[inline]
    pub fn probability(&self, emitter: usize, at: PointAndNormal, factors: Option<&[f32]>) -> (usize, f32) {
        let (mut place, mut probability) = (self.emitters[emitter], 1.0);
        loop {
            match place {
                TreePlace::Top(top) => return (top as usize, probability),
                TreePlace::Below { branch, slot } => {
                    let branch = branch as usize;
                    let factors = factors.map(|factors| &factors[self.slot(branch, 0)..][..ARITY]);
                    probability *= self.branches[branch].probability(at, factors, slot as usize);
                    place = self.parents[branch];
                }
            }
        }
    }
}

/// Numbering of the nodes: nodes of the cut, then the children of each branch.
impl EmitterTree {
    /// Returns the number of slots for nodes; every branch has as many as it may have children.
    pub fn slots(&self) -> usize {
        self.slot(self.branches.len(), 0)
    }

    /// Returns the slot of a branch's child.
    #[inline]
    fn slot(&self, branch: usize, child: usize) -> usize {
        self.top.len() + branch * ARITY + child
    }

    /// Returns the slot of the node at a position.
    fn slot_at(&self, place: TreePlace) -> usize {
        match place {
            TreePlace::Top(top) => top as usize,
            TreePlace::Below { branch, slot } => self.slot(branch as usize, slot as usize),
        }
    }

    /// Lists the slots of an emitter's node and of the nodes above it.
    fn slots_above(&self, emitter: usize) -> impl Iterator<Item = usize> {
        let above = |place: &TreePlace| match *place {
            TreePlace::Top(_) => None,
            TreePlace::Below { branch, .. } => Some(self.parents[branch as usize]),
        };
        std::iter::successors(Some(self.emitters[emitter]), above).map(|place| self.slot_at(place))
    }
}

/// Returns a cut of at most `size` nodes below a node of the binary tree. Nodes of the highest cost are split first.
fn cut(nodes: &[BinaryNode], root: usize, size: usize) -> Vec<usize> {
    let mut cut = vec![root];
    while cut.len() < size {
        let splittable = (0..cut.len()).filter_map(|i| match nodes[cut[i]].content {
            Content::Children(children) => Some((nodes[cut[i]].bounds.cost(), i, children)),
            Content::Emitter(_) => None,
        });
        let Some((_, i, [left, right])) = splittable.reduce(|a, b| if b.0 > a.0 { b } else { a }) else {
            break;
        };
        cut[i] = left;
        cut.insert(i + 1, right);
    }
    cut
}
