//! Description of a setting: everything but its value.

use super::value::{Value, first_paragraph};
use serde::Serialize;

/// Factors from four times the default down to a quarter.
pub const DOWN: [f64; 5] = [4.0, 2.0, 1.0, 0.5, 0.25];
/// Factors from a quarter of the default up to four times it.
pub const UP: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// Description of a setting.
#[derive(Debug)]
pub struct Spec {
    /// Name in statistics and metadata, and of the option with dashes.
    pub key: &'static str,
    /// Documentation of the field. Its first paragraph is the text for users.
    doc: &'static str,
    /// Heading of the setting's group in `--help`; empty for none.
    pub heading: &'static str,
    /// Placeholder of the value in `--help`, if the name does not describe it.
    pub placeholder: Option<&'static str>,
    /// True for an option without a value, which turns the setting on.
    pub flag: bool,
    /// Minimum and maximum of every number.
    range: [f64; 2],
    /// Levels that benchmarks try, if the setting trades error for time.
    levels: Levels,
}

/// Levels of a setting from coarse, which should be faster, to fine, which should be better.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Factors on the default.
    pub factors: &'static [f64],
    /// Values as users type them.
    pub values: &'static [&'static str],
    /// Names of the numbers, if the setting has several. Numbers without a name are not varied.
    pub parts: &'static [&'static str],
    /// Other settings, by key, with which this one has an effect, if it has none by default.
    pub with: &'static [(&'static str, &'static str)],
    /// Error by which levels are judged.
    pub judged_by: JudgedBy,
}

/// Errors that show the effect of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum JudgedBy {
    /// Error against much finer cuts of the same virtual lights at the same samples.
    ///
    /// Errors of the virtual lights and of clamping would hide all others.
    Limit,
    /// Error against path tracing: the setting changes the virtual lights or their clamping.
    Light,
    /// FLIP of complete images: the setting changes the samples.
    Flip,
}

const NO_LEVELS: Levels =
    Levels { factors: &[], values: &[], parts: &[""], with: &[], judged_by: JudgedBy::Limit };

impl Spec {
    /// Creates a setting of any value, which no benchmark varies.
    pub const fn new(key: &'static str, doc: &'static str, heading: &'static str) -> Spec {
        let range = [f64::MIN, f64::MAX];
        Spec { key, doc, heading, placeholder: None, flag: false, range, levels: NO_LEVELS }
    }

    /// Sets another name than the field's.
    pub const fn named(self, key: &'static str) -> Spec {
        Spec { key, ..self }
    }

    /// Sets another heading than the struct's.
    pub const fn heading(self, heading: &'static str) -> Spec {
        Spec { heading, ..self }
    }

    /// Sets the placeholder of the value in `--help`.
    pub const fn placeholder(self, text: &'static str) -> Spec {
        Spec { placeholder: Some(text), ..self }
    }

    /// Makes the setting an option without a value.
    pub const fn flag(self) -> Spec {
        Spec { flag: true, ..self }
    }

    /// Limits numbers to the range from `low` to `high`.
    pub const fn range(self, low: f64, high: f64) -> Spec {
        Spec { range: [low, high], ..self }
    }

    /// Limits numbers to `low` and more.
    pub const fn at_least(self, low: f64) -> Spec {
        self.range(low, f64::MAX)
    }

    /// Limits numbers to more than 0.
    pub const fn positive(self) -> Spec {
        self.at_least(f64::MIN_POSITIVE)
    }

    /// Limits numbers to the range from 0 to 1.
    pub const fn fraction(self) -> Spec {
        self.range(0.0, 1.0)
    }

    /// Lets benchmarks vary the setting by factors on its default.
    pub const fn scaled(self, factors: &'static [f64]) -> Spec {
        Spec { levels: Levels { factors, ..self.levels }, ..self }
    }

    /// Lets benchmarks vary the setting over values as users type them.
    pub const fn values(self, values: &'static [&'static str]) -> Spec {
        Spec { levels: Levels { values, ..self.levels }, ..self }
    }

    /// Names the numbers. Benchmarks do not vary numbers without a name.
    pub const fn parts(self, parts: &'static [&'static str]) -> Spec {
        Spec { levels: Levels { parts, ..self.levels }, ..self }
    }

    /// Sets values of other settings with which benchmarks vary this one.
    pub const fn with(self, with: &'static [(&'static str, &'static str)]) -> Spec {
        Spec { levels: Levels { with, ..self.levels }, ..self }
    }

    /// Sets the error by which benchmarks judge levels; [`JudgedBy::Limit`] by default.
    pub const fn judged_by(self, judged_by: JudgedBy) -> Spec {
        Spec { levels: Levels { judged_by, ..self.levels }, ..self }
    }

    /// Returns the levels that benchmarks try; `None` if the setting does not trade error for time.
    pub fn levels(&self) -> Option<&Levels> {
        Some(&self.levels).filter(|levels| !levels.factors.is_empty() || !levels.values.is_empty())
    }

    /// Returns the name of the option, without its two dashes.
    pub fn option(&self) -> String {
        self.key.replace('_', "-")
    }

    /// Returns true for a setting of the paper or of tuning, which the option `--set` sets.
    pub fn is_tuning(&self) -> bool {
        !self.heading.is_empty()
    }

    /// Returns the words of the command line that set a value.
    pub fn words(&self, value: &str) -> String {
        match self.is_tuning() {
            true => format!("--set {}={value}", self.option()),
            false => format!("--{} {value}", self.option()),
        }
    }

    /// Returns the text for users.
    pub fn help(&self) -> String {
        first_paragraph(self.doc)
    }

    /// Sets `value` from text.
    ///
    /// # Errors
    /// A description of the values expected. `value` is unchanged then.
    pub fn set(&self, value: &mut dyn Value, text: &str) -> Result<(), String> {
        let before = value.text();
        let [low, high] = self.range;
        let is_in = |number: &f64| (low..=high).contains(number);
        match value.parse(text.trim()) {
            Ok(()) if value.numbers().iter().all(is_in) => return Ok(()),
            Ok(()) => value.parse(&before)?,
            // The range of the setting is narrower than that of its type.
            Err(_) if text.trim().parse().is_ok_and(|number: f64| number.is_finite() && !is_in(&number)) => {}
            Err(error) => return Err(error),
        }
        Err(match (self.range_text(), (low, high)) {
            (Some(range), (_, f64::MAX)) => format!("expected {range}"),
            (Some(range), _) => format!("expected from {range}"),
            (None, _) => "expected a finite number".to_owned(),
        })
    }

    /// Describes the range of the numbers; `None` if all are allowed.
    pub fn range_text(&self) -> Option<String> {
        match (self.range[0], self.range[1]) {
            (f64::MIN, f64::MAX) => None,
            (f64::MIN_POSITIVE, f64::MAX) => Some("more than 0".to_owned()),
            (low, f64::MAX) => Some(format!("at least {low}")),
            (low, high) => Some(format!("{low} to {high}")),
        }
    }

    /// Sets a number of `value`, one of several if `part` is not 0, to the nearest in range.
    pub fn set_number(&self, value: &mut dyn Value, part: usize, number: f64) {
        value.put(part, number.clamp(self.range[0], self.range[1]));
    }
}
