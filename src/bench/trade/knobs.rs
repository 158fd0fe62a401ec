//! Settings that trade error for time, each with its levels from coarse to fine around the default, and builds of the
//! acceleration structure.
//!
//! Coarse levels should be faster and fine ones better, if a setting has such an order.

use crate::study::{Candidate, Group};
use base::setting::{JudgedBy, Levels, Spec, Value};
use embree::BuildQuality;
use render::method::{Method, vpl};
use transport::paths::Estimand;

/// A setting, one of its numbers, or a choice between builds.
pub struct Knob {
    /// Option on the command line, or name of the choice.
    pub name: String,
    key: &'static str,
    part: usize,
    /// Levels from coarse to fine.
    pub levels: Vec<Level>,
    /// Builds of the levels, in a choice between builds.
    pub builds: &'static [BuildQuality],
    /// Method rendered in a sweep, on which the setting has an effect.
    pub base: Method,
    /// Error that the knob is judged by.
    pub judged_by: JudgedBy,
}

/// A value of a setting.
pub struct Level {
    /// The value as text.
    pub text: String,
    /// The value, if it is a number.
    number: Option<f64>,
}

impl Knob {
    /// Returns the name without dashes in front.
    pub fn plain_name(&self) -> &str {
        self.name.trim_start_matches('-')
    }

    /// Returns the label of a level.
    pub fn label(&self, level: usize) -> String {
        format!("{} {}", self.name, self.levels[level].text)
    }

    /// Returns the image of a level in a sweep.
    pub fn candidate(&self, level: usize) -> Candidate {
        let mut method = self.base;
        self.turn(level, &mut method);
        let (label, build) = (self.label(level), self.builds.get(level).copied());
        Candidate { build, options: label.clone(), group: Group::Sweep, ..Candidate::new(label, method) }
    }

    /// Sets a level.
    pub fn turn(&self, level: usize, method: &mut Method) {
        let Level { text, number } = &self.levels[level];
        match number {
            Some(number) => method.each(&mut |spec, value| {
                if spec.key == self.key {
                    spec.set_number(value, self.part, *number);
                }
            }),
            // A test sets all levels. Builds have no setting.
            None => drop(method.set(self.key, text)),
        }
    }

    /// Returns the index of the level that leaves `method` as it is.
    pub fn level_of(&self, method: &Method) -> Option<usize> {
        let same = |level: &usize| {
            let mut turned = *method;
            self.turn(*level, &mut turned);
            turned.settings() == method.settings()
        };
        (0..self.levels.len()).find(same)
    }
}

/// Returns all knobs of the default method, then the choices between builds.
pub fn knobs() -> Vec<Knob> {
    let mut knobs = settings();
    knobs.push(builds(
        "build quality",
        &["low", "medium", "high"],
        &[BuildQuality::Low, BuildQuality::Medium, BuildQuality::High],
    ));
    knobs.push(builds("robust traversal", &["off", "on"], &[BuildQuality::Medium, BuildQuality::Robust]));
    knobs
}

/// Returns a choice between builds of the acceleration structure.
fn builds(name: &str, levels: &[&str], builds: &'static [BuildQuality]) -> Knob {
    let level = |text: &&str| Level { text: (*text).to_owned(), number: None };
    Knob {
        name: name.to_owned(),
        key: "",
        part: 0,
        levels: levels.iter().map(level).collect(),
        builds,
        base: Method::default(),
        judged_by: JudgedBy::Limit,
    }
}

/// Returns the knobs that are settings of the default method.
fn settings() -> Vec<Knob> {
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
                name: format!("--{}{comma}{label}", spec.option()),
                key: spec.key,
                part,
                levels: levels_of(spec, levels, value, part),
                builds: &[],
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
        let knobs = settings();
        assert!(knobs.iter().any(|knob| knob.name == "--reach, largest"));
        for knob in &knobs {
            let candidates: Vec<Candidate> =
                (0..knob.levels.len()).map(|level| knob.candidate(level)).collect();
            let found: Vec<_> = candidates.iter().map(|c| c.method.settings()).collect();
            assert!(found.len() > 1 && knob.level_of(&knob.base).is_some(), "{}", knob.name);
            for candidate in candidates.iter().filter(|_| knob.judged_by != JudgedBy::Flip) {
                assert!(limit_of(candidate).is_some(), "{}", candidate.label);
            }
            for i in 1..found.len() {
                assert!(!found[..i].contains(&found[i]), "{}: {}", knob.name, knob.levels[i].text);
            }
        }
    }
}
