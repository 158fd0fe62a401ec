//! Settings that trade error for time, each with its levels from coarse to fine around the default.
//!
//! Coarse levels should be faster and fine ones better, if a setting has such an order.

use crate::study::{Answer, Candidate, Group, Shot};
use base::setting::{JudgedBy, Levels, Spec, Value};
use render::method::{Method, vpl};
use serde::Serialize;
use transport::paths::Estimand;

/// A setting, or one of its numbers.
pub struct Knob {
    /// Name of the setting, and of its number.
    pub name: String,
    key: &'static str,
    part: usize,
    /// Levels from coarse to fine.
    levels: Vec<Level>,
    /// Method rendered in a sweep, on which the setting has an effect.
    pub base: Method,
    /// Error that the knob is judged by.
    pub judged_by: JudgedBy,
}

/// A value of a setting.
struct Level {
    /// The value as text.
    text: String,
    /// The value, if it is a number.
    number: Option<f64>,
}

/// A sweep of one knob.
#[derive(Serialize)]
pub struct Sweep {
    pub knob: String,
    /// Names of the levels, with the indices of their points.
    pub levels: Vec<(String, usize)>,
    /// Error that the knob is judged by.
    pub judged_by: JudgedBy,
}

impl Knob {
    /// Returns the label of a level.
    fn label(&self, level: usize) -> String {
        format!("{} {}", self.name, self.levels[level].text)
    }

    /// Returns the images of all levels.
    pub fn candidates(&self) -> impl Iterator<Item = Candidate> {
        (0..self.levels.len()).map(|level| self.candidate(level))
    }

    /// Returns the sweep of the knob's levels in an answer.
    pub fn sweep(&self, answer: &Answer) -> Sweep {
        let place = |level: usize| {
            let label = self.label(level);
            let is_level =
                |shot: &Shot| shot.candidate.group == Group::Sweep && shot.candidate.label == label;
            Some((self.levels[level].text.clone(), answer.shots.iter().position(is_level)?))
        };
        let levels = (0..self.levels.len()).filter_map(place).collect();
        Sweep { knob: self.name.clone(), levels, judged_by: self.judged_by }
    }

    /// Returns the image of a level.
    fn candidate(&self, level: usize) -> Candidate {
        let mut method = self.base;
        self.turn(level, &mut method);
        let label = self.label(level);
        Candidate {
            options: label.clone(),
            group: Group::Sweep,
            main: false,
            ..Candidate::new(label, method)
        }
    }

    /// Sets a level.
    fn turn(&self, level: usize, method: &mut Method) {
        let Level { text, number } = &self.levels[level];
        match number {
            Some(number) => method.each(&mut |spec, value| {
                if spec.key == self.key {
                    spec.set_number(value, self.part, *number);
                }
            }),
            // A test sets all levels.
            None => drop(method.set(self.key, text)),
        }
    }
}

/// Returns the knobs that are settings of the default method.
pub fn knobs() -> Vec<Knob> {
    let mut knobs: Vec<Knob> = Vec::new();
    Method::default().visit(&mut |spec, value| {
        let Some(levels) = spec.levels() else { return };
        let mut base = Method::default();
        for (key, text) in levels.with {
            drop(base.set(key, text));
        }
        // Methods that keep eye samples are judged on those of reconstruction cuts.
        if base.estimand() != Estimand::Pixels {
            base.set_spp(vpl::Settings::reconstruction().spp);
        }
        for (part, label) in levels.parts.iter().enumerate() {
            if levels.parts.len() > 1 && label.is_empty() {
                continue;
            }
            let comma = if label.is_empty() { "" } else { ", " };
            knobs.push(Knob {
                name: format!("{}{comma}{label}", spec.option()),
                key: spec.key,
                part,
                levels: levels_of(spec, levels, value, part),
                base,
                judged_by: levels.judged_by,
            });
        }
    });
    knobs
}

/// Returns the levels, which are values or multiples of the default, without repetitions.
fn levels_of(spec: &'static Spec, levels: &Levels, value: &mut dyn Value, part: usize) -> Vec<Level> {
    let default = value.numbers().get(part).copied();
    let mut all: Vec<Level> =
        levels.values.iter().map(|text| Level { text: (*text).to_owned(), number: None }).collect();
    for factor in levels.factors {
        spec.set_number(value, part, factor * default.unwrap_or(0.0));
        let number = value.numbers().get(part).copied();
        let text = number.map_or(String::new(), |number| number.to_string());
        if all.iter().all(|level| level.text != text) {
            all.push(Level { text, number });
        }
    }
    if let Some(default) = default {
        spec.set_number(value, part, default);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trade::limit_of;

    #[test]
    fn every_knob_has_distinct_levels_that_change_the_settings_and_holds_the_default() {
        let knobs = knobs();
        assert!(knobs.iter().any(|knob| knob.name == "reach, largest"));
        for knob in &knobs {
            let candidates: Vec<Candidate> = knob.candidates().collect();
            let found: Vec<_> = candidates.iter().map(|c| c.method.settings()).collect();
            assert!(found.len() > 1 && found.contains(&knob.base.settings()), "{}", knob.name);
            for candidate in candidates.iter().filter(|_| knob.judged_by != JudgedBy::Flip) {
                assert!(limit_of(candidate).is_some(), "{}", candidate.label);
            }
            for i in 1..found.len() {
                assert!(!found[..i].contains(&found[i]), "{}: {}", knob.name, knob.levels[i].text);
            }
        }
    }
}
