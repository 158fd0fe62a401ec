//! Findings about a file, each listed once with the objects that it is about.

use crate::error::{Location, Log, SceneError};
use std::collections::BTreeSet;
use std::fmt::Display;

/// Maximum number of objects that a message names.
const MAX_NAMED: usize = 3;

/// Lists names: some of them, and the number of the others.
pub fn listed<N: Display>(names: &[N], most: usize) -> String {
    let mut listed: Vec<String> = names.iter().take(most).map(ToString::to_string).collect();
    if names.len() > most {
        listed.push(format!("{} more", names.len() - most));
    }
    listed.join(", ")
}

/// A feature that is not supported.
struct Finding {
    /// Place, if it is known better than the file.
    place: Option<Location>,
    what: String,
    fallback: String,
    changes_picture: bool,
    /// Objects in the order of the file.
    names: Vec<String>,
    known: BTreeSet<String>,
}

/// Findings about a file.
#[derive(Default)]
pub struct Findings(Vec<Finding>);

impl Findings {
    /// Adds a feature of the object `name` whose lack changes the image.
    pub fn lacks(&mut self, what: &str, fallback: &str, name: &str) {
        self.add(None, [what, fallback, name], true);
    }

    /// Adds a feature whose lack does not change the expected image.
    pub fn note(&mut self, what: &str, fallback: &str, name: &str) {
        self.add(None, [what, fallback, name], false);
    }

    /// Adds a feature of the object `name` that the file asks for at a place.
    pub fn lacks_at(&mut self, place: Location, what: &str, fallback: &str, name: &str) {
        self.add(Some(place), [what, fallback, name], true);
    }

    fn add(&mut self, place: Option<Location>, [what, fallback, name]: [&str; 3], changes_picture: bool) {
        let index = self.0.iter().position(|found| found.what == what && found.fallback == fallback);
        let index = index.unwrap_or_else(|| {
            let (what, fallback) = (what.to_owned(), fallback.to_owned());
            let (names, known) = (Vec::new(), BTreeSet::new());
            self.0.push(Finding { place, what, fallback, changes_picture, names, known });
            self.0.len() - 1
        });
        if self.0[index].known.insert(name.to_owned()) {
            self.0[index].names.push(name.to_owned());
        }
    }

    /// Writes all findings to the log. `place` is the place of findings without one.
    pub fn write(self, place: &Location, log: &mut Log) -> Result<(), SceneError> {
        for Finding { place: own, what, fallback, changes_picture, names, .. } in self.0 {
            let (place, names) = (own.as_ref().unwrap_or(place), listed(&names, MAX_NAMED));
            let what = if names.is_empty() { what } else { format!("{what}: {names}") };
            match changes_picture {
                true => log.warn(place, what, fallback)?,
                false => log.note(place, what, fallback),
            }
        }
        Ok(())
    }
}
