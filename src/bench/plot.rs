//! Plots in SVG: ratios as bars, and points over two logarithmic axes.

use super::Table;
use super::document::escaped;

/// Height of a bar, and distance between bars.
const BAR: f64 = 18.0;
const STEP: f64 = 24.0;
/// Widths of a bar plot's labels, bars and values.
const LABELS: f64 = 330.0;
const BARS: f64 = 420.0;
const VALUES: f64 = 90.0;

/// Returns a bar for each row, from 0 to its ratio, with a whisker over the quartiles and a line at 1.
pub fn bars(table: &Table) -> String {
    let most = table.rows.iter().map(|row| row.ratio.high).fold(1.0, f64::max);
    let x = |ratio: f64| LABELS + BARS * (ratio / most).clamp(0.0, 1.0);
    let (width, height) = (LABELS + BARS + VALUES, STEP * table.rows.len() as f64 + 8.0);
    let mut svg = format!("<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\">\n");
    for (i, row) in table.rows.iter().enumerate() {
        let top = 4.0 + STEP * i as f64;
        let middle = top + 0.5 * BAR;
        let ratio = &row.ratio;
        svg += &text(LABELS - 8.0, middle + 4.0, "end", &row.labels.join(", "));
        svg += &format!(
            "<rect class=\"bar\" x=\"{LABELS}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{BAR}\"/>\n",
            x(ratio.median) - LABELS
        );
        svg += &format!(
            "<path class=\"whisker\" d=\"M{0:.1} {middle:.1}H{1:.1}M{0:.1} {2:.1}v8M{1:.1} {2:.1}v8\"/>\n",
            x(ratio.low),
            x(ratio.high),
            middle - 4.0
        );
        let right = x(ratio.high.max(ratio.median)) + 6.0;
        svg += &text(right, middle + 4.0, "start", &format!("{:.2}", ratio.median));
    }
    svg + &format!("<path class=\"one\" d=\"M{0:.1} 0V{height}\"/>\n</svg>\n", x(1.0))
}

/// Returns text at `x` on the baseline `y`. `anchor` is `start`, `middle` or `end`.
fn text(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", escaped(text))
}

/// Width and height of a scatter plot.
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 420.0;
/// Edges of its area; the margins hold the axes' figures and the legend.
const LEFT: f64 = 70.0;
const RIGHT: f64 = WIDTH - 150.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = HEIGHT - 48.0;

/// Points of one colour.
pub struct Series {
    /// Name in the legend; empty to name each point instead.
    pub name: String,
    /// CSS colour.
    pub colour: &'static str,
    /// True if a line joins the points in their order.
    pub joined: bool,
    /// Points.
    pub points: Vec<Point>,
}

/// A point of a scatter plot.
#[derive(Clone)]
pub struct Point {
    /// Coordinates.
    pub x: f64,
    pub y: f64,
    /// Name, which may be empty.
    pub name: String,
}

impl Point {
    fn is_drawable(&self) -> bool {
        [self.x, self.y].iter().all(|v| v.is_finite() && *v > 0.0)
    }
}

/// A logarithmic axis.
struct Axis {
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

    fn at(&self, value: f64) -> f64 {
        let [from, to] = self.ends;
        from + (to - from) * (value / self.low).ln() / (self.high / self.low).ln()
    }

    /// Returns 1, 2 and 5 times powers of ten within the range.
    fn ticks(&self) -> Vec<f64> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let decades = (first..=last).flat_map(|decade| [1, 2, 5].map(|m| format!("{m}e{decade}")));
        // Values are parsed from text, since products of powers of a tenth are not round.
        let values = decades.filter_map(|text| text.parse().ok());
        values.filter(|v| (self.low..=self.high).contains(v)).collect()
    }
}

/// Returns a scatter plot. Points whose coordinates are not positive are left out.
pub fn scatter(x_name: &str, y_name: &str, series: &[Series]) -> String {
    let all = || series.iter().flat_map(|s| &s.points).filter(|p| p.is_drawable());
    if all().next().is_none() {
        return "<p>There is nothing to plot.</p>\n".to_owned();
    }
    let x = Axis::over(all().map(|p| p.x), [LEFT, RIGHT]);
    let y = Axis::over(all().map(|p| p.y), [BOTTOM, TOP]);
    let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" role=\"img\">\n");
    for tick in x.ticks() {
        svg += &format!("<path class=\"grid\" d=\"M{0:.1} {TOP}V{BOTTOM}\"/>", x.at(tick));
        svg += &text(x.at(tick), BOTTOM + 16.0, "middle", &tick.to_string());
    }
    for tick in y.ticks() {
        svg += &format!("<path class=\"grid\" d=\"M{LEFT} {0:.1}H{RIGHT}\"/>", y.at(tick));
        svg += &text(LEFT - 6.0, y.at(tick) + 4.0, "end", &tick.to_string());
    }
    svg += &format!("<path class=\"axis\" d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\"/>\n");
    svg += &text(0.5 * (LEFT + RIGHT), HEIGHT - 10.0, "middle", x_name);
    svg += &format!(
        "<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        0.5 * (TOP + BOTTOM),
        escaped(y_name)
    );
    let shown = |s: &&Series| s.points.iter().any(Point::is_drawable);
    series.iter().for_each(|series| svg += &marks(series, &x, &y));
    for (i, series) in series.iter().filter(shown).filter(|s| !s.name.is_empty()).enumerate() {
        let (legend, colour) = (TOP + 10.0 + 18.0 * i as f64, series.colour);
        svg += &format!("<circle cx=\"{}\" cy=\"{legend}\" r=\"4\" fill=\"{colour}\"/>", RIGHT + 12.0);
        svg += &text(RIGHT + 20.0, legend + 4.0, "start", &series.name);
    }
    svg + "</svg>\n"
}

/// Returns the points of a series and the line that joins them.
fn marks(series: &Series, x: &Axis, y: &Axis) -> String {
    let Series { colour, joined, .. } = *series;
    let points: Vec<&Point> = series.points.iter().filter(|p| p.is_drawable()).collect();
    let mut svg = String::new();
    if joined && points.len() > 1 {
        let path: Vec<String> = points.iter().map(|p| format!("{:.1} {:.1}", x.at(p.x), y.at(p.y))).collect();
        svg += &format!("<path fill=\"none\" stroke=\"{colour}\" d=\"M{}\"/>\n", path.join("L"));
    }
    for point in points {
        let (px, py, name) = (x.at(point.x), y.at(point.y), &point.name);
        svg += &format!(
            "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"4\" fill=\"{colour}\"><title>{}</title></circle>\n",
            escaped(name)
        );
        if !joined && !name.is_empty() && series.name.is_empty() {
            svg += &text(px + 7.0, py + 4.0, "start", name);
        }
    }
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        let axis = Axis { low: 0.03, high: 1.2, ends: [0.0, 1.0] };
        assert_eq!(axis.ticks(), [0.05, 0.1, 0.2, 0.5, 1.0]);
    }

    #[test]
    fn points_that_cannot_be_drawn_are_left_out() {
        let point = |x, y, name: &str| Point { x, y, name: name.to_owned() };
        let points = vec![point(1.0, 2.0, "<a>"), point(0.0, 1.0, "b"), point(1.0, f64::NAN, "c")];
        let series = Series { name: String::new(), colour: "red", joined: false, points };
        let svg = scatter("x", "y", &[series]);
        assert_eq!(svg.matches("<circle").count(), 1);
        assert!(svg.contains("&lt;a&gt;") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(!scatter("x", "y", &[]).contains("<svg"));
    }
}
