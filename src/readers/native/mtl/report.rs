//! Converter of a library, and its report of features that are not supported.

use super::source::{SourceMaterial, Unsupported};
use crate::error::{Location, SceneError};
use crate::native::builder::SceneBuilder;
use std::path::Path;

/// Maximum number of materials that a message lists.
const MAX_LISTED: usize = 3;

/// Converter of the materials of a library.
pub struct LibraryReader<'b, 'a> {
    pub builder: &'b mut SceneBuilder<'a>,
    pub file: &'b Path,
    /// Length of the file's unit in the world.
    pub unit: f32,
    /// Features that are not supported, with the names of the materials that ask for them.
    lacks: Vec<(Unsupported, Vec<String>)>,
}

impl<'b, 'a> LibraryReader<'b, 'a> {
    /// Returns a converter of the materials of `file`.
    pub fn new(builder: &'b mut SceneBuilder<'a>, file: &'b Path, unit: f32) -> LibraryReader<'b, 'a> {
        LibraryReader { builder, file, unit, lacks: Vec::new() }
    }

    /// Adds a feature that is not supported, at the line of the statement `keyword` or of the material.
    pub fn lacks(&mut self, source: &SourceMaterial, keyword: &str, what: impl Into<String>, fallback: &str) {
        let (what, fallback) = (what.into(), fallback.to_owned());
        self.add(&source.name, Unsupported { what, fallback, line: source.line(keyword) });
    }

    /// Adds a feature of a material.
    pub fn add(&mut self, name: &str, lack: Unsupported) {
        let is_like = |known: &Unsupported| known.what == lack.what && known.fallback == lack.fallback;
        match self.lacks.iter_mut().find(|(known, _)| is_like(known)) {
            Some((_, names)) if names.last().is_some_and(|last| last == name) => {}
            Some((_, names)) => names.push(name.to_owned()),
            None => self.lacks.push((lack, vec![name.to_owned()])),
        }
    }

    /// Warns of the features that are not supported, each once.
    pub fn report(self) -> Result<(), SceneError> {
        for (Unsupported { what, fallback, line }, names) in self.lacks {
            let mut listed: Vec<String> =
                names.iter().take(MAX_LISTED).map(|name| format!("\"{name}\"")).collect();
            if names.len() > MAX_LISTED {
                listed.push(format!("{} more", names.len() - MAX_LISTED));
            }
            let what = format!("{what} is not supported: {}", listed.join(", "));
            self.builder.log.warn(&Location::line(self.file, line), what, fallback)?;
        }
        Ok(())
    }
}
