//! Names that an OBJ file refers to: material libraries and materials.

use super::wavefront::{name, split_word, statements};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Names that an OBJ file refers to.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct References {
    /// Texts of `mtllib` statements with their lines, in order.
    pub libraries: Vec<(u32, String)>,
    /// Names of the materials that the faces use.
    pub materials: BTreeSet<String>,
}

/// Returns the names that the OBJ text `bytes` refers to.
pub(crate) fn references(bytes: &[u8]) -> References {
    let mut found = References::default();
    for (line, statement) in statements(bytes) {
        match split_word(&statement) {
            (b"mtllib", rest) => {
                let text = String::from_utf8_lossy(rest).trim().to_owned();
                if !found.libraries.iter().any(|library| library.1 == text) {
                    found.libraries.push((line, text));
                }
            }
            (b"usemtl", rest) => {
                found.materials.insert(name(rest));
            }
            _ => {}
        }
    }
    found
}

/// Maximum number of words of a file's name.
const MAX_WORDS: usize = 16;

/// Returns the files that the text of a statement names; `find` returns the path of a file that exists.
///
/// Names may hold spaces, and a statement may list several. So the longest name that exists counts. Names of files that
/// do not exist end at their extension; their places hold the name.
pub(crate) fn listed_files(
    text: &str,
    extension: &str,
    find: impl Fn(&str) -> Option<PathBuf>,
) -> Vec<Result<PathBuf, String>> {
    // The whole text may name one file, whatever it holds.
    if let Some(path) = find(text) {
        return vec![Ok(path)];
    }
    let text = &name(text.as_bytes());
    let mut ends = Vec::new();
    let mut starts = Vec::new();
    for word in text.split_whitespace() {
        let start = word.as_ptr() as usize - text.as_ptr() as usize;
        starts.push(start);
        ends.push(start + word.len());
    }
    let mut files = Vec::new();
    let mut at = 0;
    while at < starts.len() {
        let most = ends.len().min(at + MAX_WORDS);
        let found = (at..most).rev().find_map(|last| {
            let path = find(&text[starts[at]..ends[last]])?;
            Some((last, Ok(path)))
        });
        let is_end = |last: &usize| text[..ends[*last]].to_ascii_lowercase().ends_with(extension);
        let (last, file) = found.unwrap_or_else(|| {
            let last = (at..most).find(is_end).unwrap_or(ends.len() - 1);
            (last, Err(text[starts[at]..ends[last]].to_owned()))
        });
        files.push(file);
        at = last + 1;
    }
    files
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
    fn references_are_listed_once_with_their_lines() {
        let text = "mtllib a.mtl\n  mtllib b.mtl \\\n c.mtl\nusemtl x # y\nmtllib a.mtl\nusemtl x\nusemtl\n";
        let found = references(text.as_bytes());
        assert_eq!(found.libraries, [(1, "a.mtl".to_owned()), (2, "b.mtl  c.mtl".to_owned())]);
        assert_eq!(found.materials.into_iter().collect::<Vec<_>>(), ["", "x"]);
    }
}
