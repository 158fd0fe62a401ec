//! Refinement of a packet's cut.

use super::cut::{Judgement, Sight};
use super::{Lightcut, PacketCluster, ReceiverPacket, Unshadowed, luminances};
use crate::lightcut::clamp::{DOMINANT, DOMINANT_TO_REST, is_weak};
use crate::lightcut::{CutSettings, Transfer, Visibility};
use crate::lights::{LightNode, LightTrees};
use base::math::{F32x16, LANES, Lane, Vec3x16, f32x16};

/// Minimum luminance of a lane where errors are judged, relative to the brightest lane's.
const MIN_LUMINANCE: f32 = 1.0 / 256.0;

/// Maximum ratio of an error to the luminance of a lane. It orders errors before any light is found, and keeps the sum
/// of sixteen cubes finite.
const MAX_ERROR: f32 = 1e12;

/// Maximum divisor of the thresholds from round to round.
const MAX_FALL: f32 = 4.0;

/// Maximum ratio of the final thresholds to the wanted errors.
const TOLERANCE: f32 = 1.03;

/// Maximum error of a cluster that is fine enough for a lane, relative to the wanted error. Its descendants are taken
/// to be visible where it is.
const FINE: f32 = 0.5;

const ZERO: F32x16 = [0.0; LANES];

/// Refinement of one cut.
pub(super) struct PacketRefinement<'a, 't, 'm, V> {
    trees: &'a LightTrees,
    transfer: &'a Transfer<'t>,
    visibility: &'a V,
    receivers: &'a ReceiverPacket<'m>,
    settings: &'a CutSettings,
    /// Luminance of the cut in each lane, with limited weak singularities.
    totals: F32x16,
    /// Minimum luminance with which a lane counts.
    min_total: f32,
    /// Maximum error, by lane, of a cluster that is fine enough for the lane.
    fine: F32x16,
    /// Number of splits before the cap.
    room: usize,
    cut: &'a mut Lightcut,
}

impl<'a, 't, 'm, V: Visibility> PacketRefinement<'a, 't, 'm, V> {
    /// Prepares the refinement of the cut in the workspace `cut`.
    pub fn new(
        cut: &'a mut Lightcut,
        transfer: &'a Transfer<'t>,
        visibility: &'a V,
        receivers: &'a ReceiverPacket<'m>,
        settings: &'a CutSettings,
    ) -> PacketRefinement<'a, 't, 'm, V> {
        PacketRefinement {
            trees: transfer.trees,
            transfer,
            visibility,
            receivers,
            settings,
            totals: receivers.baseline,
            min_total: f32::MIN_POSITIVE,
            fine: ZERO,
            room: settings.max_cut,
            cut,
        }
    }

    /// Refines the cut; returns true if it ended at the cap with an error above the threshold.
    ///
    /// Thresholds fall round by round to the wanted error. They are relative to totals, which converge meanwhile.
    pub fn run(mut self) -> bool {
        let mut thresholds = self.start();
        loop {
            let mut inverse = ZERO;
            for l in 0..LANES {
                inverse[l] = 1.0 / thresholds[l];
            }
            let mut place = 0;
            while place < self.cut.clusters.len() {
                while self.offends(place, &inverse) {
                    if self.room == 0 {
                        return true;
                    }
                    self.room -= 1;
                    self.split(place);
                }
                place += 1;
            }
            // Running totals accumulate rounding errors.
            self.retotal();
            let wanted = self.wanted();
            let mut done = true;
            for l in 0..LANES {
                self.fine[l] = FINE * wanted[l];
                done &= thresholds[l] <= TOLERANCE * wanted[l];
                let fallen = thresholds[l] * (1.0 / MAX_FALL);
                let next = if wanted[l] > fallen { wanted[l] } else { fallen };
                thresholds[l] = if next < thresholds[l] { next } else { thresholds[l] };
            }
            if done {
                return false;
            }
        }
    }

    /// Starts with the roots; returns thresholds at which few of them are split.
    fn start(&mut self) -> F32x16 {
        self.cut.clusters.clear();
        self.cut.judgements.clear();
        self.cut.unshadowed.clear();
        let mut thresholds = ZERO;
        for root in self.trees.roots_of(self.settings.origin) {
            let (responses, sight, unshadowed) = self.representative_responses(root, Sight::default());
            let judgement = self.judge(root, &responses, sight, &[f32::MAX; LANES]);
            self.count(&judgement);
            for (threshold, error) in thresholds.iter_mut().zip(&judgement.errors) {
                *threshold = if *error > *threshold { *error } else { *threshold };
            }
            self.cut.clusters.push(PacketCluster { node: root, responses });
            self.cut.judgements.push(judgement);
            self.cut.unshadowed.push(unshadowed);
        }
        let largest = halved(thresholds, |a, b| if b > a { b } else { a });
        self.min_total = (largest / MAX_ERROR).max(f32::MIN_POSITIVE);
        self.room = self.room.saturating_sub(self.cut.clusters.len());
        let min = self.min_total;
        thresholds.map(|threshold| if threshold > min { threshold } else { min })
    }

    #[inline(always)]
    fn count(&mut self, judgement: &Judgement) {
        self.totals = (f32x16::new(self.totals) + f32x16::new(judgement.counted)).to_array();
    }

    fn retotal(&mut self) {
        let mut totals = f32x16::new(self.receivers.baseline);
        for judgement in &self.cut.judgements {
            totals += f32x16::new(judgement.counted);
        }
        self.totals = totals.to_array();
    }

    /// Returns the wanted error of each cluster, by lane.
    fn wanted(&self) -> F32x16 {
        let brightest = halved(self.totals, |a, b| if b > a { b } else { a });
        let floor = (MIN_LUMINANCE * brightest).max(self.min_total);
        self.totals.map(|total| self.settings.epsilon * if total > floor { total } else { floor })
    }

    /// Replaces a cluster by its children.
    fn split(&mut self, place: usize) {
        let parent = &self.cut.clusters[place];
        let Some((heir, other)) = heir_and_other(self.trees, &self.trees.nodes[parent.node as usize]) else {
            return;
        };
        let inherited = parent.responses;
        let Judgement { errors, counted, sight } = &self.cut.judgements[place];
        let sight = *sight;
        let fine = !f32x16::new(*errors).gt(f32x16::new(self.fine));
        self.totals = (f32x16::new(self.totals) - f32x16::new(*counted)).positive().to_array();
        let rest = self.totals;
        let known = Sight { known: sight.known & fine.bits(), seen: sight.seen };
        let (responses, other_sight, unshadowed) = self.representative_responses(other, known);
        let judgement = self.judge(heir, &inherited, sight, &rest);
        self.count(&judgement);
        self.cut.clusters[place].node = heir;
        self.cut.judgements[place] = judgement;
        let judgement = self.judge(other, &responses, other_sight, &rest);
        self.count(&judgement);
        self.cut.clusters.push(PacketCluster { node: other, responses });
        self.cut.judgements.push(judgement);
        self.cut.unshadowed.push(unshadowed);
    }

    /// Returns the errors of a node whose representative contributes `responses`. The other clusters sum up to `rest`.
    fn judge(&mut self, node: u32, responses: &Vec3x16, sight: Sight, rest: &F32x16) -> Judgement {
        let n = &self.trees.nodes[node as usize];
        let mut counted = luminances(n.intensity, responses);
        if self.settings.clamp.is_some() && is_weak(n) {
            for (c, &rest) in counted.iter_mut().zip(rest) {
                let limit = rest * DOMINANT_TO_REST;
                *c = if *c > limit && rest > 0.0 { limit } else { *c };
            }
        }
        let errors = if n.is_leaf() {
            ZERO
        } else {
            self.cut.counts.bounds += self.receivers.len() as u64;
            let errors = self.transfer.errors16(self.receivers, n);
            // A representative next to the points makes the whole cluster look near. So a cluster that gives more than
            // a quarter of the total is split, whatever its expected error.
            let share = self.settings.epsilon / DOMINANT;
            (f32x16::new(counted) * share).max(f32x16::new(errors)).to_array()
        };
        Judgement { errors, counted, sight }
    }

    /// Returns the contribution of a node's representative at unit intensity, its visibility, and the contribution
    /// without shadows. No shadow rays are traced in lanes in which visibility is `known`.
    fn representative_responses(&mut self, node: u32, known: Sight) -> (Vec3x16, Sight, Unshadowed) {
        let node = &self.trees.nodes[node as usize];
        let vpl = &self.trees.vpls[node.representative()];
        let (lit, mut responses) = self.transfer.unshadowed16(self.receivers, vpl, node.kind());
        let unshadowed = Unshadowed { lit, responses };
        let doubtful = lit & !known.known;
        let mut seen = known.seen & known.known;
        if doubtful != 0 {
            self.cut.counts.rays += u64::from(doubtful.count_ones());
            self.cut.counts.packets += 1;
            seen |= self.receivers.visible(self.visibility, doubtful, vpl, node);
        }
        responses.keep(lit & seen);
        self.receivers.attenuate(self.visibility, lit & seen, self.trees, node, &mut responses);
        (responses, Sight { known: known.known | lit, seen }, unshadowed)
    }

    /// True if the cubic mean over the lanes of a cluster's errors, relative to the thresholds, is above 1.
    #[inline]
    fn offends(&self, place: usize, inverse_thresholds: &F32x16) -> bool {
        let relative = f32x16::new(self.cut.judgements[place].errors) * f32x16::new(*inverse_thresholds);
        (relative.sq() * relative).reduce_add() > self.receivers.len() as f32
    }
}

/// Returns the children of a node: first the heir, which shares the node's representative and hence its response.
#[inline]
fn heir_and_other(trees: &LightTrees, parent: &LightNode) -> Option<(u32, u32)> {
    let left = parent.children()?;
    let shares_left = trees.nodes[left as usize].representative() == parent.representative();
    Some(if shares_left { (left, left + 1) } else { (left + 1, left) })
}

/// Folds lanes by halves, which compiles to vector code.
#[inline(always)]
pub(in crate::lightcut) fn halved<T: Copy>(mut lanes: [T; LANES], f: impl Fn(T, T) -> T) -> T {
    let mut half = LANES / 2;
    while half > 0 {
        for l in 0..half {
            lanes[l] = f(lanes[l], lanes[l + half]);
        }
        half /= 2;
    }
    lanes[0]
}
