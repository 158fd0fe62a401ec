//! Work in pieces that are far from even: tiles, patches, groups of records.
//!
//! Left to itself a thread goes through a long run of pieces that no other may shorten, and the others wait for the
//! last run: in a staircase, on two threads, for a seventh of the time of cuts and a twentieth of that of eye samples.

use rayon::iter::{IndexedParallelIterator, MaxLen};

/// Pieces in a short run.
const SHORT: usize = 16;

/// Parallel iterators whose items are pieces of work that take a millisecond or so, some far longer than others.
pub trait ShortRuns: IndexedParallelIterator {
    /// The same, of which threads take one item after the other from each other.
    fn one_by_one(self) -> MaxLen<Self> {
        self.with_max_len(1)
    }

    /// The same, of which threads take some items after the others: for workspaces that are made anew for each run and
    /// are large, so that one for each item would take 4 % of the time.
    fn in_short_runs(self) -> MaxLen<Self> {
        self.with_max_len(SHORT)
    }
}

impl<I: IndexedParallelIterator> ShortRuns for I {}
