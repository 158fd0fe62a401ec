//! Errors that points are judged by, and the Pareto front.

use crate::front::front;
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
    place(shot).is_some_and(|point| front(answer.shots.iter().filter_map(place)).contains(&point))
}
