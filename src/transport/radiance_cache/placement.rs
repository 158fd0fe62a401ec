//! Candidates for records: uncovered eye samples, spread evenly over the visible surfaces.
//!
//! Paper: Herzog et al. 2009, section 6 (records are computed where no record contributes). Starting with coarse cells
//! is the overture of Ward's irradiance caching. Each step takes at most one sample per cell of one level of the
//! index: the sample nearest to the middle of the uncovered samples in the cell.
//!
//! Known light masks the errors of a record, as the other layer does in section 6. Sampled direct light counts only as
//! far as the darkest part of the record's neighbourhood has it.

use super::cells::Candidate;
use super::splat::Splat;
use super::targets::Targets;
use crate::lights::DirectIndirect;
use base::math::luminance;
use glam::Vec3;
use rayon::prelude::*;
use world::SurfacePoint;

/// Levels up from a cell to the one whose darkest part the errors of its record are judged against.
const BASELINE_LEVELS_UP: u32 = 2;

/// Cells of the index that get candidates in one step: every second cell of a level, so that siblings take turns.
#[derive(Clone, Copy, Debug)]
pub struct CandidateStep {
    /// Level of the cells.
    pub level: u32,
    /// Number of each cell modulo 2, 0 or 1.
    pub parity: usize,
    /// Minimum share of a cell's samples that must be uncovered.
    pub least_lacking: f32,
}

/// Returns the layers among `cached` whose records have no more than the sum of weights `max_weight` at a sample that
/// records can light.
#[inline]
pub fn missing(
    targets: &Targets,
    splats: &DirectIndirect<Splat>,
    cached: DirectIndirect<bool>,
    sample: usize,
    max_weight: f32,
) -> DirectIndirect<bool> {
    DirectIndirect::from_fn(|origin| {
        cached[origin] && targets.cacheable[sample] && splats[origin].sums[sample].weight <= max_weight
    })
}

/// Returns the candidates of the cells of a turn. A sibling in the later turn may already be covered by the record of
/// the earlier one. No footprint is larger than `reach` spacings.
pub fn candidates(
    targets: &Targets,
    splats: &DirectIndirect<Splat>,
    cached: DirectIndirect<bool>,
    reach: f32,
    step: CandidateStep,
) -> Vec<Candidate> {
    let CandidateStep { level, parity, least_lacking } = step;
    let cells = (1usize << level) / 2;
    (0..cells.max(1))
        .into_par_iter()
        .filter_map(|pair| {
            let cell = if level == 0 { 0 } else { 2 * pair + parity };
            let range = targets.index.range(level, cell);
            let uncovered = |&i: &usize| missing(targets, splats, cached, i, 0.0).any();
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for i in range.clone().filter(uncovered) {
                sum += targets.points.geometry[i].position;
                count += 1.0;
            }
            if count == 0.0 || count < least_lacking * range.len() as f32 {
                return None;
            }
            let middle = sum / count;
            let distance = |i: &usize| targets.points.geometry[*i].position.distance_squared(middle);
            let sample = range.filter(uncovered).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            let mut candidate =
                candidate(targets, splats, sample, missing(targets, splats, cached, sample, 0.0));
            candidate.cell = (targets.points.len() >> level) as u32;
            // The footprint may reach beyond the cell.
            let up = level.min(BASELINE_LEVELS_UP);
            candidate.baseline_luminance +=
                targets.darkest_baseline(targets.index.range(level - up, cell >> up));
            candidate.clearance = targets.clearance(&candidate.point, reach * candidate.spacing);
            Some(candidate)
        })
        .collect()
}

fn candidate(
    targets: &Targets,
    splats: &DirectIndirect<Splat>,
    sample: usize,
    missing: DirectIndirect<bool>,
) -> Candidate {
    let point = &targets.points.geometry[sample];
    let geometric_normal = targets.points.surfaces.geometric_normal(sample);
    let cached = splats.as_ref().map(|splat| splat.sums[sample].mean().map_or(0.0, luminance));
    Candidate {
        sample: sample as u32,
        cell: 0,
        point: SurfacePoint { position: point.position, normal: point.normal, geometric_normal },
        spacing: point.spacing,
        clearance: f32::INFINITY,
        coat: point.coat.into(),
        edges: point.edges,
        bands: targets.bands[sample],
        missing,
        baseline_luminance: cached.direct + cached.indirect,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Floor, record};
    use super::super::record::NewRecord;
    use super::super::store::{RecordStore, Records};
    use super::*;
    use crate::lights::Origin;
    use base::math::Rgb;

    const REACH: f32 = 10.0;
    const BOTH: DirectIndirect<bool> = DirectIndirect { direct: true, indirect: true };

    fn splats(targets: &Targets, records: &Records) -> DirectIndirect<Splat> {
        records.as_ref().map(|store| Splat::new(targets, store))
    }

    /// Records of one layer that cover the half of the unit square below x = ½.
    fn half(origin: Origin, irradiance: Rgb) -> Records {
        let mut records = DirectIndirect::from_fn(|_| RecordStore::default());
        for y in 0..100 {
            let record = record(Vec3::new(0.0, y as f32 / 100.0, 0.0), [0.5, 0.1], irradiance);
            records[origin].push(NewRecord { origin, sample: 0, record, series: None });
        }
        records
    }

    #[test]
    fn every_other_cell_gives_the_sample_nearest_to_its_middle() {
        let floor = Floor::grid(32);
        let targets = floor.targets();
        let splats = splats(&targets, &Records::default());
        for level in 0..6 {
            let mut cells = Vec::new();
            for parity in 0..2 {
                let found = candidates(
                    &targets,
                    &splats,
                    BOTH,
                    REACH,
                    CandidateStep { level, parity, least_lacking: 0.0 },
                );
                assert_eq!(found.len(), (1 << level) / 2 + usize::from(level == 0));
                for (pair, candidate) in found.iter().enumerate() {
                    let cell = if level == 0 { 0 } else { 2 * pair + parity };
                    let range = floor.index.range(level, cell);
                    assert!(range.contains(&(candidate.sample as usize)));
                    let positions = || range.clone().map(|i| floor.points.geometry[i].position);
                    let middle = positions().sum::<Vec3>() / range.len() as f32;
                    let nearest = positions().map(|p| p.distance(middle)).fold(f32::INFINITY, f32::min);
                    assert_eq!(candidate.point.position.distance(middle), nearest);
                    assert_eq!((candidate.missing, candidate.baseline_luminance), (BOTH, 0.0));
                    cells.push(cell);
                }
            }
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 1 << level);
        }
    }

    #[test]
    fn covered_samples_are_no_candidates_and_the_other_layer_is_known() {
        let floor = Floor::grid(32);
        let targets = floor.targets();
        let half = half(Origin::Direct, Rgb::new(1.0, 2.0, 3.0));
        let splats = splats(&targets, &half);
        let one = |origin| DirectIndirect::from_fn(|other| other == origin);
        let all = |cached| -> Vec<Candidate> {
            (0..2)
                .flat_map(|parity| {
                    candidates(
                        &targets,
                        &splats,
                        cached,
                        REACH,
                        CandidateStep { level: 10, parity, least_lacking: 0.0 },
                    )
                })
                .collect()
        };
        // At level 10 a cell is a sample.
        assert_eq!(all(BOTH).len(), 1024);
        for candidate in all(BOTH) {
            let covered = candidate.point.position.x < 0.5;
            assert_eq!(candidate.missing, DirectIndirect { direct: !covered, indirect: true });
            let expected = if covered { luminance(Rgb::new(1.0, 2.0, 3.0)) } else { 0.0 };
            assert!((candidate.baseline_luminance - expected).abs() < 1e-5);
        }
        let direct = all(one(Origin::Direct));
        assert!(direct.len() == 512 && direct.iter().all(|c| c.point.position.x > 0.5));
        assert_eq!(all(one(Origin::Indirect)).len(), 1024);
        // The middle of the uncovered samples, not of the cell.
        let coarse = candidates(
            &targets,
            &splats,
            one(Origin::Direct),
            REACH,
            CandidateStep { level: 0, parity: 0, least_lacking: 0.0 },
        );
        assert!(coarse.len() == 1 && (coarse[0].point.position - Vec3::new(0.75, 0.5, 0.0)).length() < 0.04);
    }

    #[test]
    fn cells_that_lack_little_light_get_no_candidate() {
        let floor = Floor::grid(32);
        let targets = floor.targets();
        let splats = splats(&targets, &half(Origin::Indirect, Rgb::ONE));
        let cached = DirectIndirect { direct: false, indirect: true };
        let count = |level, least_lacking| -> usize {
            let step = |parity| CandidateStep { level, parity, least_lacking };
            (0..2).map(|parity| candidates(&targets, &splats, cached, REACH, step(parity)).len()).sum()
        };
        // Half of the floor is covered: cells of one sample are covered, or lack all light.
        let root = CandidateStep { level: 0, parity: 0, least_lacking: 0.51 };
        assert!(candidates(&targets, &splats, cached, REACH, root).is_empty());
        assert_eq!(
            candidates(&targets, &splats, cached, REACH, CandidateStep { least_lacking: 0.5, ..root }).len(),
            1
        );
        assert_eq!([0.0, 0.25, 1.0].map(|least| count(10, least)), [512; 3]);
        assert!(count(1, 0.0) >= count(1, 0.25) && count(1, 0.25) >= count(1, 0.9));
    }

    #[test]
    fn light_known_in_the_darkest_part_of_the_neighbourhood_masks_errors() {
        let floor = Floor::grid(32);
        let lit = |i: usize| floor.points.geometry[i].position.x < 0.5;
        let reflected = 3.0;
        let targets = floor.targets().with_baseline(|i| if lit(i) { reflected } else { 0.0 });
        let splats = splats(&targets, &Records::default());
        let albedo = luminance(floor.points.surfaces.get(0).bsdf.base_brdf() * std::f32::consts::PI);
        let (mut bright, mut dark) = (0, 0);
        for parity in 0..2 {
            for found in candidates(
                &targets,
                &splats,
                BOTH,
                REACH,
                CandidateStep { level: 6, parity, least_lacking: 0.0 },
            ) {
                let cell = floor.index.range(6, 0).len();
                let wider = floor.index.range(4, found.sample as usize / (4 * cell));
                if wider.clone().all(lit) {
                    let expected = std::f32::consts::PI * reflected / albedo;
                    assert!((found.baseline_luminance / expected - 1.0).abs() < 1e-4);
                    bright += 1;
                } else {
                    assert_eq!(found.baseline_luminance, 0.0);
                    dark += usize::from(lit(found.sample as usize));
                }
            }
        }
        assert_eq!((bright, dark), (32, 0), "the middle of the floor divides cells of that level");
        let coarse = candidates(
            &targets,
            &splats,
            BOTH,
            REACH,
            CandidateStep { level: 0, parity: 0, least_lacking: 0.0 },
        );
        assert_eq!(coarse[0].baseline_luminance, 0.0);
    }

    #[test]
    fn points_seen_by_mirrors_mask_no_errors_where_others_are_seen() {
        let mut floor = Floor::grid(16);
        floor.points.geometry.iter_mut().skip(1).step_by(2).for_each(|point| point.is_chained = true);
        let all = 0..floor.points.len();
        // Such points may have any error: they give little of their pixels' light.
        let known = |floor: &Floor| {
            let is_chained = |i: usize| floor.points.geometry[i].is_chained;
            let targets = floor.targets().with_baseline(|i| if is_chained(i) { 1e30 } else { 1.0 });
            targets.darkest_baseline(all.clone())
        };
        let some = known(&floor);
        floor.points.geometry.iter_mut().for_each(|point| point.is_chained = false);
        let alone = floor.targets().with_baseline(|_| 1.0).darkest_baseline(all.clone());
        assert!((some / alone - 1.0).abs() < 1e-5, "{some} {alone}");
        // If there are no others, one of them with little light is enough.
        floor.points.geometry.iter_mut().for_each(|point| point.is_chained = true);
        let targets = floor.targets().with_baseline(|i| if i % 32 == 0 { 1.0 } else { 1e30 });
        assert!((targets.darkest_baseline(all) / (32.0 * some) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn samples_that_records_cannot_light_are_no_candidates() {
        let floor = Floor::grid(8);
        let mut targets = floor.targets();
        targets.cacheable.fill(false);
        targets.cacheable[11] = true;
        let splats = splats(&targets, &Records::default());
        let found = candidates(
            &targets,
            &splats,
            BOTH,
            REACH,
            CandidateStep { level: 0, parity: 0, least_lacking: 0.0 },
        );
        assert!(found.len() == 1 && found[0].sample == 11);
    }
}
