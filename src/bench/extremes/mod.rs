//! Error at extremes: scenes far from ordinary in size, place, light, distance, gloss, angle or depth of glass, with
//! every method and record mode.
//!
//! If an extreme changes the image by no more than a factor, errors are measured against the reference of the ordinary
//! scene, and compared with its error. Otherwise each scene has a reference of its own.
//!
//! There are no curves in double precision, since rounding explains none of these. Along scale, offset and power,
//! errors stay within 1.1 times the error of the ordinary scene. Along the others they grow by the noise of few samples
//! per pixel, such as the noise of the emitter's reflection in a smooth metal ball.
//!
//! Units: errors are relative root mean squares, without the worst pixel of a thousand and the reference's noise.

mod curves;

use super::document::Grid;
use super::plot::{COLOURS, Line, Panel, Series};
use super::study::{Answer, Axis, Candidate, Question, Shot, Study, StudyError, Subject, Truth, figure};
use super::{Benchmark, Kind, Results, Scenes};
use curves::Curve;
use render::method::Method;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::rc::Rc;
use transport::paths::Estimand;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "extremes",
    about: "Error of every method in scenes far from ordinary in size, place, light, gloss or angle",
    kind: Kind::Study { scenes: Scenes::Own(4), pixels: [24, 24], run },
};

/// Largest ratio of an error to the error of the ordinary scene without a mark.
const MAX_GROWTH: f64 = 1.1;

const LEGEND: &str = "Small scenes in which one quantity is taken to its extremes, with every method, over several seeds. \
    Errors are relative root mean squares without the worst pixel of a thousand and the reference's noise. Behind the \
    stroke is the image's mean over the reference's. If an extreme changes the image only by a factor, errors are \
    measured against the reference of the ordinary scene; otherwise each scene has its own. The scenes are beside this page.";

const GROWTH: &str = "Largest error along a curve over the error of the ordinary scene, and its place. An asterisk marks more than 1.1.";

const BIAS: &str = "The mean farthest from the mean of the scene's own reference, and its place. Errors of these curves \
    differ between scenes. Few paths find light through mirrors and glass, so their means are as noisy as the images.";

/// Settings of virtual lights.
const LIGHTS: [(&str, &str); 2] = [("vpls", "3000"), ("direct_vpls", "512")];

/// Settings of a method, by key.
type Settings = &'static [(&'static str, &'static str)];

/// Method, and settings besides [`LIGHTS`], for images of some hundred pixels, by name.
const METHODS: [(&str, &str, Settings); 8] = [
    ("cache", "cache", &[("least_cell", "4"), ("spp", "8")]),
    ("denoised", "cache", &[("least_cell", "4"), ("spp", "8")]),
    ("direct records", "cache", &[("least_cell", "4"), ("direct", "records"), ("spp", "2")]),
    ("direct cuts", "cache", &[("least_cell", "4"), ("direct", "cuts"), ("spp", "2")]),
    ("reconstruction", "reconstruction", &[("spp", "2")]),
    ("lightcuts", "lightcuts", &[("spp", "1")]),
    (
        "photon-cache",
        "photon-cache",
        &[("least_cell", "4"), ("photons", "10000"), ("gather_rays", "64"), ("spp", "2")],
    ),
    ("path", "path", &[("spp", "64")]),
];

fn run(study: &Study, _: &[PathBuf]) -> Result<Results, StudyError> {
    let curves = curves::all();
    let names = study.plan.knobs(&curves.each_ref().map(|curve| curve.name))?;
    let methods = methods(study.denoises(), study.plan.repeats.max(1) as u32);
    let mut answers = Vec::new();
    for curve in curves.iter().filter(|curve| names.contains(&curve.name)) {
        answers.push((curve, answer(study, curve, &methods)?));
    }
    let mut results = Results::new("Extremes", study.facts(), LEGEND);
    let labels: Vec<&str> = methods.iter().map(|method| &*method.label).collect();
    results.json["methods"] = json!(labels);
    summary(&mut results, &answers, &labels);
    answers.iter().for_each(|(curve, answer)| section(&mut results, curve, answer, &labels));
    Ok(results)
}

/// Returns every method; denoised images only `if_denoised`.
fn methods(if_denoised: bool, seeds: u32) -> Vec<Candidate> {
    let candidate = |(name, method, settings): (&str, &str, Settings)| {
        let mut method = Method::named(method)?;
        for (key, value) in LIGHTS.iter().chain(settings) {
            // Some methods have no virtual lights.
            let _ = method.set(key, value);
        }
        Some(Candidate { denoise: name == "denoised", seeds, ..Candidate::new(name, method) })
    };
    METHODS.into_iter().filter_map(candidate).filter(|method| if_denoised || !method.denoise).collect()
}

fn answer(study: &Study, curve: &Curve, images: &[Candidate]) -> Result<Answer, StudyError> {
    let subject = |value: f64| -> Result<Subject, StudyError> {
        let subject = study.own_subject(&format!("{} {value:e}", curve.name), &(curve.scene)(value))?;
        Ok(Subject { value, ..subject })
    };
    let ordinary = curve.middle.map(|middle| study.reference(&subject(middle)?, Estimand::Pixels));
    let ordinary = ordinary.transpose()?.map(Rc::new);
    let error = ordinary.as_ref().map_or(Truth::Pixels, Truth::Given);
    let axis = Axis::Value(curve.name);
    let question = Question { images, axis, error, brightness: curve.brightness, ..Question::PLAIN };
    study.ask(question, curve.values.iter().map(|&value| subject(value)))
}

/// Adds the largest errors of all curves, then the means farthest from the reference's.
fn summary(results: &mut Results, answers: &[(&Curve, Answer)], methods: &[&str]) {
    for (about, has_middle) in [(GROWTH, true), (BIAS, false)] {
        let answers = answers.iter().filter(|(curve, _)| curve.middle.is_some() == has_middle);
        let row = |(curve, answer): &(&Curve, Answer)| {
            let cells =
                (0..methods.len()).map(|method| worst(curve, of_method(answer, method, methods.len())));
            [curve.name.to_owned()].into_iter().chain(cells.map(Option::unwrap_or_default)).collect()
        };
        let rows: Vec<Vec<String>> = answers.map(row).collect();
        if !rows.is_empty() {
            results.document.text(about);
            results.document.grid(&Grid::new(1, &[&[""], methods].concat(), rows));
        }
    }
    let shots = answers.iter().flat_map(|(_, answer)| &answer.shots);
    let nonfinite: u64 = shots.map(|shot| shot.nonfinite).sum();
    results.document.text(&format!("Values that were not finite: {nonfinite}."));
}

/// Returns the largest error of a method over its error at the middle of the curve; without a middle, the mean that
/// differs most from the reference's.
fn worst<'s>(curve: &Curve, shots: impl Iterator<Item = &'s Shot> + Clone) -> Option<String> {
    let largest = |of: &dyn Fn(&Shot) -> f64| shots.clone().max_by(|a, b| of(a).total_cmp(&of(b)));
    match curve.middle {
        Some(middle) => {
            let middle = shots.clone().find(|shot| shot.value == middle)?;
            let base = middle.errors.rel_rmse().max(f64::MIN_POSITIVE);
            let shot = largest(&|shot| shot.errors.rel_rmse())?;
            let growth = shot.errors.rel_rmse() / base;
            let mark = if growth > MAX_GROWTH { " *" } else { "" };
            Some(format!("{growth:.2} at {:e}{mark}", shot.value))
        }
        None => {
            let shot = largest(&|shot| (shot.errors.brightness - 1.0).abs())?;
            Some(format!("{:.3} at {:e}", shot.errors.brightness, shot.value))
        }
    }
}

/// Returns the images of a method of `count` methods.
fn of_method(answer: &Answer, method: usize, count: usize) -> impl Iterator<Item = &Shot> + Clone {
    answer.shots.iter().skip(method).step_by(count)
}

fn section(results: &mut Results, curve: &Curve, answer: &Answer, methods: &[&str]) {
    let scenes = || answer.shots.chunks(methods.len());
    let point = |shots: &[Shot]| {
        let figures = |s: &Shot| json!({ "error": s.errors.rel_rmse(), "brightness": s.errors.brightness, "nonfinite": s.nonfinite });
        json!({ "value": shots[0].value, "figures": shots.iter().map(figures).collect::<Value>() })
    };
    let points: Value = scenes().map(point).collect();
    let facts = json!({ "name": curve.name, "about": curve.about, "middle": curve.middle });
    results.push("series", facts, json!({ "points": points }));
    let document = &mut results.document;
    document.heading(2, curve.name);
    document.text(&format!("{}.", curve.about));
    let series = |(i, method): (usize, &&str)| Series {
        name: (*method).to_owned(),
        colour: COLOURS[i % COLOURS.len()].0,
        line: Line::All,
        points: answer.points(of_method(answer, i, methods.len()), |s| Some(s.errors.rel_rmse())),
    };
    let series = methods.iter().enumerate().map(series).collect();
    answer.draw(document, curve.name, vec![Panel { title: "relative error".to_owned(), series }]);
    let row = |shots: &[Shot]| {
        let cells =
            shots.iter().map(|s| format!("{} / {:.3}", figure(s.errors.rel_rmse()), s.errors.brightness));
        [format!("{:e}", shots[0].value)].into_iter().chain(cells).collect()
    };
    document.grid(&Grid::new(1, &[&[curve.name], methods].concat(), scenes().map(row).collect()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_one_of_the_method() {
        assert_eq!(methods(true, 1).len(), 8);
        assert_eq!(methods(false, 1).len(), 7);
        let all = methods(true, 1);
        for (i, method) in all.iter().enumerate() {
            let text = format!("{:?}", method.method);
            let others = all[..i].iter().filter(|other| format!("{:?}", other.method) == text);
            assert_eq!(others.count(), usize::from(method.denoise), "{text}");
        }
    }
}
