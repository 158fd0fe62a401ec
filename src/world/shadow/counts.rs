//! Counts of shadow queries, by kind of query.

use base::stats::{Stats, add_fields};
use std::cell::Cell;

/// Counts of one kind of query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QueryCounts {
    /// Number of queries, of one ray or of a packet.
    pub queries: u64,
    /// Number of rays.
    pub rays: u64,
    /// Number of occluded rays.
    pub occluded: u64,
    /// Number of rays that the occluder cache answered.
    pub saved: u64,
}
add_fields!(QueryCounts { queries, rays, occluded, saved });

/// Counts of shadow queries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowCounts {
    /// Queries of one ray.
    pub single: QueryCounts,
    /// Queries of packets from neighbouring points towards one light.
    pub packets: QueryCounts,
}
add_fields!(ShadowCounts { single, packets });

impl ShadowCounts {
    /// Reports the counts that are not zero to the statistics of a run.
    pub fn report(&self, stats: &mut Stats) {
        for (kind, tally) in [("single", self.single), ("neighbours", self.packets)] {
            let figures = [
                ("queries", tally.queries),
                ("rays", tally.rays),
                ("occluded", tally.occluded),
                ("saved by the cache", tally.saved),
            ];
            for (name, n) in figures.into_iter().filter(|(_, n)| *n > 0) {
                stats.count(&format!("Shadow/{kind}: {name}"), n);
            }
        }
    }
}

/// [`ShadowCounts`] that grow while queries borrow the engine.
#[derive(Debug, Default)]
pub(super) struct Counters {
    pub single: QueryCounter,
    pub packets: QueryCounter,
}

impl Counters {
    /// Returns the counts so far and resets them.
    pub fn take(&self) -> ShadowCounts {
        ShadowCounts { single: self.single.0.take(), packets: self.packets.0.take() }
    }
}

/// A [`QueryCounts`] that grows behind a shared reference.
#[derive(Debug, Default)]
pub(super) struct QueryCounter(Cell<QueryCounts>);

impl QueryCounter {
    /// Counts one query of `rays` lanes.
    #[inline(always)]
    pub fn count(&self, rays: u32, occluded: u32, saved: u32) {
        let [rays, occluded, saved] = [rays, occluded, saved].map(u64::from);
        let mut tally = self.0.get();
        tally += QueryCounts { queries: 1, rays, occluded, saved };
        self.0.set(tally);
    }
}
