//! Export formats of reports, one per file; JSON is serde's.

mod csv;
mod terminal;

use super::Report;
use super::document::{Document, Grid};
use super::plot::bars;

pub use terminal::terminal;

/// Writers of all file formats, in the order of their options on the command line.
pub const WRITERS: [fn(&Report) -> String; 4] = [json, csv::csv, markdown, html];

/// Returns the headline of a report.
fn headline(report: &Report) -> String {
    match &report.scene {
        Some(scene) => format!("{} on {scene}", report.benchmark),
        None => report.benchmark.clone(),
    }
}

/// Returns the report with every sample as one object.
fn json(report: &Report) -> String {
    format!("{:#}\n", serde_json::json!(report))
}

/// Returns Markdown tables.
fn markdown(report: &Report) -> String {
    document(report).markdown().to_owned()
}

/// Returns one self-contained page: tables, and their ratios as bars.
fn html(report: &Report) -> String {
    document(report).html()
}

/// Returns a document with a section per table.
fn document(report: &Report) -> Document {
    let mut document = Document::new(headline(report));
    for table in &report.tables {
        document.heading(2, &table.title);
        document.text(&table.about);
        document.figure(&bars(table));
        let names = table.labels.len();
        document.grid(&Grid { names, heads: table.heads(), rows: table.cells(), ..Grid::default() });
        table.warnings.iter().for_each(|warning| document.warning(warning));
    }
    document.heading(2, "Machine and settings");
    document.facts(&report.facts);
    document
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Row, Spread, Table};

    fn report() -> Report {
        let row = |label: &str, ratio: f64| Row {
            labels: vec![label.to_owned(), "a|b".to_owned()],
            ratio: Spread { median: ratio, low: 0.9 * ratio, high: 1.1 * ratio },
            rate: Spread { median: 2.0 * ratio, low: 1.9 * ratio, high: 2.1 * ratio },
            samples: vec![1.0, 2.5],
            figures: vec![Some(0.5), None],
        };
        Report {
            benchmark: "rays".to_owned(),
            scene: Some("<nave & aisle>".to_owned()),
            facts: vec![("threads".to_owned(), "2".to_owned())],
            tables: vec![Table {
                title: "Widths".to_owned(),
                about: "Ratio to \"one\".".to_owned(),
                labels: vec!["width".to_owned(), "order".to_owned()],
                unit: "Mrays/s".to_owned(),
                figures: vec!["saved".to_owned(), "lost".to_owned()],
                rows: vec![row("one", 1.0), row("six, teen", 2.0)],
                warnings: vec!["one: 1 outliers".to_owned()],
            }],
        }
    }

    #[test]
    fn csv_quotes_what_needs_it_and_has_a_line_a_case() {
        let text = csv::csv(&report());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("benchmark,scene,table,case,ratio,"), "{text}");
        assert!(lines[2].starts_with("rays,<nave & aisle>,Widths,\"six, teen; a|b\",2,1.8,2.2,4,"), "{text}");
        assert!(lines[2].ends_with(",saved=0.5"), "{text}");
    }

    #[test]
    fn json_is_the_whole_report() {
        let value: serde_json::Value = serde_json::from_str(&json(&report())).unwrap();
        assert_eq!(value["tables"][0]["rows"][1]["ratio"]["median"], 2.0);
        assert_eq!(value["tables"][0]["rows"][0]["samples"][1], 2.5);
    }

    #[test]
    fn markdown_escapes_bars_and_terminal_aligns() {
        let text = markdown(&report());
        assert!(text.contains("| one | a\\|b | 1.00 | 0.90 .. 1.10 | 2.00 |"), "{text}");
        let text = terminal(&report());
        let column = |start: &str| text.lines().find(|l| l.contains(start)).and_then(|l| l.find("a|b"));
        assert_eq!(column("one "), column("six, teen "), "{text}");
        assert!(column("one ").is_some() && text.contains("warning: one: 1 outliers"));
    }

    #[test]
    fn html_is_self_contained_and_escaped() {
        let text = html(&report());
        assert!(text.contains("&lt;nave &amp; aisle&gt;") && !text.contains("<nave"));
        assert!(text.contains("<svg") && text.contains("</html>") && !text.contains("http"), "{text}");
        let doubled = text.matches("class=\"bar\"").count();
        assert_eq!(doubled, 2);
    }
}
