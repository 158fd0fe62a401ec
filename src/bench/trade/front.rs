//! Errors that points are judged by, and the Pareto front.

use crate::study::{Answer, Group, Shot};
use base::setting::JudgedBy;

/// Errors that fronts are drawn for.
pub const ERRORS: [JudgedBy; 3] = [JudgedBy::Limit, JudgedBy::Light, JudgedBy::Flip];

/// Returns an error of a point.
pub fn error_of(shot: &Shot, judged_by: JudgedBy) -> Option<f64> {
    match judged_by {
        JudgedBy::Limit => shot.compared.map(|errors| errors.rel_rmse()),
        JudgedBy::Light => shot.light.map(|errors| errors.rel_rmse()),
        JudgedBy::Flip => Some(shot.errors.flip),
    }
}

/// Returns the name of an error.
pub fn name(error: JudgedBy) -> &'static str {
    match error {
        JudgedBy::Limit => "error from the limit",
        JudgedBy::Light => "light error",
        JudgedBy::Flip => "FLIP",
    }
}

/// Returns true if no other image of the default method is faster and no worse than an image of it. Errors of whole
/// pixels and of eye samples are not comparable.
pub fn is_on_front(answer: &Answer, shot: &Shot, error: JudgedBy) -> bool {
    let place = |shot: &Shot| {
        let is_own = !matches!(shot.candidate.group, Group::Other | Group::DenoisedPath);
        let is_judged = is_own && (shot.candidate.whole_pixels() || error == JudgedBy::Flip);
        Some((shot.seconds(), error_of(shot, error).filter(|_| is_judged)?))
    };
    place(shot).is_some_and(|point| is_unbeaten(point, answer.shots.iter().filter_map(place)))
}

/// Returns true if no other point beats a point in both figures.
fn is_unbeaten((x, y): (f64, f64), mut others: impl Iterator<Item = (f64, f64)>) -> bool {
    !others.any(|other| other.0 <= x && other.1 <= y && (other.0 < x || other.1 < y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [(1.0, 4.0), (2.0, 2.0), (2.0, 3.0), (4.0, 1.0), (5.0, 1.0), (2.0, 2.0)];
        let front = points.map(|point| is_unbeaten(point, points.into_iter()));
        assert_eq!(front, [true, true, false, true, false, true]);
    }
}
