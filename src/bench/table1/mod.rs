//! The paper's Table 1 on our scenes: records, cuts, times and errors of every method.
//!
//! Paper: Herzog et al. 2009, Table 1.
//!
//! | column | |
//! |---|---|
//! | N_c, direct | records, and the share of them that hold direct light |
//! | anisotropy | long over short radius of footprints, mean over records: direct / indirect |
//! | a | radius of footprints over the distance of the geometry that casts light and shadow, mean: direct / indirect |
//! | cut | clusters in a record's cut, mean; of eye samples' where there are no records |
//! | T_light | light pass and trees |
//! | T_f | records, and eye samples' own cuts |
//! | T_cache | splatting and adaptation |
//! | total | all of that, the eye pass and denoising |
//!
//! The row of a walk-through, LWalk2, states means over 24 frames that end at the picture, whose errors are its: of
//! the records that a frame adds to those before it, and of times; the light pass is the first frame's alone.
//!
//! Deviations: the paper's ΣT leaves out T_light, our total does not. All errors are against a path-traced
//! reference of the same scene: of its pixels, and of light. Errors of light are, for methods that keep a few
//! eye samples a pixel, against a reference of those points alone, without their aliasing; for methods that
//! estimate the whole pixel, the default and paths, they are those of its pixels. Methods that keep eye samples
//! are compared with lightcuts per pixel on the same samples and virtual lights too, where clamping does not
//! show either.

mod document;
mod entries;
mod paper;
mod row;

use super::study::{
    Bounded, Errors, Noise, Reference, Results, Run, Study, StudyError, eye_samples, time_to,
};
use super::{Benchmark, Kind};
use base::film::Image;
use entries::{Entry, Family, OPPONENTS, entries};
use row::{Row, Versus};
use serde::Serialize;
use std::path::PathBuf;
use transport::paths::Estimand;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "table1",
    about: "The paper's Table 1: every method on whole scenes, times and errors",
    kind: Kind::Study { scenes: &["knot", "nave", "kitchen", "hall", "apartment"], pixels: [512, 512], run },
};

/// All results.
#[derive(Serialize)]
struct Table1 {
    /// Conditions that the figures depend on.
    facts: Vec<(String, String)>,
    /// Results scene by scene.
    scenes: Vec<SceneTable>,
}

/// A scene's part of the table.
#[derive(Serialize)]
struct SceneTable {
    /// The scene's name.
    scene: String,
    triangles: usize,
    /// Noise of its reference of pixels.
    reference: Noise,
    /// Noise of its reference of eye samples.
    light_reference: Noise,
    /// The methods compared, then the points on their curves.
    rows: Vec<Row>,
    #[serde(skip)]
    pictures: Pictures,
}

/// Pictures of a scene for the page.
struct Pictures {
    reference: Image,
    exposure: f32,
    /// Pictures of all rows.
    rows: Vec<Image>,
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Results, StudyError> {
    let mut table = Table1 { facts: study.facts(), scenes: Vec::new() };
    for path in scenes {
        let subject = study.subject(path)?;
        let reference = study.reference(&subject, Estimand::Pixels)?;
        let light = study.reference(&subject, eye_samples())?;
        let entries = entries(study, &subject);
        let runs: Vec<Run> =
            entries.iter().map(|entry| study.run(&subject, &entry.candidate)).collect::<Result<_, _>>()?;
        table.scenes.push(SceneTable {
            scene: subject.name.clone(),
            triangles: subject.triangles,
            reference: reference.noise,
            light_reference: light.noise,
            rows: rows(&entries, &runs, &reference, &light)?,
            pictures: Pictures {
                exposure: reference.exposure,
                reference: reference.mean,
                rows: runs.into_iter().map(|run| run.color).collect(),
            },
        });
    }
    Ok(Results { json: serde_json::json!(table), document: document::document(&table) })
}

fn rows(
    entries: &[Entry],
    runs: &[Run],
    reference: &Reference,
    light: &Reference,
) -> Result<Vec<Row>, StudyError> {
    let mut rows = Vec::with_capacity(runs.len());
    let lightcuts = entries.iter().position(|entry| entry.main && entry.family == Family::Lightcuts);
    for (i, (entry, run)) in entries.iter().zip(runs).enumerate() {
        let whole = entry.candidate.method.estimand() == Estimand::Pixels;
        let errors = Errors::against(&run.color, reference)?;
        let light = if whole { errors } else { Errors::against(&run.color, light)? };
        let mut row = Row::new(entry, run, [errors, light]);
        if let Some(lightcuts) = lightcuts.filter(|&l| l != i && !whole) {
            row.against_lightcuts = Some(Errors::between(&run.color, &runs[lightcuts].color)?);
        }
        rows.push(row);
    }
    let versus: Vec<_> = rows.iter().map(|row| OPPONENTS.map(|other| versus(row, &rows, other))).collect();
    rows.iter_mut().zip(versus).for_each(|(row, versus)| row.versus = versus);
    Ok(rows)
}

/// Compares with another family: its own row, and the curve of all its rows.
fn versus(row: &Row, rows: &[Row], (family, label): (Family, &str)) -> Option<Versus> {
    let own = rows.iter().find(|other| other.label == label)?;
    let at_equal = |error: fn(&Row) -> f64| {
        let others = rows.iter().filter(|other| other.family == family);
        let others: Vec<_> = others.map(|other| (other.total, error(other))).collect();
        let time = time_to(error(row), &others).filter(|_| row.family != family)?;
        time.over(Bounded::About(row.total.max(f64::MIN_POSITIVE)))
    };
    Some(Versus {
        method: label.to_owned(),
        speed: own.total / row.total.max(f64::MIN_POSITIVE),
        at_equal_flip: at_equal(|row| row.against_reference.flip),
        at_equal_psnr: at_equal(|row| row.against_reference.displayed_rmse()),
        at_equal_light: at_equal(|row| row.light.rel_mse),
    })
}

impl SceneTable {
    /// Finds a row by its label.
    fn row(&self, label: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.label == label)
    }
}
