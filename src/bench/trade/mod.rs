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

mod knobs;

use super::document::Grid;
use super::plot::{Chart, Colour, Line};
use super::study::{
    Answer, Candidate, Cell, Column, Curve, Figure, Group, Question, Shot, Study, StudyError, Truth,
    denoised_paths, eye_samples, optional, photons_on_eye_samples, qualities, seconds,
};
use super::{Benchmark, Kind, Results};
use base::setting::JudgedBy;
use knobs::{Knob, Sweep, knobs};
use render::method::{Method, vpl};
use serde_json::json;
use std::path::PathBuf;
use transport::lightcut::CutSettings;
use transport::paths::Estimand;
use transport::radiance_cache::FoundBy;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "trade",
    about: "What each setting buys: error against time, and the Pareto front",
    kind: Kind::Study { scenes: &[], pixels: [256, 256], run },
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
    names: 2,
    table: &[
        Column::new("label", "point", |_, s| Cell::text(&s.candidate.label)),
        Column::new("turned", "settings besides the defaults", |_, s| Cell::text(&s.candidate.options)),
        Column::new("seconds", "seconds", |_, s| Cell::seconds(s.seconds())),
        Column::new("limit", "from the limit", |_, s| Cell::optional(error_of(s, JudgedBy::Limit))),
        Column::new("light", "light error", |_, s| Cell::optional(error_of(s, JudgedBy::Light))),
        Column::new("flip", "FLIP", |_, s| Cell::figure(s.errors.flip)),
        Column::new("sort", "", |_, s| Cell::exact(s.candidate.group)),
        Column::new("settings", "", |_, s| Cell::exact(s.candidate.method.settings())),
        Column::new("denoised", "", |_, s| Cell::exact(s.counted.denoised())),
        Column::new("whole_pixels", "", |_, s| Cell::exact(s.candidate.whole_pixels())),
    ],
    brief: &["point", "seconds", "from the limit", "light error", "FLIP"],
    figures: &[
        Figure { name: "error from the limit", error: |s| error_of(s, JudgedBy::Limit), curves: CURVES },
        Figure { name: "light error", error: |s| error_of(s, JudgedBy::Light), curves: CURVES },
        Figure { name: "FLIP", error: |s| error_of(s, JudgedBy::Flip), curves: CURVES },
    ],
    ..Question::PLAIN
};

/// Groups of images, and the front of the images that estimate whole pixels. Later curves lie on top.
const CURVES: &[Curve] = &[
    Curve::of("one knob turned", Colour::Steel, Line::None, |c| c.group == Group::Sweep),
    Curve::of("front", Colour::Olive, Line::Front, |c| c.whole_pixels() && !c.is_path()),
    Curve::of("--quality", Colour::Purple, Line::None, |c| c.group == Group::Quality),
    Curve::of("default", Colour::Red, Line::None, |c| c.group == Group::Default),
    Curve::of("", Colour::Orange, Line::None, |c| c.group == Group::Other),
    Curve::of("path --denoise", Colour::Green, Line::All, |c| c.group == Group::DenoisedPath),
];

/// Returns an error of an image.
fn error_of(shot: &Shot, judged_by: JudgedBy) -> Option<f64> {
    match judged_by {
        JudgedBy::Limit => shot.compared.map(|errors| errors.rel_rmse()),
        JudgedBy::Light => shot.light.map(|errors| errors.rel_rmse()),
        JudgedBy::Flip => Some(shot.errors.flip),
    }
}

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
        section(&mut results, &answer, &knobs);
    }
    Ok(results)
}

/// Adds the results of a scene.
fn section(results: &mut Results, answer: &Answer, knobs: &[Knob]) {
    let sweeps: Vec<Sweep> = knobs.iter().map(|knob| knob.sweep(answer)).collect();
    results.push("scenes", answer.facts(), json!({ "points": answer.rows(), "sweeps": sweeps }));
    let document = &mut results.document;
    document.heading(2, &answer.scene);
    let chart = Chart { panels: answer.panels(), caption: Vec::new() };
    document.plot(&format!("{}-fronts", answer.scene), &chart);
    answer.tell(document);
    document.heading(3, "Knob by knob");
    let heads = ["knob", "judged by", "coarse → fine: seconds, error"];
    document.grid(&Grid::new(3, &heads, sweeps.iter().map(|sweep| row(answer, sweep)).collect()));
}

/// Returns the row of a sweep.
fn row(answer: &Answer, sweep: &Sweep) -> Vec<String> {
    let level = |(text, place): &(String, usize)| {
        let shot = &answer.shots[*place];
        format!("{text}: {}, {}", seconds(shot.seconds()), optional(error_of(shot, sweep.judged_by)))
    };
    let levels: Vec<String> = sweep.levels.iter().map(level).collect();
    let judged_by = match sweep.judged_by {
        JudgedBy::Limit => "error from the limit",
        JudgedBy::Light => "light error",
        JudgedBy::Flip => "FLIP",
    };
    vec![sweep.knob.clone(), judged_by.to_owned(), levels.join("; ")]
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
    let mut kept = vpl::Settings::lightcuts();
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
        Method::Vpl(vpl::Settings::lightcuts()),
        Method::Vpl(photons_on_eye_samples()),
    ]
    .map(|method| Candidate { group: Group::Other, ..Candidate::new(method.name(), method) })
}
