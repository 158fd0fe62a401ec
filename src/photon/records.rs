//! Records of indirect light by final gathering; those of direct light by cuts.
//!
//! Papers: Jensen 1996; Krivanek et al. 2005; Herzog et al. 2009, section 7 (the method they call PM).
//! Deviations: for the series of glossy surfaces, the surface seen in a stratum is a patch that stays in
//! place as the point moves (as the virtual lights of `cache` do), so that these gradients ignore the edges
//! of occluders.

use super::hemisphere::{GatherPoint, GatheredIrradiance, gather};
use super::indirect_light::{GatherCounts, IndirectLight};
use super::strata::{Met, Strata};
use crate::eye::{EyePass, PointGeometry};
use crate::gradient::Incidence;
use crate::lightcut::CutCounts;
use crate::math::{LUMINANCE, luminance};
use crate::radiance_cache::compute::{Made, Pair, RecordSource, Source};
use crate::radiance_cache::footprint::Footprint;
use crate::radiance_cache::occlusion_hessian::Sight;
use crate::radiance_cache::placement::Pick;
use crate::radiance_cache::record::{Facts, Record};
use crate::radiance_cache::series::SeriesGatherer;
use crate::radiance_cache::splat::Layer;
use crate::radiance_cache::{CacheSettings, Footprints};
use crate::sampling::hash;
use glam::Vec3;
use rayon::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Minimum cosine in denominators, at the point and at the patches that it sees.
const MIN_COS: f32 = 0.05;

/// Source of records of indirect light by final gathering.
pub struct FinalGatherSource<'w> {
    /// Direct light, by cuts.
    pub direct: Source<'w>,
    /// Indirect light.
    pub light: IndirectLight<'w>,
    strata: Strata,
    seed: u32,
    counts: Mutex<GatherCounts>,
}

impl<'w> FinalGatherSource<'w> {
    /// Creates a source whose directions of gathering are `strata`; `seed` determines the directions within
    /// them.
    pub fn new(
        direct: Source<'w>,
        light: IndirectLight<'w>,
        strata: Strata,
        seed: u32,
    ) -> FinalGatherSource<'w> {
        FinalGatherSource { direct, light, strata, seed, counts: Mutex::default() }
    }

    /// Counts of gathering so far.
    pub fn counts(&self) -> MutexGuard<'_, GatherCounts> {
        self.counts.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A thread's buffers.
#[derive(Default)]
struct GatherWorkspace {
    met: Met,
    series: SeriesGatherer,
}

impl RecordSource for FinalGatherSource<'_> {
    fn settings(&self) -> &CacheSettings {
        self.direct.settings
    }

    fn records(
        &self,
        samples: &EyePass,
        layers: &[Layer; 2],
        picks: &[Pick],
    ) -> (Vec<(Pick, Pair)>, CutCounts) {
        let direct: Vec<Pick> = picks
            .iter()
            .filter(|pick| pick.lacks[0])
            .map(|pick| Pick { lacks: [true, false], ..*pick })
            .collect();
        let (mut records, counts) = self.direct.records(samples, layers, &direct);
        let indirect: Vec<(Pick, Pair, GatherCounts)> = picks
            .par_iter()
            .filter(|pick| pick.lacks[1])
            .map_init(GatherWorkspace::default, |work, pick| {
                let mut counts = GatherCounts::default();
                let made = self.indirect(work, samples, pick.sample, &mut counts);
                (*pick, [None, made], counts)
            })
            .collect();
        let mut gathered = self.counts();
        for (pick, pair, used) in indirect {
            *gathered += used;
            records.push((pick, pair));
        }
        (records, counts)
    }
}

impl FinalGatherSource<'_> {
    fn indirect(
        &self,
        work: &mut GatherWorkspace,
        samples: &EyePass,
        sample: u32,
        counts: &mut GatherCounts,
    ) -> Option<Made> {
        let point = &samples.points.geometry[sample as usize];
        let settings = self.settings();
        let accuracy = settings.accuracy[1];
        let reach = settings.reach[1].map(|r| r * point.spacing);
        let geometric_normal = samples.points.surfaces[sample as usize].geometric_normal;
        let max_nearness = 1.0 / reach[0].max(f32::MIN_POSITIVE);
        let at = GatherPoint { point, geometric_normal, seed: hash(sample, self.seed), max_nearness };
        let g = gather(&self.light, &self.strata, &at, &mut work.met, counts);
        let luminance = luminance(g.irradiance);
        if !(luminance.is_finite() && g.vector.is_finite() && g.gradient.is_finite()) {
            return None;
        }
        let footprint = if settings.footprints == Footprints::Occlusion {
            let change = self.sight(point, geometric_normal, sample, &work.met).change(1);
            let furthest = accuracy * g.distance;
            Footprint::of_change(&change, luminance, accuracy, furthest, reach, settings)
        } else {
            let radius = (accuracy * g.distance).clamp(reach[0], reach[1]);
            Footprint::of_gradient(point.normal, g.gradient * LUMINANCE, luminance, radius, settings)
        };
        let GatheredIrradiance { vector, gradient, .. } = g;
        let facts = Facts { sample, cut: self.strata.len() as u32, distance: g.distance, ..Facts::default() };
        let (position, normal, sharing) = (point.position, point.normal, point.sharing);
        let record = Record { position, normal, sharing, footprint, vector, gradient, luminance, facts };
        work.series(&self.strata, point, max_nearness);
        let [_, series] = work.series.finish();
        Some(Made { record, series })
    }
}

impl FinalGatherSource<'_> {
    /// Returns the surfaces visible from the point, with the light found. Its gradient is that of the strata,
    /// which includes the edges of occluders.
    fn sight(&self, point: &PointGeometry, geometric_normal: Vec3, seed: u32, met: &Met) -> Sight {
        let (at, rays) = ((point.position, geometric_normal), self.settings().probe_rays);
        let mut sight = Sight::new(self.light.world, at, point.normal, rays, seed);
        let measure = self.strata.measure();
        for (i, &nearness) in met.nearness.iter().enumerate() {
            if nearness > 0.0 {
                sight.add_patch(1, met.direction[i] / nearness, met.normal[i], met.radiance[i] * measure);
            }
        }
        sight
    }
}

impl GatherWorkspace {
    /// Adds the light found to the series, if the point is to have one.
    fn series(&mut self, strata: &Strata, point: &PointGeometry, max_nearness: f32) {
        self.series.begin(point);
        if self.series.place().is_none() {
            return;
        }
        let met = &self.met;
        for (i, direction) in met.direction.iter().enumerate() {
            let solid_angle = strata.measure() / direction.z.max(MIN_COS);
            let incidence = patch(*direction, met.nearness[i].min(max_nearness), met.normal[i], solid_angle);
            self.series.add_incidence(1, &incidence, met.radiance[i]);
        }
    }
}

/// Returns the light of unit radiance from a patch of surface seen under a solid angle, and its change as the
/// point moves.
fn patch(direction: Vec3, nearness: f32, normal: Vec3, solid_angle: f32) -> Incidence<f32> {
    let cos = -direction.dot(normal);
    let slope = match nearness > 0.0 {
        true => (direction * 3.0 + normal / cos.max(MIN_COS)) * (nearness * solid_angle),
        false => Vec3::ZERO,
    };
    let gradient = [slope.x, slope.y];
    Incidence { direction: direction.to_array(), inv_dist: nearness, factor: solid_angle, gradient }
}
