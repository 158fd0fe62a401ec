//! Aligned columns for a terminal.

use super::headline;
use crate::Report;

/// Returns the whole report.
pub fn terminal(report: &Report) -> String {
    let mut text = format!("{}\n", headline(report));
    for (name, value) in &report.facts {
        text += &format!("  {name}: {value}\n");
    }
    for table in &report.tables {
        text += &format!("\n{}\n{}\n", table.title, table.about);
        let mut lines = vec![table.heads()];
        lines.extend(table.cells());
        let width =
            |column: usize| lines.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
        for cells in &lines {
            let mut line = String::new();
            for (i, (cell, &width)) in cells.iter().zip(&widths).enumerate() {
                line += &if i < table.labels.len() {
                    format!("{cell:<width$}  ")
                } else {
                    format!("{cell:>width$}  ")
                };
            }
            text += &format!("  {}\n", line.trim_end());
        }
        for warning in &table.warnings {
            text += &format!("  warning: {warning}\n");
        }
    }
    text
}
