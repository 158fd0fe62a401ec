//! Style sheet of plots, in light and dark.

use super::series::COLOURS;

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
pub fn standalone(width: f64, height: f64, elements: &str) -> String {
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
    use super::*;

    #[test]
    fn files_of_their_own_name_their_format_and_both_themes() {
        let svg = standalone(1.0, 1.0, "<text>a &gt; b</text>");
        assert!(svg.starts_with("<svg class=\"plot\" viewBox=\"0 0 1 1\"") && svg.contains("xmlns="));
        assert!(svg.contains("prefers-color-scheme:dark") && svg.ends_with("<text>a &gt; b</text></svg>\n"));
        // Only the query of the dark theme has the sign.
        assert_eq!(svg.matches('@').count(), 1, "{svg}");
    }
}
