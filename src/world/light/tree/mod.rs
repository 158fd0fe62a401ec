//! A tree over many emitters: the choice of one goes down it, by the importance of the nodes at the point.
//!
//! Papers: Conty Estevez & Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, 2018; Yuksel,
//! *Stochastic Lightcuts*, 2019.
//!
//! Deviations: the choice starts not at the root but among the nodes of a cut (all emitters, if they are few), which
//! are weighted at sixteen points at once, and goes on by branches of up to eight children. Part of it is by power,
//! against estimates that are far off. Directional lights are points far away. The angle in which a node is seen
//! enters by its sine alone, which bounds the cosines and saves roots.

mod bounds;
mod branch;
mod build;
mod cone;
mod learned;
mod node;

use super::{AreaLight, Receivers16};
use base::math::{F32x16, LANES};
pub use bounds::EmitterBounds;
use branch::Branch;
use build::{BinaryNode, Content, build};
use glam::Vec3;
pub use learned::{LampLooks, LearnedLamps};
use node::{ARITY, Child, Node};
use scene::DeltaLight;

pub(super) use node::BY_POWER;

/// A tree over area and delta lights, which are counted in this order.
#[derive(Clone, Debug)]
pub(super) struct EmitterTree {
    /// Nodes of the cut from which the choice starts.
    top: Vec<(Node, Child)>,
    branches: Vec<Branch>,
    /// Place of each emitter.
    emitters: Vec<Place>,
    /// Place of each branch.
    parents: Vec<Place>,
}

/// Place of an emitter or branch in the tree.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// In the cut.
    Top(u32),
    /// Below a branch, as a child.
    Below { branch: u32, slot: u32 },
}

impl EmitterTree {
    /// Builds the tree, with a cut of at most `top` nodes, in a scene of the given diagonals: of all surfaces, and of
    /// what positions are as precise as ([`scene::Scene::extent`]).
    /// Returns it and the powers of the cut's nodes.
    pub fn new(
        areas: &[AreaLight],
        deltas: &[DeltaLight],
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
            emitters: vec![Place::Top(0); emitters.len()],
            parents: Vec::new(),
        };
        for (i, node) in cut.iter().enumerate() {
            let child = tree.add(&binary, *node, Place::Top(i as u32), extent);
            tree.top.push((Node::new(&binary[*node].bounds, extent), child));
        }
        (tree, cut.iter().map(|node| binary[*node].bounds.power).collect())
    }

    /// Adds a binary node, and those below it, to the branches.
    fn add(&mut self, binary: &[BinaryNode], node: usize, place: Place, extent: f32) -> Child {
        if let Content::Emitter(emitter) = binary[node].content {
            self.emitters[emitter] = place;
            return Child::emitter(emitter);
        }
        let members = cut(binary, node, ARITY);
        let index = self.branches.len();
        self.branches.push(Branch::new(&[]));
        self.parents.push(place);
        let total: f64 = members.iter().map(|m| f64::from(binary[*m].bounds.power)).sum();
        let children: Vec<(Node, f32, Child)> = (0u32..)
            .zip(&members)
            .map(|(slot, member)| {
                let bounds = &binary[*member].bounds;
                let share = f64::from(bounds.power) / total;
                let share = if share.is_finite() { share as f32 } else { 0.0 };
                let place = Place::Below { branch: index as u32, slot };
                (Node::new(bounds, extent), share, self.add(binary, *member, place, extent))
            })
            .collect();
        self.branches[index] = Branch::new(&children);
        Child::branch(index)
    }

    /// Writes the importances of the cut's nodes.
    #[inline]
    pub fn weigh(&self, at: Receivers16, weights: &mut [F32x16]) {
        for (w, (node, _)) in weights.iter_mut().zip(&self.top) {
            for i in 0..LANES {
                w[i] = node.importance(at.position.get(i), at.normal.get(i));
            }
        }
    }

    /// Number of nodes in the cut.
    pub fn len(&self) -> usize {
        self.top.len()
    }

    /// Chooses an emitter below node `top` of the cut; returns it and its probability there. `None` where none shines
    /// on the point.
    #[inline]
    pub fn sample(
        &self,
        top: usize,
        at: (Vec3, Vec3),
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

    /// Returns the node of the cut above an emitter, and the probability of [`EmitterTree::sample`] choosing it there.
    #[inline]
    pub fn probability(&self, emitter: usize, at: (Vec3, Vec3), factors: Option<&[f32]>) -> (usize, f32) {
        let (mut place, mut probability) = (self.emitters[emitter], 1.0);
        loop {
            match place {
                Place::Top(top) => return (top as usize, probability),
                Place::Below { branch, slot } => {
                    let branch = branch as usize;
                    let factors = factors.map(|factors| &factors[self.slot(branch, 0)..][..ARITY]);
                    probability *= self.branches[branch].probability(at, factors, slot as usize);
                    place = self.parents[branch];
                }
            }
        }
    }
}

/// Nodes by number: those of the cut, then the children of each branch.
impl EmitterTree {
    /// Number of all nodes, and of what branches might have more.
    fn slots(&self) -> usize {
        self.slot(self.branches.len(), 0)
    }

    /// Number of a branch's child.
    #[inline]
    fn slot(&self, branch: usize, child: usize) -> usize {
        self.top.len() + branch * ARITY + child
    }

    /// Number of the node at a place.
    fn slot_at(&self, place: Place) -> usize {
        match place {
            Place::Top(top) => top as usize,
            Place::Below { branch, slot } => self.slot(branch as usize, slot as usize),
        }
    }

    /// Numbers of an emitter's node and those above it.
    fn slots_above(&self, emitter: usize) -> impl Iterator<Item = usize> {
        let above = |place: &Place| match *place {
            Place::Top(_) => None,
            Place::Below { branch, .. } => Some(self.parents[branch as usize]),
        };
        std::iter::successors(Some(self.emitters[emitter]), above).map(|place| self.slot_at(place))
    }
}

/// Returns the cut of at most `size` nodes below a node of the binary tree that splits the costliest ones.
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
