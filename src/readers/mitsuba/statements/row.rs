//! Rows of the tables.

use crate::statements::{Fate, Statement};

/// Makes the row of a statement that is read.
pub(super) const fn read(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Read, note }
}

/// Makes the row of a statement without effect.
pub(super) const fn idle(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::NoEffect, note }
}

/// Makes the row of a statement that is named.
pub(super) const fn named(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Named, note }
}

/// Makes the row of a statement that is refused.
pub(super) const fn refused(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Refused, note }
}
