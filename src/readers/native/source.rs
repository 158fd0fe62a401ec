//! Text of a description, with the lines that messages name.

use crate::error::Location;
use std::ops::Range;
use std::path::Path;

/// A description and its file.
#[derive(Clone, Copy)]
pub(super) struct SourceText<'a> {
    pub path: &'a Path,
    pub text: &'a str,
}

impl SourceText<'_> {
    /// Returns the line of a span of bytes.
    pub fn place(&self, span: Range<usize>) -> Location {
        let before = self.text.as_bytes().get(..span.start).unwrap_or_default();
        let line = before.iter().filter(|&&b| b == b'\n').count() as u32 + 1;
        Location::line(self.path, line)
    }
}
