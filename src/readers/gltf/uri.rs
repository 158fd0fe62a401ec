//! URIs: bytes in data URIs, and names of files.
//!
//! Exporters leave padding out, break lines, escape characters or not, and append queries. All of this is read.

use base64::Engine;
use base64::alphabet::STANDARD as ALPHABET;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig, STANDARD};
use std::path::{Path, PathBuf};

/// Decoder that asks for no padding.
const LENIENT: GeneralPurpose = GeneralPurpose::new(
    &ALPHABET,
    GeneralPurposeConfig::new()
        .with_decode_allow_trailing_bits(true)
        .with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Content of a URI.
pub(super) enum Resolved {
    Bytes(Vec<u8>),
    File(PathBuf),
}

/// Returns the bytes in a data URI, or the path of the file that a URI names; `None` for bytes that are not in base64.
///
/// Names are relative to `folder`.
pub(super) fn resolve(uri: &str, folder: &Path) -> Option<Resolved> {
    let uri = uri.trim();
    match without_scheme(uri, "data:") {
        Some(data) => Some(Resolved::Bytes(bytes(data)?)),
        None => Some(Resolved::File(file(uri, folder))),
    }
}

/// Returns what stands behind a scheme.
fn without_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let head = uri.get(..scheme.len())?;
    head.eq_ignore_ascii_case(scheme).then(|| &uri[scheme.len()..])
}

/// Returns the bytes of a data URI, without its scheme.
fn bytes(data: &str) -> Option<Vec<u8>> {
    let (kind, content) = data.split_once(',')?;
    let last = kind.rsplit(';').next().unwrap_or_default();
    if !last.trim().eq_ignore_ascii_case("base64") {
        return Some(percent_decoded(content));
    }
    STANDARD.decode(content).ok().or_else(|| {
        let plain = |byte: u8| match byte {
            b'-' => b'+',
            b'_' => b'/',
            other => other,
        };
        let bytes = percent_decoded(content).into_iter();
        let mut digits: Vec<u8> = bytes.filter(|byte| !byte.is_ascii_whitespace()).map(plain).collect();
        digits.truncate(digits.iter().rposition(|byte| *byte != b'=').map_or(0, |last| last + 1));
        LENIENT.decode(digits).ok()
    })
}

/// Returns the path that a URI names: escaped or as it stands, with or without a query. The first file that exists
/// counts.
fn file(uri: &str, folder: &Path) -> PathBuf {
    let name = without_scheme(uri, "file://localhost/").map(|_| &uri["file://localhost".len()..]);
    let name = name.or_else(|| without_scheme(uri, "file://")).or_else(|| without_scheme(uri, "file:"));
    let name = name.unwrap_or(uri);
    let short = name.split(['?', '#']).next().unwrap_or_default();
    let decoded = |name: &str| String::from_utf8_lossy(&percent_decoded(name)).into_owned();
    let names = [decoded(name), name.to_owned(), decoded(short), short.to_owned()];
    let slashed = names.iter().map(|name| name.replace('\\', "/"));
    let mut paths = names.iter().cloned().chain(slashed).map(|name| folder.join(name));
    paths.find(|path| path.is_file()).unwrap_or_else(|| folder.join(&names[0]))
}

fn percent_decoded(uri: &str) -> Vec<u8> {
    let (bytes, mut decoded) = (uri.as_bytes(), Vec::with_capacity(uri.len()));
    let mut at = 0;
    while at < bytes.len() {
        let digits = bytes.get(at + 1..at + 3).filter(|digits| digits.iter().all(u8::is_ascii_hexdigit));
        let hex = digits.and_then(|digits| std::str::from_utf8(digits).ok());
        match hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) if bytes[at] == b'%' => {
                decoded.push(byte);
                at += 3;
            }
            _ => {
                decoded.push(bytes[at]);
                at += 1;
            }
        }
    }
    decoded
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(uri: &str, folder: &Path) -> String {
        match resolve(uri, folder) {
            Some(Resolved::Bytes(bytes)) => String::from_utf8(bytes).unwrap(),
            Some(Resolved::File(path)) => path.strip_prefix(folder).unwrap().to_string_lossy().into_owned(),
            None => "nothing".to_owned(),
        }
    }

    #[test]
    fn data_is_read_as_exporters_write_it() {
        for (uri, bytes) in [
            ("data:application/octet-stream;base64,PDw/Pz8+Pg==", "<<???>>"),
            ("data:image/png;base64,PDw/Pz8+Pg", "<<???>>"),
            (" DATA:;BASE64,PDw/Pz8+Pg=", "<<???>>"),
            ("data:text/plain;charset=utf-8;base64,PDw/\r\n Pz8+\tPg==", "<<???>>"),
            ("data:;base64,PDw%2FPz8%2bPg%3D%3d", "<<???>>"),
            ("data:;base64,PDw_Pz8-Pg", "<<???>>"),
            ("data:application/octet-stream,%3C%3c?%3F?>%3E", "<<???>>"),
            ("data:,100%", "100%"),
            ("data:;base64,P", "nothing"),
            ("data:;base64,P!w/", "nothing"),
            ("data:image/png;base64", "nothing"),
        ] {
            assert_eq!(found(uri, Path::new("f")), bytes, "{uri}");
        }
    }

    #[test]
    fn names_are_those_of_files_that_exist() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["50%25.png", "a b.png", "tile.png", "q?v.png", "ü.png"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        std::fs::write(folder.path().join("sub/tile.png"), "").unwrap();
        for (uri, name) in [
            ("50%25.png", "50%25.png"),
            ("a b.png", "a b.png"),
            ("a%20b.png", "a b.png"),
            ("tile%2Epng?v=3#x", "tile.png"),
            ("q?v.png", "q?v.png"),
            ("file:tile.png", "tile.png"),
            ("sub\\tile.png", "sub/tile.png"),
            ("%C3%BC.png", "ü.png"),
            ("absent%20x.png", "absent x.png"),
        ] {
            assert_eq!(found(uri, folder.path()), name, "{uri}");
        }
        let absolute = format!("file://localhost{}", folder.path().join("tile.png").display());
        assert_eq!(found(&absolute, folder.path()), "tile.png");
    }
}
