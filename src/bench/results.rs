//! Results of benchmarks: figures for programs, and a document for people.

use crate::document::Document;
use crate::machine::Facts;
use crate::report::Table;
use serde_json::{Value, json};

/// Results of a benchmark.
pub struct Results {
    /// All figures, for programs.
    pub json: Value,
    /// Plots and tables, for people.
    pub document: Document,
    /// Conditions that the figures depend on.
    facts: Facts,
    /// Explanation of the columns.
    legend: &'static str,
}

impl Results {
    /// Creates results without figures.
    pub fn new(title: &str, facts: Facts, legend: &'static str) -> Results {
        Results { json: json!({ "facts": facts }), document: Document::new(title), facts, legend }
    }

    /// Adds measured tables.
    pub fn add(&mut self, tables: &[Table]) {
        self.json["tables"] = json!(tables);
        tables.iter().for_each(|table| table.tell(&mut self.document));
    }

    /// Adds an object with some facts and more of these to a list in the JSON.
    pub fn push(&mut self, list: &str, mut facts: Value, more: Value) {
        if let (Value::Object(facts), Value::Object(more)) = (&mut facts, more) {
            facts.extend(more);
        }
        match &mut self.json[list] {
            Value::Array(values) => values.push(facts),
            missing => *missing = json!([facts]),
        }
    }

    /// Returns the value of a condition.
    pub fn fact(&self, name: &str) -> &str {
        self.facts.iter().find(|(other, _)| other == name).map_or("", |(_, value)| value)
    }

    /// Adds the explanation of the columns and the conditions to the end of the document.
    pub fn conclude(&mut self) {
        if !self.legend.is_empty() {
            self.document.heading(2, "How to read the figures");
            self.document.text(self.legend);
        }
        self.document.heading(2, "Machine and settings");
        self.document.text(&self.conditions());
    }

    /// Returns the conditions as a sentence.
    pub fn conditions(&self) -> String {
        let facts: Vec<String> = self.facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
        facts.join(", ")
    }
}
