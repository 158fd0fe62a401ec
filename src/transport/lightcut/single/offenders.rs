//! Queue of clusters to split.

use std::collections::BinaryHeap;

/// Clusters by error, the worst first.
///
/// A key holds the bits of the error above the place in the cut. Non-negative floats sort as integers.
#[derive(Default)]
pub(super) struct Offenders(BinaryHeap<u64>);

impl Offenders {
    /// Removes all clusters.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds the cluster at `place`, unless its error is 0.
    #[inline]
    pub fn push(&mut self, error: f32, place: usize) {
        if error > 0.0 {
            self.0.push(u64::from(error.to_bits()) << 32 | place as u64);
        }
    }

    /// Error and place of the worst cluster.
    #[inline]
    pub fn worst(&self) -> Option<(f32, usize)> {
        self.0.peek().map(|&offender| (f32::from_bits((offender >> 32) as u32), offender as u32 as usize))
    }

    /// Removes the worst cluster.
    #[inline]
    pub fn pop(&mut self) {
        self.0.pop();
    }
}
