//! Reader of Wavefront OBJ: positions, texture coordinates, normals, polygons and material groups of selected objects.
//!
//! Six numbers after `v` are a position and a colour, coded in sRGB as Blender and MeshLab write it. Colours of whole
//! numbers above 16 go up to 255. A seventh number is an opacity, which is not read. A fourth alone is a weight.
//!
//! Faces that cannot be used are left out, and named once for each reason.
//!
//! A vertex is a distinct triple of indices (position, uv, normal), numbered by first use.
//!
//! Deviations: convex polygons are fans, as in Mitsuba. `polygon` triangulates other polygons.
//!
//! Reasons against `tobj` 4.0.5:
//! - A corner without normal or texture coordinate gets the first one of the file if others have one.
//! - An index out of range is reported without its line.
//! - Reading ends at bytes that are not UTF-8, at a `vt` of one number, and at colours on some vertices.
//! - A face of two corners is no error.
//! - It splits the mesh at `o`, `g` and `usemtl`, so vertices are no longer shared and smooth normals change.

use super::encodings::{self, spellings};
use super::faults::{Fault, Faults, MAX_CODE, are_codes, note_of_codes};
use super::obj_statements::UnreadKeywords;
use super::wavefront::{is_coloured, name, numbers, shown, split_word, statements, values, words};
use super::{RawMesh, polygon};
use crate::attributes::{NamedAttribute, VERTEX_COLOUR};
use crate::colour_profile::srgb_to_linear;
use crate::error::{Location, SceneError, Warning};
use crate::selection::PartSelection;
use base::math::Rgb;
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::path::Path;

const MISSING: u32 = u32::MAX;
/// Number of vertices per position from which a hash map finds them.
const MAX_CHAIN: usize = 16;

/// Reads the selected part of the OBJ text `bytes`; `path` is for messages. `remarks` gets a warning for each keyword
/// that is not supported.
pub fn read(
    bytes: &[u8],
    path: &Path,
    selection: &PartSelection,
    remarks: &mut Vec<Warning>,
) -> Result<RawMesh, SceneError> {
    let mut reader = ObjReader::new(path, selection.only.is_empty());
    // Estimates for 30 bytes per line. They affect the speed only.
    reader.positions.reserve(bytes.len() / 100);
    reader.mesh.triangles.reserve(bytes.len() / 60);
    for (line, statement) in statements(bytes) {
        let fail = |what: String| SceneError::mesh(Location::line(path, line), what);
        reader.statement(&statement, line, selection).map_err(fail)?;
    }
    if reader.mesh.triangles.is_empty() && !selection.only.is_empty() {
        return Err(Location::file(path).undefined("object or group", &selection.only.join("\", \"")));
    }
    let (has_faces, has_normals) = (!reader.mesh.triangles.is_empty(), !reader.normals.is_empty());
    reader.unread.report(path, has_faces, has_normals, remarks);
    std::mem::take(&mut reader.faults).report(remarks);
    reader.decode_colours(remarks);
    Ok(reader.finish())
}

struct ObjReader<'a> {
    /// For messages.
    path: &'a Path,
    positions: Vec<DVec3>,
    /// Colours of the positions up to the last one that has a colour, coded.
    colours: Vec<Rgb>,
    /// Line of the first colour.
    colour_line: u32,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// First vertex of each position. `next` chains the others, which is faster than a hash map for typical files.
    first: Vec<u32>,
    /// Vertices of positions with more than `MAX_CHAIN` vertices, by position, uv and normal.
    crowded: HashMap<[u32; 3], u32>,
    vertices: Vec<ObjVertex>,
    mesh: RawMesh,
    corners: Vec<u32>,
    /// True if a number of a position, normal or texture coordinate is infinite or NaN.
    has_odd_numbers: bool,
    faults: Faults,
    /// Names by which scenes may call the current object.
    object: Vec<String>,
    /// Names of the current groups.
    groups: Vec<String>,
    /// True if the selection contains the current object or groups.
    selected: bool,
    unread: UnreadKeywords,
}

struct ObjVertex {
    position: u32,
    uv: u32,
    normal: u32,
    next: u32,
}

impl<'a> ObjReader<'a> {
    fn new(path: &'a Path, selected: bool) -> ObjReader<'a> {
        ObjReader {
            path,
            positions: Vec::new(),
            colours: Vec::new(),
            colour_line: 0,
            uvs: Vec::new(),
            normals: Vec::new(),
            first: Vec::new(),
            crowded: HashMap::new(),
            vertices: Vec::new(),
            mesh: RawMesh::default(),
            corners: Vec::new(),
            has_odd_numbers: false,
            faults: Faults::default(),
            object: Vec::new(),
            groups: Vec::new(),
            selected,
            unread: UnreadKeywords::default(),
        }
    }

    fn statement(&mut self, statement: &[u8], line: u32, selection: &PartSelection) -> Result<(), String> {
        let (word, rest) = split_word(statement);
        match word {
            b"v" => self.position(rest, line)?,
            b"vn" => {
                let normal = DVec3::from(numbers(rest)?).as_vec3();
                self.has_odd_numbers |= !normal.is_finite();
                self.normals.push(normal);
            }
            b"vt" => {
                // The second coordinate may be left out (1-D textures).
                let [u, v] =
                    numbers(rest).or_else(|e| numbers::<1>(rest).map(|[u]| [u, 0.0]).map_err(|_| e))?;
                // NaN stands for a corner without coordinates.
                let uv = Vec2::new(u as f32, v as f32);
                self.has_odd_numbers |= !uv.is_finite();
                self.uvs.push(uv.map(|x| if x.is_nan() { f32::INFINITY } else { x }));
            }
            b"f" | b"fo" => self.face(rest, line)?,
            b"usemtl" => {
                let text = encodings::text(rest.trim_ascii());
                self.mesh.groups.push((text, self.mesh.triangles.len()));
            }
            b"o" => {
                self.object = names(rest);
                self.select(selection);
            }
            b"g" => {
                self.groups = names(rest);
                self.groups.extend(words(rest).flat_map(|word| spellings(&encodings::text(word))));
                self.select(selection);
            }
            _ => self.unread.add(word, rest, line),
        }
        Ok(())
    }

    /// Reads a position, and the colour after it if there are six numbers or more.
    fn position(&mut self, rest: &[u8], line: u32) -> Result<(), String> {
        let position = DVec3::from(numbers(rest)?);
        if is_coloured(rest) {
            let [.., r, g, b] = numbers::<6>(rest)?;
            let mut colour = Rgb::new(r as f32, g as f32, b as f32);
            if !colour.is_finite() {
                self.faults.add(Fault::NoColour, || Location::line(self.path, line));
                colour = Rgb::NAN;
            }
            if self.colours.is_empty() {
                self.colour_line = line;
            }
            self.colours.resize(self.positions.len(), Rgb::NAN);
            self.colours.push(colour);
        }
        self.has_odd_numbers |= !position.is_finite();
        self.positions.push(position);
        Ok(())
    }

    /// Makes the colours linear; those that are not there become white.
    fn decode_colours(&mut self, remarks: &mut Vec<Warning>) {
        let channels = || self.colours.iter().flat_map(|colour| colour.to_array()).filter(|c| !c.is_nan());
        let most = channels().fold(0.0, f32::max);
        let mut scale = 1.0;
        if are_codes(most.into(), channels().all(|channel| channel.fract() == 0.0)) {
            remarks.push(note_of_codes(Location::line(self.path, self.colour_line)));
            scale = 1.0 / MAX_CODE as f32;
        }
        for colour in &mut self.colours {
            let linear = Rgb::from(colour.to_array().map(|code| srgb_to_linear(code * scale)));
            *colour = if colour.is_nan() { Rgb::ONE } else { linear };
        }
    }

    fn select(&mut self, selection: &PartSelection) {
        let is_in =
            |names: &[String]| names.iter().any(|n| self.object.contains(n) || self.groups.contains(n));
        self.selected = (selection.only.is_empty() || is_in(&selection.only)) && !is_in(&selection.except);
    }

    fn face(&mut self, rest: &[u8], line: u32) -> Result<(), String> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        let fault = self.corners(rest, line, &mut corners)?;
        let mut fault = fault.or((corners.len() < 3).then_some(Fault::FewCorners));
        if self.selected && fault.is_none() {
            let position = |&corner: &u32| self.positions[self.vertices[corner as usize].position as usize];
            let is_cut = polygon::cut(&corners, position, &mut self.mesh.triangles);
            fault = (!is_cut).then_some(Fault::Crossing);
        }
        if let Some(fault) = fault.filter(|_| self.selected) {
            self.faults.add(fault, || Location::line(self.path, line));
        }
        self.corners = corners;
        Ok(())
    }

    /// Reads the corners of a face; returns why it cannot be used, if so.
    fn corners(&mut self, rest: &[u8], line: u32, corners: &mut Vec<u32>) -> Result<Option<Fault>, String> {
        let path = self.path;
        let place = || Location::line(path, line);
        for token in values(rest) {
            let mut parts = token.split(|&b| b == b'/');
            let position = match index(parts.next(), self.positions.len())? {
                Index::At(position) => position,
                Index::OutOfRange => return Ok(Some(Fault::NoSuchVertex)),
                Index::Empty => return Err(format!("cannot read face corner \"{}\"", shown(token))),
            };
            let mut other = |count| match index(parts.next(), count)? {
                Index::At(at) => Ok(at),
                Index::Empty => Ok(MISSING),
                Index::OutOfRange => {
                    self.faults.add(Fault::NoSuchValue, place);
                    Ok::<u32, String>(MISSING)
                }
            };
            let uv = other(self.uvs.len())?;
            let normal = other(self.normals.len())?;
            if self.has_odd_numbers {
                if !self.positions[position as usize].is_finite() {
                    return Ok(Some(Fault::NoPosition));
                }
                if self.uvs.get(uv as usize).is_some_and(|uv| !uv.is_finite()) {
                    self.faults.add(Fault::NoUv, place);
                }
                if self.normals.get(normal as usize).is_some_and(|normal| !normal.is_finite()) {
                    self.faults.add(Fault::NoNormal, place);
                }
            }
            corners.push(self.vertex(position, uv, normal));
        }
        Ok(None)
    }

    fn vertex(&mut self, position: u32, uv: u32, normal: u32) -> u32 {
        if self.first.len() < self.positions.len() {
            self.first.resize(self.positions.len(), MISSING);
        }
        let new = self.vertices.len() as u32;
        let (mut at, mut length) = (self.first[position as usize], 0);
        while at != MISSING {
            let vertex = &self.vertices[at as usize];
            if vertex.uv == uv && vertex.normal == normal {
                return at;
            }
            (at, length) = (vertex.next, length + 1);
            if length == MAX_CHAIN {
                let known = *self.crowded.entry([position, uv, normal]).or_insert(new);
                if known == new {
                    self.vertices.push(ObjVertex { position, uv, normal, next: MISSING });
                }
                return known;
            }
        }
        self.vertices.push(ObjVertex { position, uv, normal, next: self.first[position as usize] });
        self.first[position as usize] = new;
        new
    }

    fn finish(self) -> RawMesh {
        let ObjReader { positions, colours, uvs, normals, vertices, mut mesh, .. } = self;
        mesh.positions = vertices.iter().map(|v| positions[v.position as usize]).collect();
        if vertices.iter().any(|v| v.uv != MISSING) {
            let uv = |v: &ObjVertex| uvs.get(v.uv as usize).copied().unwrap_or(Vec2::NAN);
            mesh.uvs = vertices.iter().map(uv).collect();
        }
        if !normals.is_empty() {
            // A corner without a normal gets zero, which is later replaced by the geometric normal.
            let normal = |v: &ObjVertex| normals.get(v.normal as usize).copied().unwrap_or_default();
            mesh.normals = vertices.iter().map(normal).collect();
        }
        if !colours.is_empty() {
            let colour = |v: &ObjVertex| colours.get(v.position as usize).copied().unwrap_or(Rgb::ONE);
            let colours = vertices.iter().map(colour).collect();
            mesh.attributes.push(NamedAttribute::of_vertices(VERTEX_COLOUR, colours));
        }
        mesh
    }
}

/// Returns the names by which scenes may call an object or a group.
fn names(rest: &[u8]) -> Vec<String> {
    let [all, default] = [encodings::text(rest.trim_ascii()), name(rest)];
    [all, default].iter().flat_map(|name| spellings(name)).collect()
}

/// An index of a corner, counted from 0.
enum Index {
    At(u32),
    OutOfRange,
    Empty,
}

/// Parses a one-based index, or one that counts back from the latest if negative.
fn index(token: Option<&[u8]>, count: usize) -> Result<Index, String> {
    let Some(token) = token.filter(|t| !t.is_empty()) else { return Ok(Index::Empty) };
    let text = std::str::from_utf8(token).ok();
    let value: i64 = text
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| format!("cannot read the index \"{}\"", shown(token)))?;
    let count = count as i64;
    let zero_based = if value > 0 { value - 1 } else { count.saturating_add(value) };
    if value == 0 || zero_based < 0 || zero_based >= count.min(MISSING as i64) {
        return Ok(Index::OutOfRange);
    }
    Ok(Index::At(zero_based as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<RawMesh, String> {
        read(text.as_bytes(), Path::new("t.obj"), &PartSelection::default(), &mut Vec::new())
            .map_err(|e| e.to_string())
    }

    #[test]
    fn quads_become_fans_and_vertices_are_distinct_index_triples() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1 4/1\nf 1/2 2/1 -2/-2\n";
        let mesh = read_text(text).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 1, 2]]);
        assert_eq!(mesh.positions[4], DVec3::ZERO);
        assert_eq!(mesh.uvs[4], Vec2::ONE);
        assert!(mesh.normals.is_empty());
    }

    #[test]
    fn objects_and_groups_are_chosen_by_name() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\no lamp\ng bulb glass\nf 2 3 4\ng base\nf 3 4 1\n\
            o table\nf 4 1 2\n";
        let names = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
        let count = |only: &[&str], except: &[&str]| {
            let selection = PartSelection { only: names(only), except: names(except) };
            read(text.as_bytes(), Path::new("t.obj"), &selection, &mut Vec::new())
                .map(|mesh| mesh.triangles.len())
        };
        assert_eq!(count(&[], &[]).unwrap(), 4);
        assert_eq!(count(&["lamp"], &[]).unwrap(), 2);
        assert_eq!(count(&["glass"], &[]).unwrap(), 1);
        assert_eq!(count(&["lamp"], &["bulb"]).unwrap(), 1);
        assert_eq!(count(&[], &["lamp"]).unwrap(), 2);
        let message = count(&["lamp "], &[]).unwrap_err().to_string();
        assert!(message.contains("no object or group called \"lamp \""), "{message}");
    }

    #[test]
    fn a_vertex_with_thousands_of_texture_coordinates_is_no_trouble() {
        let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
        let count = 50_000;
        (0..count).for_each(|i| text += &format!("vt {i} 0\n"));
        (1..=count).for_each(|i| text += &format!("f 1/{i} 2/1 3/1\n"));
        (1..=count).rev().for_each(|i| text += &format!("f 1/{i} 2/1 3/1\n"));
        let mesh = read_text(&text).unwrap();
        assert_eq!(mesh.positions.len(), count + 2);
        for (i, [corner, ..]) in mesh.triangles.iter().enumerate() {
            let uv = if i < count { i } else { 2 * count - 1 - i };
            assert_eq!(mesh.uvs[*corner as usize].x, uv as f32);
        }
    }

    #[test]
    fn marks_of_utf_8_and_lines_of_old_macintoshes_are_read() {
        for text in ["\u{feff}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r"] {
            assert_eq!(read_text(text).unwrap().triangles, [[0, 1, 2]]);
        }
    }

    #[test]
    fn statements_may_be_continued_and_have_comments_behind_them() {
        let text = "v 0 0 0 # first\nv 1 0 \\\n 0\nv 0 1 0#third\nvt 0 0 # corner\n# never joined \\\n\
            usemtl dark oak # wood\ng wall # a group\nf 1/1 2/1 \\\n\t3/1 # whole\nfo 3 2 1\n";
        for end in ["\n", "\r\n"] {
            let mesh = read_text(&text.replace('\n', end)).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
            assert_eq!(mesh.groups, [("dark oak # wood".to_owned(), 0)]);
            assert!(mesh.uvs[..3].iter().all(|uv| *uv == Vec2::ZERO) && mesh.uvs[3].is_nan());
        }
        let message = read_text("v 0 0 \\\n 0\n\nf 1 \\\n / # far\n").unwrap_err();
        assert!(message.contains("t.obj:4:") && message.contains("face corner"), "{message}");
    }

    #[test]
    fn vertices_defined_after_a_face_and_never_used_are_no_trouble() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 5 5 5\nv 0 0 1\r\n  f 1 2 5\t\r\n";
        let mesh = read_text(text).unwrap();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 3]]);
    }

    #[test]
    fn errors_name_the_line_and_what_is_wrong() {
        for (text, line, what) in [
            ("v 0 0\n", 1, "expected 3 numbers"),
            ("v 0 0 zero\n", 1, "\"zero\""),
            ("v 1 2 3\nf 1/x 1 1\n", 2, "index \"x\""),
            ("v 1 2 3\nf /1 1 1\n", 2, "face corner"),
        ] {
            let message = read_text(text).unwrap_err();
            assert!(message.contains(&format!("t.obj:{line}:")) && message.contains(what), "{message}");
        }
    }
}
