//! Names that an OBJ file refers to: material libraries and materials.

use super::encodings;
use super::wavefront::{is_coloured, name, readings, split_word, statements};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Names that an OBJ file refers to.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct References {
    /// Texts of `mtllib` statements with their lines, in order.
    pub libraries: Vec<(u32, String)>,
    /// Texts that name the materials of the faces. They may hold comments.
    pub materials: BTreeSet<String>,
    /// True if a position has a colour.
    pub has_colours: bool,
}

/// Returns the names that the OBJ text `bytes` refers to.
pub(crate) fn references(bytes: &[u8]) -> References {
    let mut found = References::default();
    for (line, statement) in statements(bytes) {
        match split_word(&statement) {
            (b"mtllib", rest) => {
                let text = encodings::text(rest.trim_ascii());
                if !found.libraries.iter().any(|library| library.1 == text) {
                    found.libraries.push((line, text));
                }
            }
            (b"usemtl", rest) => {
                found.materials.insert(encodings::text(rest.trim_ascii()));
            }
            (b"v", rest) if !found.has_colours => found.has_colours = is_coloured(rest),
            _ => {}
        }
    }
    found
}

/// Maximum number of words of a file's name.
const MAX_WORDS: usize = 16;

/// Returns the files that the text of a statement names; `find` returns the path of a file that exists.
///
/// Names may hold spaces and `#`, and a statement may list several. So the longest name that exists counts. Names of
/// files that do not exist end at their extension; their places hold the name.
pub(crate) fn listed_files(
    text: &str,
    extension: &str,
    find: impl Fn(&str) -> Option<PathBuf>,
) -> Vec<Result<PathBuf, String>> {
    // The whole text may name one file, whatever it holds.
    if let Some(path) = find(text) {
        return vec![Ok(path)];
    }
    let mut lists = readings(text.as_bytes()).into_iter().map(|text| split_files(&text, extension, &find));
    let complete = lists.find(|list| !list.is_empty() && list.iter().all(Result::is_ok));
    complete.unwrap_or_else(|| split_files(&name(text.as_bytes()), extension, &find))
}

/// Returns the files that a text without a comment lists.
fn split_files(
    text: &str,
    extension: &str,
    find: impl Fn(&str) -> Option<PathBuf>,
) -> Vec<Result<PathBuf, String>> {
    let mut ends = Vec::new();
    let mut starts = Vec::new();
    for word in text.split_ascii_whitespace() {
        let start = word.as_ptr() as usize - text.as_ptr() as usize;
        starts.push(start);
        ends.push(start + word.len());
    }
    let mut files = Vec::new();
    let mut at = 0;
    while at < starts.len() {
        let most = ends.len().min(at + MAX_WORDS);
        let longest = (at..most).rev().find_map(|last| {
            let path = find(&text[starts[at]..ends[last]])?;
            Some((last, Ok(path)))
        });
        let is_end = |last: &usize| text[..ends[*last]].to_ascii_lowercase().ends_with(extension);
        let (last, file) = longest.unwrap_or_else(|| {
            let last = (at..most).find(is_end).unwrap_or(ends.len() - 1);
            (last, Err(text[starts[at]..ends[last]].to_owned()))
        });
        files.push(file);
        at = last + 1;
    }
    files
}

/// Definitions of material libraries by what their names may be.
#[derive(Debug, Default)]
pub(crate) struct Definitions {
    names: BTreeMap<String, usize>,
    /// Names before a `#` that nothing tells to be a comment; `None` if several definitions may have the name.
    short: BTreeMap<String, Option<usize>>,
    count: usize,
}

impl Definitions {
    /// Adds a library with the texts of its definitions. Names that an earlier library defines do not count.
    pub fn add<'a>(&mut self, library: impl Iterator<Item = &'a str>) {
        let first = self.count;
        for text in library {
            let number = self.count;
            self.count += 1;
            for name in [text.to_owned(), name(text.as_bytes())] {
                let known = self.names.entry(name).or_insert(number);
                *known = if *known < first { *known } else { number };
            }
            for name in readings(text.as_bytes()).into_iter().skip(1).filter(|name| !name.is_empty()) {
                let of = self.short.entry(name).or_insert(Some(number));
                *of = of.filter(|other| *other == number);
            }
        }
    }

    /// Returns the name that a text means, which may have a comment behind it, and the number of its definition.
    ///
    /// The longest name that is defined counts.
    pub fn find(&self, text: &str) -> Option<(String, usize)> {
        readings(text.as_bytes()).into_iter().find_map(|name| {
            let number = self.names.get(&name).copied().or_else(|| self.short.get(&name).copied().flatten());
            Some((name, number?))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_are_told_apart_by_which_files_exist() {
        let exist = ["walls.mtl", "trim.mtl", "dark oak.mtl", "a #2.mtl", "room"];
        let find = |name: &str| exist.contains(&name).then(|| PathBuf::from(name));
        let files = |text: &str| -> Vec<String> {
            let shown = |file: Result<PathBuf, String>| match file {
                Ok(path) => path.display().to_string(),
                Err(name) => format!("no {name}"),
            };
            listed_files(text, ".mtl", find).into_iter().map(shown).collect()
        };
        for (text, expected) in [
            ("walls.mtl trim.mtl", &["walls.mtl", "trim.mtl"][..]),
            ("walls.mtl  dark oak.mtl\ttrim.mtl # made by hand", &["walls.mtl", "dark oak.mtl", "trim.mtl"]),
            ("a #2.mtl", &["a #2.mtl"]),
            ("walls.mtl a #2.mtl # both", &["walls.mtl", "a #2.mtl"]),
            ("walls.mtl #old", &["walls.mtl"]),
            ("b #2.mtl # new", &["no b #2.mtl"]),
            ("my room.mtl walls.mtl", &["no my room.mtl", "walls.mtl"]),
            ("room", &["room"]),
            ("My Room.MTL", &["no My Room.MTL"]),
            ("", &[]),
            ("# none", &[]),
        ] {
            assert_eq!(files(text), expected, "{text}");
        }
    }

    #[test]
    fn materials_are_told_apart_by_which_are_defined() {
        let all =
            ["Material #25", "Material #26", "oak # old", "brick", "Paint\t#1", "a # 1", "a # 2", "#ff0000"];
        let mut definitions = Definitions::default();
        definitions.add(all.into_iter());
        definitions.add(["brick", "stone"].into_iter());
        for (text, expected) in [
            ("Material #25", Some(0)),
            ("Material #26 # right", Some(1)),
            ("Material", None),
            ("Material #27", None),
            ("oak", Some(2)),
            ("oak # new", Some(2)),
            ("brick #red", Some(3)),
            ("Paint\t#1", Some(4)),
            ("a # 2", Some(6)),
            ("a", Some(6)),
            ("#ff0000", Some(7)),
            ("stone", Some(9)),
            ("", None),
        ] {
            assert_eq!(definitions.find(text).map(|found| found.1), expected, "{text}");
        }
        assert_eq!(definitions.find("brick #red # x"), Some(("brick".to_owned(), 3)));
    }

    #[test]
    fn references_are_listed_once_with_their_lines() {
        let text = "mtllib a.mtl\n  mtllib b.mtl \\\n c.mtl\nusemtl x # y\nmtllib a.mtl\nusemtl x\nusemtl\n";
        let found = references(text.as_bytes());
        assert_eq!(found.libraries, [(1, "a.mtl".to_owned()), (2, "b.mtl  c.mtl".to_owned())]);
        assert_eq!(found.materials.into_iter().collect::<Vec<_>>(), ["", "x", "x # y"]);
        assert!(!found.has_colours && references(b"v 0 0 0 1\nv 0 0 0 1 1 1 # red").has_colours);
    }
}
