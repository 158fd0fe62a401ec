//! Growth for people: a summary, then a table and a plot a quantity.

use super::{Growth, Point, Series};
use crate::document::{Document, Grid};
use crate::study::{figure, scatter, seconds};

const LEGEND: &str = "The default's pictures, and how their time grows. Growth is from the first row to the last and, in \
    brackets, the exponent: 1 where time is in proportion to the quantity. Errors are relative root mean squares before \
    denoising; at equal time they are multiplied by the root of the time, as if samples were added or left out.";

const COLOURS: [&str; 4] = ["#d00", "#07c", "#0a7", "#000"];

/// Time of a picture.
type TimeOf = fn(&Point) -> f64;

/// Times of a picture, by name.
const TIMES: [(&str, TimeOf); 4] = [
    ("eye pass", |point| point.eye_pass),
    ("cache", |point| point.cache),
    ("denoising", |point| point.denoising),
    ("whole", |point| point.whole),
];

/// Returns the whole document.
pub fn document(growth: &Growth) -> Document {
    let mut document = Document::new("Growth");
    document.facts(&growth.facts);
    document.text(LEGEND);
    growth.series.iter().for_each(|series| section(&mut document, series));
    document
}

fn section(document: &mut Document, series: &Series) {
    document.heading(2, &series.name);
    let has_load = series.points.iter().any(|point| point.load.is_some());
    let has_error = series.points.iter().any(|point| point.error.is_some());
    let mut heads = vec![series.knob.to_owned()];
    heads.extend(has_load.then(|| "load and build".to_owned()));
    heads.extend(TIMES.map(|(name, _)| name.to_owned()));
    if has_error {
        heads.extend(["error", "error at equal time"].map(str::to_owned));
    }
    let row = |point: &Point| {
        let mut row = vec![point.value.to_string()];
        row.extend(point.load.map(seconds));
        row.extend(TIMES.map(|(_, of)| seconds(of(point))));
        row.extend([point.error, point.error_at_equal_time()].into_iter().flatten().map(figure));
        row
    };
    let mut rows: Vec<Vec<String>> = series.points.iter().map(row).collect();
    if let [first, .., last] = &series.points[..] {
        let mut row = vec!["growth".to_owned()];
        let grown = |a: f64, b: f64| match a > 0.0 && b > 0.0 {
            true => format!("{} ({:.2})", figure(b / a), (b / a).ln() / (last.value / first.value).ln()),
            false => "-".to_owned(),
        };
        row.extend(first.load.zip(last.load).map(|(a, b)| grown(a, b)));
        row.extend(TIMES.map(|(_, of)| grown(of(first), of(last))));
        let errors =
            [first.error.zip(last.error), first.error_at_equal_time().zip(last.error_at_equal_time())];
        row.extend(errors.into_iter().flatten().map(|(a, b)| grown(a, b)));
        rows.push(row);
    }
    document.grid(Grid { names: 1, heads, rows, ..Grid::default() });
    let curve = |name: &str, colour: usize, of: &dyn Fn(&Point) -> f64| scatter::Series {
        name: name.to_owned(),
        colour: COLOURS[colour % COLOURS.len()],
        joined: true,
        points: series.points.iter().map(|point| (point.value, of(point), String::new())).collect(),
    };
    let times: Vec<_> = TIMES.iter().enumerate().map(|(i, (name, of))| curve(name, i, of)).collect();
    document.figure(scatter::scatter(series.knob, "processor seconds", &times));
    if has_error {
        let errors = [
            curve("at equal samples", 0, &|point| point.error.unwrap_or(0.0)),
            curve("at equal time", 1, &|point| point.error_at_equal_time().unwrap_or(0.0)),
        ];
        document.figure(scatter::scatter(series.knob, "relative error", &errors));
    }
}
