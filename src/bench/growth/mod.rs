//! Growth of time, and of error, with the picture, the number of lamps and the number of triangles.
//!
//! Pictures are those of the default method. Along a scene's pixels there is time alone; along the lamps the error at
//! equal samples and at equal time, before denoising, for it is light's noise that many lamps could add.
//!
//! Units: processor seconds over all threads; errors are relative root mean squares, without the worst pixel of a
//! thousand and the reference's noise.

mod document;
mod scenes;

use super::study::{Candidate, Errors, Results, Run, Study, StudyError, Subject};
use super::{Benchmark, Kind};
use base::stats::{Stage, Stopwatch};
use render::method::Method;
use serde::Serialize;
use std::fs;
use std::io::BufWriter;
use std::path::PathBuf;
use transport::paths::Estimand;
use world::view::View;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "growth",
    about: "How time and error grow with the picture, with lamps and with triangles",
    kind: Kind::Study { scenes: &["cornell", "nave"], pixels: [512, 512], run },
};

/// Quantities that grow.
const KNOBS: [&str; 3] = ["pixels", "lamps", "triangles"];

/// Factors on the length of each side of the picture.
const SIDES: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// Numbers of lamps.
const LAMPS: [u32; 4] = [1, 10, 100, 1000];

/// Numbers of triangles.
const TRIANGLES: [u32; 3] = [100_000, 1_000_000, 10_000_000];

/// Stages of the cache, as against those of the eye pass and of denoising.
const CACHE: [Stage; 5] = [Stage::LightPass, Stage::Tree, Stage::Records, Stage::Splat, Stage::Render];

/// All results.
#[derive(Serialize)]
struct Growth {
    facts: Vec<(String, String)>,
    series: Vec<Series>,
}

/// Results along a quantity.
#[derive(Serialize)]
struct Series {
    name: String,
    /// The quantity.
    knob: &'static str,
    points: Vec<Point>,
}

/// Figures of a picture.
#[derive(Serialize)]
struct Point {
    /// Number of pixels, lamps or triangles.
    value: f64,
    /// Seconds that loading and building the acceleration structure take, where they are measured.
    load: Option<f64>,
    eye_pass: f64,
    cache: f64,
    denoising: f64,
    /// Seconds of all stages that make the picture.
    whole: f64,
    /// Relative error, where it is measured.
    error: Option<f64>,
}

fn run(study: &Study, files: &[PathBuf]) -> Result<Results, StudyError> {
    let knobs = &study.plan.knobs;
    if let Some(name) = knobs.iter().find(|name| !KNOBS.contains(&name.as_str())) {
        return Err(StudyError::Knob { name: name.clone(), known: KNOBS.join(", ") });
    }
    let is_chosen = |knob: &str| knobs.is_empty() || knobs.iter().any(|name| name == knob);
    let mut growth = Growth { facts: study.facts(), series: Vec::new() };
    if is_chosen("pixels") {
        for file in files {
            growth.series.push(pixels(study, study.subject(file)?)?);
        }
    }
    if is_chosen("lamps") {
        growth.series.push(lamps(study)?);
    }
    if is_chosen("triangles") {
        growth.series.push(triangles(study)?);
    }
    Ok(Results { json: serde_json::json!(growth), document: document::document(&growth) })
}

fn pixels(study: &Study, mut subject: Subject) -> Result<Series, StudyError> {
    let candidate = Candidate::new("default", Method::default());
    let mut points = Vec::new();
    for side in SIDES {
        let film = study.plan.resolution.map(|length| (f64::from(length) * side).round().max(1.0) as u32);
        subject.view = View::whole(subject.session.cameras.still, film);
        let run = study.run(&subject, &candidate)?;
        points.push(Point::new(subject.view.window.pixel_count() as f64, &run));
    }
    Ok(Series { name: format!("Pixels of {}", subject.name), knob: KNOBS[0], points })
}

fn lamps(study: &Study) -> Result<Series, StudyError> {
    let candidate =
        Candidate { denoise: false, ..Candidate::new("default, not denoised", Method::default()) };
    let mut points = Vec::new();
    for count in LAMPS {
        let file = study.plan.folder.join(format!("{count} lamps.toml"));
        fs::write(&file, scenes::hall(count))
            .map_err(|source| StudyError::Scene { path: file.clone(), source })?;
        let subject = study.subject(&file)?;
        let reference = study.reference(&subject, Estimand::Pixels)?;
        let run = study.run(&subject, &candidate)?;
        let error = Errors::against(&run.color, &reference)?.rel_rmse();
        points.push(Point { error: Some(error), ..Point::new(count.into(), &run) });
    }
    Ok(Series { name: "Lamps in a hall".to_owned(), knob: KNOBS[1], points })
}

fn triangles(study: &Study) -> Result<Series, StudyError> {
    let candidate = Candidate::new("default", Method::default());
    let mut points = Vec::new();
    for count in TRIANGLES {
        let file = study.plan.folder.join(format!("{count} triangles.toml"));
        let mesh = study.plan.folder.join(scenes::mesh_name(count));
        let write = || {
            if !mesh.exists() {
                scenes::write_dunes(count, BufWriter::new(fs::File::create(&mesh)?))?;
            }
            fs::write(&file, scenes::dunes(count))
        };
        write().map_err(|source| StudyError::Scene { path: file.clone(), source })?;
        let watch = Stopwatch::start();
        let subject = study.subject(&file)?;
        let load = watch.elapsed().cpu_seconds;
        let run = study.run(&subject, &candidate)?;
        points.push(Point { load: Some(load), ..Point::new(subject.triangles as f64, &run) });
    }
    Ok(Series { name: "Triangles of dunes".to_owned(), knob: KNOBS[2], points })
}

impl Point {
    fn new(value: f64, run: &Run) -> Point {
        Point {
            value,
            load: None,
            eye_pass: run.seconds(&[Stage::EyePass]),
            cache: run.seconds(&CACHE),
            denoising: run.seconds(&[Stage::Denoise]),
            whole: run.seconds(&Stage::ALL),
            error: None,
        }
    }

    /// Error at the time of another picture whose samples are as many.
    fn error_at_equal_time(&self) -> Option<f64> {
        Some(self.error? * self.whole.sqrt())
    }
}
