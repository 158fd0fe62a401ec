//! Text for terminals: characters that would act on the terminal, or turn the direction of a text, are escaped as in
//! JSON.

use std::borrow::Cow;
use std::fmt::Write;

/// True for control characters, and for marks that turn or isolate the direction of a text.
fn acts(char: char) -> bool {
    let turns = matches!(char,
        '\u{061C}' | '\u{200E}' | '\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2066}'..='\u{2069}' | '\u{FEFF}');
    char.is_control() || turns
}

fn escaped(text: &str, acts: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&acts) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for char in text.chars() {
        match char {
            '\n' if acts(char) => shown.push_str("\\n"),
            _ if acts(char) => {
                // Writing to a String cannot fail.
                let _ = write!(shown, "\\u{:04x}", u32::from(char));
            }
            _ => shown.push(char),
        }
    }
    Cow::Owned(shown)
}

/// Returns a name or message with line ends escaped, too.
pub fn shown_line(text: &str) -> Cow<'_, str> {
    escaped(text, acts)
}

/// Returns a text of several lines. Valid JSON stays valid, with equal values.
pub fn shown(text: &str) -> Cow<'_, str> {
    escaped(text, |char| acts(char) && !matches!(char, '\n' | '\t'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_on_a_terminal_is_escaped_and_all_else_stays() {
        assert_eq!(
            shown_line("\u{1b}[2Jred\u{7}\r\n\u{9b}1m\u{202e}x\0"),
            r"\u001b[2Jred\u0007\u000d\n\u009b1m\u202ex\u0000"
        );
        assert_eq!(shown("a\tb\nc\u{1b}\n"), "a\tb\nc\\u001b\n");
        for text in ["Tür, дверь, ドア, باب, 🚪", "a\\b \"c\""] {
            assert!(matches!(shown_line(text), Cow::Borrowed(same) if same == text));
        }
    }
}
