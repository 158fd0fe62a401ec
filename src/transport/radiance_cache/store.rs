//! Records of one layer, which outlive the frame that they were computed for.

use super::record::NewRecord;
use super::record::Record;
use crate::hsh::Radiance;
use crate::lights::DirectIndirect;
use std::iter::repeat_with;
use std::mem;

/// Records of direct and of indirect light.
pub type Records = DirectIndirect<RecordStore>;

/// Records of one origin.
#[derive(Default)]
pub struct RecordStore {
    /// Records in the order of their creation.
    pub records: Vec<Record>,
    /// Series of the records on glossy surfaces; shorter than `records` if the last records have none.
    series: Vec<Option<Radiance>>,
}

impl RecordStore {
    /// Adds a record.
    pub fn push(&mut self, new: NewRecord) {
        if new.series.is_some() {
            self.series.resize(self.records.len(), None);
            self.series.push(new.series);
        }
        self.records.push(new.record);
    }

    /// Removes and returns all records with their series.
    pub fn drain(&mut self) -> impl Iterator<Item = (Record, Option<Radiance>)> {
        let series = mem::take(&mut self.series).into_iter().chain(repeat_with(|| None));
        mem::take(&mut self.records).into_iter().zip(series)
    }

    /// Returns the series of a record, if it has one.
    #[inline]
    pub fn series(&self, id: u32) -> Option<&Radiance> {
        self.series.get(id as usize)?.as_ref()
    }

    /// Returns the number of records with series.
    pub fn series_count(&self) -> usize {
        self.series.iter().flatten().count()
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::record;
    use super::*;
    use crate::lights::Origin;
    use base::math::Rgb;
    use glam::Vec3;

    #[test]
    fn series_stay_with_their_records() {
        let mut store = RecordStore::default();
        for bands in [0, 3, 0, 0, 5, 0] {
            let series = (bands > 0).then(|| Radiance::black(bands));
            let record = record(Vec3::X * bands as f32, [1.0; 2], Rgb::ONE);
            store.push(NewRecord { origin: Origin::Direct, sample: 0, record, series });
        }
        for (id, record) in (0..).zip(&store.records) {
            let bands = store.series(id).map_or(0, Radiance::bands);
            assert_eq!(bands as f32, record.position.x);
        }
        assert_eq!((store.series(6), store.series_count()), (None, 2));
    }
}
