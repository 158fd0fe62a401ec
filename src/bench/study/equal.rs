//! Time that a method takes to an error, within the range of its measured images.

use crate::plot::front;
use serde::Serialize;
use std::fmt;

/// A time or a ratio of times, or a bound of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "is", content = "value", rename_all = "snake_case")]
pub enum Bounded {
    /// Value interpolated between two images.
    About(f64),
    /// Lower bound, the best image's: no image is as good.
    AtLeast(f64),
    /// Upper bound, the fastest image's: all images are better.
    AtMost(f64),
}

impl fmt::Display for Bounded {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Bounded::About(x) => write!(f, "{x:.2}"),
            Bounded::AtLeast(x) => write!(f, "> {x:.2}"),
            Bounded::AtMost(x) => write!(f, "< {x:.2}"),
        }
    }
}

impl Bounded {
    /// Returns the ratio to `other`; `None` if the bounds do not bound it.
    pub fn over(self, other: Bounded) -> Option<Bounded> {
        use Bounded::{About, AtLeast, AtMost};
        match (self, other) {
            (About(a), About(b)) => Some(About(a / b)),
            (About(a) | AtLeast(a), About(b) | AtMost(b)) => Some(AtLeast(a / b)),
            (About(a) | AtMost(a), About(b) | AtLeast(b)) => Some(AtMost(a / b)),
            _ => None,
        }
    }
}

/// Returns the time to `error`, from the times and errors of a method's images, all positive. Images that another image
/// beats in both are ignored. Times are interpolated in logarithms.
pub fn time_to(error: f64, images: &[(f64, f64)]) -> Option<Bounded> {
    let front = front(images.iter().copied().filter(|image| image.0 > 0.0 && image.1 > 0.0));
    let (fastest, best) = (*front.first()?, *front.last()?);
    if error.is_nan() || error <= 0.0 {
        return None;
    }
    if error < best.1 {
        return Some(Bounded::AtLeast(best.0));
    }
    if error >= fastest.1 {
        let time = fastest.0;
        return Some(if error > fastest.1 { Bounded::AtMost(time) } else { Bounded::About(time) });
    }
    let pair = front.windows(2).find(|pair| pair[1].1 <= error)?;
    let share = (pair[0].1 / error).ln() / (pair[0].1 / pair[1].1).ln();
    let log_time = pair[0].0.ln() + share * (pair[1].0 / pair[0].0).ln();
    Some(Bounded::About(log_time.exp()))
}

#[cfg(test)]
mod tests {
    use super::Bounded::{About, AtLeast, AtMost};
    use super::*;

    #[test]
    fn times_are_interpolated_within_the_front_and_bounds_beyond_it() {
        // Error halves as time doubles; the third is beaten by the second.
        let images = [(1.0, 0.4), (4.0, 0.1), (5.0, 0.2)];
        let at = |error| time_to(error, &images);
        let Some(About(x)) = at(0.2) else { panic!() };
        assert!((x - 2.0).abs() < 1e-12, "{x}");
        assert_eq!([at(0.05), at(0.8)], [Some(AtLeast(4.0)), Some(AtMost(1.0))]);
        assert_eq!([at(0.4), at(0.1)], [Some(About(1.0)), Some(About(4.0))]);
        assert_eq!([at(0.0), time_to(1.0, &[])], [None; 2]);
    }

    #[test]
    fn ratios_of_bounds_are_bounds_where_those_allow_it() {
        assert_eq!(About(6.0).over(About(2.0)), Some(About(3.0)));
        assert_eq!(AtLeast(6.0).over(About(2.0)), Some(AtLeast(3.0)));
        assert_eq!(AtLeast(6.0).over(AtMost(2.0)), Some(AtLeast(3.0)));
        assert_eq!(About(6.0).over(AtLeast(2.0)), Some(AtMost(3.0)));
        assert_eq!(AtMost(6.0).over(About(2.0)), Some(AtMost(3.0)));
        assert_eq!([AtLeast(6.0).over(AtLeast(2.0)), AtMost(6.0).over(AtMost(2.0))], [None; 2]);
    }
}
