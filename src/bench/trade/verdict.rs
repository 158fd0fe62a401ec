//! Verdicts on knobs: finer levels should lower the error and cost more.

use serde::Serialize;
use std::fmt;

/// Relative change of error that counts as none.
pub const ERROR_TOLERANCE: f64 = 0.03;
/// Relative change of time that counts as none; times of a busy machine vary.
pub const TIME_TOLERANCE: f64 = 0.1;

/// Course of a figure from coarse to fine.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Course {
    /// No change.
    Flat,
    /// Monotonic rise; the last value over the first.
    Rises(f64),
    /// Monotonic fall; the first value over the last.
    Falls(f64),
    /// Rise and fall: the pairs of levels between which the figure moves against its overall direction.
    Mixed(Vec<[String; 2]>),
}

/// Returns the course of values from coarse to fine; `names` are those of the levels.
pub fn course(values: &[f64], names: &[String], tolerance: f64) -> Course {
    let step = |from: f64, to: f64| match to / from {
        ratio if ratio > 1.0 + tolerance => 1,
        ratio if ratio < 1.0 / (1.0 + tolerance) => -1,
        _ => 0,
    };
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return Course::Flat };
    let on_the_whole = if last > first { 1 } else { -1 };
    // Compared with the extreme so far, so that many small steps are not overlooked.
    let mut extreme = 0;
    let mut against = Vec::new();
    let mut moves = false;
    for i in 1..values.len() {
        let direction = step(values[extreme], values[i]);
        moves |= direction != 0;
        if direction == -on_the_whole {
            against.push([names[extreme].clone(), names[i].clone()]);
        }
        if (values[i] - values[extreme]) * f64::from(on_the_whole) > 0.0 {
            extreme = i;
        }
    }
    match (moves, against.is_empty(), on_the_whole) {
        (false, ..) => Course::Flat,
        (_, false, _) => Course::Mixed(against),
        (_, true, 1) => Course::Rises(last / first),
        (_, true, _) => Course::Falls(first / last),
    }
}

impl fmt::Display for Course {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Course::Flat => write!(f, "flat"),
            Course::Rises(factor) => write!(f, "rises {factor:.2} times"),
            Course::Falls(factor) => write!(f, "falls {factor:.2} times"),
            Course::Mixed(against) => {
                let steps: Vec<String> = against.iter().map(|[a, b]| format!("{a} → {b}")).collect();
                write!(f, "not monotone at {}", steps.join(", "))
            }
        }
    }
}

/// Returns the verdict on both courses.
pub fn verdict(error: &Course, time: &Course) -> &'static str {
    use Course::{Falls, Flat, Mixed, Rises};
    match (error, time) {
        (Flat, Flat) => "no effect here",
        (Falls(_), Rises(_)) => "monotone: finer is better and costs more",
        (Falls(_), Flat | Falls(_)) => "monotone: finer is better and costs no more",
        (Flat, Rises(_)) => "finer costs more and is no better here",
        (Flat, Falls(_)) => "finer costs less and is no worse",
        (Rises(_), _) => "the wrong way: finer is worse",
        (Mixed(_), _) => "error not monotone",
        (_, Mixed(_)) => "time not monotone",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> Course {
        let names: Vec<String> = (0..values.len()).map(|i| i.to_string()).collect();
        course(values, &names, 0.1)
    }

    #[test]
    fn courses_are_judged_within_the_tolerance() {
        assert_eq!(of(&[1.0, 1.05, 0.97]), Course::Flat);
        assert_eq!(of(&[1.0, 1.05, 2.0, 4.0]), Course::Rises(4.0));
        assert_eq!(of(&[4.0, 2.0, 2.1, 1.0]), Course::Falls(4.0));
        assert_eq!(of(&[4.0, 1.0, 2.0]), Course::Mixed(vec![["1".into(), "2".into()]]));
        // A slow rise by less than the tolerance a step is detected.
        assert_eq!(of(&[4.0, 1.0, 1.08, 1.16]), Course::Mixed(vec![["1".into(), "3".into()]]));
        assert_eq!(verdict(&of(&[2.0, 1.0]), &of(&[1.0, 3.0])), "monotone: finer is better and costs more");
    }
}
