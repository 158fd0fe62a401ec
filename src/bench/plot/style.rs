//! Style sheets of plots and pages, in light and dark.

use super::series::Colour;

/// A rule of plots: its selector, its declarations with `@` for the colour, and the colour in light and in dark.
type Rule = (&'static str, &'static str, &'static str, &'static str);

/// Rules of the parts that are no series.
const RULES: [Rule; 7] = [
    (".plot text", "fill:@", "#222", "#e6e6e6"),
    (".plot .minor", "fill:@", "#666", "#a0a0a0"),
    (".axis", "stroke:@;fill:none", "#777", "#999"),
    (".grid", "stroke:@;fill:none", "#e2e2e2", "#383838"),
    (".bar", "fill:@", "#4a7fb5", "#5b93cc"),
    (".whisker", "stroke:@;fill:none", "#222", "#e6e6e6"),
    (".one", "stroke:@;stroke-dasharray:4 3;fill:none", "#a40", "#f0883e"),
];

/// Rules of pages alone.
const PAGE: [Rule; 5] = [
    ("body", "color:@", "#222", "#e6e6e6"),
    ("body", "background:@", "#fff", "#16181c"),
    ("th,td", "border-bottom:1px solid @", "#ddd", "#3a3a3a"),
    ("tr.minor", "color:@", "#777", "#999"),
    (".warning", "color:@", "#a40", "#f0883e"),
];

/// Layout of pages.
const LAYOUT: &str = "body{font:15px system-ui,sans-serif;max-width:80em;margin:2em auto;padding:0 1em}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1em 0;font-size:13px}\
th,td{padding:.15em .6em;text-align:right}.name{text-align:left}.wide{overflow-x:auto}\
figure{display:inline-block;margin:.4em .6em .4em 0;vertical-align:top;max-width:100%}\
figcaption{font-size:13px;max-width:44em}figcaption.narrow{max-width:22em}img{display:block;max-width:100%}\
.zoom{image-rendering:pixelated;width:200px;height:200px}svg{max-width:100%;height:auto}summary{cursor:pointer}";

/// Font of plots.
const FONT: &str = ".plot text{font:12px system-ui,-apple-system,'Segoe UI',sans-serif}.plot .head{font-weight:600}\
.plot path.line{stroke-width:1.8;fill:none}";

/// Returns the style sheet of pages, which holds the style of plots.
pub fn page_style() -> String {
    format!("{LAYOUT}{FONT}{}", themes(&[&PAGE[..], &RULES].concat()))
}

/// Returns a plot as a file of its own.
pub fn standalone(svg: &str) -> String {
    let style = format!("<style>{FONT}{}</style>", themes(&RULES));
    match svg.split_once('>') {
        Some((head, rest)) => format!("{head} xmlns=\"http://www.w3.org/2000/svg\">\n{style}{rest}"),
        None => String::new(),
    }
}

/// Returns rules and colours of series for light, then for dark surroundings.
fn themes(rules: &[Rule]) -> String {
    let theme = |is_dark: bool| -> String {
        let rules = rules.iter().map(|(selector, declarations, light, dark)| {
            format!("{selector}{{{}}}", declarations.replace('@', if is_dark { dark } else { light }))
        });
        let series = Colour::ALL.map(|colour| {
            let (class, [light, dark]) = (colour.class(), colour.shades());
            let shade = if is_dark { dark } else { light };
            format!(".{class}{{fill:{shade}}}.plot path.{class}{{stroke:{shade}}}")
        });
        rules.chain(series).collect()
    };
    format!("{}@media(prefers-color-scheme:dark){{{}}}", theme(false), theme(true))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_their_own_name_their_format_and_both_themes() {
        let svg = standalone("<svg class=\"plot\" viewBox=\"0 0 1 1\"><text>a &gt; b</text></svg>\n");
        assert!(
            svg.starts_with("<svg class=\"plot\" viewBox=\"0 0 1 1\" xmlns=\"http://www.w3.org/2000/svg\">")
        );
        assert!(svg.contains("prefers-color-scheme:dark") && svg.ends_with("<text>a &gt; b</text></svg>\n"));
        // Only the query of the dark theme has the sign.
        assert_eq!(svg.matches('@').count(), 1, "{svg}");
        assert!(
            page_style().contains("body{background:#fff}")
                && page_style().contains("body{background:#16181c}")
        );
    }
}
