//! Logarithmic axes.

/// Most ticks of an axis that are labelled.
const TICKS: usize = 8;

/// Multiples of powers of ten that are labelled, the densest first.
const FACTORS: [&[u32]; 3] = [&[1, 2, 3, 4, 5, 6, 7, 8, 9], &[1, 2, 5], &[1]];

/// A logarithmic axis.
pub struct Axis {
    /// Range of values.
    pub low: f64,
    pub high: f64,
    /// Positions of `low` and `high`.
    pub ends: [f64; 2],
}

impl Axis {
    /// Creates an axis over positive values, with a margin of a tenth that also keeps the range from being empty.
    pub fn over(values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Axis {
        let (low, high) = values.fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), v| (l.min(v), h.max(v)));
        let margin = (high / low).powf(0.1).max(1.1);
        Axis { low: low / margin, high: high * margin, ends }
    }

    /// Returns the position of a value.
    pub fn at(&self, value: f64) -> f64 {
        let [from, to] = self.ends;
        from + (to - from) * (value / self.low).ln() / (self.high / self.low).ln()
    }

    /// Returns the densest round values within the range that are not too many, or else the powers of ten.
    pub fn ticks(&self) -> Vec<f64> {
        let densest = FACTORS.iter().map(|factors| self.multiples(factors)).find(|all| all.len() <= TICKS);
        densest.unwrap_or_else(|| self.multiples(&[1]))
    }

    /// Returns some multiples of powers of ten within the range.
    fn multiples(&self, factors: &[u32]) -> Vec<f64> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let decades = (first..=last).flat_map(|decade| factors.iter().map(move |m| format!("{m}e{decade}")));
        // Values are parsed from text, since products of powers of a tenth are not round.
        let values = decades.filter_map(|text| text.parse().ok());
        values.filter(|v| (self.low..=self.high).contains(v)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        let axis = Axis { low: 0.03, high: 1.2, ends: [0.0, 1.0] };
        assert_eq!(axis.ticks(), [0.05, 0.1, 0.2, 0.5, 1.0]);
        assert_eq!(Axis { high: 1200.0, ..axis }.ticks(), [0.1, 1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(Axis { low: 0.025, high: 0.061, ..axis }.ticks(), [0.03, 0.04, 0.05, 0.06]);
    }
}
