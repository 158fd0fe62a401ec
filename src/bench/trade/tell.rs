//! The trade-off of a scene in JSON, tables and plots.

use super::errors::{ERRORS, error_of, name};
use super::front::{Effect, is_on_front};
use super::sweep::{KnobEffect, Sweep};
use super::verdict::{ERROR_TOLERANCE, TIME_TOLERANCE};
use crate::document::Grid;
use crate::escape::escaped;
use crate::plot::{Colour, Point, Series, scatter};
use crate::study::{Answer, Group, Results, Shot, optional, seconds};
use base::setting::JudgedBy;
use serde_json::json;

/// Caption of the effects of knobs.
const TOGETHER: &str = "Factors by which error and time change from a knob's coarsest to its finest level. All other knobs \
    vary in a designed sample. Brackets are 95 % confidence intervals. The error is the error of light. The fit is linear in \
    logarithms from level to level; curvature counts as noise. If there are fewer samples than knobs, effects of different \
    knobs may be mistaken for each other.";

/// Adds the results of a scene.
pub fn section(results: &mut Results, answer: &Answer, sweeps: &[Sweep], effects: &[KnobEffect]) {
    let more = json!({ "points": answer.rows(), "sweeps": sweeps, "effects": effects });
    results.push("scenes", answer.facts(), more);
    let document = &mut results.document;
    document.heading(2, &answer.scene);
    document.text(&answer.about());
    document.heading(3, "The default, the qualities, and other methods");
    let named = |shot: &&Shot| !matches!(shot.candidate.group, Group::Sweep | Group::Sample);
    document.grid(&answer.grid(answer.shots.iter().filter(named)));
    for error in ERRORS {
        document.heading(3, &format!("Pareto front of {}", name(error)));
        let about =
            format!("{} over {} of {}. Lower left is better.", name(error), answer.axis(), answer.scene);
        let svg = scatter(answer.axis(), name(error), &cloud(answer, error));
        document.plot(&format!("{}-front-{}", answer.scene, name(error)), &about, &svg);
        document.grid(&answer.grid(front(answer, error)));
    }
    document.heading(3, "Knob by knob");
    document.text(&format!(
        "Each knob alone, from coarse to fine. Changes of error below {:.0} % and of time below {:.0} % count as none. The \
         second column names the error.",
        100.0 * ERROR_TOLERANCE,
        100.0 * TIME_TOLERANCE
    ));
    let heads = ["knob", "judged by", "coarse → fine: seconds, error", "error", "time", "verdict"];
    document.grid(&Grid::new(6, &heads, sweeps.iter().map(|sweep| row(answer, sweep)).collect()));
    sweeps.iter().for_each(|sweep| document.figure(&plot(answer, sweep)));
    document.heading(3, "All knobs together");
    document.text(TOGETHER);
    let text = |effect: &Option<Effect>| match effect {
        Some(e) => format!("{:.2} ({:.2} to {:.2})", e.factor, e.range[0], e.range[1]),
        None => "-".to_owned(),
    };
    let row = |e: &KnobEffect| vec![e.knob.clone(), text(&e.error), text(&e.time)];
    let heads = ["knob", "error, fine over coarse", "time, fine over coarse"];
    document.grid(&Grid::new(3, &heads, effects.iter().map(row).collect()));
}

/// Returns the points on a front, fastest first.
fn front(answer: &Answer, error: JudgedBy) -> Vec<&Shot> {
    let mut points: Vec<&Shot> =
        answer.shots.iter().filter(|shot| is_on_front(answer, shot, error)).collect();
    points.sort_by(|a, b| a.seconds().total_cmp(&b.seconds()));
    points
}

/// Returns the row of a sweep.
fn row(answer: &Answer, sweep: &Sweep) -> Vec<String> {
    let level = |(text, place): &(String, usize)| {
        let shot = &answer.shots[*place];
        format!("{text}: {}, {}", seconds(shot.seconds()), optional(error_of(shot, sweep.judged_by)))
    };
    let levels: Vec<String> = sweep.levels.iter().map(level).collect();
    vec![
        sweep.knob.clone(),
        name(sweep.judged_by).to_owned(),
        levels.join("; "),
        sweep.error.to_string(),
        sweep.time.to_string(),
        sweep.verdict.to_owned(),
    ]
}

/// Returns a point of a plot.
fn point(shot: &Shot, error: JudgedBy, name: &str) -> Point {
    Point { x: shot.seconds(), y: error_of(shot, error).unwrap_or(0.0), name: name.to_owned() }
}

/// Returns all points by group, with the front joined. Later series lie on top.
fn cloud(answer: &Answer, error: JudgedBy) -> Vec<Series> {
    let place = |shot: &Shot| {
        let is_told = matches!(shot.candidate.group, Group::Sweep | Group::Quality);
        let turned = if is_told { "" } else { &*shot.candidate.options };
        point(shot, error, &format!("{} {turned}", shot.candidate.label))
    };
    let of = |name: &str, colour, group| Series {
        name: name.to_owned(),
        colour,
        joined: group == Group::DenoisedPath,
        points: answer.shots.iter().filter(|shot| shot.candidate.group == group).map(place).collect(),
    };
    let points = front(answer, error).into_iter().map(place).collect();
    vec![
        of("designed sample", Colour::Grey, Group::Sample),
        of("one knob turned", Colour::Steel, Group::Sweep),
        Series { name: "front".to_owned(), colour: Colour::Olive, joined: true, points },
        of("--quality", Colour::Purple, Group::Quality),
        of("default", Colour::Red, Group::Default),
        of("", Colour::Orange, Group::Other),
        of("path --denoise", Colour::Green, Group::DenoisedPath),
    ]
}

/// Plots a knob's levels and the default.
fn plot(answer: &Answer, sweep: &Sweep) -> String {
    let place = |(text, place): &(String, usize)| point(&answer.shots[*place], sweep.judged_by, text);
    let levels: Vec<Point> = sweep.levels.iter().map(place).collect();
    let default = answer.find("default").map(|shot| point(shot, sweep.judged_by, "default"));
    let series = |name: &str, colour, points| Series {
        name: name.to_owned(),
        colour,
        joined: name == "coarse to fine",
        points,
    };
    let series = [
        series("coarse to fine", Colour::Steel, levels.clone()),
        series("default", Colour::Red, default.into_iter().collect()),
        series("", Colour::Steel, levels),
    ];
    format!(
        "<figure style=\"width:46%\">{}<figcaption>{}: {}</figcaption></figure>\n",
        scatter(answer.axis(), name(sweep.judged_by), &series),
        escaped(&sweep.knob),
        escaped(sweep.verdict)
    )
}
