//! Reader of STL: triangles without shared vertices, binary or text.
//!
//! Corners at the same position become one vertex. Normals in the file are ignored: they are those of the faces.
//!
//! Deviations: a file is binary if its length is that of the stated number of triangles, even if it begins with
//! `solid`. Reason against `stl_io` 0.11: it takes such files, which common exporters write, for text.

use super::RawMesh;
use crate::error::{Location, SceneError};
use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;

/// Bytes before the number of triangles.
const HEADER: usize = 80;
/// Bytes per triangle: normal, corners and two bytes of attributes.
const RECORD: usize = 50;

/// Reads the STL file `bytes`; `path` is for messages.
pub fn read(bytes: &[u8], path: &Path) -> Result<RawMesh, SceneError> {
    let mut builder = SoupBuilder::default();
    match binary_records(bytes) {
        Some(records) => records.chunks_exact(RECORD).for_each(|record| builder.record(record)),
        None => builder.text(bytes, path)?,
    }
    Ok(builder.mesh)
}

/// Returns the triangles of a binary file; `None` for a text.
fn binary_records(bytes: &[u8]) -> Option<&[u8]> {
    let count = bytes.get(HEADER..HEADER + 4)?;
    let count = u32::from_le_bytes(count.try_into().ok()?) as usize;
    let records = &bytes[HEADER + 4..];
    let is_whole = records.len() == count.checked_mul(RECORD)?;
    let is_text = bytes.trim_ascii_start().starts_with(b"solid");
    // A binary file that is cut off, or followed by other bytes, keeps its whole triangles.
    (is_whole || !is_text).then(|| &records[..records.len().min(count.saturating_mul(RECORD))])
}

#[derive(Default)]
struct SoupBuilder {
    mesh: RawMesh,
    /// Vertex at each position, by the bits of its coordinates.
    vertices: HashMap<[u32; 3], u32>,
}

impl SoupBuilder {
    fn record(&mut self, record: &[u8]) {
        let number = |at: usize| {
            let bytes = record.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
            f32::from_le_bytes(bytes.unwrap_or_default())
        };
        // The normal takes the first twelve bytes.
        let corners = [12, 24, 36].map(|at| [number(at), number(at + 4), number(at + 8)]);
        self.triangle(corners);
    }

    fn text(&mut self, bytes: &[u8], path: &Path) -> Result<(), SceneError> {
        let mut corners: Vec<[f32; 3]> = Vec::new();
        for (number, line) in super::wavefront::lines(bytes).enumerate() {
            let wrong = |what: String| SceneError::mesh(Location::line(path, number as u32 + 1), what);
            let text = String::from_utf8_lossy(line);
            let mut words = text.split_ascii_whitespace();
            match words.next().map(str::to_ascii_lowercase).as_deref() {
                Some("vertex") => {
                    let numbers: Vec<f32> = words.map_while(|word| word.parse().ok()).collect();
                    let corner = numbers
                        .try_into()
                        .map_err(|_| wrong("a vertex does not have three numbers".into()))?;
                    corners.push(corner);
                }
                Some("endloop") => match corners[..] {
                    [a, b, c] => {
                        self.triangle([a, b, c]);
                        corners.clear();
                    }
                    _ => return Err(wrong(format!("a facet has {} corners, not three", corners.len()))),
                },
                Some("solid" | "facet" | "outer" | "endfacet" | "endsolid") | None => {}
                Some(word) => return Err(wrong(format!("\"{word}\" is not a statement of STL files"))),
            }
        }
        Ok(())
    }

    fn triangle(&mut self, corners: [[f32; 3]; 3]) {
        let triangle = corners.map(|corner| {
            // Both zeros are one position.
            let key = corner.map(|coordinate| (coordinate + 0.0).to_bits());
            *self.vertices.entry(key).or_insert_with(|| {
                self.mesh.positions.push(DVec3::from(corner.map(f64::from)));
                self.mesh.positions.len() as u32 - 1
            })
        });
        self.mesh.triangles.push(triangle);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid ramp\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n\
        endloop\n endfacet\n facet normal 0 0 1\n outer loop\n vertex 1 0 -0\n vertex 1 1 0.5\n vertex 0 1 0\n endloop\n\
        endfacet\nendsolid ramp\n";

    fn read(bytes: &[u8]) -> Result<RawMesh, String> {
        super::read(bytes, Path::new("m.stl")).map_err(|error| error.to_string())
    }

    /// Returns the binary file of triangles, with a header.
    fn binary(header: &str, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.as_bytes().to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_files_give_the_same_mesh_with_shared_vertices() {
        let text = read(TEXT.as_bytes()).unwrap();
        assert_eq!((text.positions.len(), &text.triangles[..]), (4, &[[0, 1, 2], [1, 3, 2]][..]));
        let triangles = [
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            [[1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]],
        ];
        for header in ["made by hand", "solid of an exporter"] {
            let mesh = read(&binary(header, &triangles)).unwrap();
            assert_eq!((&mesh.positions, &mesh.triangles), (&text.positions, &text.triangles), "{header}");
        }
        // A file that is cut off keeps its first triangle.
        let cut = &binary("", &triangles)[..HEADER + 4 + RECORD + 7];
        assert_eq!(read(cut).unwrap().triangles.len(), 1);
    }

    #[test]
    fn damaged_texts_are_errors_with_their_line() {
        for (from, to, line) in
            [("vertex 1 0 0", "vertex 1 0", 5), ("vertex 0 1 0\nendloop", "endloop", 6), ("facet", "face", 2)]
        {
            let error = read(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(error.starts_with(&format!("m.stl:{line}: ")), "{error}");
        }
        assert!(read(b"").unwrap().triangles.is_empty());
    }
}
