//! Shading of a patch by cuts.
//!
//! Sixteen anchors spread over a patch share a cut. Its reconstruction cut shades the points between them, in packets
//! spread over the patch, so that neighbours sample different clusters. All points of a small patch are anchors, or
//! have cuts of their own. If few samples suffice, samples of a cut shade a small patch.

use super::patches::anchors;
use super::{ShadeSettings, ShadingContext, ShadingTask};
use crate::bias_compensation::points::{CompensationCounts, Compensator};
use crate::eye::ShadingPoints;
use crate::lightcut::{
    CutCounts, CutSettings, Lightcut, PacketSum, ReceiverPacket, ReconstructionCut, SampledCut,
    SampledSettings, Samples, Visibility,
};
use crate::lights::Origin;
use base::math::{LANES, Rgb};
use base::sampling::{hash, unit};
use std::mem::take;

/// Step of the random numbers of a patch's packets. The multiples of the golden ratio are well spread modulo 1.
const GOLDEN: f32 = 0.618_034;

/// Seed of the samples of cuts.
const SAMPLES_SEED: u32 = 0x3d4d_51cb;

/// Light that a point reflects.
#[derive(Clone, Copy, Debug)]
pub struct Shaded {
    /// Radiance.
    pub radiance: Rgb,
    /// Number of clusters in the cut; 0 if the light was gathered by samples.
    pub clusters: u32,
}

/// Workspaces for cuts. Each thread has one, so that buffers are allocated once.
#[derive(Default)]
pub struct Gatherers<'w> {
    packet: Lightcut,
    reconstruction: ReconstructionCut,
    sampled: SampledCut,
    compensator: Compensator,
    receivers: ReceiverPacket<'w>,
}

impl<'w> Gatherers<'w> {
    /// Shades a patch of tasks that differ only in their points; calls `shaded` with each task.
    pub fn shade<V: Visibility>(
        &mut self,
        c: &ShadingContext,
        rays: &V,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        settings: &ShadeSettings,
        mut shaded: impl FnMut(ShadingTask, Shaded),
    ) {
        let Some(first) = patch.first() else { return };
        let cut = CutSettings { origin: first.origin, ..*settings.cut };
        let samples = c.samples.filter(|_| patch.len() <= LANES && first.origin == Some(Origin::Indirect));
        if let Some(samples) = samples
            && self.by_samples(c, rays, points, patch, &sampled(&cut, &samples, first), &mut shaded)
        {
            return;
        }
        for tasks in patch.chunks(if settings.share { patch.len() } else { 1 }) {
            self.by_cut(c, rays, points, tasks, &cut, &mut shaded);
        }
    }

    /// Returns the work of cuts and of compensation since the last call.
    pub fn take_counts(&mut self) -> (CutCounts, CompensationCounts) {
        let mut cuts = take(&mut self.packet.counts);
        cuts += take(&mut self.reconstruction.counts);
        cuts += take(&mut self.sampled.counts);
        (cuts, self.compensator.take_counts())
    }

    /// Shades up to sixteen points by samples of a cut; returns false if a cut takes less time.
    fn by_samples<V: Visibility>(
        &mut self,
        c: &ShadingContext,
        rays: &V,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        settings: &SampledSettings,
        shaded: &mut impl FnMut(ShadingTask, Shaded),
    ) -> bool {
        self.receivers.set(patch.iter().map(|task| task.receiver(points)));
        let gathered = self.sampled.gather(&c.transfer, rays, &self.receivers, settings);
        let Some(mut sum) = gathered else { return false };
        if let Some(c) = &c.compensation {
            let origin = settings.cut.origin;
            self.compensator.anchors(c, origin, &self.receivers, &mut sum, Some(settings.seed));
        }
        report(patch.iter().copied(), &sum, 0, shaded);
        true
    }

    /// Shades a patch by the cut of its anchors.
    fn by_cut<V: Visibility>(
        &mut self,
        c: &ShadingContext,
        rays: &V,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        cut: &CutSettings,
        shaded: &mut impl FnMut(ShadingTask, Shaded),
    ) {
        let anchors = anchors(points, patch);
        let of = |anchor: bool| {
            let chosen = patch.iter().zip(&anchors).filter(move |(_, is_anchor)| **is_anchor == anchor);
            chosen.map(|(task, _)| *task)
        };
        self.receivers.set(of(true).map(|task| task.receiver(points)));
        let mut anchors_cut = self.packet.gather(&c.transfer, rays, &self.receivers, cut);
        let clusters = anchors_cut.clusters.len() as u32;
        let sum = &mut anchors_cut.sum;
        let near = c
            .compensation
            .as_ref()
            .and_then(|c| Some((c, self.compensator.anchors(c, cut.origin, &self.receivers, sum, None)?)));
        report(of(true), sum, clusters, shaded);
        let others: Vec<ShadingTask> = of(false).collect();
        if others.is_empty() {
            return;
        }
        self.reconstruction.set(&c.transfer, &self.receivers, &anchors_cut, cut);
        let first = unit(hash(patch[0].point, 0));
        let packets = others.len().div_ceil(LANES);
        for packet in 0..packets {
            let tasks = || others.iter().skip(packet).step_by(packets).copied();
            let start = (first + packet as f32 * GOLDEN).fract();
            self.receivers.set(tasks().map(|task| task.receiver(points)));
            let mut sum = self.reconstruction.gather(&c.transfer, rays, &self.receivers, start);
            if let Some((c, near)) = &near {
                self.compensator.others(c, near, &self.receivers, &mut sum);
            }
            report(tasks(), &sum, clusters, shaded);
        }
    }
}

/// Returns the settings for samples of a cut; the first task of a patch determines their seed.
fn sampled<'a>(cut: &'a CutSettings, samples: &'a Samples, first: &ShadingTask) -> SampledSettings<'a> {
    SampledSettings { cut, samples, seed: hash(first.point, SAMPLES_SEED) }
}

fn report(
    tasks: impl Iterator<Item = ShadingTask>,
    sum: &PacketSum,
    clusters: u32,
    shaded: &mut impl FnMut(ShadingTask, Shaded),
) {
    for (task, radiance) in tasks.zip(sum.radiance) {
        shaded(task, Shaded { radiance, clusters });
    }
}
