//! The cut: start from the roots, split the cluster with the largest error to expect until none is above the
//! threshold.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 3; Herzog et al. 2009, section 3 (one threshold for all
//! trees, relative to their common total) and Eq. 13 (weak singularities).
//! Deviations: the error of a cluster is not its upper bound but what is to be expected under that bound (see
//! [`crate::lightcut::expected`]), but a cluster that gives more than a quarter of the total is split whatever is to be expected
//! of it; up to [`BATCH`] offenders are split a round; a leaf's error is 0, so it never waits to be split;
//! weak singularities are clamped once, when the cut is final, against a luminance in which no single indirect
//! leaf counts for more than a quarter: a VPL close to the receiver would otherwise set its own limit,
//! and hide the error of all others while the cut is refined.

use crate::light_tree::LightTrees;
use crate::lightcut::{Receiver, Transfer, Visibility};
use crate::math::{Rgb, luminance};
use crate::stats::add_fields;
use crate::vpl::Origin;
use glam::DVec3;
use std::collections::BinaryHeap;

/// Clusters split before new shadow rays are traced and the threshold is looked at again.
const BATCH: usize = 16;

/// Largest share of the luminance that a single indirect leaf may have in what others are judged by.
pub(in crate::lightcut) const DOMINANT: f32 = 0.25;

/// When a cut is good enough.
#[derive(Clone, Copy, Debug)]
pub struct CutSettings {
    /// Largest error to expect of one cluster (see [`crate::lightcut::expected`]), relative to the total's luminance.
    pub epsilon: f32,
    /// Most clusters in a cut.
    pub max_cut: usize,
    /// Largest share of the luminance that a single indirect VPL may contribute; `None` leaves weak
    /// singularities as they are.
    pub clamp: Option<f32>,
    /// Whether only the trees of direct or of indirect light are cut.
    pub origin: Option<Origin>,
}

impl Default for CutSettings {
    fn default() -> CutSettings {
        CutSettings { epsilon: 0.02, max_cut: 5000, clamp: Some(0.02), origin: None }
    }
}

/// A cluster of the cut.
#[derive(Clone, Copy, Debug)]
pub struct CutEntry {
    /// Which node.
    pub node: u32,
    /// What a representative of unit intensity contributes, with visibility.
    pub response: Rgb,
    /// What the cluster contributes: its intensity times `response`, unclamped.
    pub contribution: Rgb,
    /// Luminance with which it counts in the running total.
    counted: f32,
}

/// What was done, over any number of cuts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutCounts {
    /// Cuts computed.
    pub cuts: u64,
    /// Sum of their sizes.
    pub clusters: u64,
    /// Cuts that ended at the cap with an error above the threshold.
    pub capped: u64,
    /// Shadow rays.
    pub rays: u64,
    /// Bounds evaluated.
    pub bounds: u64,
    /// Leaves whose contribution was clamped.
    pub clamped: u64,
    /// Luminance of all cuts' sums before clamping.
    pub luminance: f64,
    /// What clamping took away of it.
    pub lost: f64,
}
add_fields!(CutCounts { cuts, clusters, capped, rays, bounds, clamped, luminance, lost });

/// Computes cuts; one a thread, so that its buffers are allocated once.
#[derive(Default)]
pub struct Lightcut {
    entries: Vec<CutEntry>,
    /// Expected error (as bits: non-negative floats sort as integers) above place in `entries`.
    offenders: BinaryHeap<u64>,
    batch: Vec<u32>,
    limit: f32,
    /// What has been done so far.
    pub counts: CutCounts,
}

impl Lightcut {
    /// An empty workspace.
    pub fn new() -> Lightcut {
        Lightcut::default()
    }

    /// The clusters of the last cut.
    pub fn entries(&self) -> &[CutEntry] {
        &self.entries
    }

    /// Luminance above which the indirect leaves of the last cut were clamped; infinite without clamping.
    pub fn limit(&self) -> f32 {
        self.limit
    }

    /// What `receiver` gathers from all VPLs, to within the settings' error.
    pub fn gather<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receiver: &Receiver,
        settings: &CutSettings,
    ) -> Rgb {
        let mut pass =
            Pass { trees: transfer.trees, transfer, visibility, receiver, settings, total: 0.0, cut: self };
        pass.start();
        pass.refine();
        self.counts.cuts += 1;
        self.counts.clusters += self.entries.len() as u64;
        self.sum(transfer.trees, settings.clamp, receiver.baseline_luminance())
    }

    /// Sums the cut anew, in one order and without the drift of the running total.
    fn sum(&mut self, trees: &LightTrees, clamp: Option<f32>, known: f32) -> Rgb {
        self.limit = f32::INFINITY;
        let plain = |entries: &[CutEntry]| {
            entries.iter().fold(DVec3::ZERO, |sum, e| sum + e.contribution.as_dvec3()).as_vec3()
        };
        let unclamped = plain(&self.entries);
        self.counts.luminance += f64::from(luminance(unclamped));
        let Some(clamp) = clamp else { return unclamped };
        let is_weak = |e: &CutEntry, limit: f32| {
            luminance(e.contribution) > limit && {
                let node = &trees.nodes[e.node as usize];
                node.is_leaf() && node.origin() == Origin::Indirect
            }
        };
        let limited = |limit: f32| {
            self.entries.iter().fold((DVec3::ZERO, 0), |(sum, clamped), e| {
                if is_weak(e, limit) {
                    let scale = limit / luminance(e.contribution);
                    (sum + (e.contribution * scale).as_dvec3(), clamped + 1)
                } else {
                    (sum + e.contribution.as_dvec3(), clamped)
                }
            })
        };
        // Steps towards the luminance of which no leaf is more than a quarter; this one is frozen. A single
        // dominant leaf leaves a quarter of the excess each step; only four or more together converge slower.
        let mut frozen = luminance(unclamped) + known;
        for _ in 0..12 {
            let next = luminance(limited(DOMINANT * frozen).0.as_vec3()) + known;
            if next > 0.99 * frozen {
                break;
            }
            frozen = next;
        }
        self.limit = clamp * frozen;
        let (sum, clamped) = limited(self.limit);
        let sum = sum.as_vec3();
        self.counts.clamped += clamped;
        self.counts.lost += f64::from(luminance(unclamped) - luminance(sum));
        sum
    }
}

/// One cut in the making.
struct Pass<'a, 't, 'm, V> {
    trees: &'a LightTrees,
    transfer: &'a Transfer<'t>,
    visibility: &'a V,
    receiver: &'a Receiver<'m>,
    settings: &'a CutSettings,
    /// Luminance of the cut, as far as it counts.
    total: f64,
    cut: &'a mut Lightcut,
}

impl<V: Visibility> Pass<'_, '_, '_, V> {
    fn start(&mut self) {
        self.cut.entries.clear();
        self.cut.offenders.clear();
        self.total = f64::from(self.receiver.baseline_luminance());
        for root in self.trees.roots_of(self.settings.origin) {
            let response = self.representative_response(root);
            let entry = self.entry(root, response, f64::MAX);
            self.total += f64::from(entry.counted);
            let place = self.cut.entries.len();
            self.cut.entries.push(entry);
            self.watch(place);
        }
    }

    fn refine(&mut self) {
        loop {
            let threshold = (f64::from(self.settings.epsilon) * self.total.max(0.0)) as f32;
            let mut room = self.settings.max_cut.saturating_sub(self.cut.entries.len());
            self.cut.batch.clear();
            while let Some(&offender) = self.cut.offenders.peek() {
                if f32::from_bits((offender >> 32) as u32) <= threshold || self.cut.batch.len() == BATCH {
                    break;
                }
                if room == 0 {
                    self.cut.counts.capped += u64::from(self.cut.batch.is_empty());
                    break;
                }
                room -= 1;
                self.cut.offenders.pop();
                self.cut.batch.push(offender as u32);
            }
            if self.cut.batch.is_empty() {
                return;
            }
            for i in 0..self.cut.batch.len() {
                self.split(self.cut.batch[i] as usize);
            }
        }
    }

    /// Replaces a cluster by its children. One of them shares the representative, so its response is known.
    fn split(&mut self, place: usize) {
        let parent = self.cut.entries[place];
        let node = &self.trees.nodes[parent.node as usize];
        let Some(left) = node.children() else { return };
        let shares_left = self.trees.nodes[left as usize].representative() == node.representative();
        let (heir, other) = if shares_left { (left, left + 1) } else { (left + 1, left) };
        let response = self.representative_response(other);
        let rest = (self.total - f64::from(parent.counted)).max(0.0);
        let heir = self.entry(heir, parent.response, rest);
        let other = self.entry(other, response, rest);
        self.total = rest + f64::from(heir.counted) + f64::from(other.counted);
        self.cut.entries[place] = heir;
        self.watch(place);
        let place = self.cut.entries.len();
        self.cut.entries.push(other);
        self.watch(place);
    }

    /// Entry of a node whose representative responds with `response`, in a cut whose other clusters sum up to `rest`.
    fn entry(&self, node: u32, response: Rgb, rest: f64) -> CutEntry {
        let n = &self.trees.nodes[node as usize];
        let contribution = n.intensity * response;
        let mut counted = luminance(contribution);
        if self.settings.clamp.is_some() && rest > 0.0 && n.is_leaf() && n.origin() == Origin::Indirect {
            counted = counted.min((f64::from(DOMINANT / (1.0 - DOMINANT)) * rest) as f32);
        }
        CutEntry { node, response, contribution, counted }
    }

    /// Contribution of a node's representative at unit intensity.
    fn representative_response(&mut self, node: u32) -> Rgb {
        let node = &self.trees.nodes[node as usize];
        let vpl = &self.trees.vpls[node.representative()];
        let response = self.transfer.unshadowed(self.receiver, vpl, node.kind());
        if response == Rgb::ZERO {
            return Rgb::ZERO;
        }
        self.cut.counts.rays += 1;
        let (x, normal) = (self.receiver.position(), self.receiver.geometric_normal());
        if self.visibility.visible(x, normal, vpl, node) { response } else { Rgb::ZERO }
    }

    /// Queues the entry at `place` by the error to expect, unless it cannot be wrong.
    fn watch(&mut self, place: usize) {
        let node = &self.trees.nodes[self.cut.entries[place].node as usize];
        if node.is_leaf() {
            return;
        }
        self.cut.counts.bounds += 1;
        let bound = self.transfer.bound(self.receiver, node);
        // A representative next to the receiver passes its nearness on to the whole cluster: one that gives more than
        // a quarter of the total is split, whatever is to be expected.
        let doubt = self.settings.epsilon / DOMINANT * self.cut.entries[place].counted;
        let error = (luminance(bound.most * node.intensity) * bound.share).max(doubt);
        if error > 0.0 {
            self.cut.offenders.push(u64::from(error.to_bits()) << 32 | place as u64);
        }
    }
}
