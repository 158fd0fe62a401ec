//! Time to a quality: the default method beside denoised paths.
//!
//! The default is rendered with several sample counts and with the settings of `--quality`, paths with several sample
//! counts. Times are interpolated along the Pareto front of either. A chart shows all images, and figures of other
//! programs from a file.

mod chart;

use self::chart::{FLIP, REL_MSE, chart};
use super::document::Grid;
use super::plot::{Colour, Line};
use super::study::{
    Answer, Bounded, Candidate, Cell, Column, Curve, Errors, Figure, PeerFigure, Question, Study, StudyError,
    bounded, denoised_paths, optional, qualities, rmse_of_psnr, seconds, time_to,
};
use super::{Benchmark, Kind, Results, Scenes};
use render::method::Method;
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "race",
    about: "Error over time: cache, denoised paths and other programs",
    kind: Kind::Study {
        scenes: Scenes::Files(&["cornell", "knot", "nave", "kitchen", "apartment", "hall", "plaza"]),
        pixels: [512, 512],
        run,
    },
};

/// Samples per pixel of the default, besides its own.
const SPP: [u32; 3] = [1, 4, 64];

/// Caption of the table of times.
const TABLE: &str = "Processor seconds to a quality: cache / paths + denoiser. The figure in brackets says how many times as \
    fast the cache is. <: the fastest image is better than that. >: the best image is worse than that.";

/// Explanation of all figures.
const LEGEND: &str = "Seconds are processor seconds over all threads, without loading the scene. Times to a quality are \
    interpolated in logarithms between the images that no other image beats. The cache has 1 to 64 samples per pixel and \
    the levels of --quality; paths have 1 to 256 samples per pixel. PSNR and FLIP compare displayed images, relMSE compares \
    radiances. PSNR and relMSE are without the noise of the reference, relMSE also without the worst pixel of a thousand. \
    FLIP includes the noise of the reference.";

/// Images of a scene over processor seconds.
const QUESTION: Question = Question {
    names: 2,
    table: &[
        Column::new("label", "image", |_, s| Cell::text(&s.candidate.label)),
        Column::new("is_path", "", |_, s| Cell::exact(s.candidate.is_path())),
        Column::new("options", "options", |_, s| Cell::text(&s.candidate.options)),
        Column::new("seconds", "seconds", |_, s| Cell::seconds(s.seconds())),
        Column::new("elapsed", "elapsed", |_, s| Cell::seconds(s.counted.elapsed())),
        Column::new("errors", "", |_, s| Cell::exact(s.errors)),
        Column::new("", "PSNR", |_, s| Cell::optional(s.errors.psnr)),
        Column::new("", "FLIP", |_, s| Cell::figure(s.errors.flip)),
        Column::new("", "relMSE", |_, s| Cell::figure(s.errors.rel_mse)),
    ],
    brief: &["image", "seconds", "PSNR", "FLIP", "relMSE"],
    figures: &[
        Figure { name: REL_MSE, error: |s| Some(s.errors.rel_mse), curves: CURVES },
        Figure { name: FLIP, error: |s| Some(s.errors.flip), curves: CURVES },
    ],
    ..Question::PLAIN
};

const CURVES: &[Curve] = &[
    Curve { name: "lightsplat, cache", colour: Colour::Red, line: Line::Front, holds: |c| !c.is_path() },
    Curve {
        name: "lightsplat, paths + denoiser",
        colour: Colour::Green,
        line: Line::Front,
        holds: |c| c.is_path(),
    },
];

/// A quality that times are measured to.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum Target {
    /// PSNR of the displayed image, dB.
    Psnr(f64),
    /// Mean FLIP of the displayed image.
    Flip(f64),
}

const TARGETS: [Target; 5] =
    [Target::Psnr(35.0), Target::Psnr(40.0), Target::Psnr(45.0), Target::Flip(0.08), Target::Flip(0.05)];

/// Processor seconds to a target; `None` without any image.
#[derive(Serialize)]
struct Times {
    target: Target,
    default: Option<Bounded>,
    path: Option<Bounded>,
    /// Time of paths over the time of the default.
    ratio: Option<Bounded>,
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    let question = Question { images: &images(study), ..QUESTION };
    let ask = |path: &PathBuf| study.ask(question, [study.subject(path)]);
    let answers: Vec<Answer> = scenes.iter().map(ask).collect::<Result<_, _>>()?;
    let times: Vec<Vec<Times>> = answers.iter().map(times).collect();
    let mut results = Results::new("Time and error", study.facts(), LEGEND);
    let (peers, conditions) = (&study.plan.peers, conditions(&results));
    let chart = chart(&answers, peers, conditions);
    results.document.plot("race", &chart);
    results.document.text(TABLE);
    let heads = TARGETS.map(Target::name);
    let heads: Vec<&str> = [""].into_iter().chain(heads.iter().map(String::as_str)).collect();
    let row = |(answer, times): (&Answer, &Vec<Times>)| {
        [answer.scene.clone()].into_iter().chain(times.iter().map(Times::text)).collect()
    };
    results.document.grid(&Grid::new(1, &heads, answers.iter().zip(&times).map(row).collect()));
    for (answer, times) in answers.iter().zip(&times) {
        section(&mut results, answer, times);
    }
    if !peers.is_empty() {
        results.json["others"] = json!(peers);
        results.document.heading(2, "Figures of other programs");
        results.document.grid(&others(peers));
    }
    Ok(results)
}

/// Returns the caption's sentence on machine and program.
fn conditions(results: &Results) -> String {
    let fact = |name| results.fact(name);
    format!(
        "lightsplat {} with {}, compiled for {}, at {} pixels. {}, threads: {}. Load at the start: {}. {}.",
        fact("version"),
        fact("denoiser"),
        fact("compiled for"),
        fact("pixels"),
        fact("processor"),
        fact("threads"),
        fact("load at the start"),
        fact("date")
    )
}

/// Returns the table of other programs.
fn others(peers: &[PeerFigure]) -> Grid {
    let row = |peer: &PeerFigure| {
        let names = [&peer.scene, &peer.name, &peer.label].map(String::clone);
        let figures = [peer.psnr, peer.flip, peer.rel_mse].map(optional);
        names.into_iter().chain([seconds(peer.seconds)]).chain(figures).collect()
    };
    let heads = ["scene", "program", "image", "seconds", "PSNR", "FLIP", "relMSE"];
    Grid::new(3, &heads, peers.iter().map(row).collect())
}

/// Returns the images of a scene.
fn images(study: &Study) -> Vec<Candidate> {
    let default = Candidate::new("default", Method::default());
    let by_spp = SPP.map(|spp| {
        let mut method = Method::default();
        method.set_spp(spp);
        Candidate { options: format!("--spp {spp}"), ..Candidate::new(format!("default, {spp} spp"), method) }
    });
    [default].into_iter().chain(by_spp).chain(qualities()).chain(denoised_paths(study)).collect()
}

fn section(results: &mut Results, answer: &Answer, times: &[Times]) {
    results.push("scenes", answer.facts(), json!({ "points": answer.rows(), "times": times }));
    results.document.heading(2, &answer.scene);
    answer.tell(&mut results.document);
}

/// Returns the times to all targets.
fn times(answer: &Answer) -> Vec<Times> {
    let to = |target: Target| {
        let of = |is_path| {
            let shots = answer.shots.iter().filter(|shot| shot.candidate.is_path() == is_path);
            let points: Vec<_> = shots.map(|shot| (shot.seconds(), target.error(&shot.errors).0)).collect();
            time_to(target.error(&Errors::UNKNOWN).1, &points)
        };
        let (default, path) = (of(false), of(true));
        let ratio = path.zip(default).and_then(|(path, default)| path.over(default));
        Times { target, default, path, ratio }
    };
    TARGETS.into_iter().map(to).collect()
}

impl Times {
    fn text(&self) -> String {
        let [default, path] = [self.default, self.path].map(bounded);
        let ratio = self.ratio.map_or(String::new(), |ratio| format!(" ({ratio})"));
        format!("{default} / {path}{ratio}")
    }
}

impl Target {
    /// Returns the error of an image, which falls as images get better, and the error at the target.
    fn error(self, errors: &Errors) -> (f64, f64) {
        match self {
            Target::Psnr(psnr) => (errors.displayed_rmse(), rmse_of_psnr(psnr)),
            Target::Flip(flip) => (errors.flip, flip),
        }
    }

    fn name(self) -> String {
        match self {
            Target::Psnr(psnr) => format!("PSNR {psnr}"),
            Target::Flip(flip) => format!("FLIP {flip}"),
        }
    }
}
