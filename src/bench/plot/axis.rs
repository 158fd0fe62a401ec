//! Logarithmic axes.

/// Most ticks of an axis that are labelled.
const TICKS: usize = 8;

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

    /// Returns 1, 2 and 5 times powers of ten within the range; powers of ten alone if there are many.
    pub fn ticks(&self) -> Vec<f64> {
        let all = self.multiples(&[1, 2, 5]);
        if all.len() <= TICKS { all } else { self.multiples(&[1]) }
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
    }
}
