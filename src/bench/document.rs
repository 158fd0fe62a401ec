//! Documents for people: parts in reading order, as Markdown and as one self-contained page.

/// Style sheet of pages.
const STYLE: &str = "body{font:15px system-ui,sans-serif;max-width:80em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1em 0;font-size:13px}\
th,td{padding:.15em .6em;text-align:right;border-bottom:1px solid #ddd}.name{text-align:left}\
.wide{overflow-x:auto}figure{display:inline-block;margin:.4em .6em .4em 0;vertical-align:top}\
figcaption{font-size:13px;max-width:22em}img{display:block}.zoom{image-rendering:pixelated;width:200px;height:200px}\
svg{max-width:100%;height:auto}svg text{font:12px system-ui,sans-serif;fill:#222}.minor{color:#888}\
.axis{stroke:#888;fill:none}.grid{stroke:#e5e5e5;fill:none}.bar{fill:#4a7fb5}.whisker{stroke:#222;fill:none}\
.one{stroke:#a40;stroke-dasharray:4 3;fill:none}.warning{color:#a40}";

/// A document.
pub struct Document {
    title: String,
    parts: Vec<Part>,
}

enum Part {
    /// Its level, from 2, and text.
    Heading(usize, String),
    Text(String),
    Warning(String),
    Grid(Grid),
    /// HTML, which Markdown leaves out.
    Figure(String),
}

/// Cells in rows and columns.
#[derive(Default)]
pub struct Grid {
    /// Number of columns of names or prose, which come first and are set to the left.
    pub names: usize,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Cells by row.
    pub rows: Vec<Vec<String>>,
    /// Indices of the rows that are shown in grey.
    pub minor: Vec<usize>,
}

impl Document {
    /// An empty document.
    pub fn new(title: impl Into<String>) -> Document {
        Document { title: title.into(), parts: Vec::new() }
    }

    /// Adds a heading of `level` 2 or more.
    pub fn heading(&mut self, level: usize, text: impl Into<String>) {
        self.parts.push(Part::Heading(level, text.into()));
    }

    /// Adds a paragraph.
    pub fn text(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Text(text.into()));
    }

    /// Adds a paragraph of named facts.
    pub fn facts(&mut self, facts: &[(String, String)]) {
        let facts: Vec<String> = facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
        self.text(facts.join(", "));
    }

    /// Adds a warning.
    pub fn warning(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Warning(text.into()));
    }

    /// Adds a grid of cells.
    pub fn grid(&mut self, grid: Grid) {
        self.parts.push(Part::Grid(grid));
    }

    /// Adds a figure in HTML, which Markdown leaves out.
    pub fn figure(&mut self, html: String) {
        self.parts.push(Part::Figure(html));
    }

    /// The document as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!("# {}\n", self.title);
        for part in &self.parts {
            text += &match part {
                Part::Heading(level, heading) => format!("\n{} {heading}\n", "#".repeat(*level)),
                Part::Text(paragraph) => format!("\n{paragraph}\n"),
                Part::Warning(warning) => format!("\n*{warning}*\n"),
                Part::Grid(grid) => format!("\n{}", grid.markdown()),
                Part::Figure(_) => continue,
            };
        }
        text
    }

    /// The document as a page.
    pub fn html(&self) -> String {
        let title = escaped(&self.title);
        let body: String = self.parts.iter().map(Part::html).collect();
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{title}</title>\n\
             <style>{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
        )
    }
}

impl Part {
    fn html(&self) -> String {
        match self {
            Part::Heading(level, text) => format!("<h{level}>{}</h{level}>\n", escaped(text)),
            Part::Text(text) => format!("<p>{}</p>\n", escaped(text)),
            Part::Warning(text) => format!("<p class=\"warning\">{}</p>\n", escaped(text)),
            Part::Grid(grid) => grid.html(),
            Part::Figure(html) => html.clone(),
        }
    }
}

impl Grid {
    fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        let rule = |column: usize| if column < self.names { "---" } else { "--:" }.to_owned();
        let rules: Vec<String> = (0..self.heads.len()).map(rule).collect();
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        line(&self.heads) + &line(&rules) + &rows
    }

    fn html(&self) -> String {
        let cells = |cells: &[String], tag: &str| -> String {
            let cell = |(column, cell): (usize, &String)| {
                let class = if column < self.names { " class=\"name\"" } else { "" };
                format!("<{tag}{class}>{}</{tag}>", escaped(cell))
            };
            cells.iter().enumerate().map(cell).collect()
        };
        let mut text = format!("<div class=\"wide\"><table>\n<tr>{}</tr>\n", cells(&self.heads, "th"));
        for (i, row) in self.rows.iter().enumerate() {
            let class = if self.minor.contains(&i) { " class=\"minor\"" } else { "" };
            text += &format!("<tr{class}>{}</tr>\n", cells(row, "td"));
        }
        text + "</table></div>\n"
    }
}

/// Escapes text for HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Text in an SVG picture at `x` and on the baseline `y`; `anchor` is `start`, `middle` or `end`.
pub fn svg_text(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", escaped(text))
}
