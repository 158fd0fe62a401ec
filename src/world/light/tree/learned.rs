//! Lamps seen from each region of the scene, learned from free and occluded rays: in a house most lamps hang in other
//! rooms, and samples that go to them are lost.
//!
//! Paper: Vévoda, Kondapaneni & Křivánek, *Bayesian online regression for adaptive direct illumination sampling*, 2018.
//!
//! Deviations: learned once, before any sample is taken, by rays to lamps chosen as without knowledge. By the node of
//! the emitter tree, the share of rays that are free, under a prior that is its parent's share; the importance of the
//! node at a point is multiplied by the root of it, which is least variance if nodes are seen wholly or not at all.
//! Estimates have no bias, however little was learned, because no factor is 0.

use super::EmitterTree;
use super::node::ARITY;
use crate::light::regions::Regions;
use base::math::{LANES, Vec3x16};
use glam::Vec3;
use rayon::prelude::*;

/// Maximum number of points in a region, where there are not too many nodes.
const POINTS: usize = 64;

/// Minimum share of all rays that is occluded: knowledge of lamps that are seen from nearly everywhere spares less
/// than looking it up costs.
const MIN_OCCLUDED: f32 = 0.25;

/// Number of factors kept, about.
const MAX_FACTORS: usize = 1 << 22;

/// Weight, in rays, of a parent's share in that of its children.
const PRIOR: f32 = 1.0;

/// Minimum factor.
const MIN_FACTOR: f32 = 0.1;

/// Points, and rays from there.
#[derive(Clone, Debug, Default)]
pub struct LampLooks {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Lamps that the rays of each point in turn go to, and whether they are seen; `None` of rays to nothing that
    /// could shine there. All points have as many.
    pub rays: Vec<Option<(u32, bool)>>,
}

/// Factors on the importance of nodes, by region.
#[derive(Clone, Debug)]
pub struct LearnedLamps {
    regions: Regions,
    factors: Vec<f32>,
    /// Number of nodes.
    slots: usize,
}

impl LearnedLamps {
    /// Learns; `None` if nearly all lamps are seen from everywhere.
    pub(in crate::light) fn new(tree: &EmitterTree, looks: &LampLooks) -> Option<LearnedLamps> {
        let rays = || looks.rays.iter().flatten();
        let occluded = rays().filter(|(_, seen)| !seen).count();
        if (occluded as f32) <= MIN_OCCLUDED * rays().count() as f32 {
            return None;
        }
        let slots = tree.slots();
        let few = POINTS.max(looks.points.len().saturating_mul(slots) / MAX_FACTORS);
        let (regions, members) = Regions::new(&looks.points, few);
        let each = looks.rays.len() / looks.points.len().max(1);
        let factors = members.par_iter().flat_map_iter(|members| {
            let rays = members.iter().flat_map(|point| &looks.rays[*point as usize * each..][..each]);
            factors(tree, rays.flatten())
        });
        Some(LearnedLamps { factors: factors.collect(), regions, slots })
    }

    /// Factors at sixteen points, by node.
    #[inline]
    pub(in crate::light) fn at(&self, x: &Vec3x16) -> [&[f32]; LANES] {
        self.regions.find(x).map(|region| &self.factors[region * self.slots..][..self.slots])
    }
}

/// Factors by what rays have seen.
fn factors<'a>(tree: &EmitterTree, rays: impl Iterator<Item = &'a (u32, bool)>) -> Vec<f32> {
    let mut counts = vec![[0.0f32; 2]; tree.slots()];
    let mut all = [PRIOR; 2];
    for (lamp, seen) in rays {
        let add = |[free, rays]: &mut [f32; 2]| (*free, *rays) = (*free + f32::from(*seen), *rays + 1.0);
        add(&mut all);
        tree.slots_above(*lamp as usize).for_each(|slot| add(&mut counts[slot]));
    }
    let share = |[free, rays]: [f32; 2], parent: f32| (free + PRIOR * parent) / (rays + PRIOR);
    let mut shares = vec![all[0] / all[1]; counts.len()];
    for (slot, counts) in counts.iter().enumerate() {
        // Branches come after the nodes that they are the children of.
        let parent = match slot.checked_sub(tree.len()) {
            None => all[0] / all[1],
            Some(below) => shares[tree.slot_at(tree.parents[below / ARITY])],
        };
        shares[slot] = share(*counts, parent);
    }
    shares.into_iter().map(|share| share.sqrt().max(MIN_FACTOR)).collect()
}
