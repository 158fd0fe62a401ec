//! Records by lightcuts.
//!
//! Sixteen records share a cut, the nearest that there are: bounds, gradients and second derivatives are found for
//! all of them at once, and shadow rays to one light in one packet. A record that lacks one layer only cuts only
//! that layer's trees, judged against the light of the other layer, so that each layer masks the other's errors
//! (Herzog et al. 2009, section 6).

use super::compensate::{self, Clamps, Cutter};
use super::footprint::{Footprint, FootprintLimits};
use super::gather::{GatheredLayer, GatheredLayer16};
use super::lit_cluster::{LitCluster, RecordPoints};
use super::occluder_distance::{OccluderDistances, OccluderLog};
use super::occlusion_hessian::OcclusionHessian;
use super::record::{Diagnostics, Record};
use super::series::SeriesGatherer;
use super::settings::{CacheSettings, Footprints};
use super::source::{Candidate, LightcutSource, NewRecord, RecordSource};
use crate::hsh::Radiance;
use crate::lightcut::{
    CutCounts, CutSettings, PacketCluster, PacketCut, PacketLightcut, ReceiverPacket, Transfer, group_compact,
};
use crate::lights::{DirectIndirect, Origin};
use base::math::{LUMINANCE, Rgb, lanes_in, luminance};
use base::parallel::{ShortRuns, Workspaces};
use glam::{Mat3, Vec3};
use rayon::prelude::*;
use world::shadow::Engine;

impl RecordSource for LightcutSource<'_> {
    fn settings(&self) -> &CacheSettings {
        self.settings
    }

    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        let works = Workspaces::new(|| Workspace::new(self));
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

/// Light that the point of a record gathers.
struct GatheredLight {
    layers: DirectIndirect<GatheredLayer>,
    /// Light as series, where the surface needs it so.
    series: DirectIndirect<Option<Radiance>>,
    /// Change of the light over the surface, if footprints are to include occluders' edges.
    hessian: Option<OcclusionHessian>,
}

impl LightcutSource<'_> {
    /// Candidates that share a cut: neighbours that lack the same layers.
    pub fn groups(&self, candidates: &[Candidate]) -> Vec<Vec<Candidate>> {
        let place = |candidate: &Candidate| (candidate.point.position, candidate.point.normal);
        let lacks = |direct, indirect| DirectIndirect { direct, indirect };
        let mut groups = Vec::new();
        for missing in [lacks(true, true), lacks(true, false), lacks(false, true)] {
            let alike = candidates.iter().copied().filter(|candidate| candidate.missing == missing).collect();
            groups.extend(group_compact(alike, self.context.world.diagonal, place));
        }
        if self.settings.share { groups } else { groups.concat().chunks(1).map(<[_]>::to_vec).collect() }
    }

    /// True if footprints depend on the distances of occluders; the distances of probe rays replace those.
    fn needs_occluders(&self) -> bool {
        self.settings.footprints != Footprints::Occlusion
    }

    /// The record of one layer, or `None` where its light is not finite.
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
                Footprint::of_hessian(&derivatives, luminance, &limits)
            }
            None => Footprint::of_gradient(normal, gradient * LUMINANCE, luminance, &limits),
        };
        let (clamped, compensated) = (g.clamped, g.compensated);
        Some(Record {
            position: candidate.point.position,
            normal,
            coat: candidate.coat,
            bands: candidate.bands,
            footprint,
            vector: g.vector,
            gradient: if self.settings.gradients { gradient } else { Mat3::ZERO },
            luminance,
            diagnostics: Diagnostics { cut: g.cut, distance, clamped, compensated },
        })
    }
}

/// A thread's buffers.
struct Workspace<'w> {
    shadows: Engine<'w>,
    cut: PacketLightcut,
    points: ReceiverPacket<'static>,
    series: SeriesGatherer,
}

impl<'w> Workspace<'w> {
    fn new(s: &LightcutSource<'w>) -> Workspace<'w> {
        Workspace {
            shadows: Engine::scattered(s.context.world),
            cut: PacketLightcut::new(),
            points: ReceiverPacket::new(),
            series: SeriesGatherer::default(),
        }
    }

    /// The records of candidates that share a cut.
    fn compute(&mut self, s: &LightcutSource, group: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        self.cut.counts = CutCounts::default();
        let mut light = self.gather(s, group);
        if let Some(c) = &s.context.compensation {
            let cutter = Cutter { cut: &mut self.cut, points: &mut self.points };
            let mut gathered: Vec<_> = light.iter_mut().map(|light| &mut light.layers).collect();
            compensate::add(c, s, cutter, group, &mut gathered);
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

    /// Light at the points of `group` by one cut.
    fn gather(&mut self, s: &LightcutSource, group: &[Candidate]) -> Vec<GatheredLight> {
        let world = s.context.world;
        self.points.set(group.iter().map(Candidate::receiver));
        let settings = CutSettings { origin: group[0].missing.only(), ..s.settings.cut };
        let log = s.needs_occluders().then(|| OccluderLog::new(world));
        let cut = match &log {
            Some(log) => self.cut.gather(&s.context.transfer, log, &self.points, &settings),
            None => self.cut.gather(&s.context.transfer, &self.shadows, &self.points, &settings),
        };
        let clamps = Clamps::new(&s.context.compensation, &cut.sum.limits, group);
        let points = RecordPoints::new(group, &world.materials);
        let mut hessians = Vec::new();
        if !s.needs_occluders() {
            let places: Vec<_> = group.iter().map(|candidate| (candidate.point, candidate.sample)).collect();
            hessians = OcclusionHessian::at_points(world, &places, s.settings.probe_rays);
        }
        let mut layers = DirectIndirect::<GatheredLayer16>::default();
        let transfer = &s.context.transfer;
        for PacketCluster { node, responses } in cut.clusters {
            let cluster = LitCluster::new(transfer, *node);
            let (origin, kept) = (cluster.node.origin(), cluster.kept(&clamps, responses));
            let light = layers[origin].add(&points, &cluster, responses, &kept);
            OcclusionHessian::add_arriving(&mut hessians, origin, &light);
        }
        if let Some(log) = log {
            hidden(&log.sorted(), transfer, &self.points, &cut, &clamps, &mut layers);
        }
        let mut hessians = hessians.into_iter();
        let mut light = Vec::with_capacity(group.len());
        for (lane, candidate) in group.iter().enumerate() {
            let mut hessian = hessians.next();
            let layers = DirectIndirect::from_fn(|origin| {
                if let Some(hessian) = &mut hessian {
                    hessian.add_held(origin, layers[origin].held(lane));
                }
                layers[origin].layer(&points, lane, cut.clusters.len() as u32, clamps.bound(lane))
            });
            self.series.begin(candidate);
            if self.series.is_wanted() {
                for PacketCluster { node, responses } in
                    cut.clusters.iter().filter(|c| c.responses.get(lane) != Rgb::ZERO)
                {
                    let cluster = LitCluster::new(transfer, *node);
                    self.series.add(&cluster, cluster.kept(&clamps, responses)[lane]);
                }
            }
            light.push(GatheredLight { layers, series: self.series.finish(), hessian });
        }
        light
    }
}

/// Adds the clusters of a cut that are hidden from points to what is known of the distances there.
fn hidden(
    occluders: &OccluderDistances,
    transfer: &Transfer,
    points: &ReceiverPacket,
    cut: &PacketCut,
    clamps: &Clamps,
    layers: &mut DirectIndirect<GatheredLayer16>,
) {
    for PacketCluster { node, responses } in cut.clusters {
        let cluster = LitCluster::new(transfer, *node);
        let (lit, unshadowed) = transfer.unshadowed16(points, cluster.vpl, cluster.node.kind());
        let kept = cluster.kept(clamps, &unshadowed);
        let y = luminance(cluster.node.intensity);
        // A pane may take one colour of light that arrives.
        for lane in lanes_in(lit).filter(|&lane| responses.get(lane) == Rgb::ZERO) {
            let distance = occluders.get(cluster.node, lane);
            layers[cluster.node.origin()].hidden(lane, y * unshadowed.x[lane] * kept[lane], distance);
        }
    }
}
