//! Documents for people: headings, text, tables and plots, as Markdown and as one self-contained page.

/// Style sheet of pages.
const STYLE: &str = "body{font:15px system-ui,sans-serif;max-width:80em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1em 0;font-size:13px}\
th,td{padding:.15em .6em;text-align:right;border-bottom:1px solid #ddd}.name{text-align:left}\
.wide{overflow-x:auto}figure{display:inline-block;margin:.4em .6em .4em 0;vertical-align:top}\
figcaption{font-size:13px;max-width:22em}img{display:block}.zoom{image-rendering:pixelated;width:200px;height:200px}\
svg{max-width:100%;height:auto}svg text{font:12px system-ui,sans-serif;fill:#222}.minor{color:#888}\
.axis{stroke:#888;fill:none}.grid{stroke:#e5e5e5;fill:none}.bar{fill:#4a7fb5}.whisker{stroke:#222;fill:none}\
.one{stroke:#a40;stroke-dasharray:4 3;fill:none}.warning{color:#a40}";

/// A document under construction, in both formats at once.
pub struct Document {
    title: String,
    markdown: String,
    html: String,
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
    /// Indices of the rows that are shown in grey.
    pub minor: Vec<usize>,
}

impl Document {
    /// Creates an empty document.
    pub fn new(title: impl Into<String>) -> Document {
        let title = title.into();
        Document { markdown: format!("# {title}\n"), html: String::new(), title }
    }

    /// Adds a heading of `level` 2 or more.
    pub fn heading(&mut self, level: usize, text: &str) {
        self.markdown += &format!("\n{} {text}\n", "#".repeat(level));
        self.html += &format!("<h{level}>{}</h{level}>\n", escaped(text));
    }

    /// Adds a paragraph.
    pub fn text(&mut self, text: &str) {
        self.markdown += &format!("\n{text}\n");
        self.html += &format!("<p>{}</p>\n", escaped(text));
    }

    /// Adds a paragraph of named facts.
    pub fn facts(&mut self, facts: &[(String, String)]) {
        let facts: Vec<String> = facts.iter().map(|(name, value)| format!("{name} {value}")).collect();
        self.text(&facts.join(", "));
    }

    /// Adds a warning.
    pub fn warning(&mut self, text: &str) {
        self.markdown += &format!("\n*{text}*\n");
        self.html += &format!("<p class=\"warning\">{}</p>\n", escaped(text));
    }

    /// Adds a table.
    pub fn grid(&mut self, grid: &Grid) {
        self.markdown += &format!("\n{}", grid.markdown());
        self.html += &grid.html();
    }

    /// Adds HTML to the page alone.
    pub fn figure(&mut self, html: &str) {
        self.html += html;
    }

    /// Returns the document as Markdown.
    pub fn markdown(&self) -> &str {
        &self.markdown
    }

    /// Returns the document as a page.
    pub fn html(&self) -> String {
        let (title, body) = (escaped(&self.title), &self.html);
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{title}</title>\n\
             <style>{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
        )
    }
}

impl Grid {
    /// Creates a table whose first `names` columns hold text.
    pub fn new(names: usize, heads: &[&str], rows: Vec<Vec<String>>) -> Grid {
        let heads = heads.iter().map(|head| (*head).to_owned()).collect();
        Grid { names, heads, rows, minor: Vec::new() }
    }

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
        let line = |cells: &[String], tag: &str| -> String {
            let cell = |(column, cell): (usize, &String)| {
                let class = if column < self.names { " class=\"name\"" } else { "" };
                format!("<{tag}{class}>{}</{tag}>", escaped(cell))
            };
            cells.iter().enumerate().map(cell).collect()
        };
        let row = |(i, cells): (usize, &Vec<String>)| {
            let class = if self.minor.contains(&i) { " class=\"minor\"" } else { "" };
            format!("<tr{class}>{}</tr>\n", line(cells, "td"))
        };
        let rows: String = self.rows.iter().enumerate().map(row).collect();
        let heads = line(&self.heads, "th");
        format!("<div class=\"wide\"><table>\n<tr>{heads}</tr>\n{rows}</table></div>\n")
    }
}

/// Escapes text for HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
