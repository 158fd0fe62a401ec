//! Texts for users, from documentation comments.

/// Returns the first paragraph of a documentation comment, as one line without the stop at its end.
pub fn first_paragraph(doc: &str) -> String {
    let lines: Vec<&str> = doc.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    lines.join(" ").trim_end_matches('.').replace('`', "")
}
