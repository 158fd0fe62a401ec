//! Statements of OBJ files, and the report of those that are not supported.

use super::wavefront::{name, shown};
use crate::error::{Location, Warning};
use crate::statements::{Fate, Statement, fate, listed, table};
use std::path::Path;

/// Returns the statements of OBJ files. Those that say `off` or `0` have no effect.
fn obj() -> &'static [Statement] {
    table("OBJ")
}

/// Maximum number of keywords that are reported.
const MAX_REPORTED: usize = 10;

/// Keywords that are not supported, with the line of each one's first use.
#[derive(Default)]
pub(super) struct UnreadKeywords(Vec<(Vec<u8>, u32)>);

impl UnreadKeywords {
    /// Adds a statement that the reader does not use, unless it cannot change an image.
    pub fn add(&mut self, word: &[u8], rest: &[u8], line: u32) {
        if word.is_empty() || word[0] == b'#' || self.0.len() > MAX_REPORTED {
            return;
        }
        if self.0.iter().any(|(known, _)| known == word) {
            return;
        }
        let is_listed = std::str::from_utf8(word).ok().is_some_and(|word| fate(obj(), word) != Fate::Named);
        if !is_listed && !matches!(name(rest).as_str(), "off" | "0") {
            self.0.push((word.to_owned(), line));
        }
    }

    /// Adds a warning for each keyword to `remarks`. Unknown words say nothing of a file without faces.
    pub fn report(&self, path: &Path, has_faces: bool, has_normals: bool, remarks: &mut Vec<Warning>) {
        let is_listed = |word: &[u8]| obj().iter().any(|statement| statement.name.as_bytes() == word);
        let counts = |word: &[u8]| match word {
            b"s" => has_faces && !has_normals,
            word => has_faces || is_listed(word),
        };
        for (i, (word, line)) in self.0.iter().filter(|(word, _)| counts(word)).enumerate() {
            let place = Location::line(path, *line);
            if i == MAX_REPORTED {
                remarks.push(Warning::new(
                    place,
                    "further statements are not supported",
                    "they are left out",
                ));
                break;
            }
            let word = shown(word);
            let note = listed(obj(), &word).map(|statement| statement.note);
            let what = match note {
                Some(_) => format!("the statement \"{word}\" is not supported"),
                None => format!("the statement \"{word}\" is unknown"),
            };
            remarks.push(Warning::new(place, what, note.unwrap_or("it is left out")));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::obj;
    use super::*;
    use crate::selection::PartSelection;

    fn remarks(text: &str) -> Vec<String> {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{text}\nf 1 2 3\n");
        let mut remarks = Vec::new();
        let read = obj::read(text.as_bytes(), Path::new("t.obj"), &PartSelection::default(), &mut remarks);
        read.unwrap();
        remarks.iter().map(Warning::to_string).collect()
    }

    #[test]
    fn statements_that_are_named_warn_once_with_their_line_and_others_do_not() {
        for statement in super::obj() {
            let said = remarks(&format!("{0} 1 2 3\n{0} 1 2 3", statement.name));
            match statement.fate {
                Fate::Named => {
                    assert_eq!(said.len(), 1, "{said:?}");
                    assert!(said[0].starts_with("t.obj:4: the statement \""), "{said:?}");
                    assert!(
                        said[0].contains(statement.name) && said[0].ends_with(statement.note),
                        "{said:?}"
                    );
                    assert_eq!(remarks(&format!("{} off", statement.name)), [""; 0]);
                }
                _ => assert_eq!(said, [""; 0], "{}", statement.name),
            }
        }
        assert_eq!(remarks("s 1\nvn 0 0 1"), [""; 0]);
        assert_eq!(remarks("# surf\n\n   # curv"), [""; 0]);
        assert_eq!(remarks("vv 1 2"), ["t.obj:4: the statement \"vv\" is unknown; it is left out"]);
    }

    #[test]
    fn damaged_files_warn_of_a_few_words_only() {
        let words: String = (0..100).map(|i| format!("word{i} {}\n", "x".repeat(i))).collect();
        let said = remarks(&words);
        assert_eq!(said.len(), MAX_REPORTED + 1);
        assert!(said[MAX_REPORTED].contains("further statements"), "{said:?}");
        assert!(remarks(&"x".repeat(1000))[0].len() < 100);
    }
}
