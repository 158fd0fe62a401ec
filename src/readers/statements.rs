//! Fates of the statements of a format: each is read, named or refused.
//!
//! The tables of the page `docs/formats.md` are the lists. Tests of the readers hold the readers to them.

use std::sync::LazyLock;

const PAGE: &str = include_str!("../../docs/formats.md");

/// Tables of the page with their headings.
static TABLES: LazyLock<Vec<(&str, Vec<Statement>)>> = LazyLock::new(|| {
    let sections = PAGE.split("\n## ").filter_map(|section| section.split_once('\n'));
    sections.map(|(heading, text)| (heading, text.lines().filter_map(parse).collect())).collect()
});

/// Fate of a statement in a reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    /// The image follows the statement.
    Read,
    /// The image does not depend on the statement, so nothing is said.
    NoEffect,
    /// A warning names the statement and what is used instead; an error under `--strict`.
    Named,
    /// An error names the statement.
    Refused,
}

/// A keyword, property, extension, plugin or channel of a format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Statement {
    /// Name in the file.
    pub name: &'static str,
    /// Fate in the reader.
    pub fate: Fate,
    /// Meaning, or what is used instead, in a few words.
    pub note: &'static str,
}

/// Returns the statements under a heading of the page.
pub(crate) fn table(heading: &str) -> &'static [Statement] {
    let statements = TABLES.iter().find(|(title, _)| *title == heading).map_or(&[][..], |(_, table)| table);
    debug_assert!(!statements.is_empty(), "docs/formats.md has no table \"{heading}\"");
    statements
}

/// Returns the statement `name` of a table.
pub(crate) fn listed(statements: &'static [Statement], name: &str) -> Option<&'static Statement> {
    statements.iter().find(|statement| statement.name == name)
}

/// Returns the note on the statement `name`, which says what is used instead of a named one.
pub(crate) fn note(statements: &'static [Statement], name: &str) -> &'static str {
    listed(statements, name).map_or("it is left out", |statement| statement.note)
}

/// Returns the fate of the statement `name`; a statement that is not listed is named.
pub(crate) fn fate(statements: &'static [Statement], name: &str) -> Fate {
    listed(statements, name).map_or(Fate::Named, |statement| statement.fate)
}

/// Parses a line of the page: a row of name, fate and note.
fn parse(line: &'static str) -> Option<Statement> {
    let mut cells = line.strip_prefix("| `")?.strip_suffix(" |")?.splitn(3, " | ");
    let name = cells.next()?.strip_suffix('`')?;
    let fate = match cells.next()? {
        "read" => Fate::Read,
        "no effect" => Fate::NoEffect,
        "named" => Fate::Named,
        "refused" => Fate::Refused,
        _ => return None,
    };
    Some(Statement { name, fate, note: cells.next()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_of_the_page_is_a_statement_of_its_own() {
        for line in PAGE.lines().filter(|line| line.starts_with("| `")) {
            assert!(parse(line).is_some(), "{line}");
        }
        for (heading, table) in TABLES.iter() {
            for (at, row) in table.iter().enumerate() {
                assert!(listed(&table[..at], row.name).is_none(), "{} twice under {heading}", row.name);
            }
        }
        let last = table("OBJ").last().unwrap();
        assert_eq!(
            (last.name, last.fate, last.note),
            ("end", Fate::NoEffect, "end of a free-form curve or surface")
        );
    }
}
