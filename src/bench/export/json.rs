//! JSON: the report as it is, with every sample.

use crate::bench::Report;

/// One object.
pub fn json(report: &Report) -> String {
    format!("{:#}\n", serde_json::json!(report))
}
