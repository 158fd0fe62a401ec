//! Parallel work in pieces of uneven cost: tiles, patches, groups of records.
//!
//! Rayon's default is long runs of pieces, which no other thread can shorten, so threads wait for the last run. Here
//! threads take one piece, or a few, at a time.
//!
//! [`Workspaces`] keeps the buffers of threads from piece to piece, so that memory need not grow again.

use rayon::iter::{IndexedParallelIterator, MaxLen};
use std::sync::{Mutex, PoisonError};

/// Maximum number of items in a short run.
const SHORT_RUN: usize = 16;

/// Parallel iterators over pieces of uneven cost.
pub trait ShortRuns: IndexedParallelIterator {
    /// Limits rayon's splits to one item, for items of a millisecond or more.
    fn one_by_one(self) -> MaxLen<Self> {
        self.with_max_len(1)
    }

    /// Limits rayon's splits to 16 items, for items of some microseconds.
    fn in_short_runs(self) -> MaxLen<Self> {
        self.with_max_len(SHORT_RUN)
    }
}

impl<I: IndexedParallelIterator> ShortRuns for I {}

/// Workspaces of threads, as many as are in use at a time. Results must not depend on the previous use of a workspace.
pub struct Workspaces<T, F> {
    make: F,
    idle: Mutex<Vec<T>>,
}

impl<T, F: Fn() -> T> Workspaces<T, F> {
    /// Returns an empty set; `make` makes a workspace.
    pub fn new(make: F) -> Workspaces<T, F> {
        Workspaces { make, idle: Mutex::new(Vec::new()) }
    }

    /// Runs `work` with a workspace that no other thread uses meanwhile.
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
                    // Nested uses get different workspaces.
                    workspaces.with(|other| other.push(0));
                    work[0]
                })
            })
            .collect();
        assert!(numbers.into_iter().eq(0..1000));
        assert!(made.into_inner() <= 2 * rayon::current_num_threads());
    }
}
