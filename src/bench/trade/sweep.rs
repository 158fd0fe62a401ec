//! Sweeps of single knobs, and the designed sample of all together.

use super::errors::error_of;
use super::front::{Effect, effect};
use super::knobs::Knob;
use super::verdict::{Course, ERROR_TOLERANCE, TIME_TOLERANCE, course, verdict};
use crate::study::{Answer, Candidate, Group, Shot};
use base::sampling::Sampler;
use base::setting::JudgedBy;
use render::method::Method;
use serde::Serialize;

/// Seed of the designed sample.
const DESIGN: u32 = 1;

/// A sweep of one knob.
#[derive(Serialize)]
pub struct Sweep {
    pub knob: String,
    /// Names of the levels, with the indices of their points.
    pub levels: Vec<(String, usize)>,
    /// Courses of error and time from coarse to fine.
    pub error: Course,
    pub time: Course,
    pub verdict: &'static str,
    /// Error that the knob is judged by.
    pub judged_by: JudgedBy,
}

/// Effect of a knob on the error of light and on time, in the designed sample.
#[derive(Serialize)]
pub struct KnobEffect {
    pub knob: String,
    pub error: Option<Effect>,
    pub time: Option<Effect>,
}

/// Returns the level of each knob in each point of the designed sample.
pub fn design(knobs: &[&Knob], samples: u32) -> Vec<Vec<usize>> {
    let point = |index| {
        let mut sampler = Sampler::new(DESIGN, index);
        let mut level = |knob: &&Knob| {
            let count = knob.levels.len();
            ((f64::from(sampler.next_1d()) * count as f64) as usize).min(count - 1)
        };
        knobs.iter().map(&mut level).collect()
    };
    (0..samples).map(point).collect()
}

/// Returns a point of the designed sample.
pub fn sample(index: usize, knobs: &[&Knob], levels: &[usize]) -> Candidate {
    let mut method = Method::default();
    let mut turned = Vec::new();
    for (knob, &level) in knobs.iter().zip(levels) {
        knob.turn(level, &mut method);
        if knob.level_of(&Method::default()) != Some(level) {
            turned.push(format!("{} {}", knob.name, knob.levels[level].text));
        }
    }
    let label = format!("sample {index}");
    Candidate { group: Group::Sample, options: turned.join("; "), ..Candidate::new(label, method) }
}

/// Returns the sweep of a knob.
pub fn sweep(answer: &Answer, knob: &Knob) -> Sweep {
    let place = |level: usize| {
        let label = knob.label(level);
        answer.shots.iter().position(|s| s.candidate.group == Group::Sweep && s.candidate.label == label)
    };
    let places: Vec<usize> = (0..knob.levels.len()).filter_map(place).collect();
    let names: Vec<String> = knob.levels.iter().map(|level| level.text.clone()).collect();
    let course = |figure: &dyn Fn(&Shot) -> f64, tolerance| {
        let figures: Vec<f64> = places.iter().map(|&place| figure(&answer.shots[place])).collect();
        course(&figures, &names, tolerance)
    };
    let error = course(&|shot| error_of(shot, knob.judged_by).unwrap_or(0.0), ERROR_TOLERANCE);
    let time = course(&|shot| shot.seconds(), TIME_TOLERANCE);
    let verdict = verdict(&error, &time);
    let levels = names.iter().cloned().zip(places.iter().copied()).collect();
    Sweep { knob: knob.name.clone(), levels, error, time, verdict, judged_by: knob.judged_by }
}

/// Returns the effects of the knobs in the designed sample.
pub fn effects(answer: &Answer, knobs: &[&Knob], design: &[Vec<usize>]) -> Vec<KnobEffect> {
    let samples = || answer.shots.iter().filter(|shot| shot.candidate.group == Group::Sample);
    let errors: Vec<f64> = samples().map(|s| error_of(s, JudgedBy::Light).unwrap_or(0.0)).collect();
    let times: Vec<f64> = samples().map(Shot::seconds).collect();
    let of = |(i, knob): (usize, &&Knob)| {
        let steps = (knob.levels.len() - 1).max(1) as f64;
        let places: Vec<f64> = design.iter().map(|levels| levels[i] as f64 / steps).collect();
        KnobEffect { knob: knob.name.clone(), error: effect(&places, &errors), time: effect(&places, &times) }
    };
    knobs.iter().enumerate().map(of).collect()
}
