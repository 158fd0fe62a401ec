//! Shading of a patch by cuts.
//!
//! Sixteen anchors spread over a patch share a cut; the points between them are shaded by the reconstruction
//! cut made of it, in packets spread over the patch, so that neighbours leave different clusters to chance. A
//! patch of few points has no other points than anchors, or cuts of their own for all; or samples of a cut, where few
//! of them do.

use super::patches::anchors;
use super::{ShadeSettings, ShadingContext, ShadingTask};
use crate::bias_compensation::points::{CompensationCounts, Compensator};
use crate::eye::ShadingPoints;
use crate::lightcut::{
    CutCounts, CutSettings, Lightcut, PacketLightcut, PacketSum, PacketVisibility, RayVisibility,
    ReceiverPacket, ReconstructionCut, SampledCut, Samples, Visibility,
};
use crate::lights::Origin;
use base::math::{LANES, Rgb};
use base::sampling::{hash, unit};
use std::mem::take;

/// Step of the random numbers of a patch's packets: its multiples, modulo 1, stay far from each other.
const GOLDEN: f32 = 0.618_034;

/// Seed of the samples of cuts.
const SAMPLES_SEED: u32 = 0x3d4d_51cb;

/// Light that a point reflects.
#[derive(Clone, Copy, Debug)]
pub struct Shaded {
    /// Radiance.
    pub radiance: Rgb,
    /// Clusters in the cut that it was gathered from; 0 if it was by samples.
    pub clusters: u32,
}

/// Workspaces for cuts; one a thread, so that their buffers are allocated once.
#[derive(Default)]
pub struct Gatherers<'w> {
    single: Lightcut,
    packet: PacketLightcut,
    reconstruction: ReconstructionCut,
    sampled: SampledCut,
    compensator: Compensator,
    receivers: ReceiverPacket<'w>,
}

impl<'w> Gatherers<'w> {
    /// Shades a patch of tasks that differ in nothing but their points, and calls `shaded` with each.
    pub fn shade<V: Visibility + PacketVisibility + RayVisibility>(
        &mut self,
        c: &ShadingContext,
        rays: &V,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        settings: &ShadeSettings,
        mut shaded: impl FnMut(ShadingTask, Shaded),
    ) {
        let Some(first) = patch.first() else { return };
        let cut = CutSettings { origin: first.origin, ..settings.cut };
        let samples =
            settings.samples.filter(|_| patch.len() <= LANES && first.origin == Some(Origin::Indirect));
        if let Some(samples) = samples
            && self.by_samples(c, rays, points, patch, (&cut, &samples), &mut shaded)
        {
            return;
        }
        if settings.shares(patch.len()) {
            self.together(c, rays, points, patch, &cut, &mut shaded);
        } else {
            for tasks in patch.chunks(LANES) {
                self.alone(c, rays, points, tasks, &cut, &mut shaded);
            }
        }
    }

    /// Work of cuts and of their compensation since this was last asked.
    pub fn take_counts(&mut self) -> (CutCounts, CompensationCounts) {
        let mut cuts = take(&mut self.single.counts);
        cuts += take(&mut self.packet.counts);
        cuts += take(&mut self.reconstruction.counts);
        cuts += take(&mut self.sampled.counts);
        (cuts, self.compensator.take_counts())
    }

    /// Shades up to sixteen points by samples of a cut; false if a cut takes less time.
    fn by_samples<V: RayVisibility>(
        &mut self,
        c: &ShadingContext,
        rays: &V,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        wanted: (&CutSettings, &Samples),
        shaded: &mut impl FnMut(ShadingTask, Shaded),
    ) -> bool {
        self.receivers.set(patch.iter().map(|task| task.receiver(points)));
        let seed = hash(patch[0].point, SAMPLES_SEED);
        let found = self.sampled.gather(&c.transfer, rays, &self.receivers, wanted, seed);
        let Some(mut sum) = found else { return false };
        if let Some(c) = &c.compensation {
            self.compensator.anchors(c, wanted.0.origin, &self.receivers, &mut sum, Some(seed));
        }
        report(patch.iter().copied(), &sum, 0, shaded);
        true
    }

    fn together<V: PacketVisibility>(
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

    /// Shades up to sixteen points, each by a cut of its own.
    fn alone<V: Visibility>(
        &mut self,
        c: &ShadingContext,
        rays: &V,
        points: &ShadingPoints<'w>,
        tasks: &[ShadingTask],
        cut: &CutSettings,
        shaded: &mut impl FnMut(ShadingTask, Shaded),
    ) {
        let (mut sum, mut clusters) = (PacketSum::default(), [0; LANES]);
        for (lane, task) in tasks.iter().enumerate() {
            let own = self.single.gather(&c.transfer, rays, &task.receiver(points), cut);
            (sum.radiance[lane], sum.limits[lane]) = (own.radiance, own.limit);
            clusters[lane] = own.clusters.len() as u32;
        }
        if let Some(c) = &c.compensation {
            self.receivers.set(tasks.iter().map(|task| task.receiver(points)));
            self.compensator.anchors(c, cut.origin, &self.receivers, &mut sum, None);
        }
        for ((task, radiance), clusters) in tasks.iter().zip(sum.radiance).zip(clusters) {
            shaded(*task, Shaded { radiance, clusters });
        }
    }
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
