//! Records computed by lightcuts.
//!
//! Up to sixteen neighbouring records share a cut. Bounds, gradients and second derivatives are computed for all of
//! them at once, and the shadow rays to one light form one packet. A record that lacks only one layer cuts only the
//! trees of that layer. Errors are then judged relative to the light of both layers, so that each layer masks the
//! errors of the other.
//!
//! Paper: Herzog et al. 2009, section 6.
//! Deviations: series are clamped and not compensated (see [`crate::bias_compensation`]).

use super::cells::{Candidate, CellLimits};
use super::footprint::{Footprint, FootprintLimits};
use super::gather::{GatheredLayer, GatheredLayer16};
use super::lit_cluster::{Arriving16, RecordPoints};
use super::lit_cut::LitCut;
use super::occluder_distance::OccluderLog;
use super::occlusion_hessian::OcclusionHessian;
use super::record::{Diagnostics, NewRecord, Record};
use super::series::SeriesGatherer;
use super::settings::{CacheSettings, Footprints};
use crate::bias_compensation::Compensation;
use crate::bias_compensation::points::{Compensator, Lacking};
use crate::bias_compensation::short_rays::ClampedPoint;
use crate::eye::edge_class;
use crate::hsh::Radiance;
use crate::lightcut::{CutCounts, CutSettings, Lightcut, OrientedPoint, ReceiverPacket, group_compact};
use crate::lights::{DirectIndirect, Origin};
use crate::shade::ShadingContext;
use base::math::{LUMINANCE, Rgb, luminance};
use base::parallel::{ShortRuns, Workspaces};
use glam::{Mat3, Vec3};
use rayon::prelude::*;
use world::shadow::Engine;

impl RecordSource for LightcutSource<'_> {
    fn settings(&self) -> &CacheSettings {
        self.settings
    }

    fn cells(&self) -> CellLimits {
        self.cells
    }

    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        let works = Workspaces::new(|| RecordWorkspace::new(self));
        let compute = |group: &Vec<Candidate>| works.with(|work| work.compute(self, group));
        let done: Vec<(Vec<NewRecord>, CutCounts)> =
            self.groups(candidates).par_iter().one_by_one().map(compute).collect();
        let mut counts = CutCounts::default();
        let mut records = Vec::with_capacity(candidates.len());
        for (new, used) in done {
            counts += used;
            records.extend(new);
        }
        (records, counts)
    }
}

/// Light gathered at the point of a record.
struct GatheredLight {
    layers: DirectIndirect<GatheredLayer>,
    /// Light as series, if the surface needs one.
    series: DirectIndirect<Option<Radiance>>,
    /// Second derivatives of the light over the surface, if footprints account for the edges of occluders.
    hessian: Option<OcclusionHessian>,
}

impl LightcutSource<'_> {
    /// Groups candidates that share a cut: neighbours that lack the same layers.
    pub fn groups(&self, candidates: &[Candidate]) -> Vec<Vec<Candidate>> {
        let place = |candidate: &Candidate| OrientedPoint {
            position: candidate.point.position,
            normal: candidate.point.normal,
        };
        let lacks = |direct, indirect| DirectIndirect { direct, indirect };
        let mut groups = Vec::new();
        for missing in [lacks(true, true), lacks(true, false), lacks(false, true)] {
            let alike = candidates.iter().copied().filter(|candidate| candidate.missing == missing).collect();
            groups.extend(group_compact(alike, self.context.world.diagonal, place));
        }
        if self.share { groups } else { groups.concat().chunks(1).map(<[_]>::to_vec).collect() }
    }

    /// Returns true if footprints depend on the distances of occluders. With probe rays the distances of visible
    /// surfaces take their place.
    fn needs_occluders(&self) -> bool {
        self.settings.footprints != Footprints::Occlusion
    }

    /// Returns the record of one layer, or `None` if its light is not finite.
    fn record(&self, candidate: &Candidate, origin: Origin, light: &GatheredLight) -> Option<Record> {
        let g = &light.layers[origin];
        let luminance = luminance(g.irradiance);
        if !(luminance.is_finite() && g.vector.is_finite() && g.gradient.is_finite()) {
            return None;
        }
        let normal = candidate.point.normal;
        let tangential = |v: Vec3| v - normal * normal.dot(v);
        let mut gradient = Mat3::from_cols(
            tangential(g.gradient.x_axis),
            tangential(g.gradient.y_axis),
            tangential(g.gradient.z_axis),
        );
        let distance = light.hessian.as_ref().map_or_else(|| g.distance(), |hessian| hessian.distance());
        let limits = FootprintLimits::new(self.settings, origin, candidate, distance);
        let footprint = match &light.hessian {
            Some(hessian) => {
                let derivatives = hessian.derivatives(origin);
                gradient += derivatives.edge_gradient;
                Footprint::from_hessian(&derivatives, luminance, &limits)
            }
            None => Footprint::from_gradient(normal, gradient * LUMINANCE, luminance, &limits),
        };
        let (clamped, compensated) = (g.clamped, g.compensated);
        Some(Record {
            position: candidate.point.position,
            normal,
            coat: candidate.coat,
            edge_class: edge_class(candidate.edges),
            bands: candidate.bands,
            footprint,
            vector: g.vector,
            gradient: if self.settings.gradients { gradient } else { Mat3::ZERO },
            luminance,
            diagnostics: Diagnostics { cut: g.cut, distance, clamped, compensated },
        })
    }
}

/// Buffers of a thread.
struct RecordWorkspace<'w> {
    shadows: Engine<'w>,
    cut: Lightcut,
    points: ReceiverPacket<'static>,
    series: SeriesGatherer,
    compensator: Compensator,
    /// Light of each cluster of the cut.
    arriving: Vec<Arriving16>,
}

impl<'w> RecordWorkspace<'w> {
    fn new(s: &LightcutSource<'w>) -> RecordWorkspace<'w> {
        RecordWorkspace {
            shadows: Engine::scattered(s.context.world),
            cut: Lightcut::new(),
            points: ReceiverPacket::new(),
            series: SeriesGatherer::default(),
            compensator: Compensator::default(),
            arriving: Vec::new(),
        }
    }

    /// Computes the records of candidates that share a cut.
    fn compute(&mut self, s: &LightcutSource, group: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        self.cut.counts = CutCounts::default();
        let mut light = self.gather(s, group);
        if let Some(c) = &s.context.compensation {
            let mut gathered: Vec<_> = light.iter_mut().map(|light| &mut light.layers).collect();
            compensate(c, &mut self.compensator, group, &mut gathered);
            self.cut.counts += self.compensator.take_counts().cuts;
        }
        let mut records = Vec::with_capacity(2 * group.len());
        for (candidate, mut light) in group.iter().zip(light) {
            for origin in Origin::ALL.into_iter().filter(|origin| candidate.missing[*origin]) {
                let Some(record) = s.record(candidate, origin, &light) else { continue };
                let series = light.series[origin].take();
                let series =
                    if s.settings.gradients { series } else { series.map(Radiance::without_gradients) };
                records.push(NewRecord { origin, sample: candidate.sample, record, series });
            }
        }
        (records, self.cut.counts)
    }

    /// Gathers the light at the points of `group` by one cut. Threads that have no group help with the probe rays and
    /// sums.
    fn gather(&mut self, s: &LightcutSource, group: &[Candidate]) -> Vec<GatheredLight> {
        let RecordWorkspace { shadows, cut, points: receivers, series, arriving, .. } = self;
        let (world, transfer) = (s.context.world, &s.context.transfer);
        receivers.set(group.iter().map(Candidate::receiver));
        let receivers = &*receivers;
        let Candidate { missing, cell, .. } = group[0];
        let epsilon = s.cells.epsilon(s.settings.epsilon, cell);
        let settings = CutSettings { epsilon, origin: missing.single_origin(), ..*s.cut };
        let log = s.needs_occluders().then(|| OccluderLog::new(world));
        let places: Vec<_> = group.iter().map(|candidate| (candidate.point, candidate.sample)).collect();
        let (cut, mut hessians) = match &log {
            Some(log) => (cut.gather(transfer, log, receivers, &settings), Vec::new()),
            None => rayon::join(
                move || cut.gather(transfer, &*shadows, receivers, &settings),
                || OcclusionHessian::at_points(world, &places, s.settings.probe_rays),
            ),
        };
        let clamps = &cut.sum.clamps;
        let points = RecordPoints::new(group, &world.materials);
        let lit = LitCut::new(transfer, cut.clusters, &points, receivers, clamps, arriving);
        let mut layers = lit.layers(&points, &mut hessians);
        if let Some(log) = log {
            lit.add_hidden(&log.sorted(), receivers, clamps, &mut layers);
        }
        let mut hessians = hessians.into_iter();
        let mut light = Vec::with_capacity(group.len());
        for (lane, candidate) in group.iter().enumerate() {
            let clusters = cut.clusters.len() as u32;
            let layer = |layer: &GatheredLayer16| layer.layer(&points, lane, clusters, clamps.bounds[lane]);
            let layers = layers.as_ref().map(layer);
            let series = lit.series(series, candidate, lane);
            light.push(GatheredLight { layers, series, hessian: hessians.next() });
        }
        light
    }
}

/// Adds the compensation for clamped virtual lights to the direct and indirect light of a task's records.
fn compensate(
    c: &Compensation,
    compensator: &mut Compensator,
    task: &[Candidate],
    gathered: &mut [&mut DirectIndirect<GatheredLayer>],
) {
    let clamped = |(candidate, gathered): (&Candidate, &&mut DirectIndirect<GatheredLayer>)| ClampedPoint {
        point: candidate.point,
        bound: if candidate.missing.indirect { gathered.indirect.bound } else { f32::INFINITY },
        direct: candidate.missing.direct,
        edges: candidate.edges,
    };
    let points: Vec<ClampedPoint> = task.iter().zip(gathered.iter()).map(clamped).collect();
    let irradiances = gathered.iter().map(|g| luminance(g.direct.irradiance + g.indirect.irradiance));
    let mean = irradiances.sum::<f32>() / task.len().max(1) as f32;
    compensator.lacking(c, &points, mean, None, |record, Lacking { near, reflected, emitted }| {
        let candidate = &task[record];
        let passed = match candidate.coat {
            0 => 1.0,
            coat => c.world.materials.coat_transmittance(coat, near.cos),
        };
        for (origin, light) in [(Origin::Direct, emitted), (Origin::Indirect, reflected)] {
            if light != Rgb::ZERO {
                gathered[record][origin].compensate(candidate.point.normal, light * passed, near.distance);
            }
        }
    });
}

/// Algorithm that computes records.
pub trait RecordSource: Sync {
    /// Settings of the cache.
    fn settings(&self) -> &CacheSettings;

    /// Returns the limits on the cells that get a record.
    fn cells(&self) -> CellLimits {
        CellLimits::new(self.settings())
    }

    /// Computes records of the missing layers. The order does not depend on the number of threads. Records whose light
    /// is not finite are left out.
    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts);
}

/// Source that computes records by lightcuts.
#[derive(Clone, Copy)]
pub struct LightcutSource<'a> {
    /// Scene and virtual lights.
    pub context: ShadingContext<'a>,
    /// Settings of the cache.
    pub settings: &'a CacheSettings,
    /// Limits on the cells that get a record.
    pub cells: CellLimits,
    /// Cap and clamp of cuts, which are those of eye samples; the error bound is that of [`CacheSettings`] instead.
    pub cut: &'a CutSettings,
    /// True if neighbours share cuts.
    pub share: bool,
}
