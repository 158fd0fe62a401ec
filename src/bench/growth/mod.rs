//! Growth of time, and of error, with the size of the image, and with the numbers of lamps, triangles and instances.
//!
//! Images are those of the default method. Along the pixels and triangles, only times are measured. Along the lamps,
//! errors are measured at equal samples and at equal time, before denoising: many lamps could add noise.
//!
//! Units: errors are relative root mean squares, without the worst pixel of a thousand and the reference's noise.

mod threads;

use super::study::{
    Answer, Candidate, Cell, Column, Question, Shot, Study, StudyError, Subject, Truth, figure,
};
use super::{Benchmark, Kind, Results};
use base::stats::{Stage, Stopwatch};
use render::method::Method;
use serde_json::json;
use std::path::{Path, PathBuf};
use world::view::View;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "growth",
    about: "How time and error grow with the image, with lamps, triangles and instances",
    kind: Kind::Study { scenes: &["cornell", "nave"], pixels: [512, 512], run },
};

/// Factors on the length of each side of the image.
const SIDES: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// Numbers of lamps.
const LAMPS: [u32; 4] = [10, 100, 1000, 10_000];

/// Numbers of triangles.
const TRIANGLES: [u32; 3] = [100_000, 1_000_000, 10_000_000];

/// Numbers of trees, each of about 100,000 triangles.
const TREES: [u32; 4] = [10, 100, 1000, 10_000];

/// Caption of the tables.
const LEGEND: &str = "Times of the default's images. Growth is from the first row to the last and, in brackets, the \
    exponent: 1 if time is proportional to the quantity. Errors are relative root mean squares before denoising. At equal \
    time they are multiplied by the root of the time, as if samples were added or left out.";

/// Stages of the cache, as opposed to the eye pass and denoising.
const CACHE: [Stage; 5] = [Stage::LightPass, Stage::Tree, Stage::Records, Stage::Splat, Stage::Render];

/// Times and errors over a quantity.
const QUESTION: Question = Question {
    error: Truth::None,
    table: &[
        Column::new("value", "scene", |_, s| Cell { exact: json!(s.value), text: s.value.to_string() }),
        Column::new("load", "load and build", |_, s| s.load.map_or(Cell::MISSING, Cell::seconds)),
        Column::new("eye_pass", "eye pass", |_, s| Cell::seconds(s.counted.seconds(&[Stage::EyePass]))),
        Column::new("cache", "cache", |_, s| Cell::seconds(s.counted.seconds(&CACHE))),
        Column::new("denoising", "denoising", |_, s| Cell::seconds(s.counted.seconds(&[Stage::Denoise]))),
        Column::new("whole", "whole", |_, s| Cell::seconds(s.seconds())),
        Column::new("error", "error", |_, s| error(s).map_or(Cell::MISSING, Cell::figure)),
        Column::new("", "error at equal time", |_, s| at_equal_time(s).map_or(Cell::MISSING, Cell::figure)),
    ],
    ..Question::PLAIN
};

/// Function that writes the meshes of a scene of some size into a folder, and returns its description.
type WriteSized = fn(u32, &Path) -> std::io::Result<String>;

/// Returns the error, if there is a reference.
fn error(shot: &Shot) -> Option<f64> {
    shot.errors.rel_mse.is_finite().then(|| shot.errors.rel_rmse())
}

/// Returns the error at the time of another image whose samples are as many.
fn at_equal_time(shot: &Shot) -> Option<f64> {
    Some(error(shot)? * shot.seconds().sqrt())
}

fn run(study: &Study, files: &[PathBuf]) -> Result<Results, StudyError> {
    let knobs = study.plan.knobs(&["pixels", "lamps", "triangles", "instances", "threads"])?;
    let default = [Candidate::new("default", Method::default())];
    let noisy = default.clone().map(|candidate| Candidate { denoise: false, ..candidate });
    let mut results = Results::new("Growth", study.facts(), LEGEND);
    for file in files.iter().filter(|_| knobs.contains(&"pixels")) {
        let scenes = SIDES.iter().map(|&side| enlarged(study, file, side));
        let answer = study.ask(Question { images: &default, ..QUESTION }, scenes)?;
        section(&mut results, &format!("Pixels of {}", answer.scene), "pixels", &answer);
    }
    if knobs.contains(&"lamps") {
        let question = Question { images: &noisy, error: Truth::Pixels, ..QUESTION };
        let answer = study.ask(question, LAMPS.iter().map(|&count| plaza(study, count)))?;
        section(&mut results, "Lamps of a plaza", "lamps", &answer);
    }
    if knobs.contains(&"triangles") {
        let scenes =
            TRIANGLES.iter().map(|&count| sized(study, count, "triangles", lightsplat_scenes::dunes));
        let answer = study.ask(Question { images: &default, ..QUESTION }, scenes)?;
        section(&mut results, "Triangles of dunes", "triangles", &answer);
    }
    if knobs.contains(&"instances") {
        let scenes = TREES.iter().map(|&count| sized(study, count, "trees", lightsplat_scenes::forest));
        let answer = study.ask(Question { images: &default, ..QUESTION }, scenes)?;
        section(&mut results, "Trees of a forest", "triangles seen", &answer);
    }
    for file in files.iter().filter(|_| knobs.contains(&"threads")) {
        threads::measure(study, file, &mut results)?;
    }
    Ok(results)
}

/// Loads a scene, with each side of its image times a factor.
fn enlarged(study: &Study, file: &Path, side: f64) -> Result<Subject, StudyError> {
    let subject = study.subject(file)?;
    let film = study.plan.resolution.map(|length| (f64::from(length) * side).round().max(1.0) as u32);
    let view = View::whole(subject.session.cameras.still, film);
    Ok(Subject { value: view.window.pixel_count() as f64, view, ..subject })
}

/// Loads the plaza with a number of lamps.
fn plaza(study: &Study, count: u32) -> Result<Subject, StudyError> {
    let text = lightsplat_scenes::file("plaza.toml").unwrap_or_default();
    let generator = format!("generator = \"plaza {count}\"");
    let text = String::from_utf8_lossy(text).replace("generator = \"plaza\"", &generator);
    let subject = study.own_subject(&format!("{count} lamps"), &text)?;
    Ok(Subject { value: count.into(), ..subject })
}

/// Writes a scene of some size, and loads it in a measured time.
fn sized(study: &Study, size: u32, unit: &str, write: WriteSized) -> Result<Subject, StudyError> {
    let text = study.write_scene(|folder| write(size, folder))?;
    let watch = Stopwatch::start();
    let subject = study.own_subject(&format!("{size} {unit}"), &text)?;
    let load = Some(watch.elapsed().cpu_seconds);
    Ok(Subject { value: subject.triangles as f64, load, ..subject })
}

fn section(results: &mut Results, name: &str, quantity: &str, answer: &Answer) {
    let facts = json!({ "name": name, "knob": quantity });
    results.push("series", facts, json!({ "points": answer.rows() }));
    results.document.heading(2, name);
    let mut grid = answer.grid(&answer.shots);
    grid.heads[0] = quantity.to_owned();
    if let [first, .., last] = &answer.shots[..] {
        let grown = |column: &Column<Shot>| {
            let [a, b] = [first, last].map(|shot| (column.cell)(answer, shot).exact.as_f64());
            let (a, b) = (a.unwrap_or(0.0), b.unwrap_or(0.0));
            match a > 0.0 && b > 0.0 {
                true => format!("{} ({:.2})", figure(b / a), (b / a).ln() / (last.value / first.value).ln()),
                false => "-".to_owned(),
            }
        };
        let columns =
            QUESTION.table.iter().filter(|column| grid.heads.iter().any(|head| head == column.head));
        grid.rows.push(["growth".to_owned()].into_iter().chain(columns.map(grown)).collect());
    }
    results.document.grid(&grid);
}
