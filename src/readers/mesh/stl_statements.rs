//! Statements of text STL, and parts of binary STL.

use crate::statements::{Fate, Statement};

/// Colour of all faces in the header.
pub(super) const COLOR: &str = "COLOR=";
/// Material of all faces in the header.
pub(super) const MATERIAL: &str = "MATERIAL=";

const fn statement(name: &'static str, fate: Fate, note: &'static str) -> Statement {
    Statement { name, fate, note }
}

/// Statements, in the order of a file.
pub(super) const STL: &[Statement] = &[
    statement("solid", Fate::NoEffect, "begins a part, whose name ends with the line"),
    statement("#", Fate::NoEffect, "comment until the end of the line; also `//` and `;`"),
    statement("facet", Fate::Read, "triangle; facets of other numbers of corners are named"),
    statement("normal", Fate::NoEffect, "triangles are flat, and the order of their corners tells the front"),
    statement("outer", Fate::Read, "begins the corners, with `loop`"),
    statement("vertex", Fate::Read, "corner; a comma may be the decimal point"),
    statement("endloop", Fate::Read, "ends the corners; also `end loop`"),
    statement("endfacet", Fate::Read, "also `end facet`"),
    statement(
        "endsolid",
        Fate::Read,
        "also `end solid`; a text without it is named, since it may be cut off",
    ),
    statement("color", Fate::Named, "it is left out; only colours of binary files are read"),
    statement(
        "number of triangles",
        Fate::Read,
        "the triangles in the file are read; another number is named",
    ),
    statement(
        "attributes of a triangle",
        Fate::Read,
        "colour of VisCAM or SolidView, or of Magics beside `COLOR=`",
    ),
    statement(COLOR, Fate::Read, "colour of all triangles without their own (Magics)"),
    statement(MATERIAL, Fate::Named, "triangles have their colours, and are matt"),
];

/// Returns the remark on a statement.
pub(super) fn note(name: &str) -> &'static str {
    STL.iter().find(|statement| statement.name == name).map_or("it is left out", |statement| statement.note)
}

#[cfg(test)]
mod tests {
    use super::super::stl::tests::read;
    use super::*;
    use crate::statements::assert_page_lists;

    #[test]
    fn the_page_lists_the_statements() {
        assert_page_lists("STL", STL);
    }

    #[test]
    fn statements_of_texts_are_named_as_the_page_says() {
        let words = STL.iter().filter(|statement| statement.name.len() < 9 && statement.name != COLOR);
        for Statement { name, fate, .. } in words {
            let facet = "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
            let line = if *name == "vertex" { "" } else { name };
            let (mesh, said) = read(format!("solid a\n{facet}{line}\n{facet}endsolid\n").as_bytes());
            assert_eq!(mesh.triangles.len(), 2, "{name}");
            // A lone end of corners has none.
            let is_said = *fate == Fate::Named || *name == "endloop";
            assert_eq!(said.len(), usize::from(is_said), "{name}: {said:?}");
        }
    }
}
