//! The trade-off of each setting of the default method: error against time, one setting at a time.
//!
//! Images are denoised if their method's default says so. Three errors are distinguished:
//!
//! - from the limit: against the same image with cuts of a quarter of the error, the same virtual lights and the same
//!   samples of direct light. This is the error added by records and cuts;
//! - of light: against a path-traced reference. It includes the errors of virtual lights and their clamping, and the
//!   noise that remains of sampled light;
//! - FLIP against the same reference.
//!
//! The reference is one of whole pixels. Methods that keep a few eye samples per pixel, and knobs that only have an
//! effect on these, have limit and light judged on those samples, without their aliasing.
//!
//! The settings of `--quality` and denoised paths are shown beside them.

mod front;
mod knobs;
mod tell;

use super::study::{
    Candidate, Cell, Column, Group, Question, Study, StudyError, Truth, denoised_paths, eye_samples,
    lightcuts_on_eye_samples, photons_on_eye_samples, qualities,
};
use super::{Benchmark, Kind, Results, Scenes};
use base::setting::JudgedBy;
use front::{ERRORS, error_of, is_on_front};
use knobs::{Knob, knobs};
use render::method::{Method, vpl};
use std::path::PathBuf;
use transport::lightcut::CutSettings;
use transport::paths::Estimand;
use transport::radiance_cache::FoundBy;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "trade",
    about: "What each setting buys: error against time, and the Pareto front",
    kind: Kind::Study { scenes: Scenes::Files(&[]), pixels: [256, 256], run },
};

/// Caption of the tables.
const LEGEND: &str = "Times are processor seconds over all threads. From the limit: relative RMSE against the same image with \
    cuts of a quarter of the error, the same virtual lights and the same samples of direct light; the error that cuts and \
    records add. Light error: relative RMSE against the reference, without its noise and without the worst pixel of a \
    thousand; it includes the errors of virtual lights and their clamping, and the remaining noise. FLIP includes the \
    noise of the reference. The default and paths are denoised. Reconstruction, lightcuts, photon-cache and knobs with \
    direct light from records or cuts keep four eye samples per pixel: their errors from the limit and of light are against \
    lightcuts and a reference through those samples, and their FLIP includes their aliasing.";

/// Points of a scene over processor seconds.
const QUESTION: Question = Question {
    error: Truth::PixelsAndEyeSamples,
    compared_with: limit_of,
    names: 6,
    table: &[
        Column::new("seconds", "seconds", |_, s| Cell::seconds(s.seconds())),
        Column::new("limit", "from the limit", |_, s| Cell::optional(error_of(s, JudgedBy::Limit))),
        Column::new("light", "light error", |_, s| Cell::optional(error_of(s, JudgedBy::Light))),
        Column::new("flip", "FLIP", |_, s| Cell::figure(s.errors.flip)),
        Column::new("label", "point", |_, s| Cell::text(&s.candidate.label)),
        Column::new("turned", "settings besides the defaults", |_, s| Cell::text(&s.candidate.options)),
        Column::new("sort", "", |_, s| Cell::exact(s.candidate.group)),
        Column::new("settings", "", |_, s| Cell::exact(s.candidate.method.settings())),
        Column::new("denoised", "", |_, s| Cell::exact(s.counted.denoised())),
        Column::new("whole_pixels", "", |_, s| Cell::exact(s.candidate.whole_pixels())),
        Column::new("fronts", "", |a, s| {
            Cell::exact(ERRORS.into_iter().filter(|e| is_on_front(a, s, *e)).collect::<Vec<_>>())
        }),
    ],
    ..Question::PLAIN
};

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    let mut knobs = knobs();
    let names: Vec<String> = knobs.iter().map(|knob| knob.name.clone()).collect();
    let chosen = study.plan.knobs(&names.iter().map(String::as_str).collect::<Vec<_>>())?;
    knobs.retain(|knob| chosen.contains(&&*knob.name));
    let mut results = Results::new("Trade", study.facts(), LEGEND);
    for path in scenes {
        let mut images = vec![Candidate::new("default", Method::default())];
        images.extend(others());
        images.extend(denoised_paths(study));
        images.extend(qualities());
        images.extend(knobs.iter().flat_map(Knob::candidates));
        let question = Question { images: &images, others: &limits(), ..QUESTION };
        let answer = study.ask(question, [study.subject(path)])?;
        let sweeps: Vec<_> = knobs.iter().map(|knob| knob.sweep(&answer)).collect();
        tell::section(&mut results, &answer, &sweeps);
    }
    Ok(results)
}

/// Returns the limits of cuts and records on the defaults' virtual lights, for the default's samples and for eye
/// samples: cuts of a quarter of the error at every point.
fn limits() -> Vec<Candidate> {
    let finer = |cut: &mut CutSettings| {
        cut.epsilon *= 0.25;
        cut.max_cut *= 16;
    };
    let mut sampled = vpl::Settings::cache();
    sampled.cache.indirect = FoundBy::Cuts;
    sampled.share = false;
    finer(&mut sampled.cut);
    let mut kept = lightcuts_on_eye_samples();
    finer(&mut kept.cut);
    [("limit", Method::Vpl(sampled)), ("limit of eye samples", Method::Vpl(kept))]
        .map(|(label, method)| Candidate::new(label, method))
        .into()
}

/// Returns the index of the limit with the samples of a candidate, if there is one.
fn limit_of(candidate: &Candidate) -> Option<usize> {
    match candidate.method.estimand() {
        Estimand::Pixels => has_default_samples(&candidate.method).then_some(0),
        estimand => (estimand == eye_samples()).then_some(1),
    }
}

/// Returns true if a method takes the samples of the default.
fn has_default_samples(method: &Method) -> bool {
    let samples = |method: &Method| (method.name(), method.estimand(), method.spp(), method.seed());
    samples(method) == samples(&Method::default())
}

/// Returns the methods that keep eye samples at their defaults, all on those of reconstruction cuts.
fn others() -> [Candidate; 3] {
    [
        Method::Vpl(vpl::Settings::reconstruction()),
        Method::Vpl(lightcuts_on_eye_samples()),
        Method::Vpl(photons_on_eye_samples()),
    ]
    .map(|method| Candidate { group: Group::Other, ..Candidate::new(method.name(), method) })
}
