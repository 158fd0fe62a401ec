//! One self-contained page: tables, and their ratios as bars.

use super::{headline, plot};
use crate::bench::{Report, Table};

const STYLE: &str = "body{font:15px system-ui,sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1em 0}\
th,td{padding:.15em .7em;text-align:right;border-bottom:1px solid #ddd}\
.name{text-align:left}.warning{color:#a40}svg{max-width:100%;height:auto}\
text{font:13px system-ui,sans-serif;fill:#222}.label{text-anchor:end}.bar{fill:#4a7fb5}\
.whisker{stroke:#222;fill:none}.one{stroke:#a40;stroke-dasharray:4 3;fill:none}";

/// Returns the page.
pub fn html(report: &Report) -> String {
    let title = escaped(&headline(report));
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n<p>"
    );
    let facts: Vec<String> =
        report.facts.iter().map(|(name, value)| escaped(&format!("{name} {value}"))).collect();
    text += &format!("{}</p>\n", facts.join(", "));
    for table in &report.tables {
        text += &section(table);
    }
    text + "</body>\n</html>\n"
}

fn section(table: &Table) -> String {
    let mut text = format!("<h2>{}</h2>\n<p>{}</p>\n", escaped(&table.title), escaped(&table.about));
    text += &plot::bars(table);
    let line = |cells: Vec<String>, tag: &str| {
        let cell = |(i, cell): (usize, String)| {
            let class = if i < table.labels.len() { " class=\"name\"" } else { "" };
            format!("<{tag}{class}>{}</{tag}>", escaped(&cell))
        };
        format!("<tr>{}</tr>\n", cells.into_iter().enumerate().map(cell).collect::<String>())
    };
    text += &format!("<table>\n{}", line(table.heads(), "th"));
    for row in &table.rows {
        text += &line(table.cells(row), "td");
    }
    text += "</table>\n";
    for warning in &table.warnings {
        text += &format!("<p class=\"warning\">{}</p>\n", escaped(warning));
    }
    text
}

/// Escapes text for HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
