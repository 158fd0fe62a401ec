//! A chart of several panels with one legend and a caption.

use super::panel::{Area, key, panel, text};
use super::series::{Point, Series};
use crate::escape::escaped;

/// Width of a chart, and height of a row of panels.
const WIDTH: f64 = 780.0;
const ROW: f64 = 250.0;
/// Height of a line of text.
const LINE: f64 = 17.0;
/// Distance between the names of a legend.
const KEY: f64 = 240.0;
/// Most characters in a line of the caption.
const CHARACTERS: usize = 118;

/// A panel of a chart.
pub struct Panel {
    /// Title: the scene and the error.
    pub title: String,
    /// Points of each program or method, not yet joined.
    pub series: Vec<Series>,
}

/// A chart: panels in two columns over one quantity.
pub struct Chart {
    /// Name of the horizontal axes.
    pub axis: &'static str,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Paragraphs of the caption.
    pub caption: Vec<String>,
}

impl Chart {
    /// Returns the chart as an element of a page. Lines join the points that no other point of the series beats.
    /// Panels without a point are empty.
    pub fn svg(&self) -> String {
        let legend = self.legend();
        let keys = legend.len().div_ceil(3) as f64;
        let caption: Vec<String> = self.caption.iter().flat_map(|text| lines(text, CHARACTERS)).collect();
        let top = 14.0 + LINE * keys;
        let rows = self.panels.len().div_ceil(2) as f64;
        let height = top + ROW * rows + LINE * caption.len() as f64 + 12.0;
        let mut svg = format!(
            "<svg class=\"plot\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" role=\"img\">\n"
        );
        svg += &format!("<title>{}</title>\n", escaped(&self.description()));
        for (i, series) in legend.iter().enumerate() {
            svg += &key(60.0 + KEY * (i % 3) as f64, 14.0 + LINE * (i / 3) as f64, series);
        }
        for (i, panel) in self.panels.iter().enumerate() {
            svg += &self.draw(panel, [(i % 2) as f64 * 0.5 * WIDTH, top + ROW * (i / 2) as f64]);
        }
        for (i, line) in caption.iter().enumerate() {
            let y = top + ROW * rows + LINE * (i as f64 + 0.5);
            svg += &text(14.0, y, "start", line).replacen("<text", "<text class=\"minor\"", 1);
        }
        svg + "</svg>\n"
    }

    /// Describes the chart for readers who do not see it.
    pub fn description(&self) -> String {
        let titles: Vec<&str> = self.panels.iter().map(|panel| &*panel.title).collect();
        let names: Vec<String> = self.legend().into_iter().map(|series| series.name).collect();
        format!("Error over {} of {}: {}", self.axis, names.join(", "), titles.join("; "))
    }

    /// Returns one series per name, in the order of appearance.
    fn legend(&self) -> Vec<Series> {
        let mut legend: Vec<Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            let is_new = !series.name.is_empty() && legend.iter().all(|other| other.name != series.name);
            if is_new && series.drawable().next().is_some() {
                legend.push(Series { points: Vec::new(), ..series.clone() });
            }
        }
        legend
    }

    /// Draws a panel at the left and upper edges of its place.
    fn draw(&self, panel_of: &Panel, [x, y]: [f64; 2]) -> String {
        let area =
            Area { left: x + 62.0, right: x + 0.5 * WIDTH - 12.0, top: y + 24.0, bottom: y + ROW - 46.0 };
        let mut series = Vec::new();
        for points in &panel_of.series {
            // Points without a common name are labelled instead of joined.
            if points.name.is_empty() {
                series.push(points.clone());
                continue;
            }
            let front = points.front();
            let on_front = |point: &Point| front.iter().any(|p| p.x == point.x && p.y == point.y);
            let beaten = points.drawable().filter(|p| !on_front(p)).cloned().collect();
            series.push(Series { joined: false, points: beaten, ..points.clone() });
            series.push(Series {
                joined: true,
                points: front.into_iter().cloned().collect(),
                ..points.clone()
            });
        }
        let mut svg =
            text(area.left, y + 14.0, "start", &panel_of.title).replacen("<text", "<text class=\"head\"", 1);
        svg += &panel(area, &series).unwrap_or_default();
        svg + &text(0.5 * (area.left + area.right), area.bottom + 33.0, "middle", self.axis)
    }
}

/// Breaks text into lines of at most `most` characters, if words allow it.
fn lines(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                *line += " ";
                *line += word;
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::series::Colour;
    use super::*;

    fn series(name: &str, colour: Colour, points: &[[f64; 2]]) -> Series {
        let points = points.iter().map(|&[x, y]| Point { x, y, name: String::new() }).collect();
        Series { name: name.to_owned(), colour, joined: false, points }
    }

    #[test]
    fn a_chart_joins_fronts_and_names_each_series_once() {
        let ours = || series("ours & co", Colour::Red, &[[1.0, 0.4], [2.0, 0.5], [4.0, 0.1]]);
        let theirs = series("theirs", Colour::Blue, &[[1.0, 0.3]]);
        let panel = |title: &str, series| Panel { title: title.to_owned(), series };
        let chart = Chart {
            axis: "seconds",
            panels: vec![
                panel("a: FLIP", vec![ours(), theirs]),
                panel("b: FLIP", vec![ours()]),
                panel("c", vec![]),
            ],
            caption: vec!["word ".repeat(40)],
        };
        let svg = chart.svg();
        assert_eq!(svg.matches(">ours &amp; co<").count(), 1, "{svg}");
        // Two points of each front are joined; the beaten one and the single one are not.
        assert_eq!((svg.matches("class=\"line").count(), svg.matches("<circle").count()), (2, 2 + 4 + 3));
        assert_eq!(svg.matches("class=\"minor\"").count(), 2);
        assert!(chart.description().contains("ours & co, theirs: a: FLIP; b: FLIP; c"));
        assert_eq!(lines("aa bb cccccc d", 5), ["aa bb", "cccccc", "d"]);
    }
}
