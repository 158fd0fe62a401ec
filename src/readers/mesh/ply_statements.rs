//! Elements and properties of PLY files: those that are read, and names of those that are not.

use super::ply_attributes::{ChannelProperty, attributes};
use super::ply_header::line_end;
use crate::error::{Location, Warning};
use crate::statements::{Fate, Statement, listed, table};
use std::path::Path;

/// Names of a coordinate of a texture, of which the first in the file is read.
const UV: [[&str; 3]; 2] = [["u", "s", "texture_u"], ["v", "t", "texture_v"]];

/// Returns the elements, properties and lines of the header, as the page lists them.
fn ply() -> &'static [Statement] {
    table("PLY")
}

/// An element of a header: its line, number, and the names of its properties.
struct HeaderElement<'a> {
    line: u32,
    name: &'a str,
    count: u64,
    /// Line and name of each property, and whether it is a list.
    properties: Vec<(u32, &'a str, bool)>,
}

/// Returns a warning for each element that is not read, or that has properties that are not read.
///
/// Elements without number are left out. `header` ends before the first value.
pub(super) fn unread(header: &[u8], path: &Path) -> Vec<Warning> {
    let text = String::from_utf8_lossy(header);
    let named = |element: HeaderElement| {
        let is_of_mesh = ["vertex", "face"].contains(&element.name);
        if !is_of_mesh {
            let what = format!("the PLY element {} is not read", element.name);
            let fallback = note(element.name).unwrap_or("it is left out");
            return Some(Warning::new(Location::line(path, element.line), what, fallback));
        }
        let fates = fates(&element);
        let left: Vec<&(u32, &str, bool)> = element
            .properties
            .iter()
            .zip(fates)
            .filter(|(_, fate)| *fate == Fate::Named)
            .map(|(p, _)| p)
            .collect();
        let (line, ..) = left.first()?;
        let names: Vec<&str> = left.iter().map(|(_, name, _)| *name).collect();
        let what =
            format!("properties of the PLY element {} are not read: {}", element.name, names.join(", "));
        let fallback = names.iter().find_map(|name| note(&format!("{}.{name}", element.name)));
        Some(Warning::new(Location::line(path, *line), what, fallback.unwrap_or("they are left out")))
    };
    elements(&text).into_iter().filter(|element| element.count > 0).filter_map(named).collect()
}

/// Returns the remark of the page on a statement that is named.
fn note(name: &str) -> Option<&'static str> {
    listed(ply(), name).filter(|statement| statement.fate == Fate::Named).map(|statement| statement.note)
}

/// Parses the elements of a valid header.
fn elements(header: &str) -> Vec<HeaderElement<'_>> {
    let mut elements: Vec<HeaderElement> = Vec::new();
    let line_end = char::from(line_end(header.as_bytes()));
    for (line, text) in (1..).zip(header.split(line_end)) {
        let words: Vec<&str> = text.split_whitespace().collect();
        match (words[..].iter().as_slice(), elements.last_mut()) {
            (["element", name, count], _) => {
                let count = count.parse().unwrap_or(0);
                elements.push(HeaderElement { line, name, count, properties: Vec::new() });
            }
            (["property", kind @ .., name], Some(element)) => {
                element.properties.push((line, name, kind.first() == Some(&"list")));
            }
            _ => {}
        }
    }
    elements
}

/// Returns the fate of each property of vertices or faces.
fn fates(element: &HeaderElement) -> Vec<Fate> {
    let properties = &element.properties;
    let find = |names: &[&str]| {
        properties.iter().position(|(_, name, _)| names.iter().any(|known| known.eq_ignore_ascii_case(name)))
    };
    // Groups of properties that are read if all exist.
    let groups = [
        ["x", "y", "z"].map(|name| find(&[name])).to_vec(),
        ["nx", "ny", "nz"].map(|name| find(&[name])).to_vec(),
        UV.map(|names| find(&names)).to_vec(),
    ];
    let channels: Vec<Option<ChannelProperty>> = properties
        .iter()
        .map(|(_, name, is_list)| (!is_list).then_some(ChannelProperty { name, max: None }))
        .collect();
    let of_attributes: Vec<usize> = attributes("", &channels)
        .iter()
        .flat_map(|attribute| attribute.properties().collect::<Vec<_>>())
        .collect();
    let is_read = |at: usize| match element.name {
        _ if of_attributes.contains(&at) => true,
        "vertex" => groups.iter().any(|group| group.iter().all(Option::is_some) && group.contains(&Some(at))),
        _ => {
            let is_it = |name: &&str| name.eq_ignore_ascii_case(properties[at].1);
            properties[at].2 && ["vertex_index", "vertex_indices"].iter().any(is_it)
        }
    };
    (0..properties.len()).map(|at| if is_read(at) { Fate::Read } else { Fate::Named }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::ply;

    /// Returns the warnings about a triangle with further lines in the headers of its vertices and faces, and after.
    fn warnings([vertex, face, after]: [&str; 3], values: [&str; 3]) -> Vec<String> {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{vertex}\
             element face 1\nproperty list uchar int vertex_indices\n{face}{after}end_header\n\
             0 0 0{v}\n1 0 0{v}\n0 1 0{v}\n3 0 1 2{f}\n{a}",
            v = values[0],
            f = values[1],
            a = values[2]
        );
        let mut remarks = Vec::new();
        let mesh = ply::read(text.as_bytes(), Path::new("t.ply"), &mut remarks).unwrap();
        assert_eq!(mesh.triangles.len(), 1);
        remarks.iter().map(Warning::to_string).collect()
    }

    #[test]
    fn what_is_listed_as_named_is_named_and_what_is_read_is_not() {
        assert_eq!(warnings([""; 3], [""; 3]), [""; 0]);
        for Statement { name, fate, .. } in super::ply() {
            let found = match name.split_once('.') {
                Some(("vertex", "x")) => Vec::new(),
                Some(("vertex", "nx")) => {
                    let lines = ["nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
                    warnings([&lines, "", ""], [" 0 0 1", "", ""])
                }
                Some((element, "red")) => {
                    let lines =
                        ["red", "green", "blue"].map(|name| format!("property uchar {name}\n")).concat();
                    match element {
                        "vertex" => warnings([&lines, "", ""], [" 1 2 3", "", ""]),
                        _ => warnings(["", &lines, ""], ["", " 1 2 3", ""]),
                    }
                }
                Some(("face", "name_x")) => warnings(["", "property float name_x\n", ""], ["", " 7", ""]),
                Some(("vertex", "name_x")) => warnings(["property float name_x\n", "", ""], [" 7", "", ""]),
                Some(("vertex", first)) if *fate == Fate::Read => {
                    let second = first.replace("texture_u", "texture_v").replace('s', "t");
                    let second = if first == "u" { "v".to_owned() } else { second };
                    let lines = format!("property float {first}\nproperty float {second}\n");
                    warnings([&lines, "", ""], [" 0 1", "", ""])
                }
                Some(("vertex", name)) => {
                    warnings([&format!("property float {name}\n"), "", ""], [" 7", "", ""])
                }
                Some((_, name)) if name.starts_with("vertex_") => Vec::new(),
                Some((_, name)) => {
                    warnings(["", &format!("property list uchar float {name}\n"), ""], ["", " 1 7", ""])
                }
                None if *fate == Fate::Refused => {
                    let text = "ply\nformat ascii 1.0\nzz 1\nend_header\n";
                    assert!(ply::read(text.as_bytes(), Path::new("t.ply"), &mut Vec::new()).is_err());
                    Vec::new()
                }
                None if *fate == Fate::NoEffect => {
                    warnings(["", "", &format!("{name} made here\n")], [""; 3])
                }
                None => {
                    let lines = format!("element {name} 1\nproperty list int int vertex_indices\n");
                    assert!(warnings(["", "", &lines.replace(" 1\n", " 0\n")], [""; 3]).is_empty());
                    warnings(["", "", &lines], ["", "", "3 0 1 2\n"])
                }
            };
            let last = name.rsplit('.').next().unwrap();
            assert_eq!(found.len(), usize::from(*fate == Fate::Named), "{name}: {found:?}");
            assert!(found.iter().all(|text| text.starts_with("t.ply:") && text.contains(last)), "{found:?}");
        }
    }

    #[test]
    fn a_warning_names_all_properties_of_an_element_and_the_line_of_the_first() {
        let lines =
            "property uchar flags\nproperty float nx\nproperty float s\nproperty float t\nproperty float u\n";
        let found = warnings([lines, "", ""], [" 1 1 0 0 0", "", ""]);
        assert_eq!(
            found,
            ["t.ply:7: properties of the PLY element vertex are not read: flags, nx, u; they are left out"]
        );
    }
}
