//! Light of a packet's points from samples of a coarse cut, for images that are noisy anyway. It takes a fraction of
//! the shadow rays of a cut, and its errors are noise, not a pattern.
//!
//! Papers: Yuksel, *Stochastic Lightcuts*, 2019: representatives are sampled anew for each point; Rath et al., *EARS:
//! Efficiency-Aware Russian Roulette and Splitting*, 2022: numbers of samples.
//!
//! A point samples clusters in proportion to their unshadowed contributions, or to a share of their bounds if that is
//! more. From there it descends a few levels of the tree, in proportion to the members' intensities. The mean is the
//! light of all VPLs, limited as in a cut, except that the nodes where the descent ends have fixed
//! representatives.
//!
//! The first samples of all points tell how much of the light is visible. Each point takes further samples in
//! proportion to the standard deviation of one sample, relative to its light. A dark corner so has many.
//!
//! Errors: the luminance of nodes above leaves is not limited. So at points very close to a light, light remains that a
//! cut would clamp.
//!
//! Deviations: clusters share a number of samples, instead of having one each. The cut is that of sixteen points, and
//! all VPLs count as visible in it. Rays of all points to a cluster are traced together, since they are coherent. A
//! point learns from the other points' samples alone, so that its light is unbiased.

mod descent;
#[cfg(test)]
mod tests;

use self::descent::{Descent, Pending, Sample};
use super::refine::PacketRefinement;
use super::{Clamps, Lightcut, PacketSum, ReceiverPacket, luminances};
use crate::lightcut::clamp::{DOMINANT, MAX_STEPS, frozen_luminance, is_weak};
use crate::lightcut::{CutCounts, CutSettings, Transfer, Visibility, to_vpl};
use crate::lights::Origin;
use base::math::{F32x16, LANES, Rgb, V3, lanes_in, luminance};
use base::sampling::{hash, unit};
use embree::Rays16;

/// ε of the coarse cut.
const EPSILON: f32 = 0.15;

/// Share of a cluster's expected error that counts as its light if its representative gives less.
const DOUBT: f32 = 0.3;

/// Maximum number of levels that a sample descends below its cluster.
const LEVELS: u32 = 5;

/// Maximum number of samples per point; if the mean is higher, a cut takes less time.
const MAX_SAMPLES: f32 = 150.0;

/// Share of the samples that are taken before it is known how much light is visible.
const FIRST: f32 = 0.5;

/// Range of the visible share of the light.
const VISIBLE: [f32; 2] = [0.02, 0.95];

/// Ratio of wanted samples to [`MAX_SAMPLES`] above which no coarse cut is made.
const HOPELESS: f32 = 3.0;

/// Numbers of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Number at a point that reflects no other light, half of which is visible; at other points, the number is in
    /// proportion to the standard deviation of a sample over all light.
    pub whole: f32,
    /// Minimum number.
    pub least: f32,
}

/// Cut to sample, numbers of samples, and their seed.
#[derive(Clone, Copy, Debug)]
pub struct SampledSettings<'a> {
    /// Clamp and origin of the light; `epsilon` is that of the coarse cut instead.
    pub cut: &'a CutSettings,
    /// Numbers of samples.
    pub samples: &'a Samples,
    /// Seed of the samples.
    pub seed: u32,
}

/// Workspace for samples of cuts. Each thread has one, so that buffers are allocated once.
#[derive(Default)]
pub struct SampledCut {
    cut: Lightcut,
    /// Importance of each cluster in each lane, as luminance.
    importance: Vec<F32x16>,
    /// Samples of all lanes, before their VPLs are read.
    descents: Vec<Descent>,
    /// Samples whose VPLs are visible, by lane.
    visible: [Vec<Sample>; LANES],
    /// Work done so far.
    pub counts: CutCounts,
}

/// Visibility of a cut in which all VPLs are visible.
struct AllVisible;

impl Visibility for AllVisible {
    fn visible16(&self, _: &Rays16, lanes: u16, _: Option<u32>) -> u16 {
        lanes
    }
}

/// Numbers of samples per importance, by lane.
#[derive(Clone, Copy)]
struct Rates {
    /// Samples to take.
    next: F32x16,
    /// All samples, with these.
    all: F32x16,
}

impl Samples {
    /// Returns the numbers of samples for points that gather these `totals` of luminance, by lane; `None` if a cut
    /// takes less time, or if a total is not finite.
    fn numbers(&self, receivers: &ReceiverPacket, totals: &F32x16) -> Option<F32x16> {
        let mut numbers = [0.0; LANES];
        for lane in lanes_in(receivers.valid) {
            let share = totals[lane] / (totals[lane] + receivers.baseline[lane]);
            let wanted = self.whole * share;
            numbers[lane] = if wanted > self.least { wanted } else { self.least };
        }
        let is_cheap = numbers.iter().sum::<f32>() <= MAX_SAMPLES * receivers.len() as f32;
        (is_cheap && totals.iter().all(|total| total.is_finite())).then_some(numbers)
    }
}

impl SampledCut {
    /// Gathers the light of all VPLs by samples; `None` if a cut takes less time. The counts hold the number of samples
    /// as the number of clusters.
    pub fn gather<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        settings: &SampledSettings,
    ) -> Option<PacketSum> {
        let SampledSettings { cut, samples, seed } = *settings;
        if !(samples.whole < HOPELESS * MAX_SAMPLES) {
            return None;
        }
        let coarse = CutSettings { epsilon: EPSILON, ..*cut };
        let capped = PacketRefinement::new(&mut self.cut, transfer, &AllVisible, receivers, &coarse).run();
        self.counts.bounds += std::mem::take(&mut self.cut.counts).bounds;
        let totals = self.weigh(transfer);
        let numbers = samples.numbers(receivers, &totals)?;
        self.counts.capped += receivers.len() as u64 * u64::from(capped);
        self.counts.cuts += receivers.len() as u64;
        lanes_in(receivers.valid).for_each(|lane| self.visible[lane].clear());
        let first = per_importance(&numbers.map(|number| FIRST * number), &totals);
        self.sample(transfer, visibility, receivers, &Rates { next: first, all: first }, seed);
        let further = per_importance(&self.further(receivers, &totals, &numbers, samples), &totals);
        let all: F32x16 = std::array::from_fn(|lane| first[lane] + further[lane]);
        for lane in lanes_in(receivers.valid) {
            let share = first[lane] / all[lane];
            for sample in &mut self.visible[lane] {
                (sample.light, sample.factor) = (sample.light * share, sample.factor * share);
            }
        }
        self.sample(transfer, visibility, receivers, &Rates { next: further, all }, hash(seed, 1));
        let mut sum = PacketSum::default();
        for lane in lanes_in(receivers.valid) {
            sum.radiance[lane] = self.visible[lane].iter().map(|sample| sample.light).sum();
            self.counts.luminance += f64::from(luminance(sum.radiance[lane]));
        }
        if let Some(clamp) = cut.clamp {
            self.clamp(transfer, receivers, clamp, &mut sum);
        }
        Some(sum)
    }

    /// Sets the importance of the clusters of the cut; returns the sums of importance by lane.
    fn weigh(&mut self, transfer: &Transfer) -> F32x16 {
        self.importance.clear();
        let mut totals = [0.0; LANES];
        for (cluster, judgement) in self.cut.clusters.iter().zip(&self.cut.judgements) {
            let node = &transfer.trees.nodes[cluster.node as usize];
            let mut importance = luminances(node.intensity, &cluster.responses);
            for l in 0..LANES {
                let doubt = DOUBT * judgement.errors[l];
                importance[l] = if doubt > importance[l] { doubt } else { importance[l] };
                totals[l] += importance[l];
            }
            self.importance.push(importance);
        }
        totals
    }

    /// Returns the numbers of samples by lane to take after the first of `numbers`. The product of time and squared
    /// error is least if a point has as many samples as the standard deviation of one over all light.
    fn further(
        &self,
        receivers: &ReceiverPacket,
        totals: &F32x16,
        numbers: &F32x16,
        samples: &Samples,
    ) -> F32x16 {
        let mut found = [0.0; LANES];
        for lane in lanes_in(receivers.valid) {
            found[lane] = self.visible[lane].iter().map(|sample| luminance(sample.light)).sum();
        }
        let [found_by_all, total_of_all] = [&found, totals].map(|lanes| lanes.iter().sum::<f32>());
        let mut further = [0.0; LANES];
        for lane in lanes_in(receivers.valid) {
            let total = totals[lane];
            let visible = (found_by_all - found[lane]) / (total_of_all - total);
            let visible = if visible.is_finite() { visible.clamp(VISIBLE[0], VISIBLE[1]) } else { 0.5 };
            let deviation = (visible * (1.0 - visible)).sqrt() * total;
            let wanted = samples.whole * deviation / (receivers.baseline[lane] + visible * total);
            let more = wanted.clamp(samples.least, MAX_SAMPLES) - FIRST * numbers[lane];
            further[lane] = if more >= 1.0 { more } else { 0.0 };
        }
        further
    }

    /// Takes samples of all lanes at the `next` rates.
    fn sample<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        rates: &Rates,
        seed: u32,
    ) {
        self.choose(receivers, rates, seed);
        let trees = transfer.trees;
        let mut pending = Pending::default();
        for group in self.descents.chunks_mut(LANES) {
            // The samples of a group wait for memory together, because the trees exceed the caches.
            for _ in 0..LEVELS {
                group.iter_mut().for_each(|sample| sample.descend(&trees.nodes));
            }
            let mut vpls = [trees.vpls[0]; LANES];
            for (vpl, sample) in vpls.iter_mut().zip(&*group) {
                *vpl = trees.vpls[trees.nodes[sample.node as usize].representative()];
            }
            for (vpl, sample) in vpls.iter().zip(&*group) {
                let (node, lane) = (&trees.nodes[sample.node as usize], usize::from(sample.lane));
                let density = sample.of_cluster * sample.density;
                let receiver = receivers.get(lane);
                let response = transfer.unshadowed(receiver, vpl, node.kind());
                if response == Rgb::ZERO {
                    continue;
                }
                let [x, normal] = [receiver.position(), receiver.geometric_normal()].map(V3::<f32>::splat);
                let ray = to_vpl(x, normal, vpl, node.kind()).into();
                let (x, normal) = receiver.place();
                let (x, normal) = (V3::<f32>::splat(x), V3::splat(normal));
                let geometry = match node.origin() {
                    Origin::Indirect => transfer.geometry_term(x, normal, vpl, node.kind()),
                    Origin::Direct => 0.0,
                };
                let factor = if is_weak(node) { density.recip() } else { f32::INFINITY };
                let sample = Sample { light: response * (node.intensity / density), factor, geometry };
                let (_, before) = trees.representative(node);
                pending.sheets[pending.count] = receiver.sheets(before);
                if pending.push(&ray, sample, lane) {
                    pending.trace(visibility, &mut self.visible, &mut self.counts);
                }
            }
        }
        pending.trace(visibility, &mut self.visible, &mut self.counts);
        self.counts.clusters += self.descents.len() as u64;
    }

    /// Chooses the clusters and random numbers of samples, in the order of the clusters. A lane's clusters follow one
    /// another on a line, as long as their numbers of samples.
    fn choose(&mut self, receivers: &ReceiverPacket, rates: &Rates, seed: u32) {
        self.descents.clear();
        let seeds: [u32; LANES] = std::array::from_fn(|lane| hash(seed, lane as u32));
        let mut next = seeds.map(|seed| unit(hash(seed, 0)));
        let (mut reached, mut numbers) = ([0.0; LANES], [0; LANES]);
        for (cluster, importance) in self.cut.clusters.iter().zip(&self.importance) {
            let mut due = 0;
            for lane in 0..LANES {
                reached[lane] += importance[lane] * rates.next[lane];
                due |= u16::from(next[lane] < reached[lane]) << lane;
            }
            for lane in lanes_in(due & receivers.valid) {
                while next[lane] < reached[lane] {
                    next[lane] += 1.0;
                    numbers[lane] += 1;
                    self.descents.push(Descent {
                        node: cluster.node,
                        u: unit(hash(seeds[lane], numbers[lane])),
                        of_cluster: importance[lane] * rates.all[lane],
                        density: 1.0,
                        lane: lane as u8,
                    });
                }
            }
        }
    }

    /// Limits weak singularities by the share `clamp` of the frozen luminance.
    fn clamp(&mut self, transfer: &Transfer, receivers: &ReceiverPacket, clamp: f32, sum: &mut PacketSum) {
        let mut shares = [f32::INFINITY; LANES];
        for lane in lanes_in(receivers.valid) {
            let baseline = receivers.baseline[lane];
            let limited = |frozen: f32| -> f32 {
                let limited =
                    |sample: &Sample| luminance(sample.light).min(DOMINANT * frozen * sample.factor);
                self.visible[lane].iter().map(limited).sum::<f32>() + baseline
            };
            shares[lane] =
                clamp * frozen_luminance(luminance(sum.radiance[lane]) + baseline, MAX_STEPS, limited);
        }
        sum.clamps = Clamps::new(transfer, receivers, &shares);
        for lane in lanes_in(receivers.valid) {
            let mut clamped = Rgb::ZERO;
            for Sample { light, factor, geometry } in &self.visible[lane] {
                let retained = sum.clamps.retained_in(lane, *geometry, luminance(*light) / factor);
                clamped += *light * retained;
                self.counts.clamped += u64::from(retained < 1.0);
            }
            self.counts.lost += f64::from(luminance(sum.radiance[lane] - clamped));
            sum.radiance[lane] = clamped;
        }
    }
}

/// Returns numbers of samples over the importance of all clusters. If a total is too small to be divided, there are no
/// samples, and no light.
fn per_importance(numbers: &F32x16, totals: &F32x16) -> F32x16 {
    let rate = |lane: usize| Some(numbers[lane] / totals[lane]).filter(|rate| rate.is_finite());
    std::array::from_fn(|lane| rate(lane).unwrap_or(0.0))
}
