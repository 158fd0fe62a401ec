//! Sources of records: the trait, and the source that gathers light by lightcuts.

use super::candidate::Candidate;
use super::cells::CellLimits;
use super::record::NewRecord;
use super::settings::CacheSettings;
use crate::lightcut::{CutCounts, CutSettings};
use crate::shade::ShadingContext;

/// Algorithm that computes records.
pub trait RecordSource: Sync {
    /// Settings of the cache.
    fn settings(&self) -> &CacheSettings;

    /// Returns the limits on the cells that get a record.
    fn cells(&self) -> CellLimits {
        CellLimits::new(self.settings())
    }

    /// Computes records of the missing layers. The order does not depend on the number of threads. Records whose light
    /// is not finite are left out.
    fn records(&self, candidates: &[Candidate]) -> (Vec<NewRecord>, CutCounts);
}

/// Source that computes records by lightcuts.
#[derive(Clone, Copy)]
pub struct LightcutSource<'a> {
    /// Scene and virtual lights.
    pub context: ShadingContext<'a>,
    /// Settings of the cache.
    pub settings: &'a CacheSettings,
    /// Limits on the cells that get a record.
    pub cells: CellLimits,
    /// Cap and clamp of cuts, which are those of eye samples; the error bound is that of [`CacheSettings`] instead.
    pub cut: &'a CutSettings,
    /// True if neighbours share cuts.
    pub share: bool,
}
