//! Settings that trade error for time, each with its levels from coarse to fine around the default.
//!
//! Coarse levels should be faster, fine ones better, where a setting has such an order.

use base::setting::{JudgedBy, Levels, Spec, Value};
use render::method::{Method, reconstruction};
use transport::paths::Estimand;

/// A setting, or one number of several that it has.
pub struct Knob {
    /// Its option on the command line.
    pub name: String,
    key: &'static str,
    part: usize,
    /// From coarse to fine.
    pub levels: Vec<Level>,
    /// Method rendered where the setting is varied alone, one on which it has an effect.
    pub base: Method,
    /// Error that the knob is judged by.
    pub judged_by: JudgedBy,
}

/// A value of a setting.
pub struct Level {
    /// The value as text.
    pub text: String,
    /// As a number, where it is one.
    number: Option<f64>,
}

impl Knob {
    /// Sets it to a level.
    pub fn turn(&self, level: &Level, method: &mut Method) {
        match level.number {
            Some(number) => method.each(&mut |spec, value| {
                if spec.key == self.key {
                    spec.set_number(value, self.part, number);
                }
            }),
            // Levels are valid by their declaration; a test sets them all.
            None => drop(method.set(self.key, &level.text)),
        }
    }

    /// Its index among the levels that leave `method` as it is.
    pub fn level_of(&self, method: &Method) -> Option<usize> {
        let same = |level: &Level| {
            let mut turned = *method;
            self.turn(level, &mut turned);
            turned.settings() == method.settings()
        };
        self.levels.iter().position(same)
    }
}

/// Returns all knobs of the default method.
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
            base.set_spp(reconstruction::Settings::default().spp);
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
                base,
                judged_by: levels.judged_by,
            });
        }
    });
    knobs
}

/// Values, or multiples of the default, with equal ones merged.
fn levels_of(spec: &'static Spec, levels: &Levels, value: &mut dyn Value, part: usize) -> Vec<Level> {
    let default = value.numbers().get(part).copied();
    let mut found: Vec<Level> =
        levels.values.iter().map(|text| Level { text: (*text).to_owned(), number: None }).collect();
    for factor in levels.factors {
        spec.set_number(value, part, factor * default.unwrap_or(0.0));
        let number = value.numbers().get(part).copied();
        let text = number.map_or(String::new(), |number| number.to_string());
        if found.iter().all(|level| level.text != text) {
            found.push(Level { text, number });
        }
    }
    if let Some(default) = default {
        spec.set_number(value, part, default);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::eye_samples;
    use crate::trade::has_default_samples;

    #[test]
    fn every_knob_has_distinct_levels_that_change_the_settings_and_holds_the_default() {
        let knobs = knobs();
        assert!(knobs.iter().any(|knob| knob.name == "--reach, largest"));
        for knob in &knobs {
            let turned = |level: &Level| {
                let mut method = knob.base;
                knob.turn(level, &mut method);
                method.settings()
            };
            let found: Vec<_> = knob.levels.iter().map(turned).collect();
            assert!(found.len() > 1 && knob.level_of(&knob.base).is_some(), "{}", knob.name);
            for level in knob.levels.iter().filter(|_| knob.judged_by != JudgedBy::Flip) {
                let mut method = knob.base;
                knob.turn(level, &mut method);
                let has_limit = has_default_samples(&method) || method.estimand() == eye_samples();
                assert!(has_limit, "{} {}", knob.name, level.text);
            }
            for i in 1..found.len() {
                assert!(!found[..i].contains(&found[i]), "{}: {}", knob.name, knob.levels[i].text);
            }
        }
    }
}
