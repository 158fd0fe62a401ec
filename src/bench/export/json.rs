//! JSON: the report unchanged, with every sample.

use crate::Report;

/// Returns one object.
pub fn json(report: &Report) -> String {
    format!("{:#}\n", serde_json::json!(report))
}
