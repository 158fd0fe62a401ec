//! Work in pieces that are far from even: tiles, patches, groups of records.
//!
//! Left to itself a thread goes through a long run of pieces that no other may shorten, and the others wait for the
//! last run: in a staircase, on two threads, for a seventh of the time of cuts and a twentieth of that of eye samples.
//! So threads take one piece after the other. Workspaces outlive the pieces ([`Workspaces`]): made anew for each, they
//! would take 4 % of the time, for memory that grows again.

use rayon::iter::{IndexedParallelIterator, MaxLen};
use std::sync::{Mutex, PoisonError};

/// Pieces in a short run.
const SHORT: usize = 16;

/// Parallel iterators whose items are pieces of work, some far longer than others.
pub trait ShortRuns: IndexedParallelIterator {
    /// The same, of which threads take one item after the other from each other: for items of a millisecond or so.
    fn one_by_one(self) -> MaxLen<Self> {
        self.with_max_len(1)
    }

    /// The same, of which threads take some items after the others: for items of some microseconds.
    fn in_short_runs(self) -> MaxLen<Self> {
        self.with_max_len(SHORT)
    }
}

impl<I: IndexedParallelIterator> ShortRuns for I {}

/// Workspaces of threads, of which no more are made than are in use at a time. Results must not depend on what one was
/// used for before.
pub struct Workspaces<T, F> {
    make: F,
    idle: Mutex<Vec<T>>,
}

impl<T, F: Fn() -> T> Workspaces<T, F> {
    /// None as yet; `make` makes one.
    pub fn new(make: F) -> Workspaces<T, F> {
        Workspaces { make, idle: Mutex::new(Vec::new()) }
    }

    /// Runs `work` in one that nobody else uses meanwhile.
    pub fn with<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let free = idle().pop();
        let mut workspace = free.unwrap_or_else(&self.make);
        let result = work(&mut workspace);
        idle().push(workspace);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn workspaces_are_used_again_and_by_one_at_a_time() {
        let made = AtomicUsize::new(0);
        let workspaces = Workspaces::new(|| {
            made.fetch_add(1, Ordering::Relaxed);
            Vec::with_capacity(1)
        });
        let numbers: Vec<usize> = (0..1000)
            .into_par_iter()
            .one_by_one()
            .map(|i| {
                workspaces.with(|work| {
                    work.clear();
                    work.push(i);
                    // One within the other is another.
                    workspaces.with(|other| other.push(0));
                    work[0]
                })
            })
            .collect();
        assert!(numbers.into_iter().eq(0..1000));
        assert!(made.into_inner() <= 2 * rayon::current_num_threads());
    }
}
