//! Values of named counters.

/// The value of one counter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Counter {
    /// An integer count.
    Count(u64),
    /// A real sum.
    Sum(f64),
    /// Summary of integer observations.
    Distribution(Observations),
}

impl Counter {
    /// Adds `other`. If the two are of different kinds, the first one stays; a debug build panics.
    pub(super) fn combine(&mut self, other: Counter) {
        match (self, other) {
            (Counter::Count(a), Counter::Count(b)) => *a = a.saturating_add(b),
            (Counter::Sum(a), Counter::Sum(b)) => *a += b,
            (Counter::Distribution(a), Counter::Distribution(b)) => a.merge(&b),
            (kept, dropped) => debug_assert!(false, "{kept:?} cannot take {dropped:?}"),
        }
    }
}

/// Number, sum and range of integer observations. The integers are exact, so any order of merging gives the same
/// result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Observations {
    /// Number of observations.
    pub count: u64,
    /// Sum of the observations.
    pub sum: u64,
    /// Minimum; `u64::MAX` if there is none.
    pub min: u64,
    /// Maximum; 0 if there is none.
    pub max: u64,
}

impl Default for Observations {
    fn default() -> Observations {
        Observations { count: 0, sum: 0, min: u64::MAX, max: 0 }
    }
}

impl Observations {
    /// Creates the summary of one observation.
    pub fn one(value: u64) -> Observations {
        Observations { count: 1, sum: value, min: value, max: value }
    }

    /// Adds one observation.
    #[inline]
    pub fn observe(&mut self, value: u64) {
        self.merge(&Observations::one(value));
    }

    /// Adds all observations of `other`.
    #[inline]
    pub fn merge(&mut self, other: &Observations) {
        self.count += other.count;
        self.sum = self.sum.saturating_add(other.sum);
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Returns the mean; 0 without observations.
    pub fn mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.sum as f64 / self.count as f64 }
    }
}

/// Implements `+=` field by field.
#[macro_export]
macro_rules! add_fields {
    ($counts:ident { $($field:ident),+ $(,)? }) => {
        impl std::ops::AddAssign for $counts {
            #[inline]
            fn add_assign(&mut self, other: $counts) {
                // The pattern has no `..`, so that no field is forgotten.
                let $counts { $($field),+ } = other;
                $(self.$field += $field;)+
            }
        }
    };
}
pub use add_fields;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_distribution_is_neutral() {
        let mut d = Observations::default();
        assert_eq!(d.mean(), 0.0);
        d.merge(&Observations::one(7));
        d.merge(&Observations::default());
        assert_eq!(d, Observations::one(7));
    }
}
