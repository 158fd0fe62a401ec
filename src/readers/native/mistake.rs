//! Errors of the TOML parser, with the key that they concern and a remedy.

use super::source::SourceText;
use crate::error::{Location, SceneError};

/// Converts an error of the parser.
pub(super) fn error(file: SourceText, error: &toml::de::Error) -> SceneError {
    let place = error.span().map_or(Location::file(file.path), |span| file.place(span));
    let message = error.message();
    if file.text.parse::<toml::Table>().is_err() {
        return place.malformed(message);
    }
    if message.starts_with("unknown field") {
        return place.wrong(message, "correct the key, or leave it out");
    }
    if message.starts_with("missing field") {
        return place.wrong(message, "add it");
    }
    let key = error.span().and_then(|span| key_of(file.text.get(..span.start)?));
    let what = key.map_or(message.to_owned(), |key| format!("{key}: {message}"));
    place.wrong(what, "correct the value")
}

/// Returns the key of the value, or list of values, that follows `text`.
fn key_of(text: &str) -> Option<&str> {
    let mut closed = 0u32;
    let equals = text.rfind(|c| {
        match c {
            ']' | '}' => closed += 1,
            '[' | '{' => closed = closed.saturating_sub(1),
            _ => {}
        }
        c == '=' && closed == 0
    })?;
    let before = text.get(..equals)?.trim_end();
    let start = before.rfind(|c: char| !(c.is_alphanumeric() || "_-.".contains(c))).map_or(0, |i| i + 1);
    before.get(start..).filter(|key| !key.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_values_are_found_in_lists_and_tables() {
        for (text, key) in [
            ("a = 1\nresolution = ", Some("resolution")),
            ("origin = [0, ", Some("origin")),
            ("keys = [{ origin = [0, 1, 2], fov = ", Some("fov")),
            ("keys = [{ origin = [0, 1, 2] }, ", Some("keys")),
            ("[[mesh]]\n", None),
        ] {
            assert_eq!(key_of(text), key, "{text}");
        }
    }
}
