//! Visibility of emitters from each region of the scene, as factors on their importance.
//!
//! For each node of the emitter tree the visibility is the share of free rays, with the parent's share as prior. The
//! importance of a node is multiplied by the root of the share, which minimises the variance if nodes are wholly
//! visible or wholly occluded.

use super::EmitterTree;
use super::node::ARITY;
use crate::light::observed::{Observed, PRIOR};
use base::math::LANES;

/// Minimum share of occluded rays for which visibility is used; below it, the lookup costs more than it saves.
const MIN_OCCLUDED: f32 = 0.25;

/// Approximate maximum number of factors.
pub const MAX_FACTORS: usize = 1 << 22;

/// Weight of the share above a node of the tree in the node's own, in rays.
const ABOVE: f32 = 1.0;

/// Minimum factor.
const MIN_FACTOR: f32 = 0.1;

/// Factors on the importance of nodes by region.
#[derive(Clone, Debug)]
pub struct LearnedEmitters {
    /// Factors of the nodes by region.
    factors: Vec<Vec<f32>>,
}

impl LearnedEmitters {
    /// Learns the factors; `None` if nearly all emitters are visible from everywhere.
    pub(in crate::light) fn new(tree: &EmitterTree, observed: &Observed) -> Option<LearnedEmitters> {
        let rays = || observed.waves.iter().flat_map(|wave| wave.emitters.iter().flatten());
        let occluded = rays().filter(|(_, seen)| !seen).count();
        if (occluded as f32) <= MIN_OCCLUDED * rays().count() as f32 {
            return None;
        }
        let add = |region: usize, counts: &mut [[f32; 2]]| {
            for (emitter, seen) in observed.rays(region, |wave| &wave.emitters).flatten() {
                for slot in tree.slots_above(*emitter as usize) {
                    counts[slot] = [counts[slot][0] + f32::from(*seen), counts[slot][1] + 1.0];
                }
            }
        };
        let everywhere = shares(tree, rays());
        let factor = |share: &mut f32| *share = share.sqrt().max(MIN_FACTOR);
        let mut factors = observed.regions.means(add, PRIOR, &everywhere);
        factors.iter_mut().flatten().for_each(factor);
        Some(LearnedEmitters { factors })
    }

    /// Returns the factors in sixteen regions, by node.
    #[inline]
    pub(in crate::light) fn at(&self, regions: &[usize; LANES]) -> [&[f32]; LANES] {
        regions.map(|region| &self.factors[region][..])
    }
}

/// Returns the shares of free rays among all rays to emitters.
fn shares<'a>(tree: &EmitterTree, rays: impl Iterator<Item = &'a (u32, bool)>) -> Vec<f32> {
    let mut counts = vec![[0.0f32; 2]; tree.slots()];
    let mut all = [ABOVE; 2];
    for (emitter, seen) in rays {
        let add = |[free, rays]: &mut [f32; 2]| (*free, *rays) = (*free + f32::from(*seen), *rays + 1.0);
        add(&mut all);
        tree.slots_above(*emitter as usize).for_each(|slot| add(&mut counts[slot]));
    }
    let share = |[free, rays]: [f32; 2], parent: f32| (free + ABOVE * parent) / (rays + ABOVE);
    let mut shares = vec![all[0] / all[1]; counts.len()];
    for (slot, counts) in counts.iter().enumerate() {
        // A branch comes after the node whose child it is.
        let parent = match slot.checked_sub(tree.len()) {
            None => all[0] / all[1],
            Some(below) => shares[tree.slot_at(tree.parents[below / ARITY])],
        };
        shares[slot] = share(*counts, parent);
    }
    shares
}
