//! Documents in Markdown, whose plots are files beside them. All reports and studies are written by these.

use crate::plot::Chart;

/// A document under construction.
pub struct Document {
    markdown: String,
    files: Vec<(String, String)>,
}

/// A table of cells.
#[derive(Default)]
pub struct Grid {
    /// Number of leading columns that hold text, which is set to the left.
    pub names: usize,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Cells of each row.
    pub rows: Vec<Vec<String>>,
}

impl Document {
    /// Creates an empty document.
    pub fn new(title: &str) -> Document {
        Document { markdown: format!("# {title}\n"), files: Vec::new() }
    }

    /// Adds a heading of `level` 2 or more.
    pub fn heading(&mut self, level: usize, text: &str) {
        self.text(&format!("{} {text}", "#".repeat(level)));
    }

    /// Adds a paragraph.
    pub fn text(&mut self, text: &str) {
        self.markdown += &format!("\n{text}\n");
    }

    /// Adds a table.
    pub fn grid(&mut self, grid: &Grid) {
        self.text(grid.markdown().trim_end());
    }

    /// Adds a plot. `name` is the name of its file without an extension.
    pub fn plot(&mut self, name: &str, chart: &Chart) {
        let Some(svg) = chart.svg() else { return self.text("There is nothing to plot.") };
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' };
        let file = format!("{}.svg", name.chars().map(plain).collect::<String>());
        self.text(&format!("![{}]({file})", chart.description()));
        self.file(&file, svg);
    }

    /// Adds content that is folded away under a summary.
    pub fn fold(&mut self, summary: &str, content: impl FnOnce(&mut Document)) {
        self.text(&format!("<details><summary>{summary}</summary>"));
        content(self);
        self.text("</details>");
    }

    /// Adds a file beside the document.
    pub fn file(&mut self, name: &str, text: String) {
        self.files.push((name.to_owned(), text));
    }

    /// Returns the files beside the document, each with its name.
    pub fn files(&self) -> &[(String, String)] {
        &self.files
    }

    /// Returns the document as Markdown.
    pub fn markdown(&self) -> &str {
        &self.markdown
    }
}

impl Grid {
    /// Creates a table whose first `names` columns hold text.
    pub fn new(names: usize, heads: &[&str], rows: Vec<Vec<String>>) -> Grid {
        Grid { names, heads: heads.iter().map(|head| (*head).to_owned()).collect(), rows }
    }

    /// Returns the table with columns of equal width, which can be read on a terminal, too.
    fn markdown(&self) -> String {
        let escaped = |cells: &Vec<String>| cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        let rows: Vec<Vec<String>> = [&self.heads].into_iter().chain(&self.rows).map(escaped).collect();
        let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).fold(3, usize::max);
        let widths: Vec<usize> = (0..self.heads.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cell = |(column, (cell, &width)): (usize, (&String, &usize))| match column < self.names {
                true => format!(" {cell:<width$} |"),
                false => format!(" {cell:>width$} |"),
            };
            let cells = row.iter().zip(&widths).enumerate().map(cell);
            format!("|{}\n", cells.collect::<String>())
        };
        let rule = |(column, width): (usize, &usize)| {
            format!(" {}{} |", "-".repeat(width - 1), if column < self.names { '-' } else { ':' })
        };
        let rules: String = widths.iter().enumerate().map(rule).collect();
        format!("{}|{rules}\n{}", line(&rows[0]), rows[1..].iter().map(line).collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Colour, Line, Panel, Point, Series};

    #[test]
    fn markdown_links_its_plots_and_aligns_its_tables() {
        let mut document = Document::new("A & B");
        let points = vec![Point { x: 1.0, y: 2.0, name: String::new() }];
        let series = Series { name: "s".to_owned(), colour: Colour::Red, line: Line::None, points };
        let panel = Panel { title: "a: FLIP".to_owned(), series: vec![series] };
        document.plot("race, my scene", &Chart { panels: vec![panel], caption: Vec::new() });
        document.plot("empty", &Chart { panels: Vec::new(), caption: Vec::new() });
        document.fold("All columns", |document| {
            let rows = vec![vec!["a|b".to_owned(), "1.00".to_owned()]];
            document.grid(&Grid::new(1, &["name", "x"], rows));
        });
        assert_eq!(document.files().len(), 1);
        assert_eq!(document.files()[0].0, "race--my-scene.svg");
        let markdown = document.markdown();
        assert!(
            markdown.contains("](race--my-scene.svg)") && markdown.contains("nothing to plot"),
            "{markdown}"
        );
        let folded = "\n<details><summary>All columns</summary>\n\n| name |    x |\n| ---- | ---: |\n| a\\|b | 1.00 |\n\n\
                      </details>\n";
        assert!(markdown.contains(folded), "{markdown}");
    }
}
