//! The trade-off of each setting of the default method: error against time, one setting at a time and by a
//! designed sample.
//!
//! Every knob is swept alone around the defaults; then all are varied together by an Owen-scrambled Sobol
//! design, whose projection on any one knob is stratified. Pictures are denoised where that is their method's
//! default. Three errors are distinguished:
//!
//! - from the limit: against the same picture by cuts of a quarter of the error on the same virtual lights, with
//!   the same samples of direct light: the error added by records and cuts;
//! - of light: against a path-traced reference, which includes the errors of virtual lights and their clamping,
//!   and the noise that remains of drawn light;
//! - FLIP: against the same reference, as it is seen.
//!
//! The reference is one of whole pixels. Methods that keep a few eye samples a pixel, and knobs that have an effect
//! with direct light by records or cuts only, have limit and light judged on those samples instead, without
//! their aliasing.
//!
//! The settings of `--quality` are shown beside them, and denoised paths. Builds of the acceleration structure
//! are varied alone, not in the designed sample.

mod builds;
mod document;
mod front;
mod knobs;
mod sweep;
mod verdict;

use super::study::{Candidate, Errors, Noise, Reference, Results, Run, Study, StudyError, Subject};
use super::study::{eye_samples, qualities};
use super::{Benchmark, Kind};
use base::setting::JudgedBy;
use base::stats::Stage;
use builds::{BUILDS, Builds};
use front::{Effect, front};
use knobs::{Knob, knobs};
use render::method::{Method, cache, lightcuts, photon_cache, reconstruction};
use serde::Serialize;
use serde_json::Value;
use std::path::PathBuf;
use transport::lightcut::CutSettings;
use transport::paths::Estimand;
use transport::radiance_cache::FoundBy;
use verdict::Course;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "trade",
    about: "What each setting buys: error against time, and the Pareto front",
    kind: Kind::Study { scenes: &[], pixels: [256, 256], run },
};

/// Errors that fronts are drawn for.
const ERRORS: [JudgedBy; 3] = [JudgedBy::Limit, JudgedBy::Light, JudgedBy::Flip];

/// All results.
#[derive(Serialize)]
struct Trade {
    facts: Vec<(String, String)>,
    scenes: Vec<SceneTrade>,
}

/// Results of a scene.
#[derive(Serialize)]
struct SceneTrade {
    scene: String,
    /// Noise of the reference of pixels.
    reference: Noise,
    /// Noise of the reference of eye samples.
    light_reference: Noise,
    points: Vec<Point>,
    sweeps: Vec<Sweep>,
    effects: Vec<KnobEffect>,
}

/// A picture's settings, time and errors.
#[derive(Serialize)]
struct Point {
    label: String,
    /// Reason for which it was rendered.
    sort: Sort,
    settings: Value,
    /// True if the picture is denoised.
    denoised: bool,
    /// True if it estimates whole pixels, false if it keeps eye samples.
    whole_pixels: bool,
    /// Processor seconds.
    seconds: f64,
    /// Settings that differ from the defaults.
    turned: String,
    /// Relative RMSE from the limit, where that has the same samples.
    limit: Option<f64>,
    /// Relative RMSE of light: of whole pixels, or of the reference's eye samples.
    light: Option<f64>,
    /// FLIP against the reference of pixels.
    flip: f64,
    /// Errors by which no other point of the default method is faster and no worse.
    fronts: Vec<JudgedBy>,
}

/// Reason for which a picture was rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Sort {
    /// The defaults.
    Default,
    /// A setting of `--quality`.
    Quality,
    /// One knob varied.
    Sweep,
    /// A point of the designed sample.
    Sample,
    /// Another method.
    Other,
    /// Denoised paths of some number of samples.
    DenoisedPath,
}

/// A sweep of one knob.
#[derive(Serialize)]
struct Sweep {
    knob: String,
    /// Names of the levels, with the indices of their points.
    levels: Vec<(String, usize)>,
    /// Courses of error and time from coarse to fine.
    error: Course,
    time: Course,
    verdict: &'static str,
    /// Error that the knob is judged by.
    judged_by: JudgedBy,
}

/// A knob's effect in the designed sample, on the error of light.
#[derive(Serialize)]
struct KnobEffect {
    knob: String,
    error: Option<Effect>,
    time: Option<Effect>,
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    // Names are checked before anything is rendered.
    chosen(&study.plan.knobs)?;
    let mut trade = Trade { facts: study.facts(), scenes: Vec::new() };
    for path in scenes {
        let subject = study.subject(path)?;
        trade.scenes.push(scene(study, subject)?);
    }
    Ok(Results { json: serde_json::json!(trade), document: document::document(&trade) })
}

/// Renders points and judges them.
struct Judge<'a> {
    study: &'a Study<'a>,
    subject: Subject,
    /// Reference of whole pixels.
    reference: Reference,
    /// Reference of eye samples.
    light: Reference,
    /// Limits of the default and of methods that keep eye samples.
    limits: [Run; 2],
    points: Vec<Point>,
}

fn scene(study: &Study, subject: Subject) -> Result<SceneTrade, StudyError> {
    let [limit, limit_of_eye_samples] = limits();
    let mut judge = Judge {
        study,
        reference: study.reference(&subject, Estimand::Pixels)?,
        light: study.reference(&subject, eye_samples())?,
        limits: [study.run(&subject, &limit)?, study.run(&subject, &limit_of_eye_samples)?],
        subject,
        points: Vec::new(),
    };
    judge.point(&Candidate::new("default", Method::default()), "", Sort::Default)?;
    for candidate in others() {
        judge.point(&candidate, "", Sort::Other)?;
    }
    for candidate in study.denoised_paths() {
        judge.point(&candidate, "", Sort::DenoisedPath)?;
    }
    for (candidate, options) in qualities() {
        judge.point(&candidate, &options, Sort::Quality)?;
    }
    let (knobs, builds) = chosen(&study.plan.knobs)?;
    let mut sweeps: Vec<Sweep> = knobs.iter().map(|knob| judge.sweep(knob)).collect::<Result<_, _>>()?;
    for builds in builds {
        sweeps.push(judge.sweep_builds(builds)?);
    }
    let effects = judge.sample(&knobs)?;
    let Judge { subject, reference, light, mut points, .. } = judge;
    mark_fronts(&mut points);
    Ok(SceneTrade {
        scene: subject.name,
        reference: reference.noise,
        light_reference: light.noise,
        points,
        sweeps,
        effects,
    })
}

/// Returns the limits of cuts and records over the defaults' virtual lights, on the default's samples and on eye
/// samples: cuts of a quarter of the error at every point.
fn limits() -> [Candidate; 2] {
    let finer = |cut: &mut CutSettings| {
        cut.epsilon *= 0.25;
        cut.max_cut *= 16;
    };
    let mut drawn = cache::Settings::default();
    drawn.cache.indirect = FoundBy::Cuts;
    drawn.cache.share = false;
    finer(&mut drawn.cut);
    let mut kept = lightcuts_on_eye_samples();
    finer(&mut kept.cut);
    [("limit", Method::Cache(drawn)), ("limit of eye samples", Method::Lightcuts(kept))]
        .map(|(label, method)| Candidate::new(label, method))
}

/// Returns lightcuts on the eye samples and virtual lights of reconstruction cuts.
fn lightcuts_on_eye_samples() -> lightcuts::Settings {
    let reconstruction::Settings { spp, seed, light, cut, family, .. } = Default::default();
    lightcuts::Settings { spp, seed, light, cut, family, ..Default::default() }
}

/// Returns the knobs and builds named, or all.
fn chosen(names: &[String]) -> Result<(Vec<Knob>, Vec<&'static Builds>), StudyError> {
    let mut knobs = knobs();
    let mut builds: Vec<&Builds> = BUILDS.iter().collect();
    let plain = |name: &str| name.trim_start_matches('-').to_owned();
    let known: Vec<String> =
        knobs.iter().map(|k| plain(&k.name)).chain(builds.iter().map(|b| plain(b.name))).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(name)) {
        return Err(StudyError::Knob { name: name.clone(), known: known.join("; ") });
    }
    let wanted = |name: &str| names.is_empty() || names.contains(&plain(name));
    knobs.retain(|knob| wanted(&knob.name));
    builds.retain(|builds| wanted(builds.name));
    Ok((knobs, builds))
}

/// Returns the methods that keep eye samples at their defaults, all on those of reconstruction cuts.
fn others() -> [Candidate; 3] {
    let reconstruction = reconstruction::Settings::default();
    let reconstruction::Settings { spp, seed, .. } = reconstruction;
    let photons = photon_cache::Settings { spp, seed, ..Default::default() };
    let cuts = Method::Lightcuts(lightcuts_on_eye_samples());
    [Method::Reconstruction(reconstruction), cuts, Method::PhotonCache(photons)]
        .map(|method| Candidate::new(method.name(), method))
}

impl Judge<'_> {
    /// Renders a point; returns its index.
    fn point(&mut self, candidate: &Candidate, turned: &str, sort: Sort) -> Result<usize, StudyError> {
        let run = self.study.run(&self.subject, candidate)?;
        self.judge(candidate, turned, sort, &run)
    }

    /// Returns the reference of a method's light and the limit of its cuts and records, as far as they have its
    /// samples.
    fn standards(&self, method: &Method) -> (Option<&Reference>, Option<&Run>) {
        let [limit, limit_of_eye_samples] = &self.limits;
        match method.estimand() {
            Estimand::Pixels => (Some(&self.reference), has_default_samples(method).then_some(limit)),
            estimand if estimand == eye_samples() => (Some(&self.light), Some(limit_of_eye_samples)),
            Estimand::EyeSamples { .. } => (None, None),
        }
    }

    /// Judges a picture; returns the index of its point.
    fn judge(
        &mut self,
        candidate: &Candidate,
        turned: &str,
        sort: Sort,
        run: &Run,
    ) -> Result<usize, StudyError> {
        let (light, limit) = self.standards(&candidate.method);
        let light = light.map(|light| Errors::against(&run.color, light)).transpose()?;
        let limit = limit.map(|limit| Errors::between(&run.color, &limit.color)).transpose()?;
        let flip = Errors::against(&run.color, &self.reference)?.flip;
        self.points.push(Point {
            label: candidate.label.clone(),
            sort,
            settings: candidate.method.settings(),
            denoised: run.denoised(),
            whole_pixels: candidate.method.estimand() == Estimand::Pixels,
            seconds: run.seconds(&Stage::ALL),
            turned: turned.to_owned(),
            limit: limit.map(|errors| errors.rel_rmse()),
            light: light.map(|errors| errors.rel_rmse()),
            flip,
            fronts: Vec::new(),
        });
        Ok(self.points.len() - 1)
    }
}

/// True if a method draws the samples of the default.
fn has_default_samples(method: &Method) -> bool {
    let samples = |method: &Method| (method.name(), method.estimand(), method.spp(), method.seed());
    samples(method) == samples(&Method::default())
}

/// Marks the fronts among the points of the default method; errors of whole pixels and of eye samples do not compare.
fn mark_fronts(points: &mut [Point]) {
    for error in ERRORS {
        let own = |point: &Point| {
            let found = !matches!(point.sort, Sort::Other | Sort::DenoisedPath)
                && (point.whole_pixels || error == JudgedBy::Flip);
            (point.seconds, point.error(error).filter(|_| found))
        };
        let places = points.iter().map(own).enumerate();
        let (judged, figures): (Vec<usize>, Vec<(f64, f64)>) =
            places.filter_map(|(i, (seconds, error))| Some((i, (seconds, error?)))).unzip();
        for (i, on) in judged.into_iter().zip(front(&figures)) {
            if on {
                points[i].fronts.push(error);
            }
        }
    }
}

impl SceneTrade {
    /// Returns the points that do not belong to the search for the front.
    fn named(&self) -> Vec<&Point> {
        let found = |point: &&Point| !matches!(point.sort, Sort::Sweep | Sort::Sample);
        self.points.iter().filter(found).collect()
    }

    /// Returns the points on a front, fastest first.
    fn front(&self, error: JudgedBy) -> Vec<&Point> {
        let mut points: Vec<&Point> = self.points.iter().filter(|p| p.fronts.contains(&error)).collect();
        points.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        points
    }
}

impl Point {
    /// Returns one of its errors.
    fn error(&self, judged_by: JudgedBy) -> Option<f64> {
        match judged_by {
            JudgedBy::Limit => self.limit,
            JudgedBy::Light => self.light,
            JudgedBy::Flip => Some(self.flip),
        }
    }
}
