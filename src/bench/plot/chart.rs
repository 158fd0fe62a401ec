//! A chart of several panels with one legend and a caption.

use super::panel::{Area, escaped, key, panel, text};
use super::series::{COLOURS, Series};

/// Name of the horizontal axes.
const AXIS: &str = "processor seconds";
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

/// A chart: panels in two columns over processor seconds.
pub struct Chart {
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Paragraphs of the caption.
    pub caption: Vec<String>,
}

impl Chart {
    /// Returns the chart as the text of a file; `None` if no panel has a point. Panels without a point are empty.
    pub fn svg(&self) -> Option<String> {
        let legend = self.legend();
        self.panels.iter().flat_map(|panel| &panel.series).flat_map(Series::drawable).next()?;
        let width = WIDTH * self.panels.len().min(2) as f64 / 2.0;
        let characters = (CHARACTERS as f64 * width / WIDTH) as usize;
        let per_line = (width / KEY).max(1.0) as usize;
        let caption: Vec<String> = self.caption.iter().flat_map(|text| lines(text, characters)).collect();
        let top = 14.0 + LINE * legend.len().div_ceil(per_line) as f64;
        let rows = self.panels.len().div_ceil(2) as f64;
        let height = top + ROW * rows + LINE * caption.len() as f64 + 12.0;
        let mut svg = format!("<title>{}</title>\n", escaped(&self.description()));
        for (i, series) in legend.iter().enumerate() {
            let [column, line] = [i % per_line, i / per_line].map(|n| n as f64);
            svg += &key(60.0 + KEY * column, 14.0 + LINE * line, series);
        }
        for (i, panel) in self.panels.iter().enumerate() {
            svg += &self.draw(panel, [(i % 2) as f64 * 0.5 * WIDTH, top + ROW * (i / 2) as f64]);
        }
        for (i, line) in caption.iter().enumerate() {
            let y = top + ROW * rows + LINE * (i as f64 + 0.5);
            svg += &text(14.0, y, "start", line).replacen("<text", "<text class=\"minor\"", 1);
        }
        Some(standalone(width, height, &svg))
    }

    /// Describes the chart for readers who do not see it.
    pub fn description(&self) -> String {
        let titles: Vec<&str> = self.panels.iter().map(|panel| &*panel.title).collect();
        let names: Vec<String> = self.legend().into_iter().map(|series| series.name).collect();
        format!("{} over {AXIS}: {}", titles.join("; "), names.join(", "))
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
        let mut svg =
            text(area.left, y + 14.0, "start", &panel_of.title).replacen("<text", "<text class=\"head\"", 1);
        svg += &panel(area, &panel_of.series).unwrap_or_default();
        svg + &text(0.5 * (area.left + area.right), area.bottom + 33.0, "middle", AXIS)
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

/// A rule: its selector, its declarations with `@` for the colour, and the colour in light and in dark.
type Rule = (&'static str, &'static str, [&'static str; 2]);

/// Rules of the parts that are no series.
const RULES: [Rule; 4] = [
    (".plot text", "fill:@", ["#222", "#e6e6e6"]),
    (".plot .minor", "fill:@", ["#666", "#a0a0a0"]),
    (".axis", "stroke:@;fill:none", ["#777", "#999"]),
    (".grid", "stroke:@;fill:none", ["#e2e2e2", "#383838"]),
];

/// Font and lines.
const FONT: &str = ".plot text{font:12px system-ui,-apple-system,'Segoe UI',sans-serif}.plot .head{font-weight:600}\
.plot path.line{stroke-width:1.8;fill:none}";

/// Returns the text of a file with elements of a plot.
fn standalone(width: f64, height: f64, elements: &str) -> String {
    let [light, dark] = [theme(0), theme(1)];
    format!(
        "<svg class=\"plot\" viewBox=\"0 0 {width} {height:.0}\" width=\"{width}\" role=\"img\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n<style>{FONT}{light}@media(prefers-color-scheme:dark){{{dark}}}</style>\n\
         {elements}</svg>\n"
    )
}

/// Returns rules and colours of series for light (0) or dark (1) surroundings.
fn theme(ground: usize) -> String {
    let rules = RULES
        .iter()
        .map(|(selector, rule, shades)| format!("{selector}{{{}}}", rule.replace('@', shades[ground])));
    let series = COLOURS.iter().map(|(_, class, shades)| {
        let shade = shades[ground];
        format!(".{class}{{fill:{shade}}}.plot path.{class}{{stroke:{shade}}}")
    });
    rules.chain(series).collect()
}

#[cfg(test)]
mod tests {
    use super::super::series::{Colour, Line, Point};
    use super::*;

    fn series(name: &str, colour: Colour, points: &[[f64; 2]]) -> Series {
        let points = points.iter().map(|&[x, y]| Point { x, y, name: String::new() }).collect();
        Series { name: name.to_owned(), colour, line: Line::Front, points }
    }

    #[test]
    fn a_chart_joins_fronts_and_names_each_series_once() {
        let ours = || series("ours & co", Colour::Red, &[[1.0, 0.4], [2.0, 0.5], [4.0, 0.1]]);
        let theirs = series("theirs", Colour::Blue, &[[1.0, 0.3]]);
        let panel = |title: &str, series| Panel { title: title.to_owned(), series };
        let chart = Chart {
            panels: vec![
                panel("a: FLIP", vec![ours(), theirs]),
                panel("b: FLIP", vec![ours()]),
                panel("c", vec![]),
            ],
            caption: vec!["word ".repeat(40)],
        };
        let svg = chart.svg().unwrap();
        assert_eq!(svg.matches(">ours &amp; co<").count(), 1, "{svg}");
        // Two points of each front are joined; the beaten one and the single one are not.
        assert_eq!((svg.matches("class=\"line").count(), svg.matches("<circle").count()), (2, 2 + 4 + 3));
        assert_eq!(svg.matches("class=\"minor\"").count(), 2);
        assert!(chart.description().contains("b: FLIP; c over processor seconds: ours & co, theirs"));
        assert_eq!(lines("aa bb cccccc d", 5), ["aa bb", "cccccc", "d"]);
    }

    #[test]
    fn files_of_their_own_name_their_format_and_both_themes() {
        let svg = standalone(1.0, 1.0, "<text>a &gt; b</text>");
        assert!(svg.starts_with("<svg class=\"plot\" viewBox=\"0 0 1 1\"") && svg.contains("xmlns="));
        assert!(svg.contains("prefers-color-scheme:dark") && svg.ends_with("<text>a &gt; b</text></svg>\n"));
        // Only the query of the dark theme has the sign.
        assert_eq!(svg.matches('@').count(), 1, "{svg}");
    }
}
