//! Scatter plots over two logarithmic axes, in SVG.

use crate::document::{escaped, svg_text};

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 420.0;
/// Margins for the axes' figures, left and below; and for names, right and above.
const LEFT: f64 = 70.0;
const BELOW: f64 = 48.0;
const RIGHT: f64 = 150.0;
const ABOVE: f64 = 14.0;

/// Points of one colour.
pub struct Series {
    /// Name in the legend; not in the legend if empty.
    pub name: String,
    /// CSS colour.
    pub colour: &'static str,
    /// True if the points are joined in their order.
    pub joined: bool,
    /// Points: x, y and a name, which may be empty.
    pub points: Vec<(f64, f64, String)>,
}

/// Returns a scatter plot; points with a coordinate that is not positive are left out.
pub fn scatter(x_name: &str, y_name: &str, series: &[Series]) -> String {
    let all = || series.iter().flat_map(|s| &s.points).filter(|p| drawable(p));
    let range = |of: fn(&(f64, f64, String)) -> f64| {
        let (low, high) =
            all().map(of).fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), v| (l.min(v), h.max(v)));
        // A margin of a tenth, which also keeps the range from being empty.
        let margin = (high / low).powf(0.1).max(1.1);
        (low / margin, high * margin)
    };
    if all().next().is_none() {
        return "<p>There is nothing to plot.</p>\n".to_owned();
    }
    let ((x0, x1), (y0, y1)) = (range(|p| p.0), range(|p| p.1));
    let x = |v: f64| LEFT + (WIDTH - LEFT - RIGHT) * (v / x0).ln() / (x1 / x0).ln();
    let y = |v: f64| HEIGHT - BELOW - (HEIGHT - BELOW - ABOVE) * (v / y0).ln() / (y1 / y0).ln();
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BELOW);
    let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" role=\"img\">\n");
    for tick in ticks(x0, x1) {
        svg += &format!("<path class=\"grid\" d=\"M{0:.1} {ABOVE}V{bottom}\"/>", x(tick));
        svg += &svg_text(x(tick), bottom + 16.0, "middle", &tick.to_string());
    }
    for tick in ticks(y0, y1) {
        svg += &format!("<path class=\"grid\" d=\"M{LEFT} {0:.1}H{right}\"/>", y(tick));
        svg += &svg_text(LEFT - 6.0, y(tick) + 4.0, "end", &tick.to_string());
    }
    svg += &format!("<path class=\"axis\" d=\"M{LEFT} {ABOVE}V{bottom}H{right}\"/>\n");
    svg += &svg_text(0.5 * (LEFT + right), HEIGHT - 10.0, "middle", x_name);
    let centre = 0.5 * (ABOVE + bottom);
    svg += &format!(
        "<text transform=\"translate(14 {centre}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        escaped(y_name)
    );
    let mut legend = ABOVE + 10.0;
    for series in series {
        let points: Vec<_> = series.points.iter().filter(|p| drawable(p)).collect();
        if series.joined && points.len() > 1 {
            let path: Vec<String> = points.iter().map(|p| format!("{:.1} {:.1}", x(p.0), y(p.1))).collect();
            svg += &format!("<path fill=\"none\" stroke=\"{}\" d=\"M{}\"/>\n", series.colour, path.join("L"));
        }
        let drawn = !points.is_empty();
        for (px, py, name) in points {
            let (px, py) = (x(*px), y(*py));
            svg += &format!(
                "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"4\" fill=\"{}\"><title>{}</title></circle>",
                series.colour,
                escaped(name)
            );
            if !series.joined && !name.is_empty() && series.name.is_empty() {
                svg += &svg_text(px + 7.0, py + 4.0, "start", name);
            }
            svg.push('\n');
        }
        if drawn && !series.name.is_empty() {
            let colour = series.colour;
            svg += &format!("<circle cx=\"{}\" cy=\"{legend}\" r=\"4\" fill=\"{colour}\"/>", right + 12.0);
            svg += &svg_text(right + 20.0, legend + 4.0, "start", &series.name);
            legend += 18.0;
        }
    }
    svg + "</svg>\n"
}

fn drawable(point: &(f64, f64, String)) -> bool {
    [point.0, point.1].iter().all(|v| v.is_finite() && *v > 0.0)
}

/// Returns 1, 2 and 5 times powers of ten within the range.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let decades = (first..=last).flat_map(|decade| [1, 2, 5].map(|m| format!("{m}e{decade}")));
    // Parsed from text, for 5 times a tenth of a tenth is not 0.05.
    let values = decades.filter_map(|text| text.parse().ok());
    values.filter(|v| (low..=high).contains(v)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        assert_eq!(ticks(0.03, 1.2), [0.05, 0.1, 0.2, 0.5, 1.0]);
    }

    #[test]
    fn points_that_cannot_be_drawn_are_left_out() {
        let points =
            vec![(1.0, 2.0, "<a>".to_owned()), (0.0, 1.0, "b".to_owned()), (1.0, f64::NAN, "c".to_owned())];
        let series = Series { name: String::new(), colour: "red", joined: false, points };
        let svg = scatter("x", "y", &[series]);
        assert_eq!(svg.matches("<circle").count(), 1);
        assert!(svg.contains("&lt;a&gt;") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(!scatter("x", "y", &[]).contains("<svg"));
    }
}
