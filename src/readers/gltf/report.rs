//! Report of unsupported features, each listed once with the objects that ask for it.

use crate::error::{Location, Log, SceneError};

/// Maximum number of objects that a message names.
const MAX_NAMED: usize = 3;

/// An unsupported feature.
struct Unsupported {
    what: String,
    fallback: &'static str,
    changes_picture: bool,
    names: Vec<String>,
}

/// Findings about a model.
#[derive(Default)]
pub(super) struct Findings {
    findings: Vec<Unsupported>,
}

impl Findings {
    /// Adds a feature of the object `name` whose lack changes the image.
    pub fn lacks(&mut self, what: &str, fallback: &'static str, name: &str) {
        self.add(what, fallback, true, name);
    }

    /// Adds a feature whose lack does not change the expected image.
    pub fn note(&mut self, what: &str, fallback: &'static str, name: &str) {
        self.add(what, fallback, false, name);
    }

    fn add(&mut self, what: &str, fallback: &'static str, changes_picture: bool, name: &str) {
        let same = |f: &&mut Unsupported| f.what == what && f.fallback == fallback;
        match self.findings.iter_mut().find(same) {
            Some(finding) if finding.names.iter().any(|known| known == name) => {}
            Some(finding) => finding.names.push(name.to_owned()),
            None => {
                let (what, names) = (what.to_owned(), vec![name.to_owned()]);
                self.findings.push(Unsupported { what, fallback, changes_picture, names });
            }
        }
    }

    /// Writes all findings to the log.
    pub fn write(self, place: &Location, log: &mut Log) -> Result<(), SceneError> {
        for Unsupported { what, fallback, changes_picture, names } in self.findings {
            let mut listed = names.iter().take(MAX_NAMED).cloned().collect::<Vec<_>>().join(", ");
            if names.len() > MAX_NAMED {
                listed = format!("{listed} and {} more", names.len() - MAX_NAMED);
            }
            let what = if listed.is_empty() { what } else { format!("{what}: {listed}") };
            match changes_picture {
                true => log.warn(place, what, fallback)?,
                false => log.note(place, what, fallback),
            }
        }
        Ok(())
    }
}
