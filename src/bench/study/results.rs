//! Results of studies.

use super::Study;
use crate::document::Document;
use crate::machine::Facts;
use serde_json::{Value, json};

/// Results of a study.
pub struct Results {
    /// All figures, for programs.
    pub json: Value,
    /// Plots, images and tables, for people.
    pub document: Document,
    /// Conditions that the figures depend on.
    facts: Facts,
    /// Explanation of the columns.
    legend: &'static str,
}

impl Results {
    /// Creates results without figures.
    pub(crate) fn new(study: &Study, title: &str, legend: &'static str) -> Results {
        let facts = study.facts();
        Results { json: json!({ "facts": facts }), document: Document::new(title), facts, legend }
    }

    /// Returns the value of a condition.
    pub(crate) fn fact(&self, name: &str) -> &str {
        self.facts.iter().find(|(other, _)| other == name).map_or("", |(_, value)| value)
    }

    /// Adds the explanation of the columns and the conditions to the end of the document.
    pub fn conclude(&mut self) {
        self.document.heading(2, "How to read the figures");
        self.document.text(self.legend);
        self.document.heading(2, "Machine and settings");
        self.document.facts(&self.facts);
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
