//! The records of one wave.
//!
//! Records that lie close together share a cut, as neighbouring pixels do: its shadow rays are coherent.
//! A record that lacks one layer only cuts only that layer's trees, judged against what the other is known to give, so
//! that each layer masks the other's errors (Herzog et al. 2009, section 6).

use super::compensate::{Clamp, Compensation, Cutters};
use super::gather::{Gathered, Gatherer};
use super::layer::Layer;
use super::record::{Facts, Footprint, Record};
use super::series::SeriesGatherer;
use super::settings::{CacheSettings, Footprints};
use super::sight::{Change, Sight};
use super::wave::Pick;
use crate::embree::Occluders16;
use crate::eye::EyeSamples;
use crate::hsh::Radiance;
use crate::light_tree::{LightTrees, Node};
use crate::lightcut::group::{
    GroupLightcut, GroupVisibility, LANES, LEAST_SHARED, Lanes, Points, group_alike, shadow_rays,
};
use crate::lightcut::{CutCounts, CutSettings, Lightcut, Reflector, Transfer, Visibility};
use crate::math::{Frame, Rgb, luminance};
use crate::shadow;
use crate::vpl::{Origin, Vpl, VplKind};
use crate::world::World;
use glam::{Mat3, Vec3};
use rayon::prelude::*;
use std::cell::RefCell;

/// What computing records needs.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The scene.
    pub world: &'a World,
    /// Its virtual lights.
    pub trees: &'a LightTrees,
    /// What reaches a point from them.
    pub transfer: Transfer<'a>,
    /// Settings.
    pub settings: &'a CacheSettings,
    /// How clamped light is found again, if it is.
    pub compensation: Option<Compensation>,
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

impl Source<'_> {
    /// Computes the records of a wave, in the order of the picks.
    pub fn records(
        &self,
        samples: &EyeSamples,
        layers: &[Layer; 2],
        picks: &[Pick],
    ) -> (Vec<(Pick, Pair)>, CutCounts) {
        let tasks = self.tasks(samples, picks);
        let done: Vec<(Vec<(Pick, Pair)>, CutCounts)> = tasks
            .par_iter()
            .map_init(Workspace::default, |work, task| {
                let counts = work.counts();
                let pairs = work.compute(self, samples, layers, task);
                (task.iter().copied().zip(pairs).collect(), work.counts().since(&counts))
            })
            .collect();
        let mut counts = CutCounts::default();
        let mut records = Vec::with_capacity(picks.len());
        for (pairs, used) in done {
            counts.add(&used);
            records.extend(pairs);
        }
        (records, counts)
    }

    /// Picks that share a cut: neighbours that lack the same layers.
    fn tasks(&self, samples: &EyeSamples, picks: &[Pick]) -> Vec<Vec<Pick>> {
        let place = |pick: &Pick| {
            let point = &samples.points[pick.sample as usize];
            (point.position, point.normal)
        };
        group_alike(picks.iter().copied(), LANES, self.world.diagonal, place, |a, b| a.lacks == b.lacks)
    }

    /// The record of one layer, or `None` where it would be of no use.
    fn record(&self, samples: &EyeSamples, sample: u32, layer: usize, view: &View) -> Option<Record> {
        let g = &view.gathered[layer];
        let point = &samples.points[sample as usize];
        let luminance = luminance(g.irradiance);
        if !(luminance.is_finite() && g.vector.is_finite() && g.gradient.is_finite()) {
            return None;
        }
        let settings = &self.settings.layers[layer];
        let reach = settings.reach.map(|r| r * point.spacing);
        let normal = point.normal;
        let tangential = |v: Vec3| v - normal * normal.dot(v);
        let mut gradient = Mat3::from_cols(
            tangential(g.gradient.x_axis),
            tangential(g.gradient.y_axis),
            tangential(g.gradient.z_axis),
        );
        let footprint = match &view.sight {
            Some(sight) => {
                let change = sight.change(layer);
                gradient += change.gradient;
                let furthest = settings.accuracy * sight.distance();
                self.seeing(&change, luminance, settings.accuracy, furthest, reach)
            }
            None => {
                let radius = (settings.accuracy * g.distance()).clamp(reach[0], reach[1]);
                self.footprint(normal, gradient * crate::math::LUMINANCE, luminance, radius)
            }
        };
        Some(Record {
            position: point.position,
            normal,
            sharing: point.sharing,
            footprint,
            vector: g.vector,
            gradient,
            luminance,
            facts: Facts { sample, cut: g.cut, clamped: g.clamped, compensated: g.compensated },
        })
    }

    /// An ellipse along whose axes second derivatives change the luminance by half the square of `accuracy`, relatively, no
    /// longer than `furthest`, nor than twice its width.
    fn seeing(
        &self,
        change: &Change,
        luminance: f32,
        accuracy: f32,
        furthest: f32,
        reach: [f32; 2],
    ) -> Footprint {
        let radius = |curvature: f32| {
            let inverse_sq = curvature / (luminance.max(f32::MIN_POSITIVE) * accuracy * accuracy);
            1.0 / (inverse_sq + 1.0 / (furthest * furthest)).sqrt()
        };
        let [short, long] = change.curvature.map(radius);
        let short = short.clamp(reach[0], reach[1]);
        let long = long.min(2.0 * short).clamp(short, reach[1]);
        Footprint {
            axes: change.axes,
            radii: [short, long],
            inverse_normal_tolerance: 1.0 / self.settings.normal_tolerance,
        }
    }

    /// An ellipse of the area of a circle of `radius`, short along the gradient of the luminance.
    fn footprint(&self, normal: Vec3, gradient: Vec3, luminance: f32, radius: f32) -> Footprint {
        let change = radius * gradient.length() / luminance.max(f32::MIN_POSITIVE);
        let (axis, g) = match gradient.try_normalize() {
            Some(axis) if self.settings.footprints == Footprints::Anisotropic => {
                let relative = change / self.settings.mu;
                (axis, (1.0 / (1.0 + relative * relative)).max(0.3))
            }
            _ => (Frame::from_normal(normal).tangent, 1.0),
        };
        Footprint {
            axes: [axis, normal.cross(axis)],
            radii: [radius * g, radius / g],
            inverse_normal_tolerance: 1.0 / self.settings.normal_tolerance,
        }
    }
}

/// A thread's buffers.
#[derive(Default)]
struct Workspace {
    single: Lightcut,
    group: GroupLightcut,
    points: Points<'static>,
    series: SeriesGatherer,
}

impl Workspace {
    fn counts(&self) -> CutCounts {
        let mut counts = self.single.counts;
        counts.add(&self.group.counts);
        counts
    }

    fn compute(&mut self, s: &Source, samples: &EyeSamples, layers: &[Layer; 2], task: &[Pick]) -> Vec<Pair> {
        let collectors = task.iter().map(|pick| {
            let i = pick.sample as usize;
            let point = &samples.points[i];
            let frame = Frame::from_normal(point.normal);
            let known = [0, 1].map(|l| match layers[l].sums[i].mean() {
                Some(irradiance) if !pick.lacks[l] => luminance(irradiance),
                _ => 0.0,
            });
            Reflector::collector(point.position, samples.surfaces[i].geometric_normal, &frame)
                .knowing(known[0] + known[1])
        });
        let only = match task[0].lacks {
            [true, false] => Some(Origin::Direct),
            [false, true] => Some(Origin::Indirect),
            _ => None,
        };
        let cut = CutSettings { only, ..s.settings.cut };
        let mut views: Vec<View> = if task.len() < LEAST_SHARED {
            collectors.zip(task).map(|(c, pick)| self.alone(s, samples, pick, &c, &cut)).collect()
        } else {
            self.points.set(collectors);
            self.shared(s, samples, task, &cut)
        };
        if let Some(compensation) = s.compensation {
            let cutters =
                Cutters { single: &mut self.single, group: &mut self.group, points: &mut self.points };
            let mut indirect: Vec<_> = views.iter_mut().map(|view| &mut view.gathered[1]).collect();
            compensation.add(s, cutters, samples, task, &mut indirect);
        }
        let record = |(pick, mut view): (&Pick, View)| {
            [0, 1].map(|l| {
                let record =
                    if pick.lacks[l] { s.record(samples, pick.sample, l, &view)? } else { return None };
                Some(Made { record, series: view.series[l].take() })
            })
        };
        task.iter().zip(views).map(record).collect()
    }

    fn alone(
        &mut self,
        s: &Source,
        samples: &EyeSamples,
        pick: &Pick,
        collector: &Reflector<'static>,
        cut: &CutSettings,
    ) -> View {
        let rays = OccluderLog::new(s.world);
        self.single.gather(s.trees, &s.transfer, &rays, collector, cut);
        let log = rays.sorted();
        let gatherer = s.gatherer(samples, pick.sample, collector);
        let clamp = s.clamp(self.single.limit());
        let mut view = s.view(samples, pick.sample, self.single.entries().len(), clamp);
        let series = &mut self.series;
        series.begin(&samples.points[pick.sample as usize]);
        for entry in self.single.entries() {
            s.add((&mut view, series), &gatherer, entry.node, entry.response, clamp, (&log, 0));
        }
        view.series = series.finish();
        view
    }

    fn shared(&mut self, s: &Source, samples: &EyeSamples, task: &[Pick], cut: &CutSettings) -> Vec<View> {
        let rays = OccluderLog::new(s.world);
        let mut irradiance = [Rgb::ZERO; LANES];
        self.group.gather(s.trees, &s.transfer, &rays, &self.points, cut, &mut irradiance);
        let log = rays.sorted();
        let series = &mut self.series;
        let lane = |(lane, pick): (usize, &Pick)| {
            let gatherer = s.gatherer(samples, pick.sample, self.points.get(lane));
            let clamp = s.clamp(self.group.limit(lane));
            let mut view = s.view(samples, pick.sample, self.group.size(), clamp);
            series.begin(&samples.points[pick.sample as usize]);
            for (node, responses) in self.group.entries() {
                let response = Rgb::from_array(std::array::from_fn(|c| responses[c][lane]));
                s.add((&mut view, series), &gatherer, node, response, clamp, (&log, lane));
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
    fn view(&self, samples: &EyeSamples, sample: u32, cut: usize, clamp: Clamp) -> View {
        let sight = (self.settings.footprints == Footprints::Occlusion).then(|| {
            let point = &samples.points[sample as usize];
            let geometric_normal = samples.surfaces[sample as usize].geometric_normal;
            Box::new(Sight::new(self.world, point.position, geometric_normal, point.normal, sample))
        });
        let gathered = Gathered { cut: cut as u32, bound: clamp.bound(), ..Gathered::default() };
        View { gathered: [gathered; 2], series: [None, None], sight }
    }

    fn gatherer(&self, samples: &EyeSamples, sample: u32, collector: &Reflector<'static>) -> Gatherer<'a> {
        let point = &samples.points[sample as usize];
        Gatherer {
            collector: *collector,
            position: point.position,
            normal: point.normal,
            coat: point.sharing.coat(),
            materials: &self.world.materials,
        }
    }

    /// How indirect leaves are clamped where none may give more than the luminance `limit`.
    fn clamp(&self, limit: f32) -> Clamp {
        self.compensation.map_or(Clamp::Luminance(limit), |c| c.clamp(limit))
    }

    #[inline]
    fn add(
        &self,
        (view, series): (&mut View, &mut SeriesGatherer),
        g: &Gatherer,
        node: u32,
        response: Rgb,
        clamp: Clamp,
        (log, lane): (&[(u32, Lanes)], usize),
    ) {
        let node = &self.trees.nodes[node as usize];
        let vpl = &self.trees.vpls[node.representative()];
        let number = layer_of(node.origin());
        let layer = &mut view.gathered[number];
        let weak = node.is_leaf() && node.origin() == Origin::Indirect;
        if response == Rgb::ZERO {
            let would_be = self.transfer.unshadowed(&g.collector, vpl, node.kind());
            let hidden = luminance(node.intensity * would_be);
            if hidden > 0.0 {
                let kept = if weak { clamp.kept(hidden, would_be.x) } else { 1.0 };
                layer.hidden(kept * hidden, occluder_distance(log, node, lane));
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

/// Visibility in the scene that notes how far away occluders are.
struct OccluderLog<'w> {
    world: &'w World,
    /// Representative, and the distance to what hides it from each lane, or infinity.
    log: RefCell<Vec<(u32, Lanes)>>,
}

impl<'w> OccluderLog<'w> {
    fn new(world: &'w World) -> OccluderLog<'w> {
        OccluderLog { world, log: RefCell::new(Vec::new()) }
    }

    /// What was noted, sorted by representative.
    fn sorted(self) -> Vec<(u32, Lanes)> {
        let mut log = self.log.into_inner();
        log.sort_unstable_by_key(|entry| entry.0);
        log
    }
}

/// Distance to what hides a representative from a lane; infinite if nothing does.
fn occluder_distance(log: &[(u32, Lanes)], node: &Node, lane: usize) -> f32 {
    let found = log.binary_search_by_key(&(node.representative() as u32), |entry| entry.0);
    found.map_or(f32::INFINITY, |i| log[i].1[lane])
}

impl Visibility for OccluderLog<'_> {
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool {
        let ray = match node.kind() {
            VplKind::Oriented => shadow::segment(x, normal, vpl.position, vpl.normal()),
            VplKind::Omni => shadow::segment(x, normal, vpl.position, Vec3::ZERO),
            VplKind::Directional => shadow::ray_from(x, normal, vpl.position),
        };
        match self.world.accel.occluder(&ray) {
            Some(occluder) => {
                let distance = occluder.t * ray.direction.length();
                self.log.borrow_mut().push((node.representative() as u32, [distance; LANES]));
                false
            }
            None => true,
        }
    }
}

impl GroupVisibility for OccluderLog<'_> {
    fn visible16(&self, points: &Points, lanes: u16, vpl: &Vpl, node: &Node) -> u16 {
        let rays = shadow_rays(points, lanes, vpl, node.kind());
        let mut found = Occluders16::default();
        let occluded = lanes & self.world.accel.occluders16(&rays, lanes, true, &mut found);
        if occluded != 0 {
            let mut distances = [f32::INFINITY; LANES];
            for (lane, distance) in distances.iter_mut().enumerate() {
                let direction =
                    Vec3::new(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]);
                if occluded >> lane & 1 != 0 {
                    *distance = found.t[lane] * direction.length();
                }
            }
            self.log.borrow_mut().push((node.representative() as u32, distances));
        }
        lanes & !occluded
    }
}
