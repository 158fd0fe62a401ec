//! Places of the elements of an XML file.

use crate::error::Location;
use std::path::Path;

/// An XML file, and where its lines end. The parser's library would count the lines before each element anew, which
/// takes seconds for ten thousand instances.
pub(super) struct XmlFile<'a> {
    /// Path of the file.
    pub path: &'a Path,
    /// Offsets of the line feeds.
    line_feeds: Vec<usize>,
}

impl<'a> XmlFile<'a> {
    /// Finds the lines of a file with this content.
    pub fn new(path: &'a Path, text: &str) -> XmlFile<'a> {
        let line_feeds =
            text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at).collect();
        XmlFile { path, line_feeds }
    }

    /// Returns the line on which a node begins.
    pub fn place(&self, node: &roxmltree::Node) -> Location {
        let line = 1 + self.line_feeds.partition_point(|at| *at < node.range().start);
        Location::line(self.path, line as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_on_the_lines_that_the_library_counts() {
        let text = "<a>\n\n<b>é\n<c/><d\n\n x='1'/>\r\n</b>\n<!-- \n\n --><e/>\n</a>\n";
        let document = roxmltree::Document::parse(text).unwrap();
        let file = XmlFile::new(Path::new("x.xml"), text);
        let mut lines = Vec::new();
        for node in document.descendants().filter(|node| node.is_element()) {
            let expected = document.text_pos_at(node.range().start).row;
            assert_eq!(file.place(&node).to_string(), Location::line(file.path, expected).to_string());
            lines.push(expected);
        }
        assert_eq!(lines, [1, 3, 4, 4, 10]);
    }
}
