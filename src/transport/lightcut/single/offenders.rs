//! The queue of clusters to be split.

use std::collections::BinaryHeap;

/// Clusters above the threshold, by their place in the cut, the worst first.
///
/// Errors as bits stand above places: non-negative floats sort as integers.
#[derive(Default)]
pub(super) struct Offenders(BinaryHeap<u64>);

impl Offenders {
    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Queues the cluster at `place` by its error, unless it cannot be wrong.
    #[inline]
    pub fn push(&mut self, error: f32, place: usize) {
        if error > 0.0 {
            self.0.push(u64::from(error.to_bits()) << 32 | place as u64);
        }
    }

    /// Error and place of the worst.
    #[inline]
    pub fn worst(&self) -> Option<(f32, usize)> {
        self.0.peek().map(|&offender| (f32::from_bits((offender >> 32) as u32), offender as u32 as usize))
    }

    /// Removes the worst.
    #[inline]
    pub fn pop(&mut self) {
        self.0.pop();
    }
}
