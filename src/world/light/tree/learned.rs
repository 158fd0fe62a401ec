//! Visibility of emitters from each region of the scene, learned from free and occluded rays. In a building with many
//! rooms most emitters are occluded, and samples of them are wasted.
//!
//! Paper: Vévoda, Kondapaneni & Křivánek, *Bayesian online regression for adaptive direct illumination sampling*, 2018.
//!
//! Deviations: the visibility is learned once, before any sample is taken, by rays to emitters that are chosen without
//! it. For each node of the emitter tree it is the share of free rays, with the parent's share as prior. The importance
//! of a node is multiplied by the root of the share, which minimises the variance if nodes are wholly visible or wholly
//! occluded. Estimates are unbiased, because no factor is 0.

use super::EmitterTree;
use super::node::ARITY;
use crate::light::regions::Regions;
use base::math::{LANES, Vec3x16};
use glam::Vec3;
use rayon::prelude::*;

/// Maximum number of points in a region, unless there are too many nodes (see [`MAX_FACTORS`]).
const POINTS: usize = 64;

/// Minimum share of occluded rays for which visibility is used; below it, the lookup costs more than it saves.
const MIN_OCCLUDED: f32 = 0.25;

/// Approximate maximum number of factors.
const MAX_FACTORS: usize = 1 << 22;

/// Weight of a parent's share in its children's shares, in rays.
const PRIOR: f32 = 1.0;

/// Minimum factor.
const MIN_FACTOR: f32 = 0.1;

/// Points, and the visibility of emitters from each.
#[derive(Clone, Debug, Default)]
pub struct EmitterObservations {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Emitters to which the rays of each point in turn were traced, and true if they are visible; `None` for rays to
    /// emitters that cannot light the point. Every point has the same number of rays.
    pub rays: Vec<Option<(u32, bool)>>,
}

/// Factors on the importance of nodes by region.
#[derive(Clone, Debug)]
pub struct LearnedEmitters {
    regions: Regions,
    /// Factors by region and node.
    factors: Vec<f32>,
    /// Number of slots for nodes.
    slots: usize,
}

impl LearnedEmitters {
    /// Learns the factors; `None` if nearly all emitters are visible from everywhere.
    pub(in crate::light) fn new(
        tree: &EmitterTree,
        observations: &EmitterObservations,
    ) -> Option<LearnedEmitters> {
        let rays = || observations.rays.iter().flatten();
        let occluded = rays().filter(|(_, seen)| !seen).count();
        if (occluded as f32) <= MIN_OCCLUDED * rays().count() as f32 {
            return None;
        }
        let slots = tree.slots();
        let most = POINTS.max(observations.points.len().saturating_mul(slots) / MAX_FACTORS);
        let (regions, members) = Regions::new(&observations.points, most);
        let each = observations.rays.len() / observations.points.len().max(1);
        let factors = members.par_iter().flat_map_iter(|members| {
            let rays = members.iter().flat_map(|point| &observations.rays[*point as usize * each..][..each]);
            factors(tree, rays.flatten())
        });
        Some(LearnedEmitters { factors: factors.collect(), regions, slots })
    }

    /// Returns the factors at sixteen points, by node.
    #[inline]
    pub(in crate::light) fn at(&self, x: &Vec3x16) -> [&[f32]; LANES] {
        self.regions.find(x).map(|region| &self.factors[region * self.slots..][..self.slots])
    }
}

/// Computes the factors of a region from its rays.
fn factors<'a>(tree: &EmitterTree, rays: impl Iterator<Item = &'a (u32, bool)>) -> Vec<f32> {
    let mut counts = vec![[0.0f32; 2]; tree.slots()];
    let mut all = [PRIOR; 2];
    for (emitter, seen) in rays {
        let add = |[free, rays]: &mut [f32; 2]| (*free, *rays) = (*free + f32::from(*seen), *rays + 1.0);
        add(&mut all);
        tree.slots_above(*emitter as usize).for_each(|slot| add(&mut counts[slot]));
    }
    let share = |[free, rays]: [f32; 2], parent: f32| (free + PRIOR * parent) / (rays + PRIOR);
    let mut shares = vec![all[0] / all[1]; counts.len()];
    for (slot, counts) in counts.iter().enumerate() {
        // A branch comes after the node whose child it is.
        let parent = match slot.checked_sub(tree.len()) {
            None => all[0] / all[1],
            Some(below) => shares[tree.slot_at(tree.parents[below / ARITY])],
        };
        shares[slot] = share(*counts, parent);
    }
    shares.into_iter().map(|share| share.sqrt().max(MIN_FACTOR)).collect()
}
