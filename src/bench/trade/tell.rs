//! The trade-off of a scene in JSON, tables and plots.

use super::front::{ERRORS, error_of, is_on_front, name};
use super::knobs::Sweep;
use crate::Results;
use crate::document::Grid;
use crate::plot::{Colour, Line, Panel, Point, Series};
use crate::study::{Answer, Group, Shot, optional, seconds};
use base::setting::JudgedBy;
use serde_json::json;

/// Adds the results of a scene.
pub fn section(results: &mut Results, answer: &Answer, sweeps: &[Sweep]) {
    let more = json!({ "points": answer.rows(), "sweeps": sweeps });
    results.push("scenes", answer.facts(), more);
    let document = &mut results.document;
    document.heading(2, &answer.scene);
    document.text(&answer.about());
    document.heading(3, "The default, the qualities, and other methods");
    let named = |shot: &&Shot| shot.candidate.group != Group::Sweep;
    document.grid(&answer.grid(answer.shots.iter().filter(named)));
    let panel = |error| Panel { title: name(error).to_owned(), series: cloud(answer, error) };
    answer.draw(document, &format!("{}-fronts", answer.scene), ERRORS.map(panel).into());
    for error in ERRORS {
        document.heading(3, &format!("Pareto front of {}", name(error)));
        document.grid(&answer.grid(front(answer, error)));
    }
    document.heading(3, "Knob by knob");
    let heads = ["knob", "judged by", "coarse → fine: seconds, error"];
    document.grid(&Grid::new(3, &heads, sweeps.iter().map(|sweep| row(answer, sweep)).collect()));
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
    vec![sweep.knob.clone(), name(sweep.judged_by).to_owned(), levels.join("; ")]
}

/// Returns all points by group, with the front joined. Later series lie on top.
fn cloud(answer: &Answer, error: JudgedBy) -> Vec<Series> {
    let place = |shot: &Shot| {
        let is_told = matches!(shot.candidate.group, Group::Sweep | Group::Quality);
        let turned = if is_told { "" } else { &*shot.candidate.options };
        let name = format!("{} {turned}", shot.candidate.label);
        Point { x: shot.seconds(), y: error_of(shot, error).unwrap_or(0.0), name }
    };
    let of = |name: &str, colour, group| Series {
        name: name.to_owned(),
        colour,
        line: if group == Group::DenoisedPath { Line::All } else { Line::None },
        points: answer.shots.iter().filter(|shot| shot.candidate.group == group).map(place).collect(),
    };
    let points = front(answer, error).into_iter().map(place).collect();
    vec![
        of("one knob turned", Colour::Steel, Group::Sweep),
        Series { name: "front".to_owned(), colour: Colour::Olive, line: Line::All, points },
        of("--quality", Colour::Purple, Group::Quality),
        of("default", Colour::Red, Group::Default),
        of("", Colour::Orange, Group::Other),
        of("path --denoise", Colour::Green, Group::DenoisedPath),
    ]
}
