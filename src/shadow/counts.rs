//! What was asked of the engine, by kind of query.

use super::Packing;
use crate::stats::Stats;
use std::cell::Cell;

/// Figures of one kind of query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Queries, of one ray or of a packet.
    pub queries: u64,
    /// Rays asked for.
    pub rays: u64,
    /// Rays found occluded.
    pub occluded: u64,
    /// Rays that the occluder cache answered.
    pub saved: u64,
}

impl Tally {
    fn add(&mut self, other: &Tally) {
        self.queries += other.queries;
        self.rays += other.rays;
        self.occluded += other.occluded;
        self.saved += other.saved;
    }
}

/// Figures by [`Packing`], in the order of [`Packing::ALL`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts(pub [Tally; 4]);

impl Counts {
    /// Adds `other`.
    pub fn add(&mut self, other: &Counts) {
        for (tally, other) in self.0.iter_mut().zip(&other.0) {
            tally.add(other);
        }
    }

    /// Of all kinds together.
    pub fn total(&self) -> Tally {
        let mut total = Tally::default();
        self.0.iter().for_each(|tally| total.add(tally));
        total
    }

    /// Puts what is not zero into the statistics of a run.
    pub fn report(&self, stats: &mut Stats) {
        for (packing, tally) in Packing::ALL.into_iter().zip(&self.0) {
            let figures = [
                ("queries", tally.queries),
                ("rays", tally.rays),
                ("occluded", tally.occluded),
                ("saved by the cache", tally.saved),
            ];
            for (name, n) in figures.into_iter().filter(|(_, n)| *n > 0) {
                stats.count(&format!("Shadow/{}: {name}", packing.name()), n);
            }
        }
    }
}

/// Counts while queries borrow the engine.
#[derive(Debug, Default)]
pub(super) struct Counters([[Cell<u64>; 4]; 4]);

impl Counters {
    /// One query of `rays` lanes.
    #[inline(always)]
    pub fn count(&self, packing: Packing, rays: u32, occluded: u32, saved: u32) {
        let tally = &self.0[packing as usize];
        for (cell, n) in tally.iter().zip([1, rays, occluded, saved]) {
            cell.set(cell.get() + u64::from(n));
        }
    }

    /// What was counted, and starts anew.
    pub fn take(&self) -> Counts {
        Counts(std::array::from_fn(|kind| {
            let [queries, rays, occluded, saved] = &self.0[kind];
            Tally {
                queries: queries.take(),
                rays: rays.take(),
                occluded: occluded.take(),
                saved: saved.take(),
            }
        }))
    }
}
