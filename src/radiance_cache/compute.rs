//! Records by lightcuts.
//!
//! Records close together share a cut, as neighbouring pixels do: its shadow rays are coherent. A record that
//! lacks one layer only cuts only that layer's trees, judged against the light of the other layer, so that
//! each layer masks the other's errors (Herzog et al. 2009, section 6).

use super::compensate::{self, Clamp, Cutters};
use super::footprint::{Footprint, FootprintLimits};
use super::gather::{GatheredLayer, LitCluster};
use super::occluder_distance::{OccluderDistances, OccluderLog};
use super::occlusion_hessian::OcclusionHessian;
use super::record::{Diagnostics, Record};
use super::series::SeriesGatherer;
use super::settings::{CacheSettings, Footprints};
use super::source::{Candidate, LightcutSource, NewRecord, RecordSource};
use crate::hsh::Radiance;
use crate::lightcut::{
    CoherenceLimit, CutCounts, CutSettings, Lightcut, PacketLightcut, Receiver, ReceiverPacket,
    group_coherent,
};
use crate::math::{LANES, LUMINANCE, Rgb, luminance};
use crate::shadow::Engine;
use crate::vpl::{DirectIndirect, Origin};
use glam::{Mat3, Vec3};
use rayon::prelude::*;

impl RecordSource for LightcutSource<'_> {
    fn settings(&self) -> &CacheSettings {
        self.settings
    }

    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        let done: Vec<(Vec<NewRecord>, CutCounts)> = self
            .groups(candidates)
            .par_iter()
            .map_init(|| Workspace::new(self), |work, group| work.compute(self, group))
            .collect();
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
    hessian: Option<Box<OcclusionHessian>>,
}

/// A cut as one of the points that it was refined for sees it.
struct PointCut<'a, C> {
    candidate: &'a Candidate,
    receiver: &'a Receiver<'static>,
    /// Distances to occluders, and the point's lane in them; `None` where they are not needed.
    occluders: Option<(&'a OccluderDistances, usize)>,
    clamp: Clamp,
    /// Number of clusters.
    size: usize,
    /// Indices of the nodes, and the point's responses to their representatives.
    clusters: C,
}

impl LightcutSource<'_> {
    /// Candidates that share a cut: neighbours that lack the same layers.
    pub fn groups(&self, candidates: &[Candidate]) -> Vec<Vec<Candidate>> {
        let place = |candidate: &Candidate| (candidate.point.position, candidate.point.normal);
        let same = |a: &Candidate, b: &Candidate| a.missing == b.missing;
        let candidates = candidates.iter().copied();
        group_coherent(CoherenceLimit::CLOSE, candidates, LANES, self.context.world.diagonal, place, same)
    }

    /// True if footprints depend on the distances of occluders; the distances of probe rays replace those.
    fn needs_occluders(&self) -> bool {
        self.settings.footprints != Footprints::Occlusion
    }

    /// Gathers the light of a cut at one point.
    fn read(
        &self,
        series: &mut SeriesGatherer,
        cut: PointCut<impl Iterator<Item = (u32, Rgb)>>,
    ) -> GatheredLight {
        let PointCut { candidate, receiver, occluders, clamp, size, clusters } = cut;
        let rays = self.settings.probe_rays;
        let hessian = (!self.needs_occluders())
            .then(|| OcclusionHessian::new(self.context.world, &candidate.point, rays, candidate.sample));
        let layer = GatheredLayer { cut: size as u32, bound: clamp.bound(), ..GatheredLayer::default() };
        let layers = DirectIndirect { direct: layer, indirect: layer };
        let mut light =
            GatheredLight { layers, series: DirectIndirect::default(), hessian: hessian.map(Box::new) };
        series.begin(candidate);
        for (node, response) in clusters {
            let node = &self.context.transfer.trees.nodes[node as usize];
            let vpl = &self.context.transfer.trees.vpls[node.representative()];
            let weak = node.is_leaf() && node.origin() == Origin::Indirect;
            // The receiver of irradiance is grey: its response is the geometry term.
            let kept = |irradiance: Rgb, response: Rgb| match weak {
                true => clamp.kept(luminance(irradiance), response.x),
                false => 1.0,
            };
            if response == Rgb::ZERO {
                let Some((distances, lane)) = occluders else { continue };
                let unshadowed = self.context.transfer.unshadowed(receiver, vpl, node.kind());
                let hidden = node.intensity * unshadowed;
                if luminance(hidden) > 0.0 {
                    let luminance = kept(hidden, unshadowed) * luminance(hidden);
                    light.layers[node.origin()].hidden(luminance, distances.get(node, lane));
                }
                continue;
            }
            let irradiance = node.intensity * response;
            let kept = kept(irradiance, response);
            let cluster = LitCluster { transfer: &self.context.transfer, node, vpl, irradiance, kept };
            series.add(&cluster);
            let passed = light.layers[node.origin()].add(candidate, &self.context.world.materials, &cluster);
            if let Some(hessian) = &mut light.hessian {
                hessian.add(&cluster, passed);
            }
        }
        light.series = series.finish();
        light
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
        let limits = FootprintLimits::new(self.settings, origin, candidate.spacing, distance);
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
    single: Lightcut,
    group: PacketLightcut,
    points: ReceiverPacket<'static>,
    series: SeriesGatherer,
}

impl<'w> Workspace<'w> {
    fn new(s: &LightcutSource<'w>) -> Workspace<'w> {
        let shadows = s.settings.shadows;
        Workspace {
            shadows: Engine::with(s.context.world, shadows.for_records(), shadows.cache),
            single: Lightcut::new(),
            group: PacketLightcut::new(),
            points: ReceiverPacket::new(),
            series: SeriesGatherer::default(),
        }
    }

    /// The records of candidates that share a cut.
    fn compute(&mut self, s: &LightcutSource, group: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        self.shadows.begin_chunk();
        (self.single.counts, self.group.counts) = Default::default();
        let cut = CutSettings { origin: group[0].missing.only(), ..s.settings.cut };
        let mut light: Vec<GatheredLight> = if !s.settings.shares(group.len()) {
            group.iter().map(|candidate| self.alone(s, candidate, &cut)).collect()
        } else {
            self.points.set(group.iter().map(Candidate::receiver));
            self.shared(s, group, &cut)
        };
        if let Some(c) = &s.context.compensation {
            let cutters =
                Cutters { single: &mut self.single, group: &mut self.group, points: &mut self.points };
            let mut gathered: Vec<_> = light.iter_mut().map(|light| &mut light.layers).collect();
            compensate::add(c, s, cutters, group, &mut gathered);
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
        let mut counts = self.single.counts;
        counts += self.group.counts;
        (records, counts)
    }

    /// Light at a point by a cut of its own.
    fn alone(&mut self, s: &LightcutSource, candidate: &Candidate, cut: &CutSettings) -> GatheredLight {
        let receiver = &candidate.receiver();
        let rays = s.needs_occluders().then(|| OccluderLog::new(s.context.world));
        let cut = match &rays {
            Some(rays) => self.single.gather(&s.context.transfer, rays, receiver, cut),
            None => self.single.gather(&s.context.transfer, &self.shadows, receiver, cut),
        };
        let occluders = rays.map(OccluderLog::sorted);
        let cut = PointCut {
            candidate,
            receiver,
            occluders: occluders.as_ref().map(|distances| (distances, 0)),
            clamp: compensate::clamp(&s.context.compensation, cut.limit),
            size: cut.clusters.len(),
            clusters: cut.clusters.iter().map(|cluster| (cluster.node, cluster.response)),
        };
        s.read(&mut self.series, cut)
    }

    /// Light at several points, which have been set, by one cut.
    fn shared(&mut self, s: &LightcutSource, group: &[Candidate], cut: &CutSettings) -> Vec<GatheredLight> {
        let rays = s.needs_occluders().then(|| OccluderLog::new(s.context.world));
        let cut = match &rays {
            Some(rays) => self.group.gather(&s.context.transfer, rays, &self.points, cut),
            None => self.group.gather(&s.context.transfer, &self.shadows, &self.points, cut),
        };
        let occluders = rays.map(OccluderLog::sorted);
        let series = &mut self.series;
        let at_lane = |(lane, candidate): (usize, &Candidate)| {
            let cut = PointCut {
                candidate,
                receiver: self.points.get(lane),
                occluders: occluders.as_ref().map(|distances| (distances, lane)),
                clamp: compensate::clamp(&s.context.compensation, cut.sum.limits[lane]),
                size: cut.clusters.len(),
                clusters: cut.clusters.iter().map(|cluster| (cluster.node, cluster.responses.get(lane))),
            };
            s.read(series, cut)
        };
        group.iter().enumerate().map(at_lane).collect()
    }
}
