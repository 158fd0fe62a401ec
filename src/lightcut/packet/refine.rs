//! Refinement of a packet's cut.

use super::{PacketCluster, PacketLightcut, ReceiverPacket, luminances};
use crate::light_tree::LightTrees;
use crate::lightcut::clamp::{DOMINANT, DOMINANT_TO_REST, is_weak};
use crate::lightcut::refinement::heir_and_other;
use crate::lightcut::{CutSettings, PacketVisibility, Transfer};
use crate::math::{F32x16, LANES, Vec3x16};

/// Minimum luminance of a lane where errors are judged, relative to the brightest lane's.
const MIN_LUMINANCE: f32 = 1.0 / 256.0;

/// Maximum of relative errors; larger ones are clamped to it; sixteen of its cubes are still finite. No lane
/// counts as darker than the largest error of a whole tree over this, so that errors have an order before any
/// light is found.
const MAX_ERROR: f32 = 1e12;

const ZERO: F32x16 = [0.0; LANES];

/// A cluster's part in the refinement.
#[derive(Clone, Copy)]
pub(super) struct Judgement {
    /// Error to expect in each lane, luminance; 0 for a leaf.
    errors: F32x16,
    /// Luminance with which the cluster counts in the running totals.
    counted: F32x16,
}

/// One cut in the making.
pub(super) struct Pass<'a, 't, 'm, V> {
    trees: &'a LightTrees,
    transfer: &'a Transfer<'t>,
    visibility: &'a V,
    receivers: &'a ReceiverPacket<'m>,
    settings: &'a CutSettings,
    /// Luminance of the cut in each lane, as far as it counts.
    totals: F32x16,
    /// Tolerated offence: each lane's error at ε.
    tolerance: f32,
    /// Luminance below which no lane counts as darker.
    min_total: f32,
    /// Splits left before the cap.
    room: usize,
    cut: &'a mut PacketLightcut,
}

impl<'a, 't, 'm, V: PacketVisibility> Pass<'a, 't, 'm, V> {
    pub fn new(
        cut: &'a mut PacketLightcut,
        transfer: &'a Transfer<'t>,
        visibility: &'a V,
        receivers: &'a ReceiverPacket<'m>,
        settings: &'a CutSettings,
    ) -> Pass<'a, 't, 'm, V> {
        Pass {
            trees: transfer.trees,
            transfer,
            visibility,
            receivers,
            settings,
            totals: receivers.baseline,
            tolerance: receivers.len() as f32 * settings.epsilon.powi(3),
            min_total: f32::MIN_POSITIVE,
            room: settings.max_cut,
            cut,
        }
    }

    /// Finds the cut; true if it ended at the cap with an error above the threshold.
    pub fn run(mut self) -> bool {
        self.start();
        self.refine();
        self.room == 0 && self.watch_offenders()
    }

    fn start(&mut self) {
        self.cut.clusters.clear();
        self.cut.judgements.clear();
        self.cut.offenders.clear();
        for root in self.trees.roots_of(self.settings.origin) {
            let responses = self.representative_responses(root);
            let judgement = self.judge(root, &responses, &[f32::MAX; LANES]);
            self.count(&judgement);
            self.cut.clusters.push(PacketCluster { node: root, responses });
            self.cut.judgements.push(judgement);
        }
        let errors = self.cut.judgements.iter().flat_map(|judgement| judgement.errors);
        let largest = errors.fold(0.0, |a, b| if b > a { b } else { a });
        self.min_total = (largest / MAX_ERROR).max(f32::MIN_POSITIVE);
        let inverse_totals = self.inverse_totals();
        for place in 0..self.cut.clusters.len() {
            self.watch(place, &inverse_totals);
        }
        self.room = self.room.saturating_sub(self.cut.clusters.len());
    }

    fn count(&mut self, judgement: &Judgement) {
        for (total, counted) in self.totals.iter_mut().zip(&judgement.counted) {
            *total += counted;
        }
    }

    fn refine(&mut self) {
        loop {
            while let Some((_, place)) = self.cut.offenders.worst() {
                let offends = self.offence(place, &self.inverse_totals()) > self.tolerance;
                if offends && self.room == 0 {
                    return;
                }
                self.cut.offenders.pop();
                if offends {
                    self.room -= 1;
                    self.split(place);
                }
            }
            // Totals may have fallen since a cluster was found harmless, and drifted.
            self.retotal();
            if !self.watch_offenders() {
                return;
            }
        }
    }

    fn retotal(&mut self) {
        self.totals = self.receivers.baseline;
        for judgement in &self.cut.judgements {
            for (total, counted) in self.totals.iter_mut().zip(&judgement.counted) {
                *total += counted;
            }
        }
    }

    /// Queues every cluster above its threshold; false if there is none.
    fn watch_offenders(&mut self) -> bool {
        let inverse_totals = self.inverse_totals();
        let mut found = false;
        for place in 0..self.cut.clusters.len() {
            if self.offence(place, &inverse_totals) > self.tolerance {
                self.watch(place, &inverse_totals);
                found = true;
            }
        }
        found
    }

    /// Factors that make errors relative to each lane's total.
    fn inverse_totals(&self) -> F32x16 {
        let brightest = halved(self.totals, |a, b| if b > a { b } else { a });
        let floor = (MIN_LUMINANCE * brightest).max(self.min_total);
        self.totals.map(|total| 1.0 / if total > floor { total } else { floor })
    }

    /// Replaces a cluster by its children.
    fn split(&mut self, place: usize) {
        let parent = &self.cut.clusters[place];
        let Some((heir, other)) = heir_and_other(self.trees, &self.trees.nodes[parent.node as usize]) else {
            return;
        };
        let inherited = parent.responses;
        let counted = &self.cut.judgements[place].counted;
        for l in 0..LANES {
            let rest = self.totals[l] - counted[l];
            self.totals[l] = if rest > 0.0 { rest } else { 0.0 };
        }
        let rest = self.totals;
        let responses = self.representative_responses(other);
        let judgement = self.judge(heir, &inherited, &rest);
        self.count(&judgement);
        self.cut.clusters[place].node = heir;
        self.cut.judgements[place] = judgement;
        let judgement = self.judge(other, &responses, &rest);
        self.count(&judgement);
        let other_place = self.cut.clusters.len();
        self.cut.clusters.push(PacketCluster { node: other, responses });
        self.cut.judgements.push(judgement);
        let inverse_totals = self.inverse_totals();
        self.watch(place, &inverse_totals);
        self.watch(other_place, &inverse_totals);
    }

    /// Errors of a node whose representative responds with `responses`, in a cut whose other clusters sum up to `rest`.
    fn judge(&mut self, node: u32, responses: &Vec3x16, rest: &F32x16) -> Judgement {
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
            let mut errors = self.transfer.errors16(self.receivers, n);
            // As in a single point's cut: more than a quarter of the total offends, whatever is to be expected.
            let least = self.settings.epsilon / DOMINANT;
            for l in 0..LANES {
                let doubt = least * counted[l];
                errors[l] = if doubt > errors[l] { doubt } else { errors[l] };
            }
            errors
        };
        Judgement { errors, counted }
    }

    /// Contribution of a node's representative at unit intensity, with visibility.
    fn representative_responses(&mut self, node: u32) -> Vec3x16 {
        let node = &self.trees.nodes[node as usize];
        let vpl = &self.trees.vpls[node.representative()];
        let (lit, mut responses) = self.transfer.unshadowed16(self.receivers, vpl, node.kind());
        if lit == 0 {
            return Vec3x16::ZERO;
        }
        self.cut.counts.rays += u64::from(lit.count_ones());
        self.cut.counts.packets += 1;
        let visible = self.visibility.visible16(self.receivers, lit, vpl, node);
        responses.keep(visible);
        self.visibility.attenuate16(self.receivers, visible, (vpl, node), &mut responses);
        responses
    }

    /// Queues the cluster at `place` by its offence.
    fn watch(&mut self, place: usize, inverse_totals: &F32x16) {
        let offence = self.offence(place, inverse_totals);
        self.cut.offenders.push(offence, place);
    }

    /// Sum over the lanes of the cubes of errors relative to the lane's total, which count as no more than `MAX_ERROR`.
    #[inline]
    fn offence(&self, place: usize, inverse_totals: &F32x16) -> f32 {
        let errors = &self.cut.judgements[place].errors;
        let mut cubes = [0.0; LANES];
        for l in 0..LANES {
            let relative = errors[l] * inverse_totals[l];
            let relative = if relative < MAX_ERROR { relative } else { MAX_ERROR };
            cubes[l] = relative * relative * relative;
        }
        halved(cubes, |a, b| a + b)
    }
}

/// Folds lanes by halves, as vector code can; one after the other it could not.
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
