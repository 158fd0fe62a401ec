//! Reader of PLY meshes, ASCII and binary of either byte order.
//!
//! Vertices have optional normals and texture coordinates. Faces have any number of corners; `polygon` triangulates
//! them. Colours and other attributes of both are those that `ply_attributes` finds. Other elements and properties are
//! named (see `ply_statements`).
//!
//! Reasons against `ply-rs-bw` 4.0.1:
//! - Reading ends at bytes that are not UTF-8, at blank lines, and at ASCII elements over several lines.
//! - Each face is a list of its own in memory.
//! - Messages have three lines.

use super::ply_attributes::{self, ChannelProperty, CollectedAttributes, PlyAttribute, max_of_type};
use super::{RawMesh, ply_statements, polygon};
use crate::error::{Location, SceneError, Warning};
use glam::{DVec3, Vec2, Vec3};
use scene::AttributeValues;
use std::path::Path;

/// Reads the PLY file `bytes`; `path` is for messages. Names in `remarks` what is not read.
pub fn read(bytes: &[u8], path: &Path, remarks: &mut Vec<Warning>) -> Result<RawMesh, SceneError> {
    let (header, body) =
        header(bytes).map_err(|(line, what)| SceneError::mesh(Location::line(path, line), what))?;
    remarks.extend(ply_statements::unread(&bytes[..bytes.len() - body.len()], path));
    let mut values: Box<dyn PlyValues> = match header.format {
        Format::Ascii => Box::new(Ascii { rest: body, line: header.lines }),
        Format::LittleEndian => Box::new(Binary { rest: body, big_endian: false }),
        Format::BigEndian => Box::new(Binary { rest: body, big_endian: true }),
    };
    contents(&header, values.as_mut()).map_err(|what| match values.line() {
        Some(line) => SceneError::mesh(Location::line(path, line), what),
        None => SceneError::mesh(Location::file(path), what),
    })
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Reader of a binary number of some type.
type Scalar = fn(&mut Binary) -> Result<f64, String>;

#[derive(Debug)]
struct Header {
    format: Format,
    elements: Vec<Element>,
    /// Number of lines of the header.
    lines: u32,
}

#[derive(Debug)]
struct Element {
    name: String,
    count: u64,
    properties: Vec<PlyProperty>,
}

#[derive(Debug)]
struct PlyProperty {
    name: String,
    /// Type of the count, for lists.
    list: Option<Scalar>,
    scalar: Scalar,
    /// Maximum of the type, if the type is an integer.
    max: Option<f64>,
}

impl Element {
    /// Returns the attributes among the properties. `prefix` is that of their names.
    fn attributes(&self, prefix: &str) -> Vec<PlyAttribute> {
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

/// Parses the header; returns it and the bytes after it, or an error with its line.
fn header(bytes: &[u8]) -> Result<(Header, &[u8]), (u32, String)> {
    let mut header = Header { format: Format::Ascii, elements: Vec::new(), lines: 0 };
    let mut format = None;
    let mut rest = bytes;
    loop {
        let line_number = header.lines + 1;
        let fail = |what: &str| Err((line_number, what.to_string()));
        let Some(end) = rest.iter().position(|&b| b == b'\n') else {
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
                    ["list", count, scalar] => (Some(self::scalar(count)), self::scalar(scalar), None),
                    [one] => (None, self::scalar(one), max_of_type(one)),
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

/// Returns the reader of a type by its name.
fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => |binary| Ok(f64::from(i8::from_le_bytes(binary.take()?))),
        "uchar" | "uint8" => |binary| Ok(f64::from(u8::from_le_bytes(binary.take()?))),
        "short" | "int16" => |binary| Ok(f64::from(i16::from_le_bytes(binary.take()?))),
        "ushort" | "uint16" => |binary| Ok(f64::from(u16::from_le_bytes(binary.take()?))),
        "int" | "int32" => |binary| Ok(f64::from(i32::from_le_bytes(binary.take()?))),
        "uint" | "uint32" => |binary| Ok(f64::from(u32::from_le_bytes(binary.take()?))),
        "float" | "float32" => |binary| Ok(f64::from(f32::from_le_bytes(binary.take()?))),
        "double" | "float64" => |binary| Ok(f64::from_le_bytes(binary.take()?)),
        _ => return None,
    })
}

/// Sequence of the values after the header.
trait PlyValues {
    fn next(&mut self, scalar: Scalar) -> Result<f64, String>;
    fn line(&self) -> Option<u32> {
        None
    }

    /// Returns the number of bytes not read yet.
    fn left(&self) -> usize;
}

struct Ascii<'a> {
    rest: &'a [u8],
    line: u32,
}

impl PlyValues for Ascii<'_> {
    fn next(&mut self, _: Scalar) -> Result<f64, String> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += self.rest[..start].iter().filter(|&&b| b == b'\n').count() as u32;
        let rest = &self.rest[start..];
        let end = rest.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(rest.len());
        self.rest = &rest[end..];
        let token = String::from_utf8_lossy(&rest[..end]);
        if token.is_empty() {
            return Err("the file ends too early".into());
        }
        token.parse().map_err(|_| format!("cannot read the number \"{token}\""))
    }

    fn line(&self) -> Option<u32> {
        Some(self.line + 1)
    }

    fn left(&self) -> usize {
        self.rest.len()
    }
}

struct Binary<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl Binary<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or("the file ends too early")?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl PlyValues for Binary<'_> {
    fn next(&mut self, scalar: Scalar) -> Result<f64, String> {
        scalar(self)
    }

    fn left(&self) -> usize {
        self.rest.len()
    }
}

/// Returns the number of elements to allocate: the header's count, limited by what the remaining bytes can hold.
fn expected(element: &Element, values: &dyn PlyValues) -> usize {
    let most = values.left() / element.properties.len().max(1);
    usize::try_from(element.count).map_or(most, |count| count.min(most))
}

fn contents(header: &Header, values: &mut dyn PlyValues) -> Result<RawMesh, String> {
    let mut mesh = RawMesh::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices(element, values, &mut mesh)?,
            "face" => faces(element, values, &mut mesh)?,
            // Elements without properties have no bytes, whatever their number.
            _ if element.properties.is_empty() => {}
            _ => {
                for _ in 0..element.count {
                    for property in &element.properties {
                        property_values(property, values, |_| ())?;
                    }
                }
            }
        }
    }
    let count = mesh.positions.len();
    if let Some(bad) = mesh.triangles.iter().flatten().find(|&&i| i as usize >= count) {
        return Err(format!("a face uses vertex {bad} of {count}"));
    }
    Ok(mesh)
}

/// Reads one property of one element, and passes on each of its values.
fn property_values(
    property: &PlyProperty,
    values: &mut dyn PlyValues,
    mut each: impl FnMut(f64),
) -> Result<(), String> {
    let count = match property.list {
        Some(scalar) => {
            let count = values.next(scalar)?;
            if !(0.0..=65536.0).contains(&count) {
                return Err(format!("a list of {count} values"));
            }
            count as u32
        }
        None => 1,
    };
    for _ in 0..count {
        each(values.next(property.scalar)?);
    }
    Ok(())
}

fn vertices(element: &Element, values: &mut dyn PlyValues, mesh: &mut RawMesh) -> Result<(), String> {
    let find = |names: &[&str]| element.properties.iter().position(|p| names.contains(&p.name.as_str()));
    let triple = |names: [&str; 3]| names.map(|n| find(&[n])).into_iter().collect::<Option<Vec<_>>>();
    let position = triple(["x", "y", "z"]).ok_or("the vertices have no x, y, z")?;
    let normal = triple(["nx", "ny", "nz"]);
    let uv = [["u", "s", "texture_u"], ["v", "t", "texture_v"]].map(|names| find(&names));
    mesh.positions.reserve_exact(expected(element, values));
    let mut row = vec![0.0; element.properties.len()];
    let mut attributes = CollectedAttributes::new(element.attributes("vertex_"));
    for _ in 0..element.count {
        for (value, property) in row.iter_mut().zip(&element.properties) {
            property_values(property, values, |v| *value = v)?;
        }
        mesh.positions.push(DVec3::new(row[position[0]], row[position[1]], row[position[2]]));
        if let Some(n) = &normal {
            mesh.normals.push(Vec3::new(row[n[0]] as f32, row[n[1]] as f32, row[n[2]] as f32));
        }
        if let [Some(u), Some(v)] = uv {
            mesh.uvs.push(Vec2::new(row[u] as f32, row[v] as f32));
        }
        attributes.push(&row, 1);
    }
    mesh.attributes.extend(attributes.finish(AttributeValues::Vertices));
    Ok(())
}

fn faces(element: &Element, values: &mut dyn PlyValues, mesh: &mut RawMesh) -> Result<(), String> {
    let is_corners =
        |p: &PlyProperty| p.list.is_some() && ["vertex_index", "vertex_indices"].contains(&p.name.as_str());
    if !element.properties.iter().any(is_corners) {
        return Err("the faces have no list of vertex indices".into());
    }
    mesh.triangles.reserve(expected(element, values));
    let mut corners = Vec::new();
    let mut row = vec![0.0; element.properties.len()];
    let mut attributes = CollectedAttributes::new(element.attributes("face_"));
    for _ in 0..element.count {
        let before = mesh.triangles.len();
        for (value, property) in row.iter_mut().zip(&element.properties) {
            if !is_corners(property) {
                property_values(property, values, |v| *value = v)?;
                continue;
            }
            corners.clear();
            // Negative and fractional indices are mapped out of range.
            let index = |v: f64| if v >= 0.0 && v.fract() == 0.0 { v as u32 } else { u32::MAX };
            property_values(property, values, |v| corners.push(index(v)))?;
            if corners.len() < 3 {
                return Err(format!("a face needs three corners, this one has {}", corners.len()));
            }
            // Corners out of range are reported after reading; their position here does not matter.
            let positions = &mesh.positions;
            let position = |&corner: &u32| positions.get(corner as usize).copied().unwrap_or_default();
            polygon::cut(&corners, position, &mut mesh.triangles);
        }
        attributes.push(&row, mesh.triangles.len() - before);
    }
    mesh.attributes.extend(attributes.finish(AttributeValues::Triangles));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8], path: &Path) -> Result<RawMesh, SceneError> {
        super::read(bytes, path, &mut Vec::new())
    }

    const HEADER: &str = "ply\nformat FORMAT 1.0\ncomment made here\nelement vertex 4\nproperty float x\n\
        property float y\nproperty double z\nproperty float s\nproperty float t\nelement extra 1\n\
        property list uchar short stuff\nelement face 1\nproperty uchar flags\n\
        property list uchar int vertex_indices\nend_header\n";
    const VERTICES: [[f64; 5]; 4] =
        [[0., 0., 0., 0., 0.], [1., 0., 0., 1., 0.], [1., 1., 0., 1., 1.], [0., 1., 0.5, 0., 1.]];

    fn ascii() -> String {
        let rows: String = VERTICES.iter().map(|r| r.map(|v| v.to_string()).join(" ") + "\n").collect();
        HEADER.replace("FORMAT", "ascii") + &rows + "2 7 8\n0 4 0 1 2 3\n"
    }

    fn binary(big: bool) -> Vec<u8> {
        let mut out =
            HEADER.replace("FORMAT", if big { "binary_big_endian" } else { "binary_little_endian" });
        out.push_str("");
        let mut out = out.into_bytes();
        let mut put = |bytes: &[u8]| match big {
            true => out.extend(bytes.iter().rev()),
            false => out.extend(bytes),
        };
        for [x, y, z, s, t] in VERTICES {
            put(&(x as f32).to_le_bytes());
            put(&(y as f32).to_le_bytes());
            put(&z.to_le_bytes());
            put(&(s as f32).to_le_bytes());
            put(&(t as f32).to_le_bytes());
        }
        put(&[2]);
        put(&7i16.to_le_bytes());
        put(&8i16.to_le_bytes());
        put(&[0]);
        put(&[4]);
        (0..4).for_each(|i: i32| put(&i.to_le_bytes()));
        out
    }

    #[test]
    fn elements_without_properties_take_no_time() {
        let text =
            ascii().replace("element extra 1\n", "element nothing 18446744073709551615\nelement extra 1\n");
        assert_eq!(read(text.as_bytes(), Path::new("t.ply")).unwrap().positions.len(), 4);
    }

    #[test]
    fn more_elements_and_greater_indices_than_32_bits_hold_are_errors() {
        let error = |text: String| read(text.as_bytes(), Path::new("t.ply")).unwrap_err().to_string();
        for count in [1u64 << 31, (1 << 32) + 1, u64::MAX] {
            for element in ["element vertex 4", "element face 1"] {
                let (name, _) = element.rsplit_once(' ').unwrap();
                let message = error(ascii().replace(element, &format!("{name} {count}")));
                assert!(message.starts_with("t.ply"), "{message}");
            }
        }
        for index in ["2147483648", "4294967295", "4294967298", "-1"] {
            let message = error(ascii().replace("4 0 1 2 3", &format!("4 0 1 2 {index}")));
            assert!(message.contains("of 4"), "{message}");
        }
    }

    #[test]
    fn all_three_encodings_read_the_same() {
        let path = Path::new("t.ply");
        let from_ascii = read(ascii().as_bytes(), path).unwrap();
        assert_eq!(from_ascii.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(from_ascii.positions[3], DVec3::new(0.0, 1.0, 0.5));
        assert_eq!(from_ascii.uvs[1], Vec2::X);
        for big in [false, true] {
            let mesh = read(&binary(big), path).unwrap();
            assert_eq!((&mesh.positions, &mesh.uvs), (&from_ascii.positions, &from_ascii.uvs));
            assert_eq!(mesh.triangles, from_ascii.triangles);
        }
    }

    #[test]
    fn old_comments_and_free_lines_are_no_trouble() {
        let text = ascii().replace("made here", "fait \u{e9}t\u{e9}").replace("0 4 0 1", "\n0 4\n0 1");
        let bytes: Vec<u8> = text.chars().map(|c| c as u8).collect();
        assert_eq!(read(&bytes, Path::new("t.ply")).unwrap().triangles.len(), 2);
    }

    #[test]
    fn every_truncation_is_an_error_and_names_the_file() {
        let whole = binary(false);
        for end in 0..whole.len() {
            let message = read(&whole[..end], Path::new("t.ply")).unwrap_err().to_string();
            assert!(message.starts_with("t.ply"), "{message}");
        }
    }

    #[test]
    fn ascii_errors_name_the_line() {
        let text = ascii().replace("0 4 0 1 2 3", "0 4 0 1 2 x");
        let message = read(text.as_bytes(), Path::new("t.ply")).unwrap_err().to_string();
        assert!(message.contains("t.ply:21:") && message.contains("\"x\""), "{message}");
        let text = ascii().replace("0 4 0 1 2 3", "0 4 0 1 2 9");
        let message = read(text.as_bytes(), Path::new("t.ply")).unwrap_err().to_string();
        assert!(message.contains("vertex 9 of 4"), "{message}");
    }
}
