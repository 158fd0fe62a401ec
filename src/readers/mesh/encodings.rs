//! Names in text files whose encoding nothing states: UTF-8, or the code page of the exporter's machine.
//!
//! A name is UTF-8 if it can be, else Windows-1252, in which each byte is one letter. So names are the same exactly if
//! their bytes are, whatever the code page was.

use encoding_rs::{BIG5, EUC_KR, Encoding, GBK, SHIFT_JIS, WINDOWS_1250, WINDOWS_1251, WINDOWS_1252};
use std::ffi::OsString;
use std::iter;
use std::path::{Path, PathBuf};

/// Code pages in which a name is sought on the disk and in scenes.
const CODE_PAGES: [&Encoding; 7] = [WINDOWS_1252, WINDOWS_1251, WINDOWS_1250, GBK, SHIFT_JIS, BIG5, EUC_KR];

/// Returns the name that has these bytes.
pub(crate) fn text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => WINDOWS_1252.decode_without_bom_handling(bytes).0.into_owned(),
    }
}

/// Returns the bytes that a name had in its file if these were no UTF-8.
fn code_page_bytes(name: &str) -> Option<Vec<u8>> {
    let (bytes, _, has_failed) = WINDOWS_1252.encode(name);
    (!has_failed && !name.is_ascii()).then(|| bytes.into_owned())
}

/// Returns the name, and what it may be in other encodings than that of [`text`].
pub(super) fn spellings(name: &str) -> Vec<String> {
    let mut all = vec![name.to_owned()];
    let Some(bytes) = code_page_bytes(name) else { return all };
    for page in CODE_PAGES {
        let decoded = page.decode_without_bom_handling_and_without_replacement(&bytes);
        if let Some(decoded) = decoded.filter(|decoded| !all.iter().any(|known| known == decoded)) {
            all.push(decoded.into_owned());
        }
    }
    all
}

/// Returns the path of the file that a statement in `folder` names, if there is one.
///
/// A file beside the statement's is used instead of one in a folder that does not exist, as of another machine.
pub(crate) fn existing_file(folder: &Path, name: &str) -> Option<PathBuf> {
    let name = name.trim_matches('"');
    let beside =
        spellings(name).into_iter().filter_map(|name| Some(name.rsplit(['/', '\\']).next()?.to_owned()));
    let names = iter::once(name.to_owned()).chain(beside);
    names.flat_map(|name| possible_paths(folder, &name)).find(|path| path.is_file())
}

/// Returns the path of a file that a statement in `folder` names, and that is not there.
pub(crate) fn missing_file(folder: &Path, name: &str) -> PathBuf {
    folder.join(name.trim_matches('"').replace('\\', "/"))
}

/// Returns the paths in `folder` that a name may mean, the likely ones first: the name itself with the separators of
/// either system, and its spellings in other encodings, as text and as bytes.
fn possible_paths(folder: &Path, name: &str) -> Vec<PathBuf> {
    let mut paths = vec![folder.join(name.replace('\\', "/")), folder.join(name)];
    if !name.is_ascii() {
        let bytes = code_page_bytes(name).map(os_string);
        paths.extend(bytes.map(|bytes| folder.join(bytes)));
        for spelling in spellings(name) {
            let spelling = spelling.replace('\\', "/");
            for page in CODE_PAGES {
                let (bytes, _, has_failed) = page.encode(&spelling);
                paths.extend((!has_failed).then(|| folder.join(os_string(bytes.into_owned()))));
            }
            paths.push(folder.join(spelling));
        }
    }
    paths
}

/// Returns the name of a file that has these bytes on the disk.
#[cfg(unix)]
fn os_string(bytes: Vec<u8>) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes)
}

/// Returns the name of a file that has these bytes on the disk, if it can have.
#[cfg(not(unix))]
fn os_string(bytes: Vec<u8>) -> OsString {
    String::from_utf8_lossy(&bytes).into_owned().into()
}

/// True if the last byte of a line is the second of a letter of two bytes, as of Shift-JIS, GBK and Big5.
pub(super) fn ends_in_letter(line: &[u8]) -> bool {
    let Some((last, before)) = line.split_last() else { return false };
    if *last < 0x40 || std::str::from_utf8(before).is_ok() {
        return false;
    }
    let mut is_second = false;
    for byte in before {
        is_second = !is_second && (0x81..=0xFE).contains(byte);
    }
    is_second
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_same_exactly_if_their_bytes_are() {
        let names =
            [&b"gr\xFCn"[..], b"gr\xF6n", b"\xBA\xEC\xC9\xAB", b"\xC2\xCC\xC9\xAB", b"\x81", b"\xFF\xFE"];
        for (i, a) in names.iter().enumerate() {
            for (k, b) in names.iter().enumerate() {
                assert_eq!(text(a) == text(b), i == k);
            }
            assert_eq!(code_page_bytes(&text(a)).as_deref(), Some(*a));
        }
        assert_eq!(text("зелёный".as_bytes()), "зелёный");
        assert_eq!(text(b"gr\xFCn"), "grün");
    }

    #[test]
    fn names_in_code_pages_are_known_by_their_letters() {
        for (bytes, name) in [
            (&b"\xBA\xEC\xC9\xAB"[..], "红色"),
            (b"\xF1\xE8\xED\xE8\xE9", "синий"),
            (b"\x95\x5C", "表"),
            (b"gr\xFCn", "grün"),
        ] {
            assert!(spellings(&text(bytes)).iter().any(|spelling| spelling == name), "{name}");
        }
        assert_eq!(spellings("oak"), ["oak"]);
    }

    #[test]
    fn a_backslash_in_a_letter_continues_no_line() {
        for (line, expected) in [
            (&b"usemtl \x95\x5C"[..], true),
            (b"usemtl \x83\x5C\x83\x74\\", false),
            (b"usemtl gr\xC3\xBC\\", false),
            (b"f 1 2 \\", false),
            (b"", false),
        ] {
            assert_eq!(ends_in_letter(line), expected, "{line:?}");
        }
    }
}
