//! Errors that points are judged by.

use crate::study::Shot;
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
