//! Statements of Wavefront's text formats, OBJ and MTL: lines, continued lines, comments and names.
//!
//! A backslash at the end of a line joins it with the next. A comment begins with `#` at the start of a line or behind
//! white space, and is never continued. Names may hold such a `#`, too: [`readings`] lists what a name may be.

use super::encodings::{ends_in_letter, text};
use super::numerals::{self, is_in_number};
use std::borrow::Cow;

/// Iterator over statements, with the number of each one's first line, counted from 1.
pub(crate) struct Statements<'a, L> {
    lines: L,
    number: u32,
    text: std::marker::PhantomData<&'a [u8]>,
}

/// Returns the statements of the text `bytes`, without white space around them.
pub(crate) fn statements(bytes: &[u8]) -> Statements<'_, impl Iterator<Item = &[u8]>> {
    Statements { lines: lines(bytes), number: 0, text: std::marker::PhantomData }
}

/// Returns the lines of a text without its byte-order mark. Lines end as on Unix, Windows or old Macintoshes.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    bytes.split(move |&b| b == end)
}

impl<'a, L: Iterator<Item = &'a [u8]>> Iterator for Statements<'a, L> {
    type Item = (u32, Cow<'a, [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        let mut line = self.lines.next()?.trim_ascii();
        self.number += 1;
        let first = self.number;
        let Some(mut start) = continued(line) else { return Some((first, Cow::Borrowed(line))) };
        let mut joined = Vec::new();
        loop {
            joined.extend_from_slice(start);
            line = match self.lines.next() {
                Some(line) => line.trim_ascii(),
                None => break,
            };
            self.number += 1;
            joined.push(b' ');
            start = match continued(line) {
                Some(start) => start,
                None => {
                    joined.extend_from_slice(line);
                    break;
                }
            };
        }
        Some((first, Cow::Owned(joined)))
    }
}

/// Returns a line without the backslash that joins it with the next one; `None` if it has none.
fn continued(line: &[u8]) -> Option<&[u8]> {
    line.strip_suffix(b"\\").filter(|start| comments(start).next().is_none() && !ends_in_letter(line))
}

/// Returns the positions at which a comment may begin.
fn comments(text: &[u8]) -> impl Iterator<Item = usize> {
    let begins = |i: &usize| text[*i] == b'#' && (*i == 0 || text[*i - 1].is_ascii_whitespace());
    (0..text.len()).filter(begins)
}

/// Returns the first word of a statement, and the rest.
pub(crate) fn split_word(statement: &[u8]) -> (&[u8], &[u8]) {
    let end = statement.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(statement.len());
    statement.split_at(end)
}

/// Returns the words of a text.
pub(crate) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|b| b.is_ascii_whitespace()).filter(|word| !word.is_empty())
}

/// Returns the words of a text without a comment, which begins at any `#` outside a number.
pub(crate) fn values(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut marks = (0..text.len()).filter(|&i| text[i] == b'#');
    let end = marks.find(|&i| !is_in_number(text, i)).unwrap_or(text.len());
    words(&text[..end])
}

/// Returns what a name may be, which may hold spaces: all of the text, and the text before each possible comment. The
/// longest is the first.
pub(crate) fn readings(rest: &[u8]) -> Vec<String> {
    let rest = rest.trim_ascii();
    let cut = comments(rest).map(|at| rest[..at].trim_ascii_end());
    let mut all: Vec<String> = cut.chain([rest]).map(text).collect();
    all.reverse();
    all
}

/// Returns a name that nothing else tells about. A `#` before a letter or digit is a part of it, as in `Material #25`;
/// a `#` alone begins a comment.
pub(crate) fn name(rest: &[u8]) -> String {
    let rest = rest.trim_ascii();
    let is_alone = |at: &usize| rest.get(at + 1).is_none_or(u8::is_ascii_whitespace);
    let end = comments(rest).find(is_alone).unwrap_or(rest.len());
    text(rest[..end].trim_ascii_end())
}

/// Returns a word for a message: its first characters, those that are not UTF-8 replaced.
pub(crate) fn shown(word: &[u8]) -> String {
    const MAX_SHOWN: usize = 24;
    String::from_utf8_lossy(&word[..word.len().min(MAX_SHOWN)]).into_owned()
}

/// Parses the first `N` numbers of a text, which may be infinite or NaN. Further words are ignored.
pub(crate) fn numbers<const N: usize>(rest: &[u8]) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    let mut words = self::values(rest);
    for value in &mut values {
        let word = words.next().ok_or_else(|| format!("expected {N} numbers"))?;
        let bad = || format!("cannot read the number \"{}\"", shown(word));
        *value = numerals::number(word).ok_or_else(bad)?;
    }
    Ok(values)
}

/// True if the numbers of a position have a colour behind them.
pub(super) fn is_coloured(rest: &[u8]) -> bool {
    values(rest).count() >= 6
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(u32, String)> {
        let whole = |(line, text): (u32, Cow<[u8]>)| (line, String::from_utf8_lossy(&text).into_owned());
        statements(text.as_bytes()).map(whole).filter(|(_, text)| !text.is_empty()).collect()
    }

    #[test]
    fn lines_are_joined_at_a_backslash_and_keep_the_number_of_the_first() {
        for end in ["\n", "\r\n", "\r"] {
            let text = "v 1 \\|\t2\\|3|# a folder C:\\|f 1 2 3 # b\\|s off|l 1 \\".replace('|', end);
            let expected =
                [(1, "v 1  2 3"), (4, "# a folder C:\\"), (5, "f 1 2 3 # b\\"), (6, "s off"), (7, "l 1 ")];
            assert_eq!(read(&text), expected.map(|(line, text)| (line, text.to_owned())));
        }
    }

    #[test]
    fn names_keep_spaces_and_marks_and_lose_comments() {
        for (rest, expected) in [
            (" dark oak\t", "dark oak"),
            (" brick # red", "brick"),
            (" C#sharp#2 #3", "C#sharp#2 #3"),
            (" Paint\t#1 #", "Paint\t#1"),
            (" #ff0000", "#ff0000"),
            (" # none", ""),
            ("", ""),
        ] {
            assert_eq!(name(rest.as_bytes()), expected);
        }
        assert_eq!(readings(b" a #1 # b "), ["a #1 # b", "a #1", "a"]);
        assert_eq!(readings(b""), [""]);
    }

    #[test]
    fn numbers_may_hold_a_mark() {
        let [a, b, c] = numbers(b"1.#QNAN -1.#INF 2.#third").unwrap();
        assert!(a.is_nan() && b == f64::NEG_INFINITY && c == 2.0);
    }
}
