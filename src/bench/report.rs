//! Tables of measured parts.

use crate::document::{Document, Grid};
use crate::study::figure;
use serde::Serialize;

/// Cases measured against each other.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Table {
    /// Title in a few words.
    pub title: &'static str,
    /// Description of the rows, and of the case that ratios refer to.
    pub about: &'static str,
    /// Names of the columns that tell rows apart.
    pub labels: &'static [&'static str],
    /// Unit of the rates.
    pub unit: &'static str,
    /// Names of further figures.
    pub figures: &'static [&'static str],
    /// The cases.
    pub rows: Vec<Row>,
    /// Warnings about cases.
    pub warnings: Vec<String>,
}

/// A case.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Labels of the case.
    pub labels: Vec<String>,
    /// Rate over the rate of the case it is compared with, sample by sample.
    pub ratio: Spread,
    /// Units of work per second.
    pub rate: Spread,
    /// Rates of all samples, in their order.
    pub samples: Vec<f64>,
    /// Further figures; `None` gives an empty cell.
    pub figures: Vec<Option<f64>>,
}

/// Median and quartiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// Lower quartile.
    pub low: f64,
    /// Upper quartile.
    pub high: f64,
}

impl Spread {
    /// Computes median and quartiles of some values; all 0 without values.
    pub fn new(values: &[f64]) -> Spread {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |fraction: f64| {
            let place = fraction * (sorted.len().max(1) - 1) as f64;
            let (below, above) = (place.floor() as usize, place.ceil() as usize);
            match (sorted.get(below), sorted.get(above)) {
                (Some(a), Some(b)) => a + (b - a) * place.fract(),
                _ => 0.0,
            }
        };
        Spread { median: at(0.5), low: at(0.25), high: at(0.75) }
    }

    /// Returns the distance of the quartiles over the median.
    pub fn relative(&self) -> f64 {
        if self.median > 0.0 { (self.high - self.low) / self.median } else { 0.0 }
    }
}

impl Table {
    /// Adds the table to a document: labels, ratio with quartiles, rate with relative spread, further figures.
    pub fn tell(&self, document: &mut Document) {
        document.heading(2, self.title);
        document.text(self.about);
        let fixed = ["ratio", "quartiles", self.unit, "spread"];
        let heads = self.labels.iter().chain(&fixed).chain(self.figures).copied().map(str::to_owned);
        let cells = |row: &Row| {
            let fixed = [
                figure(row.ratio.median),
                format!("{} .. {}", figure(row.ratio.low), figure(row.ratio.high)),
                figure(row.rate.median),
                format!("{:.1} %", 100.0 * row.rate.relative()),
            ];
            let figures = row.figures.iter().map(|f| f.map_or_else(String::new, figure));
            row.labels.iter().cloned().chain(fixed).chain(figures).collect()
        };
        let rows = self.rows.iter().map(cells).collect();
        document.grid(&Grid { names: self.labels.len(), heads: heads.collect(), rows });
        self.warnings.iter().for_each(|warning| document.text(&format!("*warning: {warning}*")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_interpolated() {
        assert_eq!(Spread::new(&[4.0, 1.0, 3.0, 2.0, 5.0]), Spread { median: 3.0, low: 2.0, high: 4.0 });
        assert_eq!(Spread::new(&[2.0, 1.0]), Spread { median: 1.5, low: 1.25, high: 1.75 });
        assert_eq!(Spread::new(&[]), Spread::default());
        assert_eq!(Spread::new(&[7.0]).relative(), 0.0);
    }
}
