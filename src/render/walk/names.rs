//! File names of frames: `f.####.exr` or `f.%04d.png`. Numbers are padded with zeros to that many digits.
//!
//! One rule holds for the frames of walks and for single frames.

use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Maximum number of digits of a name.
const MAX_DIGITS: usize = 16;

/// A name with a place for the frame's number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileNames {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl FileNames {
    /// Returns the file of a frame.
    pub fn file(&self, frame: usize) -> PathBuf {
        let FileNames { folder, before, digits, after } = self;
        folder.join(format!("{before}{frame:0digits$}{after}"))
    }

    /// Returns the name for all frames, with a `#` per digit.
    pub fn pattern(&self) -> PathBuf {
        let FileNames { folder, before, digits, after } = self;
        folder.join(format!("{before}{}{after}", "#".repeat(*digits)))
    }
}

impl FileNames {
    /// Parses a name with any extension; `None` if it has no place for a number.
    fn parse(path: &Path) -> Result<Option<FileNames>, String> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let mut places = places(name);
        let Some((start, end, digits)) = places.next() else { return Ok(None) };
        if places.next().is_some() {
            return Err("the file name has more than one placeholder for the frame number".to_owned());
        }
        if digits > MAX_DIGITS {
            return Err(format!("{digits} digits are more than {MAX_DIGITS}"));
        }
        let (before, after) = (name[..start].to_owned(), name[end..].to_owned());
        Ok(Some(FileNames { folder, before, digits, after }))
    }
}

impl FromStr for FileNames {
    type Err = String;

    fn from_str(text: &str) -> Result<FileNames, String> {
        let Some(names) = FileNames::parse(Path::new(text))? else {
            return Err(
                "the file name has no placeholder for the frame number; write a name like f.####.exr or f.%04d.exr".to_owned()
            );
        };
        let is_known = |extension: &str| names.after.to_ascii_lowercase().ends_with(extension);
        if ![".exr", ".png"].into_iter().any(is_known) {
            return Err("the file name must end in .exr, or in .png for PNG files alone".to_owned());
        }
        Ok(names)
    }
}

/// Returns the file of a single frame: `path`, with the number of the frame where its name has a place for it.
///
/// # Errors
/// If the name has such a place and there is no frame, or the place is invalid.
pub fn numbered(path: &Path, frame: Option<usize>) -> Result<PathBuf, String> {
    match (FileNames::parse(path)?, frame) {
        (None, _) => Ok(path.to_owned()),
        (Some(names), Some(frame)) => Ok(names.file(frame)),
        (Some(_), None) => {
            Err("the file name has a placeholder for the frame number; add --frame N, or name the file without # and %d"
                .to_owned())
        }
    }
}

/// Finds start, end and number of digits of every place for a number: a run of `#`, or `%d`, `%4d`, `%04d`.
fn places(name: &str) -> impl Iterator<Item = (usize, usize, usize)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        while at < name.len() {
            let (start, rest) = (at, &name.as_bytes()[at..]);
            let run = |of: fn(&u8) -> bool| rest[1..].iter().take_while(|byte| of(byte)).count();
            match rest[0] {
                b'#' => {
                    at += 1 + run(|byte| *byte == b'#');
                    return Some((start, at, at - start));
                }
                b'%' => {
                    let width = run(u8::is_ascii_digit);
                    at += 1 + width;
                    if rest.get(1 + width) == Some(&b'd') {
                        at += 1;
                        // A width that is too large for a number is too large for a name.
                        let digits =
                            name[start + 1..at - 1].parse().unwrap_or(if width > 0 { usize::MAX } else { 1 });
                        return Some((start, at, digits));
                    }
                }
                _ => at += 1,
            }
        }
        None
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_with_their_digits_in_the_place_for_them() {
        let name = |pattern: &str, frame| {
            let file = pattern.parse::<FileNames>().unwrap().file(frame);
            file.to_str().unwrap().to_owned()
        };
        assert_eq!(name("frames/f.####.exr", 7), "frames/f.0007.exr");
        assert_eq!(name("/tmp/a b/%04d.EXR", 123_456), "/tmp/a b/123456.EXR");
        assert_eq!(name("f%d_x.exr", 7), "f7_x.exr");
        assert_eq!(name("f%3d.exr", 7), "f007.exr");
        assert_eq!(name("#.exr", 12), "12.exr");
        assert_eq!(name("ü%ü#.exr", 1), "ü%ü1.exr");
        // The name of the folder does not change.
        assert_eq!(name("take##/f#.exr", 3), "take##/f3.exr");
    }

    #[test]
    fn single_frames_are_named_as_those_of_walks() {
        let name = |pattern: &str, frame| {
            numbered(Path::new(pattern), frame).map(|file| file.to_str().unwrap().to_owned())
        };
        for pattern in ["a#/still.####.exr", "a#/still.%04d.png", "a#/still#.png"] {
            let walked = FileNames::parse(Path::new(pattern)).unwrap().unwrap().file(7);
            assert_eq!(name(pattern, Some(7)), Ok(walked.to_str().unwrap().to_owned()));
        }
        assert_eq!(name("still.####.exr", Some(7)).unwrap(), "still.0007.exr");
        assert_eq!(name("a#/still.exr", Some(7)).unwrap(), "a#/still.exr");
        assert_eq!(name("still.exr", None).unwrap(), "still.exr");
        assert!(name("still.#.exr", None).unwrap_err().contains("--frame"));
        assert!(name("#.#.exr", Some(7)).unwrap_err().contains("more than one"));
    }

    #[test]
    fn names_without_one_place_are_refused_with_the_remedy() {
        let error = |pattern: &str| pattern.parse::<FileNames>().unwrap_err();
        for bad in ["f.exr", "", "/", "a#/f.exr", "f%4x.exr", "f%"] {
            assert!(error(bad).contains("####"), "{bad}");
        }
        assert!(error("#_%d.exr").contains("more than one") && error("#a#.exr").contains("more than one"));
        assert!(error("f.####.jpg").contains(".exr"));
        for bad in ["f.%99d.exr", "f.%99999999999999999999999d.exr"] {
            assert!(error(bad).contains("digits"), "{bad}");
        }
    }
}
