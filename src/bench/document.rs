//! Documents for people: headings, text, tables, plots and images, as Markdown and as one self-contained page.
//!
//! Markdown holds no images. Its plots and images are files of their own, which lie beside it.

use crate::escape::escaped;
use crate::plot::{page_style, standalone};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// A document under construction, in both formats at once.
pub struct Document {
    title: String,
    markdown: String,
    html: String,
    files: Vec<(String, Vec<u8>)>,
}

/// An image of a strip, as JPEG.
pub struct Thumbnail {
    /// Caption.
    pub caption: String,
    /// Name of its file without an extension.
    pub name: String,
    /// Contents of its file.
    pub jpeg: Vec<u8>,
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
        Document { markdown: format!("# {title}\n"), html: String::new(), files: Vec::new(), title }
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

    /// Adds a plot. `name` is the name of its file without an extension, `about` its caption.
    pub fn plot(&mut self, name: &str, about: &str, svg: &str) {
        if !svg.starts_with("<svg") {
            return self.text("There is nothing to plot.");
        }
        let file = format!("{}.svg", plain(name));
        self.markdown += &format!("\n![{about}]({file})\n");
        self.html += &format!("<figure>{svg}<figcaption>{}</figcaption></figure>\n", escaped(about));
        self.files.push((file, standalone(svg).into_bytes()));
    }

    /// Adds images side by side.
    pub fn strip(&mut self, images: Vec<Thumbnail>) {
        if images.is_empty() {
            return;
        }
        let (mut heads, mut links) = (Vec::new(), Vec::new());
        self.html += "<div>";
        for Thumbnail { caption, name, jpeg } in images {
            let file = format!("{}.jpg", plain(&name));
            links.push(format!("![{caption}]({file})"));
            let (source, text) = (STANDARD.encode(&jpeg), escaped(&caption));
            self.html += &format!(
                "<figure><img src=\"data:image/jpeg;base64,{source}\" alt=\"{text}\">\
                 <figcaption class=\"narrow\">{text}</figcaption></figure>\n"
            );
            heads.push(caption);
            self.files.push((file, jpeg));
        }
        self.html += "</div>\n";
        let names = heads.len();
        self.markdown +=
            &format!("\n{}", Grid { names, heads, rows: vec![links], minor: Vec::new() }.markdown());
    }

    /// Adds content that is folded away under a summary.
    pub fn fold(&mut self, summary: &str, content: impl FnOnce(&mut Document)) {
        let head = format!("<details><summary>{}</summary>\n", escaped(summary));
        self.markdown += &format!("\n{head}");
        self.html += &head;
        content(self);
        self.markdown += "\n</details>\n";
        self.html += "</details>\n";
    }

    /// Returns the files of the plots and images of the Markdown, each with its name.
    pub fn files(&self) -> &[(String, Vec<u8>)] {
        &self.files
    }

    /// Returns the document as Markdown.
    pub fn markdown(&self) -> &str {
        &self.markdown
    }

    /// Returns the document as a page.
    pub fn html(&self) -> String {
        let (title, body, style) = (escaped(&self.title), &self.html, page_style());
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{title}</title>\n\
             <meta name=\"color-scheme\" content=\"light dark\"><style>{style}</style></head>\n<body>\n<h1>{title}</h1>\n{body}</body>\n</html>\n"
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

/// Returns a name of a file: letters, digits, dots and hyphens.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markdown_links_the_files_of_its_plots_and_images() {
        let mut document = Document::new("A & B");
        let svg = "<svg class=\"plot\"><text>x</text></svg>\n";
        document.plot("race, my scene", "Error over time.", svg);
        let image = |name: &str| Thumbnail {
            caption: format!("{name} 2 s"),
            name: name.to_owned(),
            jpeg: vec![1, 2],
        };
        document.strip(vec![image("a"), image("b/c")]);
        document.fold("All columns", |document| document.text("Rest."));
        let names: Vec<&str> = document.files().iter().map(|(name, _)| &**name).collect();
        assert_eq!(names, ["race--my-scene.svg", "a.jpg", "b-c.jpg"]);
        let markdown = document.markdown();
        assert!(names.iter().all(|name| markdown.contains(&format!("]({name})"))), "{markdown}");
        assert!(
            markdown.contains("\n\n<details><summary>All columns</summary>\n\nRest.\n\n</details>\n"),
            "{markdown}"
        );
        let html = document.html();
        assert!(
            html.contains("data:image/jpeg;base64,AQI=")
                && html.contains("A &amp; B")
                && !html.contains("xmlns")
        );
        assert!(html.contains("Rest.</p>\n</details>"), "{html}");
    }
}
