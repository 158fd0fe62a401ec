//! Cache of one frame: records are placed and splatted until every cell of sufficient size is covered, and then
//! adapted.
//!
//! Paper: Herzog et al. 2009, sections 5.2 and 6.
//!
//! The records outlive the frame (see [`super::store`]). This part depends on the eye samples of the frame.

use super::adapt::{self, Discontinuity};
use super::cells::CellLimits;
use super::compute::RecordSource;
use super::placement::{CandidateStep, candidates};
use super::record::Record;
use super::settings::CacheSettings;
use super::splat::Splat;
use super::store::Records;
use super::targets::Targets;
use crate::lightcut::CutCounts;
use crate::lights::{DirectIndirect, Origin};
use base::progress::Control;
use base::stats::{Stage, Stats};
use std::f32::consts::PI;

/// Minimum index level of cells that get candidates.
const FIRST_LEVEL: u32 = 5;

/// Records as they light the eye samples of one frame.
pub struct CacheFrame<'a> {
    pub(super) targets: Targets<'a>,
    /// Layers that have records.
    pub(super) cached: DirectIndirect<bool>,
    pub(super) splats: DirectIndirect<Splat>,
    /// Eye samples at which records were computed.
    pub(super) placed: DirectIndirect<Vec<u32>>,
    /// Discontinuities between records before each pass of adaptation.
    pub(super) discontinuities: Vec<Vec<Discontinuity>>,
    /// Work counts of the records' cuts.
    pub cuts: CutCounts,
}

impl<'a> CacheFrame<'a> {
    /// Adds records from `source` until the eye samples are covered. Then shrinks their footprints and covers the
    /// samples that this uncovers.
    pub fn fill(
        targets: Targets<'a>,
        records: &mut Records,
        source: &dyn RecordSource,
        control: &Control,
        stats: &mut Stats,
    ) -> CacheFrame<'a> {
        let settings = source.settings();
        let splats = records.as_ref().map(|store| Splat::new(&targets, store));
        let mut frame = CacheFrame {
            targets,
            cached: settings.cached(),
            splats,
            placed: DirectIndirect::default(),
            discontinuities: Vec::new(),
            cuts: CutCounts::default(),
        };
        control.begin(Stage::Records, frame.targets.points.len() as u64);
        frame.cover(records, source, control, stats);
        for _ in 0..settings.passes {
            if control.is_cancelled() || !frame.adapt(records, settings, stats) {
                break;
            }
            frame.cover(records, source, control, stats);
        }
        frame.report(records, stats);
        frame
    }

    /// Computes and splats records until every cell of at least `least_cell` samples is covered.
    fn cover(
        &mut self,
        records: &mut Records,
        source: &dyn RecordSource,
        control: &Control,
        stats: &mut Stats,
    ) {
        let count = self.targets.points.len();
        let reach = source.settings().farthest();
        let CellLimits { least, least_lacking, .. } = source.cells();
        let least_cell = least.max(1) as usize;
        let mut level = first_level(count, least_cell, reach);
        while count >> level >= least_cell {
            for parity in 0..2 {
                if control.is_cancelled() {
                    return;
                }
                let candidates = stats.time(Stage::Splat, || {
                    candidates(
                        &self.targets,
                        &self.splats,
                        self.cached,
                        reach,
                        CandidateStep { level, parity, least_lacking },
                    )
                });
                let (new, cuts) = stats.time(Stage::Records, || source.records(&candidates));
                self.cuts += cuts;
                stats.time(Stage::Splat, || {
                    let first = records.as_ref().map(|store| store.records.len() as u32);
                    for new in new {
                        self.placed[new.origin].push(new.sample);
                        records[new.origin].push(new);
                    }
                    for origin in Origin::ALL {
                        self.splats[origin].add(&self.targets, &records[origin], first[origin]);
                    }
                });
            }
            level += 1;
        }
    }

    /// Shrinks footprints at visible discontinuities; returns false if there are none.
    fn adapt(&mut self, records: &mut Records, settings: &CacheSettings, stats: &mut Stats) -> bool {
        stats.time(Stage::Splat, || {
            let discontinuities = adapt::discontinuities(&self.targets, records, &self.splats);
            let changed = adapt::shrink(&self.targets, records, &discontinuities, settings);
            for origin in Origin::ALL {
                self.splats[origin].renew(&self.targets, &records[origin], &changed);
            }
            self.discontinuities.push(discontinuities);
            changed.contains(&true)
        })
    }

    fn report(&self, records: &Records, stats: &mut Stats) {
        stats.count("Cache/records, direct", records.direct.records.len() as u64);
        stats.count("Cache/records, indirect", records.indirect.records.len() as u64);
        if self.targets.glossy.is_some() {
            let series = records.direct.series_count() + records.indirect.series_count();
            stats.count("Cache/records with series", series as u64);
        }
        let last = self.discontinuities.last();
        let mut seams: Vec<u32> =
            last.into_iter().flatten().map(|discontinuity| discontinuity.sample).collect();
        seams.dedup();
        stats.count("Cache/samples at seams", seams.len() as u64);
        shapes(&records.direct.records, "direct", stats);
        shapes(&records.indirect.records, "indirect", stats);
        let indirect = records.indirect.records.iter();
        let sum = |f: fn(&Record) -> f32| indirect.clone().map(|r| f64::from(f(r))).sum::<f64>();
        let total = sum(|r| r.luminance + r.diagnostics.clamped - r.diagnostics.compensated);
        let percent = 100.0 / if total > 0.0 { total } else { 1.0 };
        stats.add("Records/indirect light lost to clamping [%]", percent * sum(|r| r.diagnostics.clamped));
        stats.add("Records/found again by short rays [%]", percent * sum(|r| r.diagnostics.compensated));
    }
}

/// Returns the level of the coarsest cells that get candidates: the first whose cells are no larger than half the
/// largest footprint, or the last with at least `least_cell` samples. `reach` is the largest radius in spacings. A
/// record covers a small part of a larger cell, and saves no record of smaller cells.
fn first_level(count: usize, least_cell: usize, reach: f32) -> u32 {
    let largest = ((0.5 * PI * reach * reach) as usize).max(least_cell);
    let too_large = |level: u32| count >> level > largest && count >> (level + 1) >= least_cell;
    (FIRST_LEVEL..usize::BITS - 1).find(|&level| !too_large(level)).unwrap_or(FIRST_LEVEL)
}

/// Reports means over the records of a layer: clusters or rays, anisotropy, and accuracy. Accuracy is the radius of
/// the circle of equal area over the distance of the geometry that sends or blocks light.
fn shapes(records: &[Record], layer: &str, stats: &mut Stats) {
    let mut mean = |what: &str, of: &dyn Fn(&Record) -> f32| {
        let values = records.iter().map(|r| f64::from(of(r))).filter(|value| value.is_finite());
        let (sum, count) = values.fold((0.0, 0u64), |(sum, count), value| (sum + value, count + 1));
        if count > 0 {
            stats.add(&format!("Cache/{what}, {layer}"), sum / count as f64);
        }
    };
    mean("cut or rays", &|r| r.diagnostics.cut as f32);
    mean("anisotropy", &|r| r.footprint.max_radius() / r.footprint.radii[0].min(r.footprint.radii[1]));
    mean("accuracy", &|r| (r.footprint.radii[0] * r.footprint.radii[1]).sqrt() / r.diagnostics.distance);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coarsest_cells_are_half_the_largest_footprint_or_the_smallest_that_get_records() {
        // Half of a circle of 40 spacings has 2513 samples, of 20 spacings 628.
        assert_eq!(first_level(512 * 512, 256, 40.0), 7);
        assert_eq!(first_level(2048 * 2048, 256, 40.0), 11);
        assert_eq!(first_level(512 * 512, 256, 20.0), 9);
        assert_eq!(first_level(512 * 512, 256, 1.0), 10);
        assert_eq!(first_level(512 * 512, 4096, 40.0), 6);
        assert_eq!([first_level(0, 1, 40.0), first_level(5000, 256, 40.0)], [FIRST_LEVEL; 2]);
    }
}
