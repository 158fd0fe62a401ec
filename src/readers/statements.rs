//! Fates of the statements of a format: each is read, named or refused.
//!
//! Each reader lists its statements. The page `docs/formats.md` has one table for each list, and a test holds the two
//! against each other.

/// Fate of a statement in a reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    /// The image follows the statement.
    Read,
    /// The image does not depend on the statement, so nothing is said.
    NoEffect,
    /// A warning names the statement and what stands in; an error under `--strict`.
    Named,
    /// An error names the statement.
    #[allow(dead_code)]
    Refused,
}

/// A keyword, property, extension, plugin or channel of a format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Statement {
    /// Name in the file.
    pub name: &'static str,
    /// Fate in the reader.
    pub fate: Fate,
    /// Meaning, or what stands in, in a few words.
    pub note: &'static str,
}

/// Returns the fate of the statement `name`; a statement that is not listed is named.
pub(crate) fn fate(statements: &[Statement], name: &str) -> Fate {
    statements.iter().find(|statement| statement.name == name).map_or(Fate::Named, |found| found.fate)
}

/// Fails unless the table under `heading` of `docs/formats.md` is that of the statements.
#[cfg(test)]
pub(crate) fn assert_page_lists(heading: &str, statements: &[Statement]) {
    const PAGE: &str = include_str!("../../docs/formats.md");
    let word = |fate| match fate {
        Fate::Read => "read",
        Fate::NoEffect => "no effect",
        Fate::Named => "named",
        Fate::Refused => "refused",
    };
    let row = |s: &Statement| format!("| `{}` | {} | {} |\n", s.name, word(s.fate), s.note);
    let table: String = statements.iter().map(row).collect();
    let from = PAGE.find(&format!("\n## {heading}\n")).unwrap_or_else(|| panic!("no heading \"{heading}\""));
    let section = PAGE[from + 4..].split("\n## ").next().unwrap();
    let rows: String =
        section.lines().filter(|line| line.starts_with("| `")).map(|line| format!("{line}\n")).collect();
    assert!(rows == table, "the table of {heading} in docs/formats.md should have these rows:\n{table}");
}
