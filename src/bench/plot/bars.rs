//! Ratios as bars.

use super::panel::text;
use crate::report::Table;

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
    let mut svg =
        format!("<svg class=\"plot\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\">\n");
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
