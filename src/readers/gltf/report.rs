//! Parts of a model that are not consumed, each named once with the objects that ask for it.

use crate::error::{Log, Place, SceneError};

/// Number of objects that are named.
const NAMED: usize = 3;

/// A finding in the making.
struct Finding {
    what: String,
    fallback: &'static str,
    changes_picture: bool,
    names: Vec<String>,
}

/// Collects findings.
#[derive(Default)]
pub(super) struct Report {
    findings: Vec<Finding>,
}

impl Report {
    /// Adds that the object `name` asks for `what`, which changes the picture.
    pub fn lacks(&mut self, what: &str, fallback: &'static str, name: &str) {
        self.add(what, fallback, true, name);
    }

    /// Adds a finding that leaves the picture as expected.
    pub fn note(&mut self, what: &str, fallback: &'static str, name: &str) {
        self.add(what, fallback, false, name);
    }

    fn add(&mut self, what: &str, fallback: &'static str, changes_picture: bool, name: &str) {
        let same = |f: &&mut Finding| f.what == what && f.fallback == fallback;
        match self.findings.iter_mut().find(same) {
            Some(finding) => finding.names.push(name.to_owned()),
            None => {
                let (what, names) = (what.to_owned(), vec![name.to_owned()]);
                self.findings.push(Finding { what, fallback, changes_picture, names });
            }
        }
    }

    /// Writes all findings to the log.
    pub fn write(self, place: &Place, log: &mut Log) -> Result<(), SceneError> {
        for Finding { what, fallback, changes_picture, names } in self.findings {
            let mut listed = names.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
            if names.len() > NAMED {
                listed = format!("{listed} and {} more", names.len() - NAMED);
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
