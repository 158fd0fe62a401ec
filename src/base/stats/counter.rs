//! Values of named counters.

/// The value of one counter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Counter {
    /// An integer count.
    Count(u64),
    /// A real sum.
    Sum(f64),
    /// Integer observations, summarised.
    Distribution(Distribution),
}

impl Counter {
    /// Adds `other`. A name stands for one kind of counter; if a caller mixes kinds, the first one stays
    /// and the mistake shows in a debug build.
    pub(super) fn combine(&mut self, other: Counter) {
        match (self, other) {
            (Counter::Count(a), Counter::Count(b)) => *a = a.saturating_add(b),
            (Counter::Sum(a), Counter::Sum(b)) => *a += b,
            (Counter::Distribution(a), Counter::Distribution(b)) => a.merge(&b),
            (kept, dropped) => debug_assert!(false, "{kept:?} cannot take {dropped:?}"),
        }
    }
}

/// Number, sum and range of integer observations: exact, so the same for any order of merging.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Distribution {
    /// Number of observations.
    pub count: u64,
    /// Their sum.
    pub sum: u64,
    /// Minimum; `u64::MAX` if there is none.
    pub min: u64,
    /// Maximum; 0 if there is none.
    pub max: u64,
}

impl Default for Distribution {
    fn default() -> Distribution {
        Distribution { count: 0, sum: 0, min: u64::MAX, max: 0 }
    }
}

impl Distribution {
    /// Creates a distribution of one observation.
    pub fn of(value: u64) -> Distribution {
        Distribution { count: 1, sum: value, min: value, max: value }
    }

    /// Adds one observation.
    #[inline]
    pub fn observe(&mut self, value: u64) {
        self.merge(&Distribution::of(value));
    }

    /// Adds all observations of `other`.
    #[inline]
    pub fn merge(&mut self, other: &Distribution) {
        self.count += other.count;
        self.sum = self.sum.saturating_add(other.sum);
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// The mean, 0 if there is no observation.
    pub fn mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.sum as f64 / self.count as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_distribution_is_neutral() {
        let mut d = Distribution::default();
        assert_eq!(d.mean(), 0.0);
        d.merge(&Distribution::of(7));
        d.merge(&Distribution::default());
        assert_eq!(d, Distribution::of(7));
    }
}
