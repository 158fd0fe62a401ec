//! Adaptation: shrinks footprints whose records disagree visibly.
//!
//! Paper: Herzog et al. 2009, section 5.2. At each eye sample one contribution at a time is left out. If that changes
//! the luminance visibly, the record's footprint is shrunk until it excludes the sample. On glossy surfaces lit by
//! series, luminance is that of the reflected radiance, elsewhere that of the irradiance. The change is judged
//! relative to the sum of both layers, so that each masks the other.
//!
//! Deviations: the record nearest to the sample is never excluded. Leaving it out changes most, yet it is the most
//! accurate.

use super::glossy_point::GlossyPoint;
use super::settings::CacheSettings;
use super::splat::Splat;
use super::store::Records;
use super::targets::Targets;
use crate::lights::{DirectIndirect, Origin};
use base::math::{Rgb, luminance};
use rayon::prelude::*;

/// Minimum relative difference of luminance that counts as visible.
const VISIBLE: f32 = 0.02;

/// Record whose light visibly ends or begins at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Discontinuity {
    /// Layer of the record.
    pub origin: Origin,
    /// Index of the record.
    pub record: u32,
    /// Index of the eye sample.
    pub sample: u32,
}

/// Part of one record in the light of a sample.
#[derive(Clone, Copy, Debug)]
struct Contribution {
    record: u32,
    weight: f32,
    light: Rgb,
}

/// Finds all discontinuities, leaf by leaf. A difference counts if it exceeds the visible difference at the sample. If
/// that is unknown, it counts if it exceeds the share [`VISIBLE`] of the luminance.
pub fn discontinuities(
    targets: &Targets,
    records: &Records,
    splats: &DirectIndirect<Splat>,
) -> Vec<Discontinuity> {
    let by_leaf: Vec<Vec<Discontinuity>> = (0..targets.index.leaves())
        .into_par_iter()
        .map_init(DirectIndirect::<Vec<Contribution>>::default, |contributions, leaf| {
            let mut found = Vec::new();
            for sample in targets.index.leaf(leaf) {
                for origin in Origin::ALL {
                    contributions[origin].clear();
                }
                contribute(
                    targets,
                    records,
                    splats.as_ref().map(|s| &s.lists[leaf][..]),
                    sample,
                    contributions,
                );
                let visible = |origin, record| Discontinuity { origin, record, sample: sample as u32 };
                let limit = targets.visible(sample);
                judge(contributions, limit, VISIBLE, |origin, record| found.push(visible(origin, record)));
            }
            found
        })
        .collect();
    by_leaf.concat()
}

/// Adds the contributions of the listed records to a sample.
fn contribute(
    targets: &Targets,
    records: &Records,
    lists: DirectIndirect<&[u32]>,
    sample: usize,
    contributions: &mut DirectIndirect<Vec<Contribution>>,
) {
    let point = &targets.points.geometry[sample];
    let mut glossy = GlossyPoint::new(targets, sample);
    for origin in Origin::ALL {
        let store = &records[origin];
        for &id in lists[origin] {
            let record = &store.records[id as usize];
            if let Some((weight, irradiance)) = record.at(point, targets.bands[sample]) {
                let light = match &mut glossy {
                    Some(glossy) => glossy.radiance(record, store.series(id), irradiance),
                    None => irradiance,
                };
                contributions[origin].push(Contribution { record: id, weight, light });
            }
        }
    }
}

/// Calls `visible` with every record without which the light would change by more than `limit`. Without a limit, the
/// bound is the share `threshold` of the luminance of both layers. The heaviest record of each layer is exempt.
fn judge(
    contributions: &DirectIndirect<Vec<Contribution>>,
    limit: Option<f32>,
    threshold: f32,
    mut visible: impl FnMut(Origin, u32),
) {
    let sums = contributions.as_ref().map(|contributions| {
        let add = |(sum, weights), c: &Contribution| (sum + c.weight * c.light, weights + c.weight);
        contributions.iter().fold((Rgb::ZERO, 0.0), add)
    });
    let means = sums.map(|(sum, weights)| if weights > 0.0 { sum / weights } else { Rgb::ZERO });
    let limit = limit.unwrap_or_else(|| threshold * luminance(means.direct + means.indirect));
    for origin in Origin::ALL {
        let (sum, weights) = sums[origin];
        let heaviest = contributions[origin].iter().fold(0.0, |w: f32, c| w.max(c.weight));
        for &Contribution { record, weight, light } in &contributions[origin] {
            if weight >= heaviest {
                continue;
            }
            let without = (sum - weight * light) / (weights - weight);
            if luminance((without - means[origin]).abs()) > limit {
                visible(origin, record);
            }
        }
    }
}

/// Shrinks the footprints of the records at `discontinuities`. Returns true for each leaf that this affects; the sums
/// there must be recomputed.
pub fn shrink(
    targets: &Targets,
    records: &mut Records,
    discontinuities: &[Discontinuity],
    settings: &CacheSettings,
) -> Vec<bool> {
    let index = targets.index;
    let mut changed = vec![false; index.leaves()];
    for discontinuity in discontinuities {
        let record = &mut records[discontinuity.origin].records[discontinuity.record as usize];
        let point = &targets.points.geometry[discontinuity.sample as usize];
        if record.delta(point, targets.bands[discontinuity.sample as usize]) >= 1.0 {
            continue; // an earlier one has excluded this sample
        }
        let radius = record.footprint.max_radius();
        if record.exclude(point, settings.reach[discontinuity.origin as usize][0] * point.spacing) {
            index.leaves_near(record.position, radius, |leaf| changed[leaf] = true);
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Floor, record};
    use super::super::record::NewRecord;
    use super::*;
    use crate::lights::Origin::{Direct, Indirect};
    use glam::Vec3;

    fn contribution(record: u32, weight: f32, light: f32) -> Contribution {
        Contribution { record, weight, light: Rgb::splat(light) }
    }

    fn judged(direct: &[Contribution], indirect: &[Contribution], threshold: f32) -> Vec<(Origin, u32)> {
        let contributions = DirectIndirect { direct: direct.to_vec(), indirect: indirect.to_vec() };
        let mut found = Vec::new();
        judge(&contributions, None, threshold, |origin, record| found.push((origin, record)));
        found
    }

    #[test]
    fn light_that_is_missed_by_more_than_the_threshold_is_a_discontinuity() {
        // The mean is (3·1 + 1·2) / 4 = 1.25, without record 7 it is 1: a fifth is missing.
        let pair = [contribution(5, 3.0, 1.0), contribution(7, 1.0, 2.0)];
        assert_eq!(judged(&pair, &[], 0.199), [(Direct, 7)]);
        assert_eq!(judged(&pair, &[], 0.201), []);
        assert_eq!(judged(&[], &pair, 0.199), [(Indirect, 7)]);
        // Light of the other layer masks it.
        let steady = [contribution(1, 2.0, 1.25)];
        assert_eq!(judged(&pair, &steady, 0.101), []);
        assert_eq!(judged(&pair, &steady, 0.099), [(Direct, 7)]);
        // Three of 1, 1 and 4 by weights 1, 1 and 2: without the first or the second, 3 instead of 2.5.
        let three = [contribution(0, 1.0, 1.0), contribution(1, 1.0, 1.0), contribution(2, 2.0, 4.0)];
        assert_eq!(judged(&three, &[], 0.199), [(Direct, 0), (Direct, 1)]);
        assert_eq!(judged(&three, &[], 0.201), []);
    }

    fn records(all: &[(Vec3, [f32; 2], f32)]) -> Records {
        let mut records = Records::default();
        for &(position, radii, irradiance) in all {
            let record = record(position, radii, Rgb::splat(irradiance));
            records.direct.push(NewRecord { origin: Direct, sample: 0, record, series: None });
        }
        records
    }

    #[test]
    fn shrunk_footprints_end_at_the_discontinuity() {
        let floor = Floor::grid(32);
        let targets = floor.targets();
        // The farther one weighs less along the border between the two and is to give way.
        let mut records = records(&[
            (Vec3::new(0.25, 0.25, 0.0), [0.2, 0.2], 1.0),
            (Vec3::new(0.5, 0.25, 0.0), [0.2, 0.2], 1.5),
        ]);
        let mut splats = records.as_ref().map(|store| Splat::new(&targets, store));
        let mut settings = CacheSettings::default();
        settings.reach[0][0] = 0.01;
        let found = discontinuities(&targets, &records, &splats);
        assert!(!found.is_empty());
        let before = records.direct.records.clone();
        for d in &found {
            let (own, other) = (&before[d.record as usize], &before[1 - d.record as usize]);
            let point = &floor.points.geometry[d.sample as usize];
            assert!(own.delta(point, 0) > other.delta(point, 0) && own.delta(point, 0) < 1.0);
        }
        let changed = shrink(&targets, &mut records, &found, &settings);
        for d in &found {
            let record = &records.direct.records[d.record as usize];
            assert!(record.delta(&floor.points.geometry[d.sample as usize], 0) > 0.999);
        }
        // All changes are in marked leaves.
        splats.direct.renew(&targets, &records.direct, &changed);
        assert_eq!(splats.direct.sums, Splat::new(&targets, &records.direct).sums);
        assert!(changed.contains(&true) && changed.contains(&false));
        // Nothing is left to see.
        assert_eq!(discontinuities(&targets, &records, &splats), []);
    }

    #[test]
    fn footprints_keep_their_least_radius_in_spacings_of_the_sample() {
        let floor = Floor::new(&[Vec3::new(0.01, 0.0, 0.0)]);
        let targets = floor.targets();
        let settings = CacheSettings::default();
        let mut records = records(&[(Vec3::ZERO, [0.4, 0.4], 1.0)]);
        shrink(&targets, &mut records, &[Discontinuity { origin: Direct, record: 0, sample: 0 }], &settings);
        let [shrunk, kept] = records.direct.records[0].footprint.radii;
        assert!((shrunk - settings.reach[0][0] * 0.1).abs() < 1e-6 && kept == 0.4);
    }
}
