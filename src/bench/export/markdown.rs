//! Markdown tables.

use super::headline;
use crate::bench::Report;

/// Returns a section a table.
pub fn markdown(report: &Report) -> String {
    let mut text = format!("# {}\n\n", headline(report));
    let facts: Vec<String> = report.facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
    text += &format!("{}\n", facts.join(", "));
    for table in &report.tables {
        text += &format!("\n## {}\n\n{}\n\n", table.title, table.about);
        let heads = table.heads();
        text += &line(&heads);
        let rules: Vec<String> =
            (0..heads.len()).map(|i| if i < table.labels.len() { "---" } else { "--:" }.to_owned()).collect();
        text += &line(&rules);
        for row in &table.rows {
            text += &line(&table.cells(row));
        }
        for warning in &table.warnings {
            text += &format!("\n*{warning}*\n");
        }
    }
    text
}

fn line(cells: &[String]) -> String {
    let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}
