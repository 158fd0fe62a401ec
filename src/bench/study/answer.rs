//! Tables and figures of answers.

use super::cell::figure;
use super::reference::Noise;
use super::{Answer, Candidate, Column, Curve, Figure, Question, Shot};
use crate::document::{Document, Grid};
use crate::plot::{Panel, Point, Series};
use serde_json::{Value, json};

impl Answer {
    /// Returns the scene's name and the noise of its references.
    pub fn facts(&self) -> Value {
        let mut facts = json!({ "scene": self.scene });
        if let Some(reference) = &self.reference {
            facts["reference"] = json!(reference.noise);
        }
        if let Some(reference) = &self.light_reference {
            facts["light_reference"] = json!(reference.noise);
        }
        facts
    }

    /// Describes the references.
    pub fn about(&self) -> String {
        let mut text = self.reference.as_ref().map_or_else(String::new, |reference| reference.noise.about());
        if let Some(Noise { spp, rel_mse, .. }) = self.light_reference.as_ref().map(|light| light.noise) {
            text += &format!(" Reference of eye samples: {spp} paths per pixel, relMSE {}.", figure(rel_mse));
        }
        text
    }

    /// Returns an object per image.
    pub fn rows(&self) -> Value {
        self.objects(self.question.table, &self.shots)
    }

    /// Returns the table of some images.
    pub fn grid<'s>(&self, shots: impl IntoIterator<Item = &'s Shot>) -> Grid {
        self.grid_of(self.question.table, self.question.names, shots)
    }

    /// Adds a table of the main images with the brief columns, then the table of all images and columns, folded away.
    pub fn tell(&self, document: &mut Document) {
        let main = self.shots.iter().filter(|shot| shot.candidate.main);
        let Question { table, brief, names, .. } = self.question;
        let is_brief = |column: &&Column<Shot>| brief.contains(&column.head);
        let texts = table.iter().filter(|column| !column.head.is_empty()).take(names).filter(is_brief);
        document.grid(&self.grid_of(table.iter().filter(is_brief), texts.count(), main));
        let grid = self.grid(&self.shots);
        document.fold("All images and all columns", |document| {
            document.text(&self.about());
            document.grid(&grid);
        });
    }

    /// Returns the figures as panels of a chart.
    pub fn panels(&self) -> Vec<Panel> {
        let panel = |figure: &Figure| {
            let series = |curve: &Curve| Series {
                name: curve.name.to_owned(),
                colour: curve.colour,
                line: curve.line,
                points: self.points(curve.holds, figure.error),
            };
            let title = format!("{}: {}", self.scene, figure.name);
            Panel { title, series: figure.curves.iter().map(series).collect() }
        };
        self.question.figures.iter().map(panel).collect()
    }

    /// Returns points over their seconds.
    fn points(&self, holds: fn(&Candidate) -> bool, error: fn(&Shot) -> Option<f64>) -> Vec<Point> {
        let point = |shot: &Shot| {
            Some(Point { x: shot.seconds(), y: error(shot)?, name: shot.candidate.label.clone() })
        };
        let shots = self.shots.iter().filter(|shot| holds(&shot.candidate));
        let mut points: Vec<Point> = shots.filter_map(point).collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        points
    }

    /// Returns an object per record.
    pub fn objects<R>(&self, columns: &[Column<R>], records: &[R]) -> Value {
        let object = |record: &R| -> Value {
            let columns = columns.iter().filter(|column| !column.key.is_empty());
            columns.map(|column| (column.key.to_owned(), (column.cell)(self, record).exact)).collect()
        };
        records.iter().map(object).collect()
    }

    /// Returns a row per record with some columns, of which the first `names` hold text. Columns without any text are
    /// left out.
    pub fn grid_of<'r, R: 'r>(
        &self,
        columns: impl IntoIterator<Item = &'r Column<R>>,
        names: usize,
        records: impl IntoIterator<Item = &'r R>,
    ) -> Grid {
        let records: Vec<&R> = records.into_iter().collect();
        let text = |column: &Column<R>, record: &R| (column.cell)(self, record).text;
        let is_empty = |column: &Column<R>| records.iter().all(|record| text(column, record).is_empty());
        let shown: Vec<_> =
            columns.into_iter().filter(|column| !column.head.is_empty() && !is_empty(column)).collect();
        let row = |record: &&R| shown.iter().map(|column| text(column, record)).collect();
        let heads: Vec<&str> = shown.iter().map(|column| column.head).collect();
        Grid::new(names, &heads, records.iter().map(row).collect())
    }
}
