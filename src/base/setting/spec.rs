//! Description of a setting, all but its value.

use super::Value;
use serde::Serialize;

/// From four times the default down.
pub const DOWN: [f64; 5] = [4.0, 2.0, 1.0, 0.5, 0.25];
/// From a quarter of the default up.
pub const UP: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// Description of a setting.
#[derive(Debug)]
pub struct Spec {
    /// Name in statistics and metadata; with dashes, the option's.
    pub key: &'static str,
    /// The field's documentation, of which the first paragraph is for users.
    doc: &'static str,
    /// Heading of its group in `--help`; empty for none.
    pub heading: &'static str,
    /// Placeholder of the value in `--help`, where the name does not say enough.
    pub placeholder: Option<&'static str>,
    /// True for an option without a value: typed, it is on.
    pub flag: bool,
    /// Minimum and maximum.
    range: [f64; 2],
    /// Levels that benchmarks try, if it trades error for time.
    levels: Levels,
}

/// Levels of a setting from coarse, which should be faster, to fine, which should be better.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Factors on the default.
    pub factors: &'static [f64],
    /// Values as they are typed.
    pub values: &'static [&'static str],
    /// Names of the numbers that it has, if several; those without are not varied.
    pub parts: &'static [&'static str],
    /// Settings, by key, that make it matter where it does not by default.
    pub with: &'static [(&'static str, &'static str)],
    /// Error that the knob is judged by.
    pub judged_by: JudgedBy,
}

/// Errors that show the effect of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum JudgedBy {
    /// Error against cuts of a much smaller error on the same virtual lights, by the same samples: the errors of the
    /// lights and their clamping would hide all else.
    Limit,
    /// Error of light: the setting changes the virtual lights or their clamping.
    Light,
    /// FLIP of whole pictures: the setting changes the samples.
    Flip,
}

const NO_LEVELS: Levels =
    Levels { factors: &[], values: &[], parts: &[""], with: &[], judged_by: JudgedBy::Limit };

impl Spec {
    /// A setting of any value, which no benchmark varies.
    pub const fn new(key: &'static str, doc: &'static str, heading: &'static str) -> Spec {
        let range = [f64::MIN, f64::MAX];
        Spec { key, doc, heading, placeholder: None, flag: false, range, levels: NO_LEVELS }
    }

    /// Under another name than the field's.
    pub const fn named(self, key: &'static str) -> Spec {
        Spec { key, ..self }
    }

    /// Under another heading than its struct's.
    pub const fn heading(self, heading: &'static str) -> Spec {
        Spec { heading, ..self }
    }

    /// With this placeholder for its value in `--help`.
    pub const fn placeholder(self, text: &'static str) -> Spec {
        Spec { placeholder: Some(text), ..self }
    }

    /// As an option without a value.
    pub const fn flag(self) -> Spec {
        Spec { flag: true, ..self }
    }

    /// Of numbers from `low` to `high`.
    pub const fn range(self, low: f64, high: f64) -> Spec {
        Spec { range: [low, high], ..self }
    }

    /// Of numbers from `low`.
    pub const fn at_least(self, low: f64) -> Spec {
        self.range(low, f64::MAX)
    }

    /// Of numbers above 0.
    pub const fn positive(self) -> Spec {
        self.at_least(f64::MIN_POSITIVE)
    }

    /// Of numbers from 0 to 1.
    pub const fn fraction(self) -> Spec {
        self.range(0.0, 1.0)
    }

    /// Varied by benchmarks, by factors on its default.
    pub const fn scaled(self, factors: &'static [f64]) -> Spec {
        Spec { levels: Levels { factors, ..self.levels }, ..self }
    }

    /// Varied by benchmarks, over values as they are typed.
    pub const fn values(self, values: &'static [&'static str]) -> Spec {
        Spec { levels: Levels { values, ..self.levels }, ..self }
    }

    /// With names for its numbers; those without are not varied.
    pub const fn parts(self, parts: &'static [&'static str]) -> Spec {
        Spec { levels: Levels { parts, ..self.levels }, ..self }
    }

    /// Varied while other settings have values that make it matter.
    pub const fn with(self, with: &'static [(&'static str, &'static str)]) -> Spec {
        Spec { levels: Levels { with, ..self.levels }, ..self }
    }

    /// Sets another error to judge by than [`JudgedBy::Limit`].
    pub const fn judged_by(self, judged_by: JudgedBy) -> Spec {
        Spec { levels: Levels { judged_by, ..self.levels }, ..self }
    }

    /// Levels that benchmarks try; `None` if it does not trade error for time.
    pub fn levels(&self) -> Option<&Levels> {
        Some(&self.levels).filter(|levels| !levels.factors.is_empty() || !levels.values.is_empty())
    }

    /// Name of the option, without its two dashes.
    pub fn option(&self) -> String {
        self.key.replace('_', "-")
    }

    /// Text for users.
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
            // The range of the setting says more than that of its type.
            Err(_) if text.trim().parse().is_ok_and(|number: f64| number.is_finite() && !is_in(&number)) => {}
            Err(error) => return Err(error),
        }
        Err(match (low, high) {
            (f64::MIN_POSITIVE, f64::MAX) => "expected more than 0".to_owned(),
            (f64::MIN, f64::MAX) => "expected a finite number".to_owned(),
            (low, f64::MAX) => format!("expected at least {low}"),
            (low, high) => format!("expected from {low} to {high}"),
        })
    }

    /// Sets a number of `value` to the nearest that it can have.
    pub fn set_number(&self, value: &mut dyn Value, part: usize, number: f64) {
        value.put(part, number.clamp(self.range[0], self.range[1]));
    }
}

/// The first paragraph of a documentation comment, as one line without the stop at its end.
pub fn first_paragraph(doc: &str) -> String {
    let lines: Vec<&str> = doc.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    lines.join(" ").trim_end_matches('.').replace('`', "")
}
