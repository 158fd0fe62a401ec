//! Header of a PLY file: its format, elements and properties.

use super::ply_attributes::{self, ChannelProperty, PlyAttribute, max_of_type};
use super::ply_values::{Scalar, scalar as scalar_of};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Debug)]
pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// Number of lines of the header.
    pub lines: u32,
}

#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<PlyProperty>,
}

#[derive(Debug)]
pub(super) struct PlyProperty {
    pub name: String,
    /// Type of the count, for lists.
    pub list: Option<Scalar>,
    pub scalar: Scalar,
    /// Maximum of the type, if the type is an integer.
    pub max: Option<f64>,
}

impl Element {
    /// Returns the attributes among the properties. `prefix` is that of their names.
    pub fn attributes(&self, prefix: &str) -> Vec<PlyAttribute> {
        let mut channels = Vec::with_capacity(self.properties.len());
        for PlyProperty { name, list, max, .. } in &self.properties {
            channels.push(list.is_none().then_some(ChannelProperty { name, max: *max }));
        }
        ply_attributes::attributes(prefix, &channels)
    }
}

/// Returns true if the PLY file `bytes` has colours of vertices or faces.
pub(crate) fn has_colours(bytes: &[u8]) -> bool {
    let Ok((header, _)) = header(bytes) else { return false };
    let has = |element: &Element| element.attributes("").iter().any(|attribute| attribute.name == "color");
    header.elements.iter().any(|element| matches!(element.name.as_str(), "vertex" | "face") && has(element))
}

/// Returns the last byte of the lines of a header, which end as on Unix, Windows or old Macintoshes.
pub(super) fn line_end(bytes: &[u8]) -> u8 {
    let is_old = bytes.starts_with(b"ply\r") && bytes.get(4) != Some(&b'\n');
    if is_old { b'\r' } else { b'\n' }
}

/// Parses the header; returns it and the bytes after it, or an error with its line.
pub(super) fn header(bytes: &[u8]) -> Result<(Header, &[u8]), (u32, String)> {
    let mut header = Header { format: Format::Ascii, elements: Vec::new(), lines: 0 };
    let mut format = None;
    let line_end = line_end(bytes);
    let mut rest = bytes;
    loop {
        let line_number = header.lines + 1;
        let fail = |what: &str| Err((line_number, what.to_string()));
        let Some(end) = rest.iter().position(|&b| b == line_end) else {
            return fail("the header does not end");
        };
        let line = String::from_utf8_lossy(&rest[..end]).into_owned();
        rest = &rest[end + 1..];
        header.lines = line_number;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["ply"] if line_number == 1 => {}
            _ if line_number == 1 => return fail("this is not a PLY file"),
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, _] => {
                format = Some(match name {
                    "ascii" => Format::Ascii,
                    "binary_little_endian" => Format::LittleEndian,
                    "binary_big_endian" => Format::BigEndian,
                    _ => return fail("unknown PLY format"),
                });
            }
            ["element", name, count] => {
                let Ok(count) = count.parse() else { return fail("cannot read the element's count") };
                header.elements.push(Element { name: name.into(), count, properties: Vec::new() });
            }
            ["property", ref kind @ .., name] => {
                let (list, scalar, max) = match kind[..] {
                    ["list", count, scalar] => (Some(scalar_of(count)), scalar_of(scalar), None),
                    [one] => (None, scalar_of(one), max_of_type(one)),
                    _ => return fail("cannot read the property"),
                };
                let (Some(element), Some(scalar)) = (header.elements.last_mut(), scalar) else {
                    return fail("a property without element or of unknown type");
                };
                let list = match list {
                    Some(None) => return fail("a list with a count of unknown type"),
                    Some(count) => count,
                    None => None,
                };
                element.properties.push(PlyProperty { name: name.into(), list, scalar, max });
            }
            ["end_header"] => break,
            _ => return fail("unknown line in the header"),
        }
    }
    match format {
        Some(format) => Ok((Header { format, ..header }, rest)),
        None => Err((header.lines, "the header names no format".into())),
    }
}
