//! Numbers of text files, as C, Fortran and Windows write them.

/// Parses a number, which may be infinite or NaN in any system's spelling.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    let word = std::str::from_utf8(word).ok()?;
    word.parse().ok().or_else(|| odd_number(&word.to_ascii_lowercase()))
}

/// Parses `-nan(ind)`, `1.#QNAN`, `-1.#INF00` and the like, and exponents after a `d`.
fn odd_number(word: &str) -> Option<f64> {
    let size = word.trim_start_matches(['+', '-']);
    if ["nan", "1.#ind", "1.#qnan", "1.#snan", "1.#nan"].iter().any(|nan| size.starts_with(nan)) {
        return Some(f64::NAN);
    }
    if size.starts_with("1.#inf") {
        return Some(if word.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY });
    }
    let (digits, exponent) = word.split_once('d')?;
    format!("{digits}e{exponent}").parse().ok()
}

/// True if the `#` at position `at` is a part of a number, as in `1.#QNAN`.
pub(super) fn is_in_number(text: &[u8], at: usize) -> bool {
    let odd = [&b"ind"[..], b"inf", b"qnan", b"snan", b"nan"];
    let behind = &text[at + 1..];
    let starts = |odd: &&[u8]| behind.get(..odd.len()).is_some_and(|start| start.eq_ignore_ascii_case(odd));
    text[..at].ends_with(b"1.") && odd.iter().any(starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_system_are_read() {
        for nan in
            ["nan", "-nan", "NaN", "-nan(ind)", "nan(snan)", "1.#QNAN", "-1.#IND", "1.#SNAN00", "-1.#IND00"]
        {
            assert!(number(nan.as_bytes()).is_some_and(f64::is_nan), "{nan}");
        }
        for (word, value) in [
            ("1.#INF", f64::INFINITY),
            ("-1.#INF00", f64::NEG_INFINITY),
            ("-inf", f64::NEG_INFINITY),
            ("-1.0D0", -1.0),
            ("2d-1", 0.2),
            ("-.1e1", -1.0),
        ] {
            assert_eq!(number(word.as_bytes()), Some(value), "{word}");
        }
        for bad in ["", "x", "1,5", "1.#", "d", "1.#X", "0x10", "#"] {
            assert_eq!(number(bad.as_bytes()), None, "{bad}");
        }
    }
}
