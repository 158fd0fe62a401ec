//! The records of one wave.
//!
//! Records that lie close together share a cut, as neighbouring pixels do: its shadow rays are coherent.
//! A record that lacks one layer only cuts only that layer's trees, judged against what the other is known to
//! give, so that each layer masks the other's errors (Herzog et al. 2009, section 6).

use super::compensate::{self, Clamp, Cutters};
use super::footprint::Footprint;
use super::gather::{Gathered, Gatherer};
use super::occluder_distance::{Hidden, OccluderLog};
use super::occlusion_hessian::Sight;
use super::placement::Pick;
use super::record::{Facts, Record};
use super::series::SeriesGatherer;
use super::settings::{CacheSettings, Footprints};
use super::splat::Layer;
use crate::bias_compensation::Compensation;
use crate::eye::EyePass;
use crate::hsh::Radiance;
use crate::lightcut::{
    CoherenceLimit, CutCounts, CutSettings, Lightcut, PacketLightcut, Receiver, ReceiverPacket, Transfer,
    group_coherent,
};
use crate::math::{Frame, LANES, LUMINANCE, Rgb, luminance};
use crate::shadow::Engine;
use crate::vpl::Origin;
use crate::world::World;
use glam::{Mat3, Vec3};
use rayon::prelude::*;

/// What computing records needs.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The scene.
    pub world: &'a World,
    /// What reaches a point from its virtual lights.
    pub transfer: Transfer<'a>,
    /// Settings.
    pub settings: &'a CacheSettings,
    /// How clamped light is found again, if it is.
    pub compensation: Option<Compensation<'a>>,
}

/// A record, and its light as a series where the surface needs it.
pub struct Made {
    /// The record.
    pub record: Record,
    /// Of the sample's bands.
    pub series: Option<Radiance>,
}

/// Records of both layers at one eye sample.
pub type Pair = [Option<Made>; 2];

/// Which layer light of an origin belongs to.
#[inline]
pub fn layer_of(origin: Origin) -> usize {
    match origin {
        Origin::Direct => 0,
        Origin::Indirect => 1,
    }
}

/// Where records come from.
pub trait RecordSource: Sync {
    /// Settings of the cache.
    fn settings(&self) -> &CacheSettings;

    /// Computes the records of a wave, always in the same order.
    fn records(
        &self,
        samples: &EyePass,
        layers: &[Layer; 2],
        picks: &[Pick],
    ) -> (Vec<(Pick, Pair)>, CutCounts);
}

impl RecordSource for Source<'_> {
    fn settings(&self) -> &CacheSettings {
        self.settings
    }

    fn records(
        &self,
        samples: &EyePass,
        layers: &[Layer; 2],
        picks: &[Pick],
    ) -> (Vec<(Pick, Pair)>, CutCounts) {
        let tasks = self.tasks(samples, picks);
        let done: Vec<(Vec<(Pick, Pair)>, CutCounts)> = tasks
            .par_iter()
            .map_init(
                || Workspace::new(self),
                |work, task| {
                    work.shadows.begin_chunk();
                    (work.single.counts, work.group.counts) = Default::default();
                    let pairs = work.compute(self, samples, layers, task);
                    (task.iter().copied().zip(pairs).collect(), work.counts())
                },
            )
            .collect();
        let mut counts = CutCounts::default();
        let mut records = Vec::with_capacity(picks.len());
        for (pairs, used) in done {
            counts += used;
            records.extend(pairs);
        }
        (records, counts)
    }
}

impl Source<'_> {
    /// Picks that share a cut: neighbours that lack the same layers.
    pub fn tasks(&self, samples: &EyePass, picks: &[Pick]) -> Vec<Vec<Pick>> {
        let place = |pick: &Pick| {
            let point = &samples.points.geometry[pick.sample as usize];
            (point.position, point.normal)
        };
        group_coherent(
            CoherenceLimit::CLOSE,
            picks.iter().copied(),
            LANES,
            self.world.diagonal,
            place,
            |a, b| a.lacks == b.lacks,
        )
    }

    /// The record of one layer, or `None` where it would be of no use.
    fn record(&self, samples: &EyePass, sample: u32, layer: usize, view: &View) -> Option<Record> {
        let g = &view.gathered[layer];
        let point = &samples.points.geometry[sample as usize];
        let luminance = luminance(g.irradiance);
        if !(luminance.is_finite() && g.vector.is_finite() && g.gradient.is_finite()) {
            return None;
        }
        let accuracy = self.settings.accuracy[layer];
        let reach = self.settings.reach[layer].map(|r| r * point.spacing);
        let normal = point.normal;
        let tangential = |v: Vec3| v - normal * normal.dot(v);
        let mut gradient = Mat3::from_cols(
            tangential(g.gradient.x_axis),
            tangential(g.gradient.y_axis),
            tangential(g.gradient.z_axis),
        );
        let distance = view.sight.as_ref().map_or_else(|| g.distance(), |sight| sight.distance());
        let footprint = match &view.sight {
            Some(sight) => {
                let change = sight.change(layer);
                gradient += change.gradient;
                let furthest = accuracy * distance;
                Footprint::of_change(&change, luminance, accuracy, furthest, reach, self.settings)
            }
            None => {
                let radius = (accuracy * distance).clamp(reach[0], reach[1]);
                Footprint::of_gradient(normal, gradient * LUMINANCE, luminance, radius, self.settings)
            }
        };
        Some(Record {
            position: point.position,
            normal,
            sharing: point.sharing,
            footprint,
            vector: g.vector,
            gradient: if self.settings.gradients { gradient } else { Mat3::ZERO },
            luminance,
            facts: Facts { sample, cut: g.cut, distance, clamped: g.clamped, compensated: g.compensated },
        })
    }
}

/// A thread's buffers.
struct Workspace<'w> {
    shadows: Engine<'w>,
    single: Lightcut,
    group: PacketLightcut,
    points: ReceiverPacket<'static>,
    series: SeriesGatherer,
}

impl<'w> Workspace<'w> {
    fn new(s: &Source<'w>) -> Workspace<'w> {
        let shadows = s.settings.shadows;
        Workspace {
            shadows: Engine::with(s.world, shadows.for_records(), shadows.cache),
            single: Lightcut::new(),
            group: PacketLightcut::new(),
            points: ReceiverPacket::new(),
            series: SeriesGatherer::default(),
        }
    }

    fn counts(&self) -> CutCounts {
        let mut counts = self.single.counts;
        counts += self.group.counts;
        counts
    }

    fn compute(&mut self, s: &Source, samples: &EyePass, layers: &[Layer; 2], task: &[Pick]) -> Vec<Pair> {
        let collectors = task.iter().map(|pick| {
            let i = pick.sample as usize;
            let point = &samples.points.geometry[i];
            let frame = Frame::from_normal(point.normal);
            let known = [0, 1].map(|l| match layers[l].sums[i].mean() {
                Some(irradiance) if !pick.lacks[l] => luminance(irradiance),
                _ => 0.0,
            });
            Receiver::irradiance(point.position, samples.points.surfaces[i].geometric_normal, &frame)
                .with_baseline(known[0] + known[1])
        });
        let origin = match task[0].lacks {
            [true, false] => Some(Origin::Direct),
            [false, true] => Some(Origin::Indirect),
            _ => None,
        };
        let cut = CutSettings { origin, ..s.settings.cut };
        let mut views: Vec<View> = if !s.settings.shares(task.len()) {
            collectors.zip(task).map(|(c, pick)| self.alone(s, samples, pick, &c, &cut)).collect()
        } else {
            self.points.set(collectors);
            self.shared(s, samples, task, &cut)
        };
        if let Some(c) = &s.compensation {
            let cutters =
                Cutters { single: &mut self.single, group: &mut self.group, points: &mut self.points };
            let mut gathered: Vec<_> = views.iter_mut().map(|view| &mut view.gathered).collect();
            compensate::add(c, s, cutters, samples, task, &mut gathered);
        }
        let record = |(pick, mut view): (&Pick, View)| {
            [0, 1].map(|l| {
                let record =
                    if pick.lacks[l] { s.record(samples, pick.sample, l, &view)? } else { return None };
                let series = view.series[l].take();
                let series =
                    if s.settings.gradients { series } else { series.map(Radiance::without_gradients) };
                Some(Made { record, series })
            })
        };
        task.iter().zip(views).map(record).collect()
    }

    fn alone(
        &mut self,
        s: &Source,
        samples: &EyePass,
        pick: &Pick,
        collector: &Receiver<'static>,
        cut: &CutSettings,
    ) -> View {
        let rays = s.needs_occluders().then(|| OccluderLog::new(s.world));
        let cut = match &rays {
            Some(rays) => self.single.gather(&s.transfer, rays, collector, cut),
            None => self.single.gather(&s.transfer, &self.shadows, collector, cut),
        };
        let hidden = rays.map(OccluderLog::sorted);
        let gatherer = s.gatherer(samples, pick.sample, collector);
        let clamp = compensate::clamp(&s.compensation, cut.limit);
        let mut view = s.view(samples, pick.sample, cut.clusters.len(), clamp);
        let series = &mut self.series;
        series.begin(&samples.points.geometry[pick.sample as usize]);
        for cluster in cut.clusters {
            let hidden = (hidden.as_ref(), 0);
            s.add((&mut view, series), &gatherer, cluster.node, cluster.response, clamp, hidden);
        }
        view.series = series.finish();
        view
    }

    fn shared(&mut self, s: &Source, samples: &EyePass, task: &[Pick], cut: &CutSettings) -> Vec<View> {
        let rays = s.needs_occluders().then(|| OccluderLog::new(s.world));
        let cut = match &rays {
            Some(rays) => self.group.gather(&s.transfer, rays, &self.points, cut),
            None => self.group.gather(&s.transfer, &self.shadows, &self.points, cut),
        };
        let hidden = rays.map(OccluderLog::sorted);
        let series = &mut self.series;
        let lane = |(lane, pick): (usize, &Pick)| {
            let gatherer = s.gatherer(samples, pick.sample, self.points.get(lane));
            let clamp = compensate::clamp(&s.compensation, cut.sum.limits[lane]);
            let mut view = s.view(samples, pick.sample, cut.clusters.len(), clamp);
            series.begin(&samples.points.geometry[pick.sample as usize]);
            for cluster in cut.clusters {
                let (response, hidden) = (cluster.responses.get(lane), (hidden.as_ref(), lane));
                s.add((&mut view, series), &gatherer, cluster.node, response, clamp, hidden);
            }
            view.series = series.finish();
            view
        };
        task.iter().enumerate().map(lane).collect()
    }
}

/// What a record's point gathers, and what it sees, if footprints depend on that.
struct View {
    gathered: [Gathered; 2],
    /// Light as series, where the surface needs it so.
    series: [Option<Radiance>; 2],
    sight: Option<Box<Sight>>,
}

impl<'a> Source<'a> {
    /// Whether footprints depend on how far away what hides lights is; what probe rays see replaces that.
    fn needs_occluders(&self) -> bool {
        self.settings.footprints != Footprints::Occlusion
    }

    fn view(&self, samples: &EyePass, sample: u32, cut: usize, clamp: Clamp) -> View {
        let sight = (!self.needs_occluders()).then(|| {
            let point = &samples.points.geometry[sample as usize];
            let geometric_normal = samples.points.surfaces[sample as usize].geometric_normal;
            let (at, rays) = ((point.position, geometric_normal), self.settings.probe_rays);
            Box::new(Sight::new(self.world, at, point.normal, rays, sample))
        });
        let gathered = Gathered { cut: cut as u32, bound: clamp.bound(), ..Gathered::default() };
        View { gathered: [gathered; 2], series: [None, None], sight }
    }

    fn gatherer(&self, samples: &EyePass, sample: u32, collector: &Receiver<'static>) -> Gatherer<'a> {
        let point = &samples.points.geometry[sample as usize];
        Gatherer {
            collector: *collector,
            position: point.position,
            normal: point.normal,
            coat: point.sharing.coat(),
            materials: &self.world.materials,
        }
    }

    #[inline]
    fn add(
        &self,
        (view, series): (&mut View, &mut SeriesGatherer),
        g: &Gatherer,
        node: u32,
        response: Rgb,
        clamp: Clamp,
        (hidden, lane): (Option<&Hidden>, usize),
    ) {
        let node = &self.transfer.trees.nodes[node as usize];
        let vpl = &self.transfer.trees.vpls[node.representative()];
        let number = layer_of(node.origin());
        let layer = &mut view.gathered[number];
        let weak = node.is_leaf() && node.origin() == Origin::Indirect;
        if response == Rgb::ZERO {
            let Some(hidden) = hidden else { return };
            let would_be = self.transfer.unshadowed(&g.collector, vpl, node.kind());
            let luminance = luminance(node.intensity * would_be);
            if luminance > 0.0 {
                let kept = if weak { clamp.kept(luminance, would_be.x) } else { 1.0 };
                layer.hidden(kept * luminance, hidden.distance(node, lane));
            }
            return;
        }
        let contribution = node.intensity * response;
        // The collector's response is grey: it is the geometry term.
        let kept = if weak { clamp.kept(luminance(contribution), response.x) } else { 1.0 };
        series.add(number, &self.transfer, node, vpl, kept);
        let passed = layer.add(g, &self.transfer, node, vpl, contribution, kept);
        if let Some(sight) = &mut view.sight {
            sight.add(number, &self.transfer, (node, vpl), contribution, passed, kept < 1.0);
        }
    }
}
