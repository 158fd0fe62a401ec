//! Light of a packet's points from samples of a coarse cut, for images that are noisy anyway. It takes a fraction of
//! the shadow rays of a cut, and its errors are noise, not a pattern.
//!
//! Paper: Yuksel, *Stochastic Lightcuts*, 2019: representatives are sampled anew for each point.
//!
//! A point samples clusters in proportion to their unshadowed contributions, or to a share of their bounds if that is
//! more. From there it descends a few levels of the tree, in proportion to the members' intensities. The mean is the
//! light of all VPLs, limited as in a cut, except that the nodes where the descent ends have fixed
//! representatives.
//!
//! Errors: nodes above leaves are not clamped. So at points very close to a light, light remains that a cut would
//! clamp.
//!
//! Deviations: clusters share a number of samples, instead of having one each. The cut is that of sixteen points, and
//! all VPLs count as visible in it. Rays of all points to a cluster are traced together, since they are coherent.

#[cfg(test)]
mod tests;

use super::refine::PacketRefinement;
use super::{Clamps, Lightcut, PacketSum, ReceiverPacket, luminances};
use crate::lightcut::clamp::{DOMINANT, MAX_STEPS, frozen_luminance, is_weak};
use crate::lightcut::{CutCounts, CutSettings, Transfer, Visibility, to_vpl};
use crate::lights::LightNode;
use base::math::{F32x16, LANES, Rgb, V3, Vec3x16, first_lanes, lanes_in, luminance};
use base::sampling::{hash, unit};
use embree::{Ray, Rays16};

/// ε of the coarse cut.
const EPSILON: f32 = 0.3;

/// Share of a cluster's expected error that counts as its light if its representative gives less.
const DOUBT: f32 = 0.3;

/// Maximum number of levels that a sample descends below its cluster.
const LEVELS: u32 = 5;

/// Maximum mean number of samples per point; with more, a cut takes less time.
const MAX_SAMPLES: f32 = 150.0;

/// Ratio of wanted samples to [`MAX_SAMPLES`] above which no coarse cut is made.
const HOPELESS: f32 = 3.0;

/// Numbers of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Number at a point that reflects no other light; at other points, the number is in proportion to the share of the
    /// gathered light.
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
    drawn: Vec<Drawn>,
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

/// Sample whose VPL is visible.
#[derive(Clone, Copy)]
struct Sample {
    light: Rgb,
    /// Inverse of the density for samples of leaves that may be clamped; infinite for others.
    factor: f32,
    /// Geometry term of a leaf that may be clamped; 0 for others.
    geometry: f32,
}

/// Sample on its way from a cluster to a descendant.
#[derive(Clone, Copy)]
struct Drawn {
    /// Node reached.
    node: u32,
    /// Random number that chooses the descendant.
    u: f32,
    /// Number of samples per contribution of the cluster.
    of_cluster: f32,
    /// Probability of the node among the cluster's descendants.
    density: f32,
    /// Lane of the sample's point.
    lane: u8,
}

/// Samples whose rays have not been traced yet.
#[derive(Default)]
struct Pending {
    rays: Rays16,
    light: Vec3x16,
    factors: F32x16,
    geometries: F32x16,
    /// Maximum numbers of sheets that the samples' light passes (see [`crate::lightcut::Receiver::sheets`]).
    sheets: [Option<u32>; LANES],
    /// Lanes of the samples' points.
    points: [u8; LANES],
    count: usize,
}

/// Position of a point's next sample on a line along which clusters follow one another, as long as their importance.
#[derive(Clone, Copy, Default)]
struct SampleCursor {
    /// Place of the next sample.
    next: f32,
    /// Distance between samples.
    step: f32,
    /// End of the clusters so far.
    reached: f32,
    /// Number of samples so far.
    number: u32,
    seed: u32,
}

impl Samples {
    /// Returns the numbers of samples for points that gather these `totals` of luminance, by lane; `None` if a cut
    /// takes less time, or if a total is not finite.
    fn of(&self, receivers: &ReceiverPacket, totals: &F32x16) -> Option<F32x16> {
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
        let numbers = samples.of(receivers, &totals)?;
        self.counts.capped += receivers.len() as u64 * u64::from(capped);
        self.counts.cuts += receivers.len() as u64;
        let mut cursors = [SampleCursor::default(); LANES];
        for lane in lanes_in(receivers.valid) {
            self.visible[lane].clear();
            let (step, seed) = (totals[lane] / numbers[lane], hash(seed, lane as u32));
            cursors[lane] =
                SampleCursor { next: step * unit(hash(seed, 0)), step, seed, ..SampleCursor::default() };
        }
        self.sample(transfer, visibility, receivers, &mut cursors);
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

    /// Takes the samples of all lanes, one for each step of importance.
    fn sample<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receivers: &ReceiverPacket,
        cursors: &mut [SampleCursor; LANES],
    ) {
        self.draw(receivers, cursors);
        let trees = transfer.trees;
        let mut pending = Pending::default();
        for group in self.drawn.chunks_mut(LANES) {
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
                let ray = to_vpl(receiver.position(), receiver.geometric_normal(), vpl, node.kind());
                let (factor, geometry) = match is_weak(node) {
                    true => {
                        let (x, normal) = receiver.place();
                        let (x, normal) = (V3::<f32>::splat(x), V3::splat(normal));
                        (density.recip(), transfer.geometry_term(x, normal, vpl, node.kind()))
                    }
                    false => (f32::INFINITY, 0.0),
                };
                let sample = Sample { light: response * (node.intensity / density), factor, geometry };
                let (_, before) = trees.representative(node);
                pending.sheets[pending.count] = receiver.sheets(before);
                if pending.push(&ray, sample, lane) {
                    pending.trace(visibility, &mut self.visible, &mut self.counts);
                }
            }
        }
        pending.trace(visibility, &mut self.visible, &mut self.counts);
        self.counts.clusters += self.drawn.len() as u64;
    }

    /// Draws the clusters and random numbers of all samples, in the order of the clusters.
    fn draw(&mut self, receivers: &ReceiverPacket, cursors: &mut [SampleCursor; LANES]) {
        self.drawn.clear();
        // If a total is too small to be divided, its step is 0 and it gives no light.
        let lanes =
            lanes_in(receivers.valid).filter(|lane| cursors[*lane].step > 0.0).fold(0, |l, i| l | 1 << i);
        for (cluster, importance) in self.cut.clusters.iter().zip(&self.importance) {
            for lane in lanes_in(lanes) {
                let cursor = &mut cursors[lane];
                cursor.reached += importance[lane];
                while cursor.next < cursor.reached {
                    cursor.next += cursor.step;
                    cursor.number += 1;
                    let u = unit(hash(cursor.seed, cursor.number));
                    let of_cluster = importance[lane] / cursor.step;
                    self.drawn.push(Drawn {
                        node: cluster.node,
                        u,
                        of_cluster,
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

impl Pending {
    /// Adds a sample of the point in `lane`; returns true if the packet is full.
    #[inline]
    fn push(&mut self, ray: &Ray, sample: Sample, lane: usize) -> bool {
        self.rays.set(self.count, ray);
        self.light.set(self.count, sample.light);
        self.factors[self.count] = sample.factor;
        self.geometries[self.count] = sample.geometry;
        self.points[self.count] = lane as u8;
        self.count += 1;
        self.count == LANES
    }

    /// Traces the rays, and keeps the samples whose VPLs are visible.
    fn trace<V: Visibility>(
        &mut self,
        visibility: &V,
        visible: &mut [Vec<Sample>; LANES],
        counts: &mut CutCounts,
    ) {
        let count = std::mem::take(&mut self.count);
        if count == 0 {
            return;
        }
        counts.rays += count as u64;
        counts.packets += 1;
        let free = visibility.visible16(&self.rays, first_lanes(count), None);
        visibility.attenuate16(&self.rays, free, |i| self.sheets[i], &mut self.light);
        for i in lanes_in(free) {
            let (factor, geometry) = (self.factors[i], self.geometries[i]);
            let sample = Sample { light: self.light.get(i), factor, geometry };
            visible[usize::from(self.points[i])].push(sample);
        }
    }
}

impl Drawn {
    /// Descends to a child, in proportion to luminance; stays at a leaf.
    #[inline]
    fn descend(&mut self, nodes: &[LightNode]) {
        let Some(left) = nodes[self.node as usize].children() else { return };
        let [of_left, of_right] = [left, left + 1].map(|child| luminance(nodes[child as usize].intensity));
        let p = of_left / (of_left + of_right);
        if self.u < p {
            (self.node, self.u, self.density) = (left, self.u / p, self.density * p);
        } else {
            // Rounding must not make the number 1, which would choose a right child of probability 0.
            let rest = ((self.u - p) / (1.0 - p)).min(1.0 - f32::EPSILON);
            (self.node, self.u, self.density) = (left + 1, rest, self.density * (1.0 - p));
        }
    }
}
