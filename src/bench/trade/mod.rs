//! The trade-off of each setting of reconstruction cuts and of the cache: error against time, one setting at a
//! time and by a designed sample.
//!
//! Every knob is swept alone around the defaults; then all are varied together, on the cache, by an
//! Owen-scrambled Sobol design, whose projection on any one knob is stratified. Three errors are distinguished:
//!
//! - from the limit: against lightcuts of a quarter of the error on the same virtual lights, the error added
//!   by records and cuts;
//! - of light: against a reference path-traced through the picture's own eye samples, which includes the
//!   errors of virtual lights and their clamping;
//! - FLIP: against a reference of whole pixels, which includes the aliasing of few eye samples a pixel.
//!
//! The settings of `--quality` are shown beside them, and denoised paths by their FLIP. Builds of the
//! acceleration structure are varied alone, not in the designed sample.

mod builds;
mod document;
mod front;
mod knobs;
mod sweep;
mod verdict;

use super::study::{Candidate, Errors, Noise, Reference, Results, Run, Study, StudyError, Subject};
use super::{Benchmark, Kind};
use crate::method::reconstruction::Settings;
use crate::method::{Method, lightcuts, photon_cache};
use crate::paths::Look;
use crate::plan::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE, options};
use crate::setting::JudgedBy;
use crate::stats::Stage;
use builds::{BUILDS, Builds};
use front::{Effect, front};
use knobs::{Knob, knobs};
use serde::Serialize;
use serde_json::Value;
use std::path::PathBuf;
use verdict::Course;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "trade",
    about: "What each setting buys: error against time, and the Pareto front",
    kind: Kind::Study { scenes: &[], pixels: [256, 256], run },
};

/// Errors that fronts are drawn for.
const ERRORS: [JudgedBy; 3] = [JudgedBy::Limit, JudgedBy::Light, JudgedBy::Flip];

/// Samples a pixel of denoised paths.
const DENOISED_SPP: [u32; 4] = [1, 4, 16, 64];

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
    /// Processor seconds.
    seconds: f64,
    /// Settings that differ from the defaults.
    turned: String,
    /// Relative RMSE from the limit, where the eye samples are the same.
    limit: Option<f64>,
    /// Relative RMSE of light, where the eye samples are the same.
    light: Option<f64>,
    /// FLIP against the reference of pixels.
    flip: f64,
    /// Errors by which no other point of the same methods is faster and no worse.
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
    reference: Reference,
    light: Reference,
    limit: Run,
    points: Vec<Point>,
}

fn scene(study: &Study, subject: Subject) -> Result<SceneTrade, StudyError> {
    let Settings { spp, seed, .. } = Settings::default();
    let mut judge = Judge {
        study,
        reference: study.reference(&subject, Look::Pixels)?,
        light: study.reference(&subject, Look::EyeSamples { spp, seed })?,
        limit: study.run(&subject, &limit())?,
        subject,
        points: Vec::new(),
    };
    let default = Method::Reconstruction(Settings::default());
    judge.point(default.name(), "", Sort::Default, default, true)?;
    for (label, method) in others() {
        judge.point(label, "", Sort::Other, method, true)?;
    }
    if study.denoises() {
        for spp in DENOISED_SPP {
            let candidate = Candidate::denoised_path("path --denoise", spp);
            let run = study.run(&judge.subject, &candidate)?;
            judge.judge(&candidate, &format!("--spp {spp}"), Sort::DenoisedPath, &run, false)?;
        }
    }
    for (name, method) in qualities() {
        judge.point(name, &options(&method), Sort::Quality, method, method.spp() == spp)?;
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

/// Returns the limit of cuts and records over the default's virtual lights: lightcuts of a quarter of the
/// error.
fn limit() -> Candidate {
    let Settings { spp, seed, light, cut, family, .. } = Settings::default();
    let mut settings = lightcuts::Settings { spp, seed, light, cut, family, ..Default::default() };
    settings.cut.epsilon *= 0.25;
    settings.cut.max_cut *= 16;
    Candidate::new("limit", Method::Lightcuts(settings))
}

/// Returns the default method at the named levels of the quality scale.
fn qualities() -> Vec<(&'static str, Method)> {
    let ladder = Ladder::new(Method::Reconstruction(Settings::default()), &[]);
    let named = [("draft", DRAFT), ("preview", PREVIEW), ("final", FINAL), ("reference", REFERENCE)];
    ladder.iter().flat_map(|ladder| named.map(|(name, height)| (name, ladder.at(height)))).collect()
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

/// Returns the other methods at their defaults, on the same eye samples.
fn others() -> [(&'static str, Method); 2] {
    let Settings { spp, seed, light, cut, family, .. } = Settings::default();
    let cuts = lightcuts::Settings { spp, seed, light, cut, family, ..Default::default() };
    let photons = photon_cache::Settings { spp, seed, ..Default::default() };
    [("lightcuts", Method::Lightcuts(cuts)), ("photon-cache", Method::PhotonCache(photons))]
}

impl Judge<'_> {
    /// Renders a point; returns its index.
    fn point(
        &mut self,
        label: &str,
        turned: &str,
        sort: Sort,
        method: Method,
        same_samples: bool,
    ) -> Result<usize, StudyError> {
        let candidate = Candidate::new(label, method);
        let run = self.study.run(&self.subject, &candidate)?;
        self.judge(&candidate, turned, sort, &run, same_samples)
    }

    /// Judges a picture; returns the index of its point.
    fn judge(
        &mut self,
        candidate: &Candidate,
        turned: &str,
        sort: Sort,
        run: &Run,
        same_samples: bool,
    ) -> Result<usize, StudyError> {
        let (mut light, mut limit) = (None, None);
        if same_samples {
            light = Some(Errors::against(&run.color, &self.light)?.rel_rmse());
            limit = Some(Errors::between(&run.color, &self.limit.color)?.rel_rmse());
        }
        self.points.push(Point {
            label: candidate.label.clone(),
            sort,
            settings: candidate.method.settings(),
            seconds: run.seconds(&Stage::ALL),
            turned: turned.to_owned(),
            limit,
            light,
            flip: Errors::against(&run.color, &self.reference)?.flip,
            fronts: Vec::new(),
        });
        Ok(self.points.len() - 1)
    }
}

/// Marks the fronts among the points of the default method and the cache.
fn mark_fronts(points: &mut [Point]) {
    for error in ERRORS {
        let own = |point: &Point| {
            (
                point.seconds,
                point.error(error).filter(|_| !matches!(point.sort, Sort::Other | Sort::DenoisedPath)),
            )
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
