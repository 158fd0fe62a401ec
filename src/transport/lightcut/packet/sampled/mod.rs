//! Light of a packet's points by samples of a coarse cut, for pictures that have noise anyhow: with a fraction of a
//! cut's shadow rays, and errors that are noise, not a pattern.
//!
//! Paper: Yuksel, *Stochastic Lightcuts*, 2019: representatives are drawn anew for each point.
//!
//! A point draws clusters in proportion to what they give it unshadowed, or to what they might by their bounds, and
//! goes down a few levels of the tree from there, by the members' intensities. The mean is the light of all virtual
//! lights, limited as in a cut, but for the fixed representatives of the nodes where it ends.
//!
//! Errors: of points very close to a light, most of whose light is clamped, up to 3 % of all their light are not that a
//! cut would clamp, since nodes above leaves are not.
//!
//! Deviations: clusters share a number of samples, instead of having one each, and the cut is that of sixteen points,
//! in which all virtual lights count as seen. Rays of all points to a cluster are traced together, since they are
//! alike.

#[cfg(test)]
mod tests;

use super::refine::PacketRefinement;
use super::{PacketLightcut, PacketSum, ReceiverPacket, luminances};
use crate::lightcut::clamp::{DOMINANT, MAX_STEPS, frozen_luminance, is_weak};
use crate::lightcut::{CutCounts, CutSettings, PacketVisibility, RayVisibility, Transfer, to_vpl};
use crate::lights::{LightNode, Vpl};
use base::math::{F32x16, LANES, Rgb, Vec3x16, lanes_in, luminance};
use base::sampling::{hash, unit};
use embree::{Ray, Rays16};

/// Error of the coarse cut.
const EPSILON: f32 = 0.3;

/// Share of a cluster's bound that counts as its light where its representative gives less.
const DOUBT: f32 = 0.3;

/// Number of levels below a cluster at which its samples have their representatives.
const LEVELS: u32 = 5;

/// Mean number of samples of a packet's points from which on a cut takes less time, and how many times as many are
/// wanted at points that reflect nothing besides if no coarse cut is made to find out.
const MOST: f32 = 150.0;
const TOO_MANY: f32 = 3.0;

/// Numbers of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Number at a point that reflects nothing besides; at others it falls with the share that their light has of all.
    pub whole: f32,
    /// Minimum number.
    pub least: f32,
}

/// Workspace for samples of cuts; one a thread, so that its buffers are allocated once.
#[derive(Default)]
pub struct SampledCut {
    cut: PacketLightcut,
    /// By cluster: luminance by which it is drawn, in each lane.
    importance: Vec<F32x16>,
    /// By lane: samples whose virtual lights are seen.
    found: [Vec<Sample>; LANES],
    /// Work done so far.
    pub counts: CutCounts,
}

/// A cut in which everything is seen.
struct AllSeen;

impl PacketVisibility for AllSeen {
    fn visible16(&self, _: &ReceiverPacket, lanes: u16, _: &Vpl, _: &LightNode) -> u16 {
        lanes
    }
}

/// A sample whose virtual light is seen.
#[derive(Clone, Copy)]
struct Sample {
    light: Rgb,
    /// Inverse of the density, of samples of single lights that may be clamped; else infinite.
    factor: f32,
}

/// Samples of points whose rays are yet to be traced.
#[derive(Default)]
struct Pending {
    rays: Rays16,
    light: Vec3x16,
    factors: F32x16,
    /// Lanes of the points.
    points: [u8; LANES],
    count: usize,
}

/// Where the samples of a point are, on a line along which clusters follow one another by their importance.
#[derive(Clone, Copy, Default)]
struct Progress {
    /// Place of the next sample, and the distance between samples.
    next: f32,
    step: f32,
    /// End of the clusters so far.
    reached: f32,
    /// Number of samples so far.
    number: u32,
    seed: u32,
}

impl Samples {
    /// Numbers for points that have these `totals` of luminance to gather, by lane; `None` if a cut takes less time, or
    /// a total is not finite.
    fn of(&self, receivers: &ReceiverPacket, totals: &F32x16) -> Option<F32x16> {
        let mut numbers = [0.0; LANES];
        for lane in lanes_in(receivers.valid) {
            let share = totals[lane] / (totals[lane] + receivers.baseline[lane]);
            let wanted = self.whole * share;
            numbers[lane] = if wanted > self.least { wanted } else { self.least };
        }
        let few = numbers.iter().sum::<f32>() <= MOST * receivers.len() as f32;
        (few && totals.iter().all(|total| total.is_finite())).then_some(numbers)
    }
}

impl SampledCut {
    /// Gathers the light of all VPLs by `samples`, which depend on nothing but the cut and `seed`; `None` if a cut
    /// takes less time. The number of clusters in a cut is that of samples.
    pub fn gather<V: RayVisibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        (settings, samples): (&CutSettings, &Samples),
        seed: u32,
    ) -> Option<PacketSum> {
        if !(samples.whole < TOO_MANY * MOST) {
            return None;
        }
        let coarse = CutSettings { epsilon: EPSILON, ..*settings };
        let capped = PacketRefinement::new(&mut self.cut, transfer, &AllSeen, receivers, &coarse).run();
        self.counts.bounds += std::mem::take(&mut self.cut.counts).bounds;
        let totals = self.weigh(transfer);
        let numbers = samples.of(receivers, &totals)?;
        self.counts.capped += receivers.len() as u64 * u64::from(capped);
        self.counts.cuts += receivers.len() as u64;
        let mut progress = [Progress::default(); LANES];
        for lane in lanes_in(receivers.valid) {
            self.found[lane].clear();
            let (step, seed) = (totals[lane] / numbers[lane], hash(seed, lane as u32));
            progress[lane] = Progress { next: step * unit(hash(seed, 0)), step, seed, ..Progress::default() };
        }
        self.draw(transfer, visibility, receivers, &mut progress);
        let mut sum = PacketSum::default();
        for lane in lanes_in(receivers.valid) {
            (sum.radiance[lane], sum.limits[lane]) =
                self.clamped(lane, receivers.baseline[lane], settings.clamp);
        }
        Some(sum)
    }

    /// Sets the importance of the clusters of the cut; returns its sums.
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

    /// Finds the samples of all lanes, one for each step of importance.
    fn draw<V: RayVisibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        progress: &mut [Progress; LANES],
    ) {
        let trees = transfer.trees;
        // A total that is too small to be divided gives no light.
        let lanes =
            lanes_in(receivers.valid).filter(|lane| progress[*lane].step > 0.0).fold(0, |l, i| l | 1 << i);
        let mut pending = Pending::default();
        for (cluster, importance) in self.cut.clusters.iter().zip(&self.importance) {
            for lane in lanes_in(lanes) {
                let progress = &mut progress[lane];
                progress.reached += importance[lane];
                while progress.next < progress.reached {
                    progress.next += progress.step;
                    progress.number += 1;
                    let u = unit(hash(progress.seed, progress.number));
                    let (node, density) = descend(&trees.nodes, cluster.node, u);
                    let density = importance[lane] / progress.step * density;
                    let (vpl, receiver) = (&trees.vpls[node.representative()], receivers.get(lane));
                    let response = transfer.unshadowed(receiver, vpl, node.kind());
                    if response == Rgb::ZERO {
                        continue;
                    }
                    let ray = to_vpl(receiver.position(), receiver.geometric_normal(), vpl, node.kind());
                    let factor = if is_weak(node) { density.recip() } else { f32::INFINITY };
                    let sample = Sample { light: response * (node.intensity / density), factor };
                    if pending.push(&ray, sample, lane) {
                        pending.trace(visibility, &mut self.found, &mut self.counts);
                    }
                }
            }
        }
        pending.trace(visibility, &mut self.found, &mut self.counts);
        self.counts.clusters += progress.iter().map(|progress| u64::from(progress.number)).sum::<u64>();
    }

    /// The sum of the samples found in a lane, in which no weak singularity has more than the share `clamp` of all
    /// light, and the luminance of that share.
    fn clamped(&mut self, lane: usize, baseline: f32, clamp: Option<f32>) -> (Rgb, f32) {
        let found = &self.found[lane];
        let is_limited = |sample: &Sample, limit: f32| luminance(sample.light) > limit * sample.factor;
        let limited = |limit: f32| -> Rgb {
            let limited = |sample: &Sample| match is_limited(sample, limit) {
                true => sample.light * (limit * sample.factor / luminance(sample.light)),
                false => sample.light,
            };
            found.iter().map(limited).sum()
        };
        let sum = limited(f32::INFINITY);
        let total = luminance(sum);
        self.counts.luminance += f64::from(total);
        let Some(clamp) = clamp else { return (sum, f32::INFINITY) };
        let frozen = frozen_luminance(total + baseline, MAX_STEPS, |frozen| {
            luminance(limited(DOMINANT * frozen)) + baseline
        });
        let limit = clamp * frozen;
        let kept = limited(limit);
        self.counts.clamped += found.iter().filter(|sample| is_limited(sample, limit)).count() as u64;
        self.counts.lost += f64::from(total - luminance(kept));
        (kept, limit)
    }
}

impl Pending {
    /// Adds a sample of the point in `lane`; true if there is no room for another.
    #[inline]
    fn push(&mut self, ray: &Ray, sample: Sample, lane: usize) -> bool {
        self.rays.set(self.count, ray);
        self.light.set(self.count, sample.light);
        self.factors[self.count] = sample.factor;
        self.points[self.count] = lane as u8;
        self.count += 1;
        self.count == LANES
    }

    /// Traces the rays and keeps the samples that are seen.
    fn trace<V: RayVisibility>(
        &mut self,
        visibility: &V,
        found: &mut [Vec<Sample>; LANES],
        counts: &mut CutCounts,
    ) {
        let count = std::mem::take(&mut self.count);
        if count == 0 {
            return;
        }
        counts.rays += count as u64;
        counts.packets += 1;
        for i in lanes_in(visibility.arriving16(&self.rays, count, &mut self.light)) {
            let sample = Sample { light: self.light.get(i), factor: self.factors[i] };
            found[usize::from(self.points[i])].push(sample);
        }
    }
}

/// A descendant of a node, drawn by luminance, and its probability.
fn descend(nodes: &[LightNode], node: u32, mut u: f32) -> (&LightNode, f32) {
    let (mut at, mut density) = (&nodes[node as usize], 1.0);
    for _ in 0..LEVELS {
        let Some(left) = at.children() else { break };
        let [a, b] = [left, left + 1].map(|child| &nodes[child as usize]);
        let [of_a, of_b] = [a, b].map(|child| luminance(child.intensity));
        let p = of_a / (of_a + of_b);
        if u < p {
            (at, u, density) = (a, u / p, density * p);
        } else {
            // Rounding must not make it 1, by which the other child would be drawn where it gives everything.
            let rest = ((u - p) / (1.0 - p)).min(1.0 - f32::EPSILON);
            (at, u, density) = (b, rest, density * (1.0 - p));
        }
    }
    (at, density)
}
