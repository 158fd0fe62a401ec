//! The paper's Table 1 on our scenes: records, cuts, times and errors of every method.
//!
//! Paper: Herzog et al. 2009, Table 1.
//!
//! | column | |
//! |---|---|
//! | N_c, direct | records, and the share of them that hold direct light |
//! | anisotropy | long over short radius of footprints, mean over records: direct / indirect |
//! | a | radius of footprints over the distance of what casts light and shadow, mean: direct / indirect |
//! | cut | clusters in a record's cut, mean; of eye samples' where there are no records |
//! | T_light | light pass and trees |
//! | T_f | records, and cuts of eye samples' own |
//! | T_cache | splatting and adaptation |
//! | total | all of that and the eye pass |
//!
//! Deviations: the paper's ΣT leaves out T_light, our total does not. All errors are against a path-traced reference of
//! the same scene, and against lightcuts per pixel on the same eye samples and virtual lights: what the first
//! has more than the second is what few eye samples a pixel cannot resolve, and what clamping takes away.

mod entries;
mod equal;
mod html;
mod markdown;
mod paper;
mod row;

use super::study::{Document, Errors, Noise, Reference, Run, Study, StudyError};
use super::{Benchmark, Kind};
use crate::image::Image;
use entries::{Entry, Family, entries};
use equal::{Speed, speed};
use row::Row;
use serde::Serialize;
use std::path::PathBuf;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "table1",
    about: "The paper's Table 1: every method on whole scenes, times and errors",
    kind: Kind::Study { scenes: &["knot", "nave", "kitchen", "hall", "apartment"], pixels: [512, 512], run },
};

/// All that was found out.
#[derive(Serialize)]
struct Table1 {
    /// What it depends on.
    facts: Vec<(String, String)>,
    /// Scene by scene.
    scenes: Vec<SceneTable>,
}

/// A scene's part of the table.
#[derive(Serialize)]
struct SceneTable {
    /// The scene's name.
    scene: String,
    triangles: usize,
    /// Its reference's own error.
    reference: Noise,
    /// The methods compared, then the points on their curves.
    rows: Vec<Row>,
    #[serde(skip)]
    pictures: Pictures,
}

/// What a page shows of a scene.
struct Pictures {
    reference: Image,
    exposure: f32,
    /// Of every row.
    rows: Vec<Image>,
}

fn run(study: &Study, scenes: &[PathBuf]) -> Result<Document, StudyError> {
    let mut table = Table1 { facts: study.facts(), scenes: Vec::new() };
    for path in scenes {
        let subject = study.subject(path)?;
        let reference = study.reference(&subject)?;
        let entries = entries();
        let runs: Vec<Run> =
            entries.iter().map(|entry| study.run(&subject, &entry.candidate)).collect::<Result<_, _>>()?;
        table.scenes.push(SceneTable {
            scene: subject.name.clone(),
            triangles: subject.triangles,
            reference: reference.noise,
            rows: rows(&entries, &runs, &reference)?,
            pictures: Pictures {
                exposure: reference.exposure,
                reference: reference.mean,
                rows: runs.into_iter().map(|run| run.color).collect(),
            },
        });
    }
    Ok(Document {
        json: serde_json::json!(table),
        markdown: markdown::markdown(&table),
        html: html::html(&table),
    })
}

fn rows(entries: &[Entry], runs: &[Run], reference: &Reference) -> Result<Vec<Row>, StudyError> {
    let mut rows = Vec::with_capacity(runs.len());
    let lightcuts = entries.iter().position(|entry| entry.main && entry.family == Family::Lightcuts);
    for (i, (entry, run)) in entries.iter().zip(runs).enumerate() {
        let mut row = Row::new(entry, run, Errors::against(&run.color, reference)?);
        if let Some(lightcuts) = lightcuts.filter(|&l| l != i) {
            row.against_lightcuts = Some(Errors::between(&run.color, &runs[lightcuts].color)?);
        }
        rows.push(row);
    }
    for i in 0..rows.len() {
        let other = |family| {
            let of = |row: &&Row| row.family == family && rows[i].family != family;
            rows.iter().filter(of).map(|row| (row.total, row.against_reference.flip)).collect::<Vec<_>>()
        };
        let own = (rows[i].total, rows[i].against_reference.flip);
        let lightcuts = speed(own, &other(Family::Lightcuts));
        rows[i].speed_at_equal_flip = lightcuts;
        if let Some(l) = lightcuts_total(&rows) {
            rows[i].speed = l / rows[i].total.max(f64::MIN_POSITIVE);
        }
    }
    Ok(rows)
}

fn lightcuts_total(rows: &[Row]) -> Option<f64> {
    rows.iter().find(|row| row.main && row.family == Family::Lightcuts).map(|row| row.total)
}

impl SceneTable {
    /// A row by its label.
    fn row(&self, label: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.label == label)
    }
}
