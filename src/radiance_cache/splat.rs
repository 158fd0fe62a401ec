//! One layer of the cache: records of direct or of indirect light, and what they give at the eye samples.
//!
//! Every leaf of the eye samples' index keeps the list of records that may reach it. Splatting works leaf by leaf,
//! so that threads share nothing and sums are formed in the order of the records, however many threads there are.

use super::compute::Made;
use super::record::Record;
use crate::eye::{EyeIndex, EyePass, PointGeometry};
use crate::hsh::Radiance;
use crate::math::Rgb;
use rayon::prelude::*;

/// Weighted sum at an eye sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    /// Sum of weight times irradiance.
    pub irradiance: Rgb,
    /// Sum of weights.
    pub weight: f32,
}

impl Sum {
    /// The interpolated irradiance, if any record reaches the sample.
    #[inline]
    pub fn mean(&self) -> Option<Rgb> {
        (self.weight > 0.0).then(|| self.irradiance / self.weight)
    }
}

/// Records of one origin.
pub struct Layer {
    /// All of them, in the order of their making.
    pub records: Vec<Record>,
    /// Their light as series, which only records on glossy surfaces have; shorter than `records` if the last have
    /// none.
    series: Vec<Option<Radiance>>,
    /// For each leaf, the records whose footprints may reach it.
    pub lists: Vec<Vec<u32>>,
    /// For each eye sample.
    pub sums: Vec<Sum>,
}

impl Layer {
    /// No records yet.
    pub fn new(samples: &EyePass) -> Layer {
        Layer {
            records: Vec::new(),
            series: Vec::new(),
            lists: vec![Vec::new(); samples.index.leaves()],
            sums: vec![Sum::default(); samples.len()],
        }
    }

    /// The light of a record as a series.
    #[inline]
    pub fn series(&self, id: u32) -> Option<&Radiance> {
        self.series.get(id as usize)?.as_ref()
    }

    /// How many records have series.
    pub fn series_count(&self) -> usize {
        self.series.iter().flatten().count()
    }

    /// Adds records and splats them.
    pub fn splat(&mut self, samples: &EyePass, new: impl Iterator<Item = Made>) {
        let first = self.records.len() as u32;
        let mut touched = vec![false; self.lists.len()];
        for made in new {
            if made.series.is_some() {
                self.series.resize(self.records.len(), None);
                self.series.push(made.series);
            }
            self.records.push(made.record);
        }
        let reached: Vec<Vec<u32>> = self.records[first as usize..]
            .par_iter()
            .map(|record| {
                let mut leaves = Vec::new();
                samples.index.leaves_near(record.position, record.footprint.reach(), |leaf| {
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
        let records = &self.records;
        let lists = &self.lists;
        by_leaf(&mut self.sums, &samples.index, &touched).into_par_iter().for_each(|(leaf, sums)| {
            let list = &lists[leaf];
            let new = &list[list.partition_point(|&id| id < first)..];
            add(records, new, &samples.points.geometry[samples.index.leaf(leaf)], sums);
        });
    }

    /// Forms the sums of some leaves anew.
    pub fn resplat(&mut self, samples: &EyePass, changed: &[bool]) {
        let (records, lists) = (&self.records, &self.lists);
        by_leaf(&mut self.sums, &samples.index, changed).into_par_iter().for_each(|(leaf, sums)| {
            sums.fill(Sum::default());
            add(records, &lists[leaf], &samples.points.geometry[samples.index.leaf(leaf)], sums);
        });
    }
}

/// The sums of the samples of each leaf that is marked.
fn by_leaf<'a>(sums: &'a mut [Sum], index: &EyeIndex, marked: &[bool]) -> Vec<(usize, &'a mut [Sum])> {
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

/// Adds what records give at the samples of a leaf.
fn add(records: &[Record], ids: &[u32], points: &[PointGeometry], sums: &mut [Sum]) {
    for &id in ids {
        let record = &records[id as usize];
        for (point, sum) in points.iter().zip(sums.iter_mut()) {
            if let Some((weight, irradiance)) = record.at(point) {
                sum.irradiance += weight * irradiance;
                sum.weight += weight;
            }
        }
    }
}
