//! The cache from its first wave to the pixels, whatever its records are computed from.

use super::adapt::Seam;
use super::compute::RecordSource;
use super::placement::{Pick, lacking, pick};
use super::record::Record;
use super::series::Glossy;
use super::splat::Layer;
use super::{CacheSettings, FoundBy, adapt};
use crate::eye::{EyePass, PointGeometry, PointSurface};
use crate::lightcut::CutCounts;
use crate::math::{Rgb, luminance};
use crate::method::counts;
use crate::progress::Control;
use crate::shade::{Picture, ShadingTask};
use crate::stats::{Stage, Stats};
use crate::vpl::Origin;

/// What each layer holds.
const LAYERS: [Origin; 2] = [Origin::Direct, Origin::Indirect];

/// Level of the coarsest cells.
const FIRST_LEVEL: u32 = 5;

/// Both layers, and what else is known of each eye sample.
pub struct Cache {
    /// Direct, indirect.
    pub layers: [Layer; 2],
    /// Surfaces whose lobes records light too.
    glossy: Option<Glossy>,
    /// How direct and indirect light is found.
    found: [FoundBy; 2],
    /// Samples that records light: those with a base or a lobe broad enough.
    wants: Vec<bool>,
    /// Where records disagreed before each pass of adaptation.
    pub seams: Vec<Vec<Seam>>,
    counts: CutCounts,
}

impl Cache {
    /// A cache filled from `source`, adapted and filled again.
    pub fn complete(
        source: &impl RecordSource,
        samples: &EyePass,
        glossy: Option<Glossy>,
        control: &Control,
        stats: &mut Stats,
    ) -> Cache {
        let settings = source.settings();
        let mut cache = Cache::new(samples, glossy, [settings.found(0), settings.found(1)]);
        if cache.found == [FoundBy::Cuts; 2] {
            return cache;
        }
        control.begin(Stage::Records, samples.len() as u64);
        cache.fill(source, samples, control, stats);
        for _ in 0..settings.passes {
            if control.is_cancelled() || !cache.adapt(settings, samples, stats) {
                break;
            }
            cache.fill(source, samples, control, stats);
        }
        cache.report(stats);
        cache
    }

    /// A cache without records yet.
    pub fn new(samples: &EyePass, glossy: Option<Glossy>, found: [FoundBy; 2]) -> Cache {
        let lit = |(point, surface): (&PointGeometry, &PointSurface)| {
            point.sharing.bands() > 0 || surface.bsdf.split_base(1.0).0 != Rgb::ZERO
        };
        let wants = samples.points.geometry.iter().zip(&samples.points.surfaces).map(lit).collect();
        let layers = [Layer::new(samples), Layer::new(samples)];
        Cache { layers, glossy, found, wants, seams: Vec::new(), counts: CutCounts::default() }
    }

    /// Which layers a sample is to have.
    fn wanted(&self, sample: usize) -> [bool; 2] {
        self.found.map(|found| self.wants[sample] && found == FoundBy::Records)
    }

    /// Computes and splats records until every cell worth one is covered.
    fn fill(&mut self, source: &impl RecordSource, samples: &EyePass, control: &Control, stats: &mut Stats) {
        let count = samples.len();
        let mut level = FIRST_LEVEL;
        while count >> level >= source.settings().least_cell.max(1) as usize {
            for parity in 0..2 {
                if control.is_cancelled() {
                    return;
                }
                let picks: Vec<Pick> = stats
                    .time(Stage::Splat, || pick(samples, &self.layers, |i| self.wanted(i), level, parity));
                let (mut records, counts) =
                    stats.time(Stage::Records, || source.records(samples, &self.layers, &picks));
                self.counts += counts;
                stats.time(Stage::Splat, || {
                    for (l, layer) in self.layers.iter_mut().enumerate() {
                        layer.splat(samples, records.iter_mut().filter_map(|(_, pair)| pair[l].take()));
                    }
                });
            }
            level += 1;
        }
    }

    /// Shrinks footprints at visible seams; false if there are none.
    fn adapt(&mut self, settings: &CacheSettings, samples: &EyePass, stats: &mut Stats) -> bool {
        stats.time(Stage::Splat, || {
            let threshold = settings.threshold;
            let seams = adapt::seams(samples, &self.layers, self.glossy.as_ref(), threshold);
            let least = settings.reach.map(|[least, _]| least);
            let changed = adapt::shrink(samples, &mut self.layers, &seams, least);
            for layer in &mut self.layers {
                layer.resplat(samples, &changed);
            }
            self.seams.push(seams);
            changed.contains(&true)
        })
    }

    fn report(&self, stats: &mut Stats) {
        stats.count("Cache/records, direct", self.layers[0].records.len() as u64);
        stats.count("Cache/records, indirect", self.layers[1].records.len() as u64);
        let series = self.layers.iter().map(Layer::series_count).sum::<usize>();
        if self.glossy.is_some() {
            stats.count("Cache/records with series", series as u64);
        }
        let mut seams: Vec<u32> = self.seams.last().into_iter().flatten().map(|s| s.sample).collect();
        seams.dedup();
        stats.count("Cache/samples at seams", seams.len() as u64);
        counts::cuts(stats, "Records", &self.counts);
        for (layer, name) in self.layers.iter().zip(["direct", "indirect"]) {
            shapes(&layer.records, name, stats);
        }
        let sum = |f: &dyn Fn(&Record) -> f32| self.layers[1].records.iter().map(|r| f64::from(f(r))).sum();
        let total: f64 = sum(&|r| r.luminance + r.facts.clamped - r.facts.compensated);
        let clamped: f64 = sum(&|r| r.facts.clamped);
        let compensated: f64 = sum(&|r| r.facts.compensated);
        let percent = 100.0 / if total > 0.0 { total } else { 1.0 };
        stats.add("Records/indirect light lost to clamping [%]", percent * clamped);
        stats.add("Records/found again by short rays [%]", percent * compensated);
    }

    /// Adds what records give to the pixels; the rest is left to cuts.
    pub fn resolve(&self, samples: &EyePass, picture: &mut Picture) -> Vec<ShadingTask> {
        let lobes = self.glossy.as_ref().map(|glossy| glossy.lobes(samples, &self.layers));
        let mut tasks = Vec::new();
        // The only layer that records light, and the only one that they leave.
        let (recorded, left) = match self.found {
            [FoundBy::Records, FoundBy::Cuts] => (Some(Origin::Direct), Some(Origin::Indirect)),
            [FoundBy::Cuts, FoundBy::Records] => (Some(Origin::Indirect), Some(Origin::Direct)),
            _ => (None, None),
        };
        for (i, surface) in samples.points.surfaces.iter().enumerate() {
            let point = i as u32;
            let (base, lobe) = surface.bsdf.split_base(surface.out.dot(samples.points.geometry[i].normal));
            let mut baseline_luminance = 0.0;
            if self.wants[i] {
                if lacking(&self.layers, self.wanted(i), i) != [false; 2] {
                    tasks.push(ShadingTask::all(point));
                    continue;
                }
                let mean = |l: usize| self.layers[l].sums[i].mean().unwrap_or(Rgb::ZERO);
                let reflected = lobes.as_ref().map_or(Rgb::ZERO, |lobes| lobes[i]);
                baseline_luminance = luminance(base * (mean(0) + mean(1)) + reflected);
                for (l, origin) in LAYERS.into_iter().enumerate() {
                    picture.add(samples, i, Some(origin), base * mean(l));
                }
                picture.add(samples, i, recorded, reflected);
            }
            if self.found.contains(&FoundBy::Cuts) {
                tasks.push(ShadingTask { point, lobe_only: false, origin: left, baseline_luminance });
            }
            if self.found.contains(&FoundBy::Records)
                && lobe.is_some()
                && samples.points.geometry[i].sharing.bands() == 0
            {
                tasks.push(ShadingTask { point, lobe_only: true, origin: recorded, baseline_luminance });
            }
        }
        tasks
    }
}

/// Means over a layer's records: clusters or rays, anisotropy, and radius (of the circle of the same area) over the
/// distance of what casts light and shadow.
fn shapes(records: &[Record], layer: &str, stats: &mut Stats) {
    let mut mean = |what: &str, of: &dyn Fn(&Record) -> f32| {
        let values = records.iter().map(|r| f64::from(of(r))).filter(|value| value.is_finite());
        let (sum, count) = values.fold((0.0, 0u64), |(sum, count), value| (sum + value, count + 1));
        if count > 0 {
            stats.add(&format!("Cache/{what}, {layer}"), sum / count as f64);
        }
    };
    mean("cut or rays", &|r| r.facts.cut as f32);
    mean("anisotropy", &|r| {
        r.footprint.radii[0].max(r.footprint.radii[1]) / r.footprint.radii[0].min(r.footprint.radii[1])
    });
    mean("accuracy", &|r| (r.footprint.radii[0] * r.footprint.radii[1]).sqrt() / r.facts.distance);
}
