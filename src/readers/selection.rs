//! Selection of a part of a mesh file.

/// Selection of nodes, objects or groups by name, with everything below them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartSelection {
    /// Names to read; empty for everything.
    pub only: Vec<String>,
    /// Names to leave out.
    pub except: Vec<String>,
}
