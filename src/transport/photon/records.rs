//! Records of indirect light by final gathering, and records of direct light by cuts.
//!
//! Papers: Jensen 1996; Krivanek et al. 2005; Herzog et al. 2009, section 7 (method PM).
//! Deviations: for the series of glossy surfaces, the surface seen in a stratum is a patch that stays in
//! place as the point moves, like the virtual lights of lightcuts. So these gradients ignore the edges of occluders.

use super::hemisphere::{GatherPoint, GatheredIrradiance, gather};
use super::indirect_light::{GatherCounts, IndirectLight};
use super::strata::{Strata, StrataHits};
use crate::eye::edge_class;
use crate::gradient::Incidence;
use crate::hsh::Radiance;
use crate::lightcut::CutCounts;
use crate::lights::{DirectIndirect, Origin};
use crate::radiance_cache::cells::Candidate;
use crate::radiance_cache::compute::{LightcutSource, RecordSource};
use crate::radiance_cache::footprint::{Footprint, FootprintLimits};
use crate::radiance_cache::occlusion_hessian::OcclusionHessian;
use crate::radiance_cache::record::{Diagnostics, NewRecord, Record};
use crate::radiance_cache::series::SeriesGatherer;
use crate::radiance_cache::{CacheSettings, CellLimits, Footprints};
use base::math::{LUMINANCE, luminance};
use base::sampling::hash;
use glam::Vec3;
use rayon::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};
use world::SurfacePoint;

/// Minimum cosine in denominators, at the point and at the patches that it sees.
const MIN_COS: f32 = 0.05;

/// Source of records of indirect light by final gathering.
pub struct FinalGatherSource<'w> {
    /// Direct light, by cuts.
    pub direct: LightcutSource<'w>,
    /// Indirect light.
    pub light: IndirectLight<'w>,
    strata: Strata,
    seed: u32,
    counts: Mutex<GatherCounts>,
}

impl<'w> FinalGatherSource<'w> {
    /// Creates a source that gathers in the directions of `strata`; `seed` determines the directions within each
    /// stratum.
    pub fn new(
        direct: LightcutSource<'w>,
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

/// Buffers of one thread.
#[derive(Default)]
struct GatherWorkspace {
    met: StrataHits,
    series: SeriesGatherer,
}

impl RecordSource for FinalGatherSource<'_> {
    fn settings(&self) -> &CacheSettings {
        self.direct.settings
    }

    fn cells(&self) -> CellLimits {
        self.direct.cells()
    }

    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts) {
        let direct: Vec<Candidate> = candidates
            .iter()
            .filter(|candidate| candidate.missing.direct)
            .map(|c| Candidate { missing: DirectIndirect { direct: true, indirect: false }, ..*c })
            .collect();
        let (mut records, counts) = self.direct.records(&direct);
        let indirect: Vec<(Option<NewRecord>, GatherCounts)> = candidates
            .par_iter()
            .filter(|candidate| candidate.missing.indirect)
            .map_init(GatherWorkspace::default, |work, candidate| {
                let mut counts = GatherCounts::default();
                (self.indirect(work, candidate, &mut counts), counts)
            })
            .collect();
        let mut gathered = self.counts();
        for (new, used) in indirect {
            *gathered += used;
            records.extend(new);
        }
        (records, counts)
    }
}

impl FinalGatherSource<'_> {
    fn indirect(
        &self,
        work: &mut GatherWorkspace,
        candidate: &Candidate,
        counts: &mut GatherCounts,
    ) -> Option<NewRecord> {
        let &Candidate { sample, point, coat, edges, bands, .. } = candidate;
        let settings = self.settings();
        let limits = |distance| FootprintLimits::new(settings, Origin::Indirect, candidate, distance);
        let max_nearness = 1.0 / limits(0.0).radii[0].max(f32::MIN_POSITIVE);
        let at = GatherPoint { point, coat, seed: hash(sample, self.seed), max_nearness };
        let g = gather(&self.light.within(edges), &self.strata, &at, &mut work.met, counts);
        let luminance = luminance(g.irradiance);
        if !(luminance.is_finite() && g.vector.is_finite() && g.gradient.is_finite()) {
            return None;
        }
        let GatheredIrradiance { vector, gradient, distance, .. } = g;
        let footprint = if settings.footprints == Footprints::Occlusion {
            let derivatives = self.hessian(candidate, &work.met).derivatives(Origin::Indirect);
            Footprint::from_hessian(&derivatives, luminance, &limits(distance))
        } else {
            Footprint::from_gradient(point.normal, gradient * LUMINANCE, luminance, &limits(distance))
        };
        let diagnostics = Diagnostics { cut: self.strata.len() as u32, distance, ..Diagnostics::default() };
        let (SurfacePoint { position, normal, .. }, edge_class) = (point, edge_class(edges));
        let record = Record {
            position,
            normal,
            coat,
            edge_class,
            bands,
            footprint,
            vector,
            gradient,
            luminance,
            diagnostics,
        };
        let series = work.series(&self.strata, candidate, max_nearness);
        Some(NewRecord { origin: Origin::Indirect, sample, record, series })
    }

    /// Returns the second derivatives of the gathered light. Its gradient is that of the strata, which includes the
    /// edges of occluders.
    fn hessian(&self, candidate: &Candidate, met: &StrataHits) -> OcclusionHessian {
        let rays = self.settings().probe_rays;
        let point = [(candidate.point, candidate.sample)];
        let mut hessian = OcclusionHessian::at_points(self.light.world, &point, rays).remove(0);
        let measure = self.strata.measure();
        for (i, &nearness) in met.nearness.iter().enumerate() {
            if nearness > 0.0 {
                let (offset, irradiance) = (met.direction[i] / nearness, met.radiance[i] * measure);
                hessian.add_patch(Origin::Indirect, offset, met.normal[i], irradiance);
            }
        }
        hessian
    }
}

impl GatherWorkspace {
    /// Returns the gathered light as a series, if the point needs one.
    fn series(&mut self, strata: &Strata, candidate: &Candidate, max_nearness: f32) -> Option<Radiance> {
        self.series.begin(candidate);
        if !self.series.is_wanted() {
            return None;
        }
        let met = &self.met;
        for (i, direction) in met.direction.iter().enumerate() {
            let solid_angle = strata.measure() / direction.z.max(MIN_COS);
            let incidence = patch(*direction, met.nearness[i].min(max_nearness), met.normal[i], solid_angle);
            self.series.add_incidence(Origin::Indirect, &incidence, met.radiance[i]);
        }
        self.series.finish().indirect
    }
}

/// Returns the light of unit radiance from a patch of surface seen under a solid angle, and its derivatives as the
/// point moves.
fn patch(direction: Vec3, nearness: f32, normal: Vec3, solid_angle: f32) -> Incidence {
    let cos = -direction.dot(normal);
    let slope = match nearness > 0.0 {
        true => (direction * 3.0 + normal / cos.max(MIN_COS)) * (nearness * solid_angle),
        false => Vec3::ZERO,
    };
    let gradient = [slope.x, slope.y];
    Incidence { direction: direction.to_array(), inv_dist: nearness, factor: solid_angle, gradient }
}
