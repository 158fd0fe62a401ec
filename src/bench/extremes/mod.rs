//! Error at extremes: scenes far from ordinary in size, place, light, distance, gloss, angle or depth of glass, by
//! every method and record mode.
//!
//! Where an extreme leaves the picture as it is but for a factor, errors are against the reference of the ordinary
//! scene and told by their ratio to its error; elsewhere each scene has a reference of its own, by paths.
//!
//! There are no curves in double precision, for rounding explains none of these: along scale, offset and power errors
//! stay within 1.1 times that of the middle. Along the others they grow by the noise of few samples a pixel, such as
//! that of the lamp's reflection in a smooth metal ball, which covers four pixels: by 16 samples in place of one the
//! mean is right within 0.3 %.
//!
//! Units: errors are relative root mean squares, without the worst pixel of a thousand and the reference's noise.

mod curves;
mod document;
mod methods;

use super::study::{Errors, Reference, Results, Study, StudyError, Subject};
use super::{Benchmark, Kind};
use base::film::Image;
use curves::Curve;
use methods::Entrant;
use render::session::Goal;
use serde::Serialize;
use transport::paths::Estimand;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "extremes",
    about: "Error of every method in scenes far from ordinary in size, place, light, gloss or angle",
    kind: Kind::OwnScenes { pixels: [24, 24], repeats: 4, run },
};

/// All results.
#[derive(Serialize)]
struct Extremes {
    facts: Vec<(String, String)>,
    /// Names of the methods, in the order of the figures.
    methods: Vec<&'static str>,
    series: Vec<Series>,
}

/// Results along a curve.
#[derive(Serialize)]
struct Series {
    name: &'static str,
    about: &'static str,
    /// Value that the others are compared with, if they are.
    middle: Option<f64>,
    /// Results at every value of the curve.
    points: Vec<Point>,
}

/// Results in a scene.
#[derive(Serialize)]
struct Point {
    value: f64,
    /// Figures of every method.
    figures: Vec<Figures>,
}

/// Figures of a method over all seeds.
#[derive(Clone, Copy, Serialize)]
struct Figures {
    /// Relative error.
    error: f64,
    /// Mean over that of the reference.
    brightness: f64,
    /// Number of values that were not finite.
    nonfinite: u64,
}

fn run(study: &Study) -> Result<Results, StudyError> {
    let entrants = methods::all(study.denoises());
    let curves = chosen(&study.plan.knobs)?;
    let mut extremes = Extremes {
        facts: study.facts(),
        methods: entrants.iter().map(|entrant| entrant.name).collect(),
        series: Vec::new(),
    };
    for curve in &curves {
        extremes.series.push(series(study, curve, &entrants)?);
    }
    Ok(Results { json: serde_json::json!(extremes), document: document::document(&extremes) })
}

/// Returns the curves of those names, or all.
fn chosen(names: &[String]) -> Result<Vec<Curve>, StudyError> {
    let known = || curves::all().map(|curve| curve.name).join(", ");
    let unknown = names.iter().find(|name| curves::all().iter().all(|curve| curve.name != name.as_str()));
    if let Some(name) = unknown {
        return Err(StudyError::Knob { name: name.clone(), known: known() });
    }
    let is_chosen = |curve: &Curve| names.is_empty() || names.iter().any(|name| name == curve.name);
    Ok(curves::all().into_iter().filter(is_chosen).collect())
}

fn series(study: &Study, curve: &Curve, entrants: &[Entrant]) -> Result<Series, StudyError> {
    let Curve { name, about, ref values, middle, scene, brightness } = *curve;
    let subject = |value: f64| {
        let file = study.plan.folder.join(format!("{name} {value:e}.toml"));
        std::fs::write(&file, scene(value))
            .map_err(|source| StudyError::Scene { path: file.clone(), source })?;
        study.subject(&file)
    };
    let shared = middle.map(|middle| study.reference(&subject(middle)?, Estimand::Pixels)).transpose()?;
    let mut points = Vec::with_capacity(values.len());
    for &value in values {
        let subject = subject(value)?;
        let own;
        let reference = match &shared {
            Some(shared) => shared,
            None => {
                own = study.reference(&subject, Estimand::Pixels)?;
                &own
            }
        };
        let figures = |entrant| figures(study, &subject, entrant, reference, brightness(value));
        points.push(Point { value, figures: entrants.iter().map(figures).collect::<Result<_, _>>()? });
        (study.say)(&format!("{name} {value:e}"));
    }
    Ok(Series { name, about, middle, points })
}

/// Renders a scene by a method once for every seed; pictures are divided by `brightness`.
fn figures(
    study: &Study,
    subject: &Subject,
    entrant: &Entrant,
    reference: &Reference,
    brightness: f64,
) -> Result<Figures, StudyError> {
    let seeds = study.plan.repeats.max(1);
    let (mut mse, mut mean, mut nonfinite) = (0.0, 0.0, 0);
    for seed in 0..seeds {
        let mut method = entrant.method;
        method.set_seed(1000 + seed as u32);
        let goal = Goal { method, denoise: Some(entrant.denoise), ..Goal::default() };
        // Pictures are far smaller than memory: the only error is that of cancellation.
        let frame = subject.session.frame(&subject.view, &goal, study.control).ok();
        let Some(frame) = frame.filter(|frame| frame.complete) else { return Err(StudyError::Interrupted) };
        nonfinite += frame.facts["nonfinite"].as_u64().unwrap_or(0);
        let mut picture: Image = frame.film.color;
        picture.pixels.iter_mut().for_each(|p| *p = (p.as_dvec3() / brightness).as_vec3());
        let errors = Errors::against(&picture, reference)?;
        mse += errors.rel_mse / seeds as f64;
        mean += errors.brightness / seeds as f64;
    }
    Ok(Figures { error: mse.max(0.0).sqrt(), brightness: mean, nonfinite })
}

impl Series {
    /// Returns the greatest error of a method over that at the middle, and its value; `None` without a middle.
    fn growth(&self, method: usize) -> Option<(f64, f64)> {
        let middle = self.points.iter().find(|point| Some(point.value) == self.middle)?;
        let base = middle.figures[method].error.max(f64::MIN_POSITIVE);
        self.extreme(|figures| figures.error / base, method)
    }

    /// Returns the mean of a method that differs most from its reference, and its value.
    fn bias(&self, method: usize) -> Option<(f64, f64)> {
        let (_, value) = self.extreme(|figures| (figures.brightness - 1.0).abs(), method)?;
        let point = self.points.iter().find(|point| point.value == value)?;
        Some((point.figures[method].brightness, value))
    }

    /// Returns the greatest figure of a method, with its value.
    fn extreme(&self, figure: impl Fn(&Figures) -> f64, method: usize) -> Option<(f64, f64)> {
        let figures = self.points.iter().map(|point| (figure(&point.figures[method]), point.value));
        figures.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}
