//! The settings that trade error for time, each with its levels from coarse to fine around the default.
//!
//! Coarse is what should be faster, fine what should be better; where a setting has no such order the text says so.

use crate::light_tree::Family;
use crate::method::cache::Settings;
use crate::radiance_cache::{Footprints, FoundBy};
use serde::Serialize;

/// A change of settings.
type Change = fn(&mut Settings);

/// A setting.
pub struct Knob {
    /// Its option on the command line, or its name in the settings.
    pub name: &'static str,
    /// From coarse to fine.
    pub levels: Vec<Level>,
    /// Makes it matter, where it does not by default.
    pub with: Change,
    /// The error that shows what it does.
    pub judged_by: JudgedBy,
}

/// Which error shows what a knob does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum JudgedBy {
    /// That against lightcuts of a much smaller error on the same virtual lights: what they and their clamping get
    /// wrong would hide all else.
    Limit,
    /// That of light: the knob changes the virtual lights or how they are clamped.
    Light,
    /// FLIP of whole pictures: the knob changes the eye samples.
    Flip,
}

/// A value of a setting.
pub struct Level {
    /// What it is.
    pub text: String,
    set: Set,
}

enum Set {
    Number(fn(&mut Settings, f64), f64),
    Choice(Change),
}

impl Level {
    /// Sets it.
    pub fn apply(&self, settings: &mut Settings) {
        match self.set {
            Set::Number(set, value) => set(settings, value),
            Set::Choice(set) => set(settings),
        }
    }
}

impl Knob {
    fn new(name: &'static str, levels: Vec<Level>) -> Knob {
        Knob { name, levels, with: |_| (), judged_by: JudgedBy::Limit }
    }

    fn with(self, with: Change) -> Knob {
        Knob { with, ..self }
    }

    /// Its index among the levels that leave the settings as they are.
    pub fn default_level(&self) -> Option<usize> {
        let default = Settings::default();
        let same = |level: &Level| {
            let mut settings = default;
            level.apply(&mut settings);
            format!("{settings:?}") == format!("{default:?}")
        };
        self.levels.iter().position(same)
    }

    fn judged_by(self, judged_by: JudgedBy) -> Knob {
        Knob { judged_by, ..self }
    }

    /// Multiples of the default.
    fn scaled(
        name: &'static str,
        factors: &[f64],
        get: fn(&Settings) -> f64,
        set: fn(&mut Settings, f64),
    ) -> Knob {
        let default = get(&Settings::default());
        Knob::of(name, &factors.iter().map(|factor| factor * default).collect::<Vec<_>>(), get, set)
    }

    /// Values, and the default among them; those that come to the same once set are one.
    fn of(
        name: &'static str,
        values: &[f64],
        get: fn(&Settings) -> f64,
        set: fn(&mut Settings, f64),
    ) -> Knob {
        let mut levels: Vec<Level> = Vec::new();
        for &value in values {
            let mut settings = Settings::default();
            set(&mut settings, value);
            let value = get(&settings);
            // Fractions of f32 with the digits that were meant.
            let text = (value as f32).to_string();
            if levels.iter().all(|level| level.text != text) {
                levels.push(Level { text, set: Set::Number(set, value) });
            }
        }
        Knob::new(name, levels)
    }

    fn choice(name: &'static str, choices: &[(&str, Change)]) -> Knob {
        let level = |&(text, set): &(&str, Change)| Level { text: text.to_owned(), set: Set::Choice(set) };
        Knob::new(name, choices.iter().map(level).collect())
    }
}

/// From four times the default down.
const DOWN: [f64; 5] = [4.0, 2.0, 1.0, 0.5, 0.25];
/// From a quarter of the default up.
const UP: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// What asks for records of indirect light: their knobs have no effect otherwise.
fn records(settings: &mut Settings) {
    settings.cache.indirect = FoundBy::Records;
}

/// All of them.
pub fn knobs() -> Vec<Knob> {
    let clamp = |s: &Settings| f64::from(s.cut.clamp.unwrap_or(1.0));
    vec![
        Knob::scaled("--epsilon", &DOWN, |s| s.cut.epsilon.into(), |s, v| s.cut.epsilon = v as f32),
        Knob::scaled(
            "--record-epsilon",
            &DOWN,
            |s| s.cache.cut.epsilon.into(),
            |s, v| s.cache.cut.epsilon = v as f32,
        )
        .with(records),
        Knob::scaled(
            "--max-cut",
            &UP,
            |s| s.cut.max_cut as f64,
            |s, v| {
                s.cut.max_cut = v.round().max(1.0) as usize;
                s.cache.cut.max_cut = s.cut.max_cut;
            },
        ),
        Knob::scaled(
            "--vpls",
            &[1.0 / 16.0, 0.25, 1.0, 4.0],
            |s| s.light.indirect.into(),
            |s, v| s.light.indirect = v.round() as u32,
        )
        .judged_by(JudgedBy::Light),
        Knob::scaled(
            "--direct-vpls",
            &[1.0 / 16.0, 0.25, 1.0, 4.0],
            |s| s.light.direct.into(),
            |s, v| s.light.direct = v.round().max(1.0) as u32,
        )
        .judged_by(JudgedBy::Light),
        Knob::scaled("--clamp", &UP, clamp, |s, v| {
            s.cut.clamp = Some((v as f32).min(1.0));
            s.cache.cut.clamp = s.cut.clamp;
        })
        .judged_by(JudgedBy::Light),
        Knob::choice(
            "--compensation",
            &[("off", |s| s.compensation = false), ("on", |s| s.compensation = true)],
        )
        .judged_by(JudgedBy::Light),
        Knob::scaled(
            "--accuracy, direct",
            &DOWN,
            |s| s.cache.layers[0].accuracy.into(),
            |s, v| s.cache.layers[0].accuracy = v as f32,
        )
        .with(|s| s.cache.direct = FoundBy::Records),
        Knob::scaled(
            "--accuracy, indirect",
            &DOWN,
            |s| s.cache.layers[1].accuracy.into(),
            |s, v| s.cache.layers[1].accuracy = v as f32,
        )
        .with(records),
        Knob::scaled(
            "--reach, least, indirect",
            &DOWN,
            |s| s.cache.layers[1].reach[0].into(),
            |s, v| s.cache.layers[1].reach[0] = (v as f32).min(s.cache.layers[1].reach[1]),
        )
        .with(records),
        Knob::scaled(
            "--reach, largest, indirect",
            &DOWN,
            |s| s.cache.layers[1].reach[1].into(),
            |s, v| s.cache.layers[1].reach[1] = (v as f32).max(s.cache.layers[1].reach[0]),
        )
        .with(records),
        Knob::choice(
            "--footprints",
            &[
                ("isotropic", |s| s.cache.footprints = Footprints::Isotropic),
                ("anisotropic", |s| s.cache.footprints = Footprints::Anisotropic),
                ("occlusion", |s| s.cache.footprints = Footprints::Occlusion),
            ],
        )
        .with(records),
        Knob::scaled(
            "--probe-rays",
            &UP,
            |s| s.cache.probe_rays.into(),
            |s, v| s.cache.probe_rays = v.round().max(1.0) as u32,
        )
        .with(records),
        Knob::scaled("--mu (no order)", &DOWN, |s| s.cache.mu.into(), |s, v| s.cache.mu = v as f32).with(
            |s| {
                records(s);
                s.cache.footprints = Footprints::Anisotropic;
            },
        ),
        Knob::choice(
            "--direct",
            &[
                ("records", |s| s.cache.direct = FoundBy::Records),
                ("samples", |s| s.cache.direct = FoundBy::Samples),
            ],
        ),
        Knob::choice(
            "--indirect",
            &[
                ("records", |s| s.cache.indirect = FoundBy::Records),
                ("samples", |s| s.cache.indirect = FoundBy::Samples),
            ],
        ),
        Knob::of(
            "--series-alpha",
            &[0.15, 0.2, 0.25, 0.35, 0.5, 2.0],
            |s| s.cache.series.min_alpha.into(),
            |s, v| s.cache.series.min_alpha = v as f32,
        )
        .with(records),
        Knob::scaled(
            "--series-error",
            &DOWN,
            |s| s.cache.series.max_error,
            |s, v| s.cache.series.max_error = v,
        )
        .with(records),
        Knob::scaled("error of bands", &DOWN, |s| s.cache.series.error, |s, v| s.cache.series.error = v)
            .with(records),
        Knob::of(
            "--passes",
            &[0.0, 1.0, 2.0, 5.0],
            |s| s.cache.passes.into(),
            |s, v| s.cache.passes = v as u32,
        )
        .with(records),
        Knob::scaled("--threshold", &DOWN, |s| s.cache.threshold.into(), |s, v| s.cache.threshold = v as f32)
            .with(records),
        Knob::scaled(
            "--patches",
            &UP,
            |s| s.cache.patches.into(),
            |s, v| s.cache.patches = v.round().max(1.0) as u32,
        ),
        Knob::choice("--share", &[("on", |s| s.cache.share = true), ("off", |s| s.cache.share = false)]),
        Knob::scaled(
            "--least-cell",
            &UP,
            |s| s.cache.least_cell.into(),
            |s, v| s.cache.least_cell = v.round().max(1.0) as u32,
        )
        .with(records),
        Knob::scaled(
            "tolerance of normals",
            &[2.0, 1.0, 0.5],
            |s| s.cache.normal_tolerance.into(),
            |s, v| s.cache.normal_tolerance = v as f32,
        )
        .with(records),
        Knob::choice(
            "--tree",
            &[
                ("agglomerative", |s| s.family = Family::Agglomerative),
                ("divisive", |s| s.family = Family::Divisive),
            ],
        ),
        Knob {
            judged_by: JudgedBy::Flip,
            ..Knob::scaled("--spp", &UP, |s| s.spp.into(), |s, v| s.spp = v.round().max(1.0) as u32)
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_knob_has_distinct_levels_that_change_the_settings_and_holds_the_default() {
        for knob in knobs() {
            let set = |level: &Level| {
                let mut settings = Settings::default();
                (knob.with)(&mut settings);
                level.apply(&mut settings);
                format!("{settings:?}")
            };
            let mut default = Settings::default();
            (knob.with)(&mut default);
            let found: Vec<String> = knob.levels.iter().map(set).collect();
            assert!(found.len() > 1 && found.contains(&format!("{default:?}")), "{}", knob.name);
            for i in 1..found.len() {
                assert!(!found[..i].contains(&found[i]), "{}: {}", knob.name, knob.levels[i].text);
            }
        }
    }
}
