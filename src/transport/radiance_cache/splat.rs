//! Splats of one layer's records onto the eye samples of one frame.
//!
//! Paper: Herzog et al. 2009, section 6.
//!
//! Every leaf of the eye samples' index has a list of the records that may reach it. Splatting proceeds leaf by leaf,
//! so that threads share no data. Sums are formed in the order of the records, for any number of threads.

use super::record::Record;
use super::store::RecordStore;
use super::targets::Targets;
use base::kd_tree::KdTree;
use base::math::Rgb;
use rayon::prelude::*;

/// Weighted sum at an eye sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    /// Sum of weight times irradiance.
    pub irradiance: Rgb,
    /// Sum of weights.
    pub weight: f32,
}

impl Sum {
    /// Returns the interpolated irradiance, if any record reaches the sample.
    #[inline]
    pub fn mean(&self) -> Option<Rgb> {
        (self.weight > 0.0).then(|| self.irradiance / self.weight)
    }
}

/// Weighted sums of a layer's records at eye samples.
pub struct Splat {
    /// Per leaf: records whose footprints may reach it.
    pub lists: Vec<Vec<u32>>,
    /// Per eye sample: weighted sum.
    pub sums: Vec<Sum>,
}

impl Splat {
    /// Splats all records of `store`.
    pub fn new(targets: &Targets, store: &RecordStore) -> Splat {
        let lists = vec![Vec::new(); targets.index.leaves()];
        let mut splat = Splat { lists, sums: vec![Sum::default(); targets.points.len()] };
        splat.add(targets, store, 0);
        splat
    }

    /// Adds the records of `store` from index `first` on.
    pub fn add(&mut self, targets: &Targets, store: &RecordStore, first: u32) {
        let index = targets.index;
        let mut touched = vec![false; self.lists.len()];
        let reached: Vec<Vec<u32>> = store.records[first as usize..]
            .par_iter()
            .map(|record| {
                let mut leaves = Vec::new();
                index.leaves_near(record.position, record.footprint.max_radius(), |leaf| {
                    leaves.push(leaf as u32);
                });
                leaves
            })
            .collect();
        for (id, leaves) in (first..).zip(reached) {
            for leaf in leaves {
                self.lists[leaf as usize].push(id);
                touched[leaf as usize] = true;
            }
        }
        let lists = &self.lists;
        by_leaf(&mut self.sums, index, &touched).into_par_iter().for_each(|(leaf, sums)| {
            let list = &lists[leaf];
            let new = &list[list.partition_point(|&id| id < first)..];
            add(targets, leaf, &store.records, new, sums);
        });
    }

    /// Recomputes the sums of the leaves that are `marked`.
    pub fn renew(&mut self, targets: &Targets, store: &RecordStore, marked: &[bool]) {
        let lists = &self.lists;
        by_leaf(&mut self.sums, targets.index, marked).into_par_iter().for_each(|(leaf, sums)| {
            sums.fill(Sum::default());
            add(targets, leaf, &store.records, &lists[leaf], sums);
        });
    }
}

/// Returns the sums of the samples of each marked leaf.
fn by_leaf<'a>(sums: &'a mut [Sum], index: &KdTree, marked: &[bool]) -> Vec<(usize, &'a mut [Sum])> {
    let mut rest = sums;
    let mut start = 0;
    let leaves = (0..index.leaves()).filter(|&leaf| marked[leaf]);
    leaves
        .map(|leaf| {
            let range = index.leaf(leaf);
            let (_, from) = std::mem::take(&mut rest).split_at_mut(range.start - start);
            let (own, others) = from.split_at_mut(range.len());
            (rest, start) = (others, range.end);
            (leaf, own)
        })
        .collect()
}

/// Adds the contributions of records at the samples of a leaf.
fn add(targets: &Targets, leaf: usize, records: &[Record], ids: &[u32], sums: &mut [Sum]) {
    for &id in ids {
        let record = &records[id as usize];
        let points = targets.geometry(targets.index.leaf(leaf));
        for ((point, bands), sum) in points.zip(sums.iter_mut()) {
            if let Some((weight, irradiance)) = record.at(point, bands) {
                sum.irradiance += weight * irradiance;
                sum.weight += weight;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Floor, record};
    use super::super::record::NewRecord;
    use super::*;
    use crate::lights::Origin;
    use base::sampling::hash;
    use glam::Vec3;

    fn number(i: u32, dimension: u32) -> f32 {
        (hash(i, dimension) >> 8) as f32 / (1 << 24) as f32
    }

    /// Records all over the unit square.
    fn new_record(i: u32) -> NewRecord {
        let position = Vec3::new(number(i, 1), number(i, 2), 0.0);
        let radii = [0.02 + 0.2 * number(i, 3), 0.02 + 0.1 * number(i, 4)];
        let irradiance = Rgb::new(number(i, 5), number(i, 6), number(i, 7)) + 0.1;
        NewRecord {
            origin: Origin::Direct,
            sample: 0,
            record: record(position, radii, irradiance),
            series: None,
        }
    }

    fn store(count: u32) -> RecordStore {
        let mut store = RecordStore::default();
        (0..count).for_each(|i| store.push(new_record(i)));
        store
    }

    #[test]
    fn sums_are_those_of_all_records_in_the_order_of_their_making() {
        let floor = Floor::grid(50);
        let (targets, store) = (floor.targets(), store(40));
        let splat = Splat::new(&targets, &store);
        for (point, found) in floor.points.geometry.iter().zip(&splat.sums) {
            let mut sum = Sum::default();
            for (weight, irradiance) in store.records.iter().filter_map(|record| record.at(point, 0)) {
                sum.irradiance += weight * irradiance;
                sum.weight += weight;
            }
            assert_eq!(*found, sum);
            assert_eq!(found.mean(), (sum.weight > 0.0).then(|| sum.irradiance / sum.weight));
        }
        assert!(splat.sums.iter().any(|sum| sum.weight == 0.0));
    }

    #[test]
    fn splatting_in_steps_or_anew_by_any_number_of_threads_gives_the_same_bits() {
        let floor = Floor::grid(50);
        let targets = floor.targets();
        let whole = Splat::new(&targets, &store(300));
        let by_threads = |threads| {
            let mut splat = Splat::new(&targets, &RecordStore::default());
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| {
                let mut growing = RecordStore::default();
                for (first, end) in [(0, 120), (120, 260), (260, 300)] {
                    (first..end).for_each(|i| growing.push(new_record(i)));
                    splat.add(&targets, &growing, first);
                }
                assert_eq!(splat.sums, whole.sums);
                // Shrunk records leave the sums of marked leaves only.
                growing.records.iter_mut().for_each(|record| record.footprint.radii = [0.01; 2]);
                let marked: Vec<bool> = (0..floor.index.leaves()).map(|leaf| leaf % 2 == 0).collect();
                splat.renew(&targets, &growing, &marked);
                let fresh = Splat::new(&targets, &growing);
                for (leaf, &marked) in marked.iter().enumerate() {
                    let range = floor.index.leaf(leaf);
                    let expected = if marked { &fresh } else { &whole };
                    assert_eq!(splat.sums[range.clone()], expected.sums[range]);
                }
            });
            splat.sums
        };
        assert_eq!(by_threads(1), by_threads(3));
    }
}
