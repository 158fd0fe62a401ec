//! Reader of Wavefront OBJ: positions, texture coordinates, normals, polygons and material groups of selected objects.
//!
//! Six numbers after `v` are a position and a colour, coded in sRGB as Blender and MeshLab write it. A seventh is an
//! opacity, which is not read. A fourth alone is a weight.
//!
//! A vertex is a distinct triple of indices (position, uv, normal), numbered by first use. Lines, points, curves and
//! smoothing groups are ignored.
//!
//! Deviations: convex polygons are fans, as in Mitsuba. `polygon` triangulates other polygons.
//!
//! Reasons against `tobj` 4.0.5:
//! - A corner without normal or texture coordinate gets the first one of the file if others have one.
//! - An index out of range is reported without its line.
//! - Reading ends at bytes that are not UTF-8, at a `vt` of one number, and at colours on some vertices.
//! - A face of two corners is no error.
//! - It splits the mesh at `o`, `g` and `usemtl`, so vertices are no longer shared and smooth normals change.

use super::{RawMesh, polygon};
use crate::attributes::{NamedAttribute, VERTEX_COLOUR, reorder};
use crate::decode::srgb_to_linear;
use crate::error::{Location, SceneError};
use crate::selection::PartSelection;
use base::math::Rgb;
use glam::{DVec3, Vec2, Vec3};
use scene::AttributeValues;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::path::Path;

const MISSING: u32 = u32::MAX;
/// Number of vertices per position from which a hash map finds them.
const MAX_CHAIN: usize = 16;

/// Reads the selected part of the OBJ text `bytes`; `path` is for messages.
pub fn read(bytes: &[u8], path: &Path, selection: &PartSelection) -> Result<RawMesh, SceneError> {
    let mut reader = Reader { selected: selection.only.is_empty(), ..Reader::default() };
    // Estimates for 30 bytes per line. They affect the speed only.
    reader.positions.reserve(bytes.len() / 100);
    reader.mesh.triangles.reserve(bytes.len() / 60);
    for (number, line) in lines(bytes).enumerate() {
        let fail = |what: String| SceneError::mesh(Location::line(path, number as u32 + 1), what);
        reader.line(line, selection).map_err(fail)?;
    }
    if reader.mesh.triangles.is_empty() && !selection.only.is_empty() {
        return Err(Location::file(path).undefined("object or group", &selection.only.join("\", \"")));
    }
    Ok(reader.finish())
}

/// Returns the lines of a text without its byte-order mark. Lines end as on Unix, Windows or old Macintoshes.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    bytes.split(move |&b| b == end)
}

/// Returns the `mtllib` names of the OBJ text `bytes`, in order.
pub(crate) fn material_libraries(bytes: &[u8]) -> Vec<String> {
    let lines = lines(bytes).filter(|l| l.starts_with(b"mtllib"));
    lines.map(|l| String::from_utf8_lossy(&l[6..]).trim().to_owned()).filter(|n| !n.is_empty()).collect()
}

/// Returns the names of the materials that the faces of the OBJ text `bytes` use.
pub(crate) fn used_materials(bytes: &[u8]) -> BTreeSet<String> {
    let lines = lines(bytes).filter_map(|line| line.trim_ascii().strip_prefix(b"usemtl"));
    lines.map(|name| String::from_utf8_lossy(name).trim().to_owned()).collect()
}

/// Returns true if a position in the OBJ text `bytes` has a colour.
pub(crate) fn has_colours(bytes: &[u8]) -> bool {
    lines(bytes).any(|line| {
        let line = line.trim_ascii();
        line.starts_with(b"v") && line.get(1).is_some_and(u8::is_ascii_whitespace) && is_coloured(&line[1..])
    })
}

/// Returns true if the numbers of a position have a colour after them.
fn is_coloured(rest: &[u8]) -> bool {
    rest.split(|b| b.is_ascii_whitespace()).filter(|token| !token.is_empty()).count() >= 6
}

#[derive(Default)]
struct Reader {
    positions: Vec<DVec3>,
    /// Colours of the positions up to the last one that has a colour.
    colours: Vec<Rgb>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// First vertex of each position. `next` chains the others, which is faster than a hash map for typical files.
    first: Vec<u32>,
    /// Vertices of positions with more than `MAX_CHAIN` vertices, by position, uv and normal.
    crowded: HashMap<[u32; 3], u32>,
    vertices: Vec<ObjVertex>,
    mesh: RawMesh,
    corners: Vec<u32>,
    /// Name of the current object.
    object: String,
    /// Names of the current groups.
    groups: Vec<String>,
    /// True if the selection contains the current object or groups.
    selected: bool,
}

struct ObjVertex {
    position: u32,
    uv: u32,
    normal: u32,
    next: u32,
}

impl Reader {
    fn line(&mut self, line: &[u8], selection: &PartSelection) -> Result<(), String> {
        let line = line.trim_ascii();
        let word_end = line.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(line.len());
        let (word, rest) = line.split_at(word_end);
        match word {
            b"v" => self.position(rest)?,
            b"vn" => self.normals.push(DVec3::from(numbers(rest)?).as_vec3()),
            b"vt" => {
                // The second coordinate may be left out (1-D textures).
                let [u, v] =
                    numbers(rest).or_else(|e| numbers::<1>(rest).map(|[u]| [u, 0.0]).map_err(|_| e))?;
                self.uvs.push(Vec2::new(u as f32, v as f32));
            }
            b"f" => self.face(rest)?,
            b"usemtl" => {
                let name = String::from_utf8_lossy(rest).trim().to_owned();
                self.mesh.groups.push((name, self.mesh.triangles.len()));
            }
            b"o" => {
                self.object = String::from_utf8_lossy(rest).trim().to_owned();
                self.select(selection);
            }
            b"g" => {
                let names = String::from_utf8_lossy(rest);
                self.groups = names.split_whitespace().map(str::to_owned).collect();
                self.select(selection);
            }
            _ => {}
        }
        Ok(())
    }

    /// Reads a position, and the colour after it if there are six numbers or more.
    fn position(&mut self, rest: &[u8]) -> Result<(), String> {
        let [x, y, z] = numbers(rest)?;
        if is_coloured(rest) {
            let [.., r, g, b] = numbers::<6>(rest)?;
            self.colours.resize(self.positions.len(), Rgb::ONE);
            self.colours.push(Rgb::from([r, g, b].map(|code| srgb_to_linear(code as f32))));
        }
        self.positions.push(DVec3::new(x, y, z));
        Ok(())
    }

    fn select(&mut self, selection: &PartSelection) {
        let is_in = |names: &[String]| names.iter().any(|n| *n == self.object || self.groups.contains(n));
        self.selected = (selection.only.is_empty() || is_in(&selection.only)) && !is_in(&selection.except);
    }

    fn face(&mut self, rest: &[u8]) -> Result<(), String> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for token in rest.split(|b| b.is_ascii_whitespace()).filter(|t| !t.is_empty()) {
            let mut parts = token.split(|&b| b == b'/');
            let position = index(parts.next(), self.positions.len(), "vertex")?;
            if position == MISSING {
                return Err(format!("cannot read face corner \"{}\"", String::from_utf8_lossy(token)));
            }
            let uv = index(parts.next(), self.uvs.len(), "texture coordinate")?;
            let normal = index(parts.next(), self.normals.len(), "normal")?;
            corners.push(self.vertex(position, uv, normal));
        }
        if corners.len() < 3 {
            return Err(format!("a face needs three corners, this one has {}", corners.len()));
        }
        if self.selected {
            let position = |&corner: &u32| self.positions[self.vertices[corner as usize].position as usize];
            polygon::cut(&corners, position, &mut self.mesh.triangles);
        }
        self.corners = corners;
        Ok(())
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
        let Reader { positions, colours, uvs, normals, vertices, mut mesh, .. } = self;
        mesh.positions = vertices.iter().map(|v| positions[v.position as usize]).collect();
        if vertices.iter().any(|v| v.uv != MISSING) {
            mesh.uvs = vertices.iter().map(|v| uvs.get(v.uv as usize).copied().unwrap_or_default()).collect();
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

/// Splits the mesh at its material groups, by first use. The name before the first `usemtl` is empty.
pub(crate) fn split_by_material(raw: RawMesh) -> Vec<(String, RawMesh)> {
    let mut names: Vec<String> = Vec::new();
    let mut of_name: HashMap<String, usize> = HashMap::new();
    let mut parts: Vec<Vec<Range<usize>>> = Vec::new();
    let mut groups = raw.groups.clone();
    groups.insert(0, (String::new(), 0));
    for (g, (name, start)) in groups.iter().enumerate() {
        let end = groups.get(g + 1).map_or(raw.triangles.len(), |next| next.1);
        if *start == end {
            continue;
        }
        let part = *of_name.entry(name.clone()).or_insert_with(|| {
            names.push(name.clone());
            parts.push(Vec::new());
            names.len() - 1
        });
        parts[part].push(*start..end);
    }
    names.into_iter().zip(parts).map(|(name, ranges)| (name, with_used_vertices(&raw, &ranges))).collect()
}

/// Returns the mesh of ranges of the triangles of `raw` with the vertices that they use. The reader guarantees that
/// indices are in range.
fn with_used_vertices(raw: &RawMesh, ranges: &[Range<usize>]) -> RawMesh {
    let mut triangles: Vec<[u32; 3]> = chosen(&raw.triangles, ranges);
    let mut used = Vec::new();
    let mut renumbered = vec![MISSING; raw.positions.len()];
    let mut part = RawMesh::default();
    for i in triangles.iter_mut().flatten() {
        let old = *i as usize;
        if renumbered[old] == MISSING {
            renumbered[old] = part.positions.len() as u32;
            used.push(*i);
            part.positions.push(raw.positions[old]);
            part.uvs.extend(raw.uvs.get(old));
            part.normals.extend(raw.normals.get(old));
            part.tangents.extend(raw.tangents.get(old));
        }
        *i = renumbered[old];
    }
    part.triangles = triangles;
    part.attributes = raw.attributes.clone();
    reorder(&mut part.attributes, &used);
    for attribute in &mut part.attributes {
        if let AttributeValues::Triangles(values) = &mut attribute.values {
            *values = chosen(values, ranges);
        }
    }
    part
}

/// Returns the values in some ranges.
fn chosen<T: Clone>(values: &[T], ranges: &[Range<usize>]) -> Vec<T> {
    ranges.iter().flat_map(|range| values[range.clone()].iter().cloned()).collect()
}

/// Parses the first `N` numbers of a line. Further ones are ignored.
pub(super) fn numbers<const N: usize>(rest: &[u8]) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    let mut tokens = rest.split(|b| b.is_ascii_whitespace()).filter(|t| !t.is_empty());
    for value in &mut values {
        let token = tokens.next().ok_or_else(|| format!("expected {N} numbers"))?;
        let text = std::str::from_utf8(token).ok();
        let bad = || format!("cannot read the number \"{}\"", String::from_utf8_lossy(token));
        *value = text.and_then(|t| t.parse().ok()).ok_or_else(bad)?;
    }
    Ok(values)
}

/// Parses a one-based index, or one that counts back from the latest if negative; `MISSING` for an empty one.
fn index(token: Option<&[u8]>, count: usize, what: &str) -> Result<u32, String> {
    let Some(token) = token.filter(|t| !t.is_empty()) else { return Ok(MISSING) };
    let text = String::from_utf8_lossy(token);
    let value: i64 = text.parse().map_err(|_| format!("cannot read the index \"{text}\""))?;
    let count = count as i64;
    let zero_based = if value > 0 { value - 1 } else { count + value };
    if value == 0 || zero_based < 0 || zero_based >= count.min(MISSING as i64) {
        return Err(format!("{what} {value} does not exist: {count} are defined so far"));
    }
    Ok(zero_based as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<RawMesh, String> {
        read(text.as_bytes(), Path::new("t.obj"), &PartSelection::default()).map_err(|e| e.to_string())
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
            read(text.as_bytes(), Path::new("t.obj"), &selection).map(|mesh| mesh.triangles.len())
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
    fn vertices_defined_after_a_face_and_never_used_are_no_trouble() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 5 5 5\nv 0 0 1\r\n  f 1 2 5\t\r\n";
        let mesh = read_text(text).unwrap();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 3]]);
    }

    #[test]
    fn errors_name_the_line_and_what_is_wrong() {
        for (text, line, what) in [
            ("v 0 0 0\nf 1 1 2\n", 2, "vertex 2 does not exist"),
            ("v 0 0\n", 1, "expected 3 numbers"),
            ("v 0 0 zero\n", 1, "\"zero\""),
            ("\n\nv 1 2 3\nf 1 1\n", 4, "three corners"),
            ("v 1 2 3\nf 1/1 1 1\n", 2, "texture coordinate 1"),
            ("v 1 2 3\nf 0 1 1\n", 2, "vertex 0"),
            ("v 1 2 3\nf /1 1 1\n", 2, "face corner"),
        ] {
            let message = read_text(text).unwrap_err();
            assert!(message.contains(&format!("t.obj:{line}:")) && message.contains(what), "{message}");
        }
    }

    #[test]
    fn material_groups_split_the_mesh_and_share_nothing() {
        let text = "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl x\nf 1 2 4\nusemtl y\nusemtl x\nf 2 3 4\n";
        assert_eq!(material_libraries(text.as_bytes()), ["a b.mtl"]);
        let parts = split_by_material(read_text(text).unwrap());
        let names: Vec<_> =
            parts.iter().map(|p| (p.0.as_str(), p.1.triangles.len(), p.1.positions.len())).collect();
        assert_eq!(names, [("", 1, 3), ("x", 2, 4)]);
    }
}
