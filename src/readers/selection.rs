//! Choice of a part of a mesh file.

/// Part of a file that is asked for: nodes, objects or groups by name, with all below them, but none of `except`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartSelection {
    /// Names, or none for everything.
    pub only: Vec<String>,
    pub except: Vec<String>,
}
