//! Points over two logarithmic axes.

use super::series::{Line, Series};

/// Area of a panel between its axes.
#[derive(Clone, Copy)]
pub struct Area {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

/// Returns text at `x` on the baseline `y`. `anchor` is `start`, `middle` or `end`.
pub fn text(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", escaped(text))
}

/// Escapes text for SVG.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns the mark and the name of a series for a legend.
pub fn key(x: f64, y: f64, series: &Series) -> String {
    let class = series.colour.class();
    format!("<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>")
        + &text(x + 8.0, y + 4.0, "start", &series.name)
}

/// Returns axes and points without names of the axes; `None` if there is no point.
pub fn panel(area: Area, series: &[Series]) -> Option<String> {
    let all = || series.iter().flat_map(Series::drawable);
    all().next()?;
    let Area { left, right, top, bottom } = area;
    let x = Axis::over(all().map(|p| p.x), [left, right]);
    let y = Axis::over(all().map(|p| p.y), [bottom, top]);
    let mut svg = String::new();
    for tick in x.ticks() {
        svg += &format!("<path class=\"grid\" d=\"M{0:.1} {top}V{bottom}\"/>", x.at(tick));
        svg += &text(x.at(tick), bottom + 16.0, "middle", &tick.to_string());
    }
    for tick in y.ticks() {
        svg += &format!("<path class=\"grid\" d=\"M{left} {0:.1}H{right}\"/>", y.at(tick));
        svg += &text(left - 6.0, y.at(tick) + 4.0, "end", &tick.to_string());
    }
    svg += &format!("<path class=\"axis\" d=\"M{left} {top}V{bottom}H{right}\"/>\n");
    series.iter().for_each(|series| svg += &marks(series, &x, &y));
    Some(svg)
}

/// Returns the points of a series and the line that joins them.
fn marks(series: &Series, x: &Axis, y: &Axis) -> String {
    let class = series.colour.class();
    let mut svg = String::new();
    let joined = series.joined();
    if joined.len() > 1 {
        let path: Vec<String> = joined.iter().map(|p| format!("{:.1} {:.1}", x.at(p.0), y.at(p.1))).collect();
        svg += &format!("<path class=\"line {class}\" d=\"M{}\"/>\n", path.join("L"));
    }
    for point in series.drawable() {
        let (px, py, name) = (x.at(point.x), y.at(point.y), &point.name);
        svg += &format!(
            "<circle class=\"{class}\" cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"4\"><title>{}</title></circle>\n",
            escaped(name)
        );
        if series.line == Line::None && !name.is_empty() && series.name.is_empty() {
            svg += &text(px + 7.0, py + 4.0, "start", name);
        }
    }
    svg
}

/// Most ticks of an axis that are labelled.
const TICKS: usize = 8;

/// Multiples of powers of ten that are labelled, the densest first.
const FACTORS: [&[u32]; 3] = [&[1, 2, 3, 4, 5, 6, 7, 8, 9], &[1, 2, 5], &[1]];

/// A logarithmic axis.
struct Axis {
    /// Range of values.
    low: f64,
    high: f64,
    /// Positions of `low` and `high`.
    ends: [f64; 2],
}

impl Axis {
    /// Creates an axis over positive values, with a margin of a tenth that also keeps the range from being empty.
    fn over(values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Axis {
        let (low, high) = values.fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), v| (l.min(v), h.max(v)));
        let margin = (high / low).powf(0.1).max(1.1);
        Axis { low: low / margin, high: high * margin, ends }
    }

    /// Returns the position of a value.
    fn at(&self, value: f64) -> f64 {
        let [from, to] = self.ends;
        from + (to - from) * (value / self.low).ln() / (self.high / self.low).ln()
    }

    /// Returns the densest round values within the range that are not too many, or else the powers of ten.
    fn ticks(&self) -> Vec<f64> {
        let densest = FACTORS.iter().map(|factors| self.multiples(factors)).find(|all| all.len() <= TICKS);
        densest.unwrap_or_else(|| self.multiples(&[1]))
    }

    /// Returns some multiples of powers of ten within the range.
    fn multiples(&self, factors: &[u32]) -> Vec<f64> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let decades = (first..=last).flat_map(|decade| factors.iter().map(move |m| format!("{m}e{decade}")));
        // Values are parsed from text, since products of powers of a tenth are not round.
        let values = decades.filter_map(|text| text.parse().ok());
        values.filter(|v| (self.low..=self.high).contains(v)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::series::{Colour, Point};
    use super::*;

    #[test]
    fn points_that_cannot_be_drawn_are_left_out() {
        let point = |x, y, name: &str| Point { x, y, name: name.to_owned() };
        let points = vec![point(1.0, 2.0, "<a>"), point(0.0, 1.0, "b"), point(1.0, f64::NAN, "c")];
        let series = Series { name: String::new(), colour: Colour::Red, line: Line::None, points };
        let area = Area { left: 0.0, right: 100.0, top: 0.0, bottom: 100.0 };
        let svg = panel(area, &[series]).unwrap();
        assert_eq!(svg.matches("<circle").count(), 1);
        assert!(svg.contains("&lt;a&gt;") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(panel(area, &[]).is_none());
    }

    #[test]
    fn ticks_are_round_and_within_the_range() {
        let axis = Axis { low: 0.03, high: 1.2, ends: [0.0, 1.0] };
        assert_eq!(axis.ticks(), [0.05, 0.1, 0.2, 0.5, 1.0]);
        assert_eq!(Axis { high: 1200.0, ..axis }.ticks(), [0.1, 1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(Axis { low: 0.025, high: 0.061, ..axis }.ticks(), [0.03, 0.04, 0.05, 0.06]);
    }
}
