//! Time to a quality: the default method beside denoised paths.
//!
//! The default is rendered with several sample counts and with the settings of `--quality`, paths with several sample
//! counts. Times are interpolated along the Pareto front of either. A chart shows all images, and figures of other
//! programs from a file.

use super::document::Grid;
use super::plot::{Chart, Colour, Line, Panel, Point, Series};
use super::study::{
    Answer, Bounded, Candidate, Cell, Column, Curve, Errors, Figure, PeerFigure, Question, Study, StudyError,
    bounded, denoised_paths, optional, qualities, rmse_of_psnr, seconds, time_to,
};
use super::{Benchmark, Kind, Results};
use render::method::Method;
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "race",
    about: "Error over time: cache, denoised paths and other programs",
    kind: Kind::Study {
        scenes: &["cornell", "knot", "nave", "kitchen", "apartment", "hall", "plaza"],
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
    Curve::of("lightsplat, cache", Colour::Red, Line::Front, |c| !c.is_path()),
    Curve::of("lightsplat, paths + denoiser", Colour::Green, Line::Front, |c| c.is_path()),
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
    let (peers, conditions) = (&study.plan.peers, format!("{}.", results.conditions()));
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

/// Colours of other programs. The curves of the race have the others.
const COLOURS: [Colour; 6] =
    [Colour::Blue, Colour::Purple, Colour::Orange, Colour::Olive, Colour::Steel, Colour::Grey];

/// Names of the errors that are drawn.
const REL_MSE: &str = "relMSE";
const FLIP: &str = "FLIP";

/// An error: its name, and its value for an image of another program.
type Error = (&'static str, fn(&PeerFigure) -> Option<f64>);

/// Errors in the order of the panels of a scene.
const ERRORS: [Error; 2] = [(REL_MSE, |peer| peer.rel_mse), (FLIP, |peer| peer.flip)];

/// Description of what the chart shows.
const HOW_TO_READ: &str = "Lower left is better. Each point is an image. A line joins the images of a method that no other \
    image of it beats.";

/// Returns the chart: panels of the answers, then panels of the scenes that only others have rendered.
fn chart(answers: &[Answer], peers: &[PeerFigure], conditions: String) -> Chart {
    let mut names: Vec<&str> = Vec::new();
    let mut scenes: Vec<&str> = answers.iter().map(|answer| &*answer.scene).collect();
    let mut notes: Vec<&str> = Vec::new();
    for peer in peers {
        add(&mut names, &peer.name);
        add(&mut scenes, &peer.scene);
        peer.note.iter().for_each(|note| add(&mut notes, note));
    }
    let mut panels = Vec::new();
    for scene in scenes {
        let own = answers.iter().find(|answer| answer.scene == scene);
        let own = own.map_or_else(|| empty(scene), |answer| answer.panels());
        for (mut panel, (_, error)) in own.into_iter().zip(ERRORS) {
            let of_scene: Vec<&PeerFigure> = peers.iter().filter(|peer| peer.scene == scene).collect();
            panel.series.extend(names.iter().enumerate().map(|(i, name)| Series {
                name: (*name).to_owned(),
                colour: COLOURS[i % COLOURS.len()],
                line: Line::Front,
                points: points(of_scene.iter().filter(|peer| peer.name == *name), error),
            }));
            panels.push(panel);
        }
    }
    let caption =
        [HOW_TO_READ.to_owned(), conditions].into_iter().chain(notes.into_iter().map(str::to_owned));
    Chart { panels, caption: caption.collect() }
}

/// Adds a name that is not there yet.
fn add<'n>(names: &mut Vec<&'n str>, name: &'n str) {
    if !names.contains(&name) {
        names.push(name);
    }
}

/// Returns the panels of a scene that the race has not rendered.
fn empty(scene: &str) -> Vec<Panel> {
    let panel = |(name, _): Error| Panel { title: format!("{scene}: {name}"), series: Vec::new() };
    ERRORS.map(panel).into()
}

fn points<'p>(
    peers: impl Iterator<Item = &'p &'p PeerFigure>,
    error: fn(&PeerFigure) -> Option<f64>,
) -> Vec<Point> {
    let point =
        |peer: &&PeerFigure| Some(Point { x: peer.seconds, y: error(peer)?, name: peer.label.clone() });
    peers.filter_map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_programs_have_their_points_in_the_panels_of_their_scenes() {
        let peer = |name: &str, scene: &str, seconds: f64| PeerFigure {
            name: name.to_owned(),
            scene: scene.to_owned(),
            label: "16 samples".to_owned(),
            seconds,
            psnr: None,
            rel_mse: (name == "A").then_some(0.01),
            flip: Some(0.05),
            note: Some("Measured alone.".to_owned()),
        };
        let peers =
            [peer("A", "knot", 1.0), peer("A", "knot", 2.0), peer("B", "knot", 3.0), peer("B", "nave", 4.0)];
        let chart = chart(&[], &peers, "On a machine.".to_owned());
        let titles: Vec<&str> = chart.panels.iter().map(|panel| &*panel.title).collect();
        assert_eq!(titles, ["knot: relMSE", "knot: FLIP", "nave: relMSE", "nave: FLIP"]);
        let counts = |panel: usize| -> Vec<usize> {
            chart.panels[panel].series.iter().map(|series| series.points.len()).collect()
        };
        assert_eq!([counts(0), counts(1), counts(2), counts(3)], [[2, 0], [2, 1], [0, 0], [0, 1]]);
        assert_eq!(chart.caption[1..], ["On a machine.", "Measured alone."]);
        assert_ne!(chart.panels[0].series[0].colour, chart.panels[0].series[1].colour);
    }
}
