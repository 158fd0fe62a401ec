//! Speed relative to another method at equal error, as far as the other's curve reaches.

use serde::Serialize;
use std::fmt;

/// Ratio of the other's time to this one's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "is", content = "factor", rename_all = "snake_case")]
pub enum Speed {
    /// Interpolated between two of the other's pictures.
    About(f64),
    /// Lower bound: no picture of the other's is as good; taken against its best.
    AtLeast(f64),
    /// Upper bound: all pictures of the other's are better; taken against its fastest.
    AtMost(f64),
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Speed::About(x) => write!(f, "{x:.2}"),
            Speed::AtLeast(x) => write!(f, "> {x:.2}"),
            Speed::AtMost(x) => write!(f, "< {x:.2}"),
        }
    }
}

/// Returns the speed of a picture of a time and error against the times and errors of another method, all
/// positive. Settings of the other that are beaten in both by another of its settings are ignored; times are
/// interpolated in logarithms.
pub fn speed((time, error): (f64, f64), others: &[(f64, f64)]) -> Option<Speed> {
    let mut sorted: Vec<(f64, f64)> = others.iter().copied().filter(|o| o.0 > 0.0 && o.1 > 0.0).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for other in sorted {
        if front.last().is_none_or(|best| other.1 < best.1) {
            front.push(other);
        }
    }
    let (fastest, best) = (*front.first()?, *front.last()?);
    if !(time > 0.0 && error > 0.0) {
        return None;
    }
    if error < best.1 {
        return Some(Speed::AtLeast(best.0 / time));
    }
    if error >= fastest.1 {
        let factor = fastest.0 / time;
        return Some(if error > fastest.1 { Speed::AtMost(factor) } else { Speed::About(factor) });
    }
    let pair = front.windows(2).find(|pair| pair[1].1 <= error)?;
    let share = (pair[0].1 / error).ln() / (pair[0].1 / pair[1].1).ln();
    let other = pair[0].0.ln() + share * (pair[1].0 / pair[0].0).ln();
    Some(Speed::About(other.exp() / time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_interpolated_within_the_front_and_bounds_beyond_it() {
        // Error halves as time doubles; the third is beaten by the second.
        let others = [(1.0, 0.4), (4.0, 0.1), (5.0, 0.2)];
        let at = |time, error| speed((time, error), &others);
        let Some(Speed::About(x)) = at(1.0, 0.2) else { panic!() };
        assert!((x - 2.0).abs() < 1e-12, "{x}");
        assert_eq!(at(2.0, 0.05), Some(Speed::AtLeast(2.0)));
        assert_eq!(at(0.5, 0.8), Some(Speed::AtMost(2.0)));
        assert_eq!(at(2.0, 0.4), Some(Speed::About(0.5)));
        assert_eq!(at(2.0, 0.1), Some(Speed::About(2.0)));
        assert_eq!((at(0.0, 0.1), speed((1.0, 1.0), &[])), (None, None));
    }
}
