//! Refinement of a shared cut.

use super::receivers::{ReceiverPacket, lanes_of};
use super::transfer::{PacketVisibility, luminances};
use super::{LANES, Lanes, RgbLanes};
use crate::light_tree::LightTrees;
use crate::lightcut::single::DOMINANT;
use crate::lightcut::{CutCounts, CutSettings, Transfer};
use crate::math::{Rgb, luminance};
use crate::vpl::Origin;
use std::collections::BinaryHeap;

/// Least luminance of a lane where errors are judged, relative to the brightest lane's.
const DARKEST: f32 = 1.0 / 256.0;

/// Largest relative error that is told from larger ones; sixteen of its cubes are still finite. No lane counts as
/// darker than the largest error of a whole tree over this, so that errors have an order before anything lit is found.
const LARGEST: f32 = 1e12;

const ZERO: Lanes = [0.0; LANES];

/// A cluster of the cut and what is known of it in each lane.
#[derive(Clone, Copy)]
pub(in crate::lightcut) struct Entry {
    pub node: u32,
    /// A leaf of the indirect trees: the only kind that is clamped.
    pub weak: bool,
    /// Contribution of a representative of unit intensity, with visibility.
    pub responses: RgbLanes,
    /// Errors to expect, luminance; 0 for a leaf.
    pub errors: Lanes,
    /// Luminance with which the cluster counts in the running totals.
    pub counted: Lanes,
}

/// Computes shared cuts; one a thread, so that its buffers are allocated once.
#[derive(Default)]
pub struct PacketLightcut {
    pub(in crate::lightcut) entries: Vec<Entry>,
    /// Offence (as bits: non-negative floats sort as integers) above place in `entries`.
    offenders: BinaryHeap<u64>,
    /// Luminance to which indirect leaves were clamped, by lane.
    limits: Lanes,
    /// What has been done so far; a shared cut counts once for each of its points.
    pub counts: CutCounts,
    /// Packets of shadow rays.
    pub packets: u64,
}

impl PacketLightcut {
    /// An empty workspace.
    pub fn new() -> PacketLightcut {
        PacketLightcut::default()
    }

    /// Clusters in the last cut.
    pub fn size(&self) -> usize {
        self.entries.len()
    }

    /// The clusters of the last cut: node, and what a representative of unit intensity contributes to each lane,
    /// visibility included.
    pub fn entries(&self) -> impl Iterator<Item = (u32, &RgbLanes)> {
        self.entries.iter().map(|e| (e.node, &e.responses))
    }

    /// Luminance above which a lane's indirect leaves were clamped in the last cut; infinite without clamping.
    pub fn limit(&self, lane: usize) -> f32 {
        self.limits[lane]
    }

    /// The same of all lanes.
    pub fn limits(&self) -> &[f32; LANES] {
        &self.limits
    }

    /// Reflected radiance of each point, on average to within the settings' error.
    pub fn gather<V: PacketVisibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        points: &ReceiverPacket,
        settings: &CutSettings,
        radiance: &mut [Rgb; LANES],
    ) {
        let mut pass = Pass {
            trees: transfer.trees,
            transfer,
            visibility,
            points,
            settings,
            totals: points.known,
            tolerance: points.len() as f32 * settings.epsilon.powi(3),
            least_total: f32::MIN_POSITIVE,
            room: settings.max_cut,
            cut: self,
        };
        pass.start();
        pass.refine();
        let capped = pass.room == 0 && pass.watch_offenders();
        let count = points.len() as u64;
        self.counts.cuts += count;
        self.counts.clusters += count * self.entries.len() as u64;
        self.counts.capped += count * u64::from(capped);
        self.sum(transfer.trees, points, settings.clamp, &[ZERO; 3], radiance);
    }

    /// The lanes' radiance: that of the entries, and `strong` besides, which is not clamped.
    pub(in crate::lightcut) fn sum(
        &mut self,
        trees: &LightTrees,
        points: &ReceiverPacket,
        clamp: Option<f32>,
        strong: &RgbLanes,
        radiance: &mut [Rgb; LANES],
    ) {
        self.limits = [f32::INFINITY; LANES];
        let mut sums = *strong;
        let mut brightest_leaf = ZERO;
        for e in &self.entries {
            let i = trees.nodes[e.node as usize].intensity;
            for (c, sum) in sums.iter_mut().enumerate() {
                for (s, r) in sum.iter_mut().zip(&e.responses[c]) {
                    *s += i[c] * r;
                }
            }
            if e.weak {
                for (b, y) in brightest_leaf.iter_mut().zip(luminances(i, &e.responses)) {
                    *b = if y > *b { y } else { *b };
                }
            }
        }
        for lane in lanes_of(points.valid) {
            let unclamped = Rgb::new(sums[0][lane], sums[1][lane], sums[2][lane]);
            let known = points.known[lane];
            self.counts.luminance += f64::from(luminance(unclamped));
            radiance[lane] = match clamp {
                // Below this nothing is clamped: the frozen luminance is less than the unclamped one only if
                // some leaf is a dominant part of it.
                Some(clamp)
                    if luminance(unclamped) + known > 0.0
                        && brightest_leaf[lane] > clamp.min(DOMINANT) * (luminance(unclamped) + known) =>
                {
                    let strong = Rgb::new(strong[0][lane], strong[1][lane], strong[2][lane]);
                    self.clamped_sum(trees, lane, strong, unclamped, known, clamp)
                }
                _ => {
                    self.limits[lane] =
                        clamp.map_or(f32::INFINITY, |clamp| clamp * (luminance(unclamped) + known));
                    unclamped
                }
            };
        }
    }

    /// One lane's sum with its weak singularities limited, as in the single-point cut.
    fn clamped_sum(
        &mut self,
        trees: &LightTrees,
        lane: usize,
        strong: Rgb,
        unclamped: Rgb,
        known: f32,
        clamp: f32,
    ) -> Rgb {
        let limited = |limit: f32| {
            let mut clamped = 0;
            let sum = self.entries.iter().fold(strong.as_dvec3(), |sum, e| {
                let i = trees.nodes[e.node as usize].intensity;
                let mut contribution = i * Rgb::from_array(std::array::from_fn(|c| e.responses[c][lane]));
                let y = luminance(contribution);
                if e.weak && y > limit {
                    contribution *= limit / y;
                    clamped += 1;
                }
                sum + contribution.as_dvec3()
            });
            (sum.as_vec3(), clamped)
        };
        let mut frozen = luminance(unclamped) + known;
        for _ in 0..12 {
            let next = luminance(limited(DOMINANT * frozen).0) + known;
            // Errors corrected at random may leave less than nothing besides the leaves.
            if next > 0.99 * frozen || next <= 0.0 {
                break;
            }
            frozen = next;
        }
        self.limits[lane] = clamp * frozen;
        let (sum, clamped) = limited(self.limits[lane]);
        self.counts.clamped += clamped;
        self.counts.lost += f64::from(luminance(unclamped) - luminance(sum));
        sum
    }
}

/// One shared cut in the making.
struct Pass<'a, 't, 'm, V> {
    trees: &'a LightTrees,
    transfer: &'a Transfer<'t>,
    visibility: &'a V,
    points: &'a ReceiverPacket<'m>,
    settings: &'a CutSettings,
    /// Luminance of the cut in each lane, as far as it counts.
    totals: Lanes,
    /// Largest offence that is tolerated: each lane's error at ε.
    tolerance: f32,
    /// No lane counts as darker.
    least_total: f32,
    /// Splits left before the cap.
    room: usize,
    cut: &'a mut PacketLightcut,
}

impl<V: PacketVisibility> Pass<'_, '_, '_, V> {
    fn start(&mut self) {
        self.cut.entries.clear();
        self.cut.offenders.clear();
        for root in self.trees.roots_of(self.settings.origin) {
            let responses = self.representative_responses(root);
            let entry = self.entry(root, &responses, &[f32::MAX; LANES]);
            self.count(&entry);
            self.cut.entries.push(entry);
        }
        let errors = self.cut.entries.iter().flat_map(|entry| entry.errors);
        let largest = errors.fold(0.0, |a, b| if b > a { b } else { a });
        self.least_total = (largest / LARGEST).max(f32::MIN_POSITIVE);
        let inverse_totals = self.inverse_totals();
        for place in 0..self.cut.entries.len() {
            self.watch(place, &inverse_totals);
        }
        self.room = self.room.saturating_sub(self.cut.entries.len());
    }

    fn count(&mut self, entry: &Entry) {
        for (total, counted) in self.totals.iter_mut().zip(&entry.counted) {
            *total += counted;
        }
    }

    fn refine(&mut self) {
        loop {
            while let Some(&offender) = self.cut.offenders.peek() {
                let place = offender as u32 as usize;
                let errors = &self.cut.entries[place].errors;
                let offends = offence(errors, &self.inverse_totals()) > self.tolerance;
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
        self.totals = self.points.known;
        for entry in &self.cut.entries {
            for (total, counted) in self.totals.iter_mut().zip(&entry.counted) {
                *total += counted;
            }
        }
    }

    /// Queues every cluster above its threshold; false if there is none.
    fn watch_offenders(&mut self) -> bool {
        let inverse_totals = self.inverse_totals();
        let mut found = false;
        for place in 0..self.cut.entries.len() {
            if offence(&self.cut.entries[place].errors, &inverse_totals) > self.tolerance {
                self.watch(place, &inverse_totals);
                found = true;
            }
        }
        found
    }

    /// What errors are multiplied with to be relative to each lane's total.
    fn inverse_totals(&self) -> Lanes {
        let brightest = halved(self.totals, |a, b| if b > a { b } else { a });
        let floor = (DARKEST * brightest).max(self.least_total);
        self.totals.map(|total| 1.0 / if total > floor { total } else { floor })
    }

    /// Replaces a cluster by its children. One of them shares the representative, so its responses are known.
    fn split(&mut self, place: usize) {
        let parent = &self.cut.entries[place];
        let node = &self.trees.nodes[parent.node as usize];
        let Some(left) = node.children() else { return };
        let shares_left = self.trees.nodes[left as usize].representative() == node.representative();
        let (heir, other) = if shares_left { (left, left + 1) } else { (left + 1, left) };
        for l in 0..LANES {
            let rest = self.totals[l] - parent.counted[l];
            self.totals[l] = if rest > 0.0 { rest } else { 0.0 };
        }
        let rest = self.totals;
        let inherited = parent.responses;
        let responses = self.representative_responses(other);
        let heir = self.entry(heir, &inherited, &rest);
        self.count(&heir);
        self.cut.entries[place] = heir;
        let other = self.entry(other, &responses, &rest);
        self.count(&other);
        let other_place = self.cut.entries.len();
        self.cut.entries.push(other);
        let inverse_totals = self.inverse_totals();
        self.watch(place, &inverse_totals);
        self.watch(other_place, &inverse_totals);
    }

    fn entry(&mut self, node: u32, responses: &RgbLanes, rest: &Lanes) -> Entry {
        let n = &self.trees.nodes[node as usize];
        let leaf = n.is_leaf();
        let weak = leaf && n.origin() == Origin::Indirect;
        let mut counted = luminances(n.intensity, responses);
        if weak && self.settings.clamp.is_some() {
            for (c, &rest) in counted.iter_mut().zip(rest) {
                let limit = rest * (DOMINANT / (1.0 - DOMINANT));
                *c = if *c > limit && rest > 0.0 { limit } else { *c };
            }
        }
        let errors = if leaf {
            ZERO
        } else {
            self.cut.counts.bounds += self.points.len() as u64;
            let mut errors = self.transfer.errors16(self.points, n);
            // As in the single-point cut: more than a quarter of the total offends, whatever is to be expected.
            let least = self.settings.epsilon / DOMINANT;
            for l in 0..LANES {
                let doubt = least * counted[l];
                errors[l] = if doubt > errors[l] { doubt } else { errors[l] };
            }
            errors
        };
        Entry { node, weak, responses: *responses, errors, counted }
    }

    /// Contribution of a node's representative at unit intensity, with visibility.
    fn representative_responses(&mut self, node: u32) -> RgbLanes {
        let node = &self.trees.nodes[node as usize];
        let vpl = &self.trees.vpls[node.representative()];
        let mut responses = [ZERO; 3];
        let lit = self.transfer.unshadowed16(self.points, vpl, node.kind(), &mut responses);
        if lit != 0 {
            self.cut.counts.rays += u64::from(lit.count_ones());
            self.cut.packets += 1;
            let seen = self.visibility.visible16(self.points, lit, vpl, node);
            for row in &mut responses {
                for (l, r) in row.iter_mut().enumerate() {
                    *r = if seen >> l & 1 != 0 { *r } else { 0.0 };
                }
            }
        } else {
            responses = [ZERO; 3];
        }
        responses
    }

    /// Queues the entry at `place` by its offence, unless it cannot be wrong.
    fn watch(&mut self, place: usize, inverse_totals: &Lanes) {
        let key = offence(&self.cut.entries[place].errors, inverse_totals);
        if key > 0.0 {
            self.cut.offenders.push(u64::from(key.to_bits()) << 32 | place as u64);
        }
    }
}

/// Sum over the lanes of the cubes of errors relative to the lane's total, which count as no more than `LARGEST`.
fn offence(errors: &Lanes, inverse_totals: &Lanes) -> f32 {
    let mut cubes = [0.0; LANES];
    for l in 0..LANES {
        let relative = errors[l] * inverse_totals[l];
        let relative = if relative < LARGEST { relative } else { LARGEST };
        cubes[l] = relative * relative * relative;
    }
    halved(cubes, |a, b| a + b)
}

/// Folds lanes by halves, which vector code can do, and one after the other it could not.
#[inline(always)]
fn halved<T: Copy>(mut lanes: [T; LANES], f: impl Fn(T, T) -> T) -> T {
    let mut half = LANES / 2;
    while half > 0 {
        for l in 0..half {
            lanes[l] = f(lanes[l], lanes[l + half]);
        }
        half /= 2;
    }
    lanes[0]
}
