//! Results of studies.

use super::Study;
use crate::document::Document;
use serde_json::{Value, json};

/// Results of a study.
pub struct Results {
    /// All figures, for programs.
    pub json: Value,
    /// Tables and plots, for people.
    pub document: Document,
}

impl Results {
    /// Creates results without figures.
    pub(crate) fn new(study: &Study, title: &str, legend: &str) -> Results {
        let facts = study.facts();
        let mut document = Document::new(title);
        document.facts(&facts);
        document.text(legend);
        Results { json: json!({ "facts": facts }), document }
    }

    /// Adds an object with some facts and more of these to a list in the JSON.
    pub(crate) fn push(&mut self, list: &str, mut facts: Value, more: Value) {
        if let (Value::Object(facts), Value::Object(more)) = (&mut facts, more) {
            facts.extend(more);
        }
        match &mut self.json[list] {
            Value::Array(values) => values.push(facts),
            missing => *missing = json!([facts]),
        }
    }
}
