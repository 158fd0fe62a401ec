//! The paper's Table 1 on our scenes: records, cuts, times and errors of every method.
//!
//! Paper: Herzog et al. 2009, Table 1.
//!
//! | column | |
//! |---|---|
//! | N_c, direct | records, and the share of them that hold direct light |
//! | anisotropy | long over short radius of footprints, mean over records: direct / indirect |
//! | a | radius of footprints over the distance of the geometry that casts light and shadow, mean: direct / indirect |
//! | cut | clusters in a record's cut, mean; in eye samples' cuts without records |
//! | T_light | light pass and trees |
//! | T_f | records, and eye samples' own cuts |
//! | T_cache | splatting and adaptation |
//! | total | all stages, including the eye pass and denoising |
//!
//! The row of a walk-through, LWalk2, states means over 24 frames that end at the image: of the records that a frame
//! adds and of times. The light pass is that of the first frame. Its errors are those of the last frame.
//!
//! Deviations: the paper's ΣT leaves out T_light; our total does not. All errors are measured against path-traced
//! references of the same scene. The error of light of methods that keep a few eye samples per pixel is measured
//! against a reference of these points, without their aliasing. These methods are also compared with lightcuts per
//! pixel on the same eye samples and virtual lights, which leaves out clamping as well.

mod entries;
mod paper;

use super::document::Grid;
use super::plot::{Chart, Colour, Line};
use super::study::{
    Answer, Bounded, Candidate, Cell, Column, Curve, Figure, Group, Question, Shot, Study, StudyError, Truth,
    bounded, time_to,
};
use super::{Benchmark, Kind, Results};
use base::stats::Stage;
use entries::{OPPONENTS, entries, lightcuts};
use paper::{CLAIMS, LEGEND, SAVED_BY_ANISOTROPY};
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "table1",
    about: "The paper's Table 1: every method on whole scenes, times and errors",
    kind: Kind::Study { scenes: &["knot", "nave", "kitchen", "hall", "apartment"], pixels: [512, 512], run },
};

/// Caption of the chart.
const CHART: &str = "Lower left is better. Each point is an image. Lines join images of one method that no other image of it \
    beats. FLIP is against the reference. relMSE of light is without aliasing and noise.";

/// Methods of a scene over processor seconds.
const QUESTION: Question = Question {
    error: Truth::PixelsAndEyeSamples,
    compared_with: |c: &Candidate| (!c.whole_pixels() && c.label != "lightcuts").then_some(0),
    names: 2,
    brief: &[
        "method",
        "paper's",
        "N_c",
        "cut",
        "T_light",
        "T_f",
        "T_cache",
        "total",
        "PSNR",
        "FLIP",
        "PSNR to LC",
        "speed to LC",
        "speed to PM",
    ],
    table: &[
        Column::new("label", "method", |_, s| Cell::text(&s.candidate.label)),
        Column::new("paper", "paper's", |_, s| {
            let paper = entries::paper(&s.candidate.label);
            Cell { exact: json!(paper), text: paper.unwrap_or("").to_owned() }
        }),
        Column::new("main", "", |_, s| Cell::exact(s.candidate.main)),
        Column::new("settings", "", |_, s| Cell::exact(s.candidate.method.settings())),
        Column::new("denoised", "", |_, s| Cell::exact(s.counted.denoised())),
        Column::new("records", "N_c", |_, s| {
            let records = s.counted.records;
            Cell { exact: json!(records), text: whole(records.map(|[d, i]| d + i)) }
        }),
        Column::new("", "direct %", |_, s| {
            Cell::text(whole(s.counted.records.map(|[d, i]| 100.0 * d / (d + i).max(1.0))))
        }),
        Column::new("cut", "cut", |_, s| Cell::optional(s.counted.cut)),
        Column::new("eye", "", |_, s| time(s, &[Stage::EyePass])),
        Column::new("light_pass", "T_light", |_, s| time(s, &[Stage::LightPass, Stage::Tree])),
        Column::new("f", "T_f", |_, s| time(s, &[Stage::Records, Stage::Render])),
        Column::new("cache", "T_cache", |_, s| match s.counted.records {
            Some(_) => time(s, &[Stage::Splat]),
            None => Cell::optional(None),
        }),
        Column::new("total", "total", |_, s| Cell::seconds(s.seconds())),
        Column::new("elapsed", "elapsed", |_, s| Cell::seconds(s.counted.elapsed())),
        Column::new("against_reference", "", |_, s| Cell::exact(s.errors)),
        Column::new("", "PSNR", |_, s| Cell::optional(s.errors.psnr)),
        Column::new("", "relMSE", |_, s| Cell::figure(s.errors.rel_mse)),
        Column::new("", "FLIP", |_, s| Cell::figure(s.errors.flip)),
        Column::new("", "brightness", |_, s| Cell::figure(s.errors.brightness)),
        Column::new("light", "", |_, s| Cell::exact(s.light)),
        Column::new("", "light relMSE", |_, s| Cell::optional(s.light.map(|e| e.rel_mse))),
        Column::new("", "light FLIP", |_, s| Cell::optional(s.light.map(|e| e.flip))),
        Column::new("against_lightcuts", "", |_, s| Cell::exact(s.compared)),
        Column::new("", "PSNR to LC", |_, s| Cell::optional(s.compared.and_then(|e| e.psnr))),
        Column::new("", "relMSE to LC", |_, s| Cell::optional(s.compared.map(|e| e.rel_mse))),
        Column::new("", "FLIP to LC", |_, s| Cell::optional(s.compared.map(|e| e.flip))),
        Column::new("versus", "", |a, s| Cell::exact([0, 1, 2].map(|o| versus(a, s, o)))),
        Column::new("", "speed to LC", |a, s| speed(a, s, 0)),
        Column::new("", "at equal FLIP / PSNR / light", |a, s| at_equal(a, s, 0)),
        Column::new("", "speed to PM", |a, s| speed(a, s, 1)),
        Column::new("", "at equal FLIP / PSNR / light", |a, s| at_equal(a, s, 1)),
        Column::new("", "speed to path", |a, s| speed(a, s, 2)),
        Column::new("", "at equal FLIP / PSNR / light", |a, s| at_equal(a, s, 2)),
    ],
    figures: &[
        Figure { name: "FLIP", error: |s| Some(s.errors.flip), curves: CURVES },
        Figure {
            name: "relMSE of light, without noise",
            error: |s| s.light.map(|e| e.rel_mse),
            curves: CURVES,
        },
    ],
    ..Question::PLAIN
};

/// Other methods as curves, ours and the paper's as single points.
const CURVES: &[Curve] = &[
    Curve::of("lightcuts", Colour::Orange, Line::Front, |c| c.group == Group::Lightcuts),
    Curve::of("photon-cache", Colour::Olive, Line::Front, |c| c.group == Group::PhotonCache),
    Curve::of("path --denoise", Colour::Green, Line::Front, |c| c.group == Group::DenoisedPath),
    Curve::of("", Colour::Red, Line::None, |c| c.group == Group::Default),
    Curve::of("", Colour::Orange, Line::None, |c| c.group == Group::Unshared),
];

fn time(shot: &Shot, stages: &[Stage]) -> Cell {
    Cell::seconds(shot.counted.seconds(stages))
}

/// Formats an integer; a dash for `None`.
fn whole(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |n| format!("{n:.0}"))
}

/// Ratio of another method's time to the time of a row.
#[derive(Serialize)]
struct Versus {
    /// Label of the other's row.
    method: &'static str,
    /// Ratio at their own settings.
    speed: f64,
    /// Ratio at equal FLIP against the reference.
    at_equal_flip: Option<Bounded>,
    /// Ratio at equal PSNR against the reference.
    at_equal_psnr: Option<Bounded>,
    /// Ratio at equal relMSE of light.
    at_equal_light: Option<Bounded>,
}

impl Versus {
    /// Returns the ratios at equal FLIP, PSNR and error of light.
    fn at_equal(&self) -> String {
        [self.at_equal_flip, self.at_equal_psnr, self.at_equal_light].map(bounded).join(" / ")
    }
}

/// Compares a row with an opponent: with its main row, and with the curve of all its rows.
fn versus(answer: &Answer, shot: &Shot, opponent: usize) -> Option<Versus> {
    let (group, method) = OPPONENTS[opponent];
    let own = shot.seconds().max(f64::MIN_POSITIVE);
    let at_equal = |error: fn(&Shot) -> f64| {
        let others = answer.shots.iter().filter(|other| other.candidate.group == group);
        let others: Vec<_> = others.map(|other| (other.seconds(), error(other))).collect();
        let time = time_to(error(shot), &others).filter(|_| shot.candidate.group != group)?;
        time.over(Bounded::About(own))
    };
    Some(Versus {
        method,
        speed: answer.find(method)?.seconds() / own,
        at_equal_flip: at_equal(|s| s.errors.flip),
        at_equal_psnr: at_equal(|s| s.errors.displayed_rmse()),
        at_equal_light: at_equal(|s| s.light.map_or(f64::NAN, |e| e.rel_mse)),
    })
}

fn speed(answer: &Answer, shot: &Shot, opponent: usize) -> Cell {
    let versus = versus(answer, shot, opponent);
    Cell::text(versus.map_or("-".to_owned(), |versus| format!("{:.2}", versus.speed)))
}

fn at_equal(answer: &Answer, shot: &Shot, opponent: usize) -> Cell {
    Cell::text(versus(answer, shot, opponent).map_or("-".to_owned(), |versus| versus.at_equal()))
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    let mut answers = Vec::new();
    for path in scenes {
        let subject = study.subject(path)?;
        let (images, others) = (entries(study, &subject), [lightcuts()]);
        let question = Question { images: &images, others: &others, ..QUESTION };
        answers.push(study.ask(question, [Ok(subject)])?);
    }
    let mut results = Results::new("Table 1", study.facts(), LEGEND);
    let panels = answers.iter().flat_map(Answer::panels).collect();
    let chart = Chart { panels, caption: vec![CHART.to_owned()] };
    let document = &mut results.document;
    document.plot("table1", &chart);
    document.heading(2, "Beside the paper");
    document.text(
        "Ratios of times with the light pass; in brackets at equal FLIP / PSNR / error of light. The paper's are the \
         smallest and largest over its own scenes.",
    );
    let scenes = answers.iter().map(|answer| answer.scene.as_str());
    let heads: Vec<&str> = ["", "paper"].into_iter().chain(scenes).collect();
    document.grid(&Grid::new(heads.len(), &heads, claims(&answers)));
    for answer in &answers {
        let more = json!({ "triangles": answer.triangles, "rows": answer.rows() });
        results.push("scenes", answer.facts(), more);
        let document = &mut results.document;
        document.heading(2, &answer.scene);
        document.text(&format!("{} triangles.", answer.triangles));
        answer.tell(document);
    }
    Ok(results)
}

/// Returns the paper's claims, with its figures and ours for each scene.
fn claims(answers: &[Answer]) -> Vec<Vec<String>> {
    let row = |what: &str, paper: String, ours: &dyn Fn(&Answer) -> Option<String>| -> Vec<String> {
        let ours = answers.iter().map(|answer| ours(answer).unwrap_or("-".to_owned()));
        [what.to_owned(), paper].into_iter().chain(ours).collect()
    };
    let claim = |claim: &paper::Claim| {
        let [faster, slower] = claim.of;
        let ours = |answer: &Answer| {
            let (own, other) = (answer.find(faster)?, answer.find(slower)?);
            let speed = other.seconds() / own.seconds().max(f64::MIN_POSITIVE);
            let opponent = OPPONENTS.iter().position(|(_, label)| *label == slower);
            Some(match opponent.and_then(|opponent| versus(answer, own, opponent)) {
                Some(versus) => format!("{speed:.2} ({})", versus.at_equal()),
                None => format!("{speed:.2}"),
            })
        };
        let paper = claim.range.map_or("-".to_owned(), |[least, most]| format!("{least} to {most}"));
        row(claim.what, paper, &ours)
    };
    let saved = |answer: &Answer| {
        let records = |label| answer.find(label)?.counted.records.map(|[d, i]| d + i);
        let (anisotropic, isotropic) = (records("cache, anisotropic")?, records("cache, isotropic")?);
        (isotropic > 0.0).then(|| format!("{:.1} %", 100.0 * (1.0 - anisotropic / isotropic)))
    };
    let [least, most] = SAVED_BY_ANISOTROPY.map(|share| 100.0 * share);
    let last = row("records that anisotropy saves", format!("{least} to {most} %"), &saved);
    CLAIMS.iter().map(claim).chain([last]).collect()
}
