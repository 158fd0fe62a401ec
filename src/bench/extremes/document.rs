//! Errors at extremes for people: a summary, then a table and a plot a curve.

use super::{Extremes, Series};
use crate::document::{Document, Grid};
use crate::study::{figure, scatter};

/// Greatest error over that of the ordinary scene that is not remarked on.
const MAX_GROWTH: f64 = 1.1;

const LEGEND: &str = "Small scenes of which one quantity is taken to its extremes, by every method, over several seeds. Errors \
    are relative root mean squares without the worst pixel of a thousand and the reference's noise; behind the stroke \
    is the picture's mean over the reference's. Where an extreme leaves the picture as it is (but for a factor), the \
    reference is that of the ordinary scene, else each scene's own, by paths. The scenes lie beside this page.";

const GROWTH: &str = "Greatest error along a curve over that of the ordinary scene, and where; * beyond 1.1.";

const BIAS: &str = "The mean that is farthest from that of the scene's own reference, and where. Errors of these curves differ \
    by their scenes; light through mirrors and glass is found by few paths, whose means are as noisy as the pictures.";

const COLOURS: [&str; 8] = ["#d00", "#f80", "#0a7", "#07c", "#80c", "#888", "#a60", "#000"];

/// Returns the whole document.
pub fn document(extremes: &Extremes) -> Document {
    let mut document = Document::new("Extremes");
    document.facts(&extremes.facts);
    document.text(LEGEND);
    let (same, own): (Vec<&Series>, Vec<&Series>) =
        extremes.series.iter().partition(|series| series.middle.is_some());
    summary(&mut document, extremes, &same, GROWTH, |series, method| {
        let (growth, value) = series.growth(method)?;
        let mark = if growth > MAX_GROWTH { " *" } else { "" };
        Some(format!("{growth:.2} at {value:e}{mark}"))
    });
    summary(&mut document, extremes, &own, BIAS, |series, method| {
        series.bias(method).map(|(mean, value)| format!("{mean:.3} at {value:e}"))
    });
    let nonfinite: u64 = extremes.series.iter().map(Series::nonfinite).sum();
    document.text(format!("Values that were not finite: {nonfinite}."));
    extremes.series.iter().for_each(|series| section(&mut document, extremes, series));
    document
}

fn summary(
    document: &mut Document,
    extremes: &Extremes,
    series: &[&Series],
    about: &str,
    cell: impl Fn(&Series, usize) -> Option<String>,
) {
    if series.is_empty() {
        return;
    }
    document.text(about);
    let row = |series: &&Series| {
        let cells = (0..extremes.methods.len()).map(|method| cell(series, method).unwrap_or_default());
        [series.name.to_owned()].into_iter().chain(cells).collect()
    };
    let rows = series.iter().map(row).collect();
    document.grid(Grid { names: 1, heads: heads("", extremes), rows, ..Grid::default() });
}

fn heads(first: &str, extremes: &Extremes) -> Vec<String> {
    [first].iter().chain(&extremes.methods).map(|head| (*head).to_owned()).collect()
}

fn section(document: &mut Document, extremes: &Extremes, series: &Series) {
    document.heading(2, series.name);
    document.text(format!("{}.", series.about));
    let rows = series.points.iter().map(|point| {
        let cells = point.figures.iter().map(|f| format!("{} / {:.3}", figure(f.error), f.brightness));
        [format!("{:e}", point.value)].into_iter().chain(cells).collect()
    });
    let rows = rows.collect();
    document.grid(Grid { names: 1, heads: heads(series.name, extremes), rows, ..Grid::default() });
    let lines = extremes.methods.iter().enumerate().map(|(method, name)| scatter::Series {
        name: (*name).to_owned(),
        colour: COLOURS[method % COLOURS.len()],
        joined: true,
        points: series
            .points
            .iter()
            .map(|point| (point.value, point.figures[method].error, String::new()))
            .collect(),
    });
    document.figure(scatter::scatter(series.name, "relative error", &lines.collect::<Vec<_>>()));
}

impl Series {
    fn nonfinite(&self) -> u64 {
        self.points.iter().flat_map(|point| &point.figures).map(|figures| figures.nonfinite).sum()
    }
}
