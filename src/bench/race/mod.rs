//! Time to a quality: the default method beside denoised paths.
//!
//! The default is rendered by several numbers of samples a pixel and by the settings of `--quality`, paths by several
//! numbers of samples; times are interpolated along the Pareto front of either.
//!
//! Units: processor seconds over all threads, and elapsed ones.

mod document;
mod target;

use super::study::{Bounded, Candidate, Errors, Noise, Results, Run, Study, StudyError, qualities};
use super::{Benchmark, Kind};
use base::stats::Stage;
use render::method::Method;
use serde::Serialize;
use std::path::PathBuf;
use target::{TARGETS, Target};
use transport::paths::Estimand;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "race",
    about: "Time to a PSNR and to a FLIP: the default beside denoised paths",
    kind: Kind::Study {
        scenes: &["cornell", "knot", "nave", "kitchen", "apartment", "hall"],
        pixels: [512, 512],
        run,
    },
};

/// Samples a pixel of the default, besides its own.
const SPP: [u32; 3] = [1, 4, 64];

/// All results.
#[derive(Serialize)]
struct Race {
    facts: Vec<(String, String)>,
    scenes: Vec<SceneRace>,
}

/// Results of a scene.
#[derive(Serialize)]
struct SceneRace {
    scene: String,
    reference: Noise,
    points: Vec<Point>,
    /// Times to every target.
    times: Vec<Times>,
}

/// A picture's time and errors.
#[derive(Serialize)]
struct Point {
    label: String,
    /// True for denoised paths, false for the default method.
    is_path: bool,
    /// Settings that differ from the defaults.
    options: String,
    /// Processor seconds.
    seconds: f64,
    elapsed: f64,
    errors: Errors,
}

/// Processor seconds to a target; `None` without any picture.
#[derive(Serialize)]
struct Times {
    target: Target,
    default: Option<Bounded>,
    path: Option<Bounded>,
    /// The paths' time over the default's.
    ratio: Option<Bounded>,
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    let mut race = Race { facts: study.facts(), scenes: Vec::new() };
    for path in scenes {
        let subject = study.subject(path)?;
        let reference = study.reference(&subject, Estimand::Pixels)?;
        let mut points = Vec::new();
        for (candidate, options) in candidates(study) {
            let run = study.run(&subject, &candidate)?;
            points.push(Point::new(&candidate, options, &run, Errors::against(&run.color, &reference)?));
        }
        let times = TARGETS.iter().map(|target| Times::to(*target, &points)).collect();
        race.scenes.push(SceneRace { scene: subject.name, reference: reference.noise, points, times });
    }
    Ok(Results { json: serde_json::json!(race), document: document::document(&race) })
}

/// Returns all pictures of a scene, with the options that differ from the defaults.
fn candidates(study: &Study) -> Vec<(Candidate, String)> {
    let default = Candidate::new("default", Method::default());
    let by_spp = SPP.map(|spp| {
        let mut method = Method::default();
        method.set_spp(spp);
        (Candidate::new(format!("default, {spp} spp"), method), format!("--spp {spp}"))
    });
    let paths = study.denoised_paths().map(|candidate| (candidate, String::new()));
    [(default, String::new())].into_iter().chain(by_spp).chain(qualities()).chain(paths).collect()
}

impl Point {
    fn new(candidate: &Candidate, options: String, run: &Run, errors: Errors) -> Point {
        Point {
            label: candidate.label.clone(),
            is_path: matches!(candidate.method, Method::Path(_)),
            options,
            seconds: run.seconds(&Stage::ALL),
            elapsed: run.elapsed(),
            errors,
        }
    }
}

impl Times {
    fn to(target: Target, points: &[Point]) -> Times {
        let of = |is_path| {
            let points = points.iter().filter(|point| point.is_path == is_path);
            let points: Vec<_> = points.map(|point| (point.seconds, target.error(&point.errors))).collect();
            target.time(&points)
        };
        let (default, path) = (of(false), of(true));
        let ratio = path.zip(default).and_then(|(path, default)| path.over(default));
        Times { target, default, path, ratio }
    }
}
