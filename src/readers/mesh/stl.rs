//! Reader of STL: triangles without shared vertices, binary or text.
//!
//! Corners at the same position become one vertex. Normals in the file are ignored: they are those of the faces.
//!
//! Deviations: a file is binary if its length is that of the stated number of triangles, even if it begins with
//! `solid`. Of a file of another length, all triangles that are there are read. Reason against `stl_io` 0.11: it takes
//! such files, which common exporters write, for text or for broken.

use super::stl_colours::RECORD;
use super::stl_soup::SoupBuilder;
use super::{RawMesh, stl_colours, stl_text};
use crate::attributes::{FACE_COLOUR, NamedAttribute};
use crate::error::{Location, SceneError, Warning};
use scene::AttributeValues;
use std::path::Path;

/// Bytes before the number of triangles.
const HEADER: usize = 80;
/// Bytes at the start that tell a text from a binary file.
const HEAD: usize = 1024;
/// Coordinates of a triangle that the header does not count: zero, or a magnitude in this range.
const PLAUSIBLE: std::ops::Range<f32> = 1e-15..1e15;

/// Reads the STL file `bytes`; `path` is for messages. Names in `remarks` what is not read.
pub fn read(bytes: &[u8], path: &Path, remarks: &mut Vec<Warning>) -> Result<RawMesh, SceneError> {
    let mut builder = SoupBuilder::default();
    match BinaryStl::parse(bytes) {
        Some(file) => {
            file.records.iter().for_each(|record| builder.triangle(corners(record)));
            file.report(path, remarks);
            if let Some(colours) = stl_colours::of_faces(file.header, file.records) {
                let values = AttributeValues::Triangles(colours);
                builder.mesh.attributes.push(NamedAttribute { name: FACE_COLOUR.to_owned(), values });
            }
        }
        None => stl_text::read(bytes, path, &mut builder, remarks),
    }
    Ok(builder.mesh)
}

/// Returns true if the STL file `bytes` has colours of faces.
pub(crate) fn has_colours(bytes: &[u8]) -> bool {
    BinaryStl::parse(bytes).is_some_and(|file| stl_colours::of_faces(file.header, file.records).is_some())
}

/// A binary file.
struct BinaryStl<'a> {
    header: &'a [u8],
    /// Number of triangles in the header.
    stated: usize,
    /// Triangles that are read.
    records: &'a [[u8; RECORD]],
    /// Number of bytes behind them.
    behind: usize,
}

impl<'a> BinaryStl<'a> {
    /// Divides a binary file into its parts; `None` for a text.
    fn parse(bytes: &'a [u8]) -> Option<BinaryStl<'a>> {
        let (header, rest) = bytes.split_at_checked(HEADER)?;
        let (count, rest) = rest.split_first_chunk()?;
        let stated = u32::from_le_bytes(*count) as usize;
        let (records, after) = rest.as_chunks::<RECORD>();
        let is_whole = records.len() == stated && after.is_empty();
        if !is_whole && is_text(bytes) {
            return None;
        }
        let (counted, others) = records.split_at(stated.min(records.len()));
        let plausible = others.iter().take_while(|record| is_plausible(record)).count();
        let records = &records[..counted.len() + plausible];
        Some(BinaryStl { header, stated, records, behind: rest.len() - records.len() * RECORD })
    }

    /// Names a wrong number of triangles, bytes behind them, and what is not read of the colours.
    fn report(&self, path: &Path, remarks: &mut Vec<Warning>) {
        let (stated, found) = (self.stated, self.records.len());
        let mut warn = |what: String, fallback: String| {
            remarks.push(Warning::new(Location::file(path), what, fallback));
        };
        if stated != found {
            let what = format!("the header states {stated} triangles, and the file has {found}");
            warn(what, format!("{found} are read; if some are missing, download or export the file again"));
        } else if self.behind > 0 {
            warn(format!("{} bytes follow the last triangle", self.behind), "they are left out".to_owned());
        }
        stl_colours::report(self.header, self.records, path, remarks);
    }
}

/// True for a text: its first bytes are characters, or have the words of a facet.
fn is_text(bytes: &[u8]) -> bool {
    let head = bytes[..bytes.len().min(HEAD)].to_ascii_lowercase();
    let is_char = |byte: &u8| *byte >= b' ' || byte.is_ascii_whitespace();
    let has = |word: &[u8]| head.windows(word.len()).any(|part| part == word);
    head.iter().all(is_char) || has(b"facet") && has(b"vertex")
}

/// True if bytes behind the last triangle that the header counts are another one.
fn is_plausible(record: &[u8; RECORD]) -> bool {
    let is_number = |number: f32| number == 0.0 || PLAUSIBLE.contains(&number.abs());
    let normal = [0, 4, 8].map(|at| number(record, at));
    normal.iter().all(|n| n.abs() <= 1.1) && corners(record).iter().flatten().all(|&n| is_number(n))
}

/// Returns the corners of a triangle, which follow its normal.
fn corners(record: &[u8; RECORD]) -> [[f32; 3]; 3] {
    [12, 24, 36].map(|at| [number(record, at), number(record, at + 4), number(record, at + 8)])
}

fn number(record: &[u8; RECORD], at: usize) -> f32 {
    let bytes = record.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
    f32::from_le_bytes(bytes.unwrap_or_default())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const TEXT: &str = "solid ramp\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n\
        endloop\n endfacet\n facet normal 0 0 1\n outer loop\n vertex 1 0 -0\n vertex 1 1 0.5\n vertex 0 1 0\n endloop\n\
        endfacet\nendsolid ramp\n";
    const RAMP: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]],
    ];

    /// Reads a file; returns also the warnings.
    pub fn read(bytes: &[u8]) -> (RawMesh, Vec<String>) {
        let mut remarks = Vec::new();
        let mesh = super::read(bytes, Path::new("m.stl"), &mut remarks).unwrap();
        (mesh, remarks.iter().map(Warning::to_string).collect())
    }

    /// Returns the binary file of triangles with attributes.
    pub fn binary(header: &[u8], triangles: &[([[f32; 3]; 3], u16)]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for (triangle, attribute) in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
            bytes.extend(attribute.to_le_bytes());
        }
        bytes
    }

    #[test]
    fn text_and_binary_files_give_the_same_mesh_with_shared_vertices() {
        let (text, said) = read(TEXT.as_bytes());
        assert_eq!(
            (text.positions.len(), &text.triangles[..], said.len()),
            (4, &[[0, 1, 2], [1, 3, 2]][..], 0)
        );
        for header in ["made by hand", "solid of an exporter"] {
            let (mesh, said) = read(&binary(header.as_bytes(), &RAMP.map(|triangle| (triangle, 0))));
            assert_eq!((&mesh.positions, &mesh.triangles), (&text.positions, &text.triangles), "{header}");
            assert_eq!(said, [""; 0]);
        }
        assert!(read(b"").0.triangles.is_empty());
    }

    #[test]
    fn files_of_another_length_than_stated_have_the_triangles_that_are_there() {
        for header in ["", "solid part"] {
            let eight: Vec<_> = [RAMP; 4].as_flattened().iter().map(|&triangle| (triangle, 0)).collect();
            let whole = binary(header.as_bytes(), &eight);
            let stating =
                |count: u32| [&whole[..HEADER], &count.to_le_bytes(), &whole[HEADER + 4..]].concat();
            let with = |more: &[u8]| [&whole[..], more].concat();
            for (bytes, count, what) in [
                (stating(0), 8, "states 0 triangles, and the file has 8"),
                (stating(5), 8, "states 5 triangles, and the file has 8"),
                (stating(u32::MAX), 8, "states 4294967295 triangles, and the file has 8"),
                (whole[..HEADER + 4 + 3 * RECORD + 7].to_vec(), 3, "states 8 triangles, and the file has 3"),
                (whole[..HEADER + 4].to_vec(), 0, "states 8 triangles, and the file has 0"),
                (with(b"end of the file, really"), 8, "23 bytes follow the last triangle"),
                (with(&[b'e'; 2 * RECORD]), 8, "100 bytes follow the last triangle"),
            ] {
                let (mesh, said) = read(&bytes);
                assert_eq!(mesh.triangles.len(), count, "{what}");
                assert!(said.len() == 1 && said[0].contains(what), "{said:?}");
            }
        }
    }
}
