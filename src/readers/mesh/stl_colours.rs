//! Colours of the faces of binary STL, in the two bytes behind each triangle.
//!
//! - Materialise Magics: the header has `COLOR=` and the colour of all faces in four bytes. Bit 15 of a face means that
//!   colour. Else the face has its own: red in bits 0 to 4, then green and blue.
//! - VisCAM and SolidView: bit 15 means that the face has a colour: blue in bits 0 to 4, then green and red.
//!
//! Codes are sRGB. Other programs leave the bytes as they are, or number faces in them. So the bytes are colours
//! without `COLOR=` only if each is 0 or has bit 15, and not all are 0x8000 or 0xFFFF.

use crate::colour_profile::srgb_to_linear;
use crate::error::{Location, Severity, Warning};
use crate::statements::{note, table};
use base::math::Rgb;
use std::path::Path;

/// Colour of all faces in the header.
const COLOR: &str = "COLOR=";
/// Material of all faces in the header.
const MATERIAL: &str = "MATERIAL=";
/// Bytes per triangle: normal, corners and two bytes of attributes.
pub const RECORD: usize = 50;
/// Bit that all writers know.
const BIT: u16 = 0x8000;
/// Linear colour of faces without one: that of meshes without a material.
const GREY: f32 = 0.5;

/// Returns the colour of each face, if the file has colours.
pub fn of_faces(header: &[u8], records: &[[u8; RECORD]]) -> Option<Vec<Rgb>> {
    if let Some([r, g, b, _]) = behind(header, COLOR) {
        let of_all = Rgb::from([r, g, b].map(|code: u8| srgb_to_linear(f32::from(code) / 255.0)));
        let is_bare = codes(records).all(|code| code == 0);
        let colour = |code: u16| {
            if is_bare || code & BIT != 0 { of_all } else { five_bits([code, code >> 5, code >> 10]) }
        };
        return Some(codes(records).map(colour).collect());
    }
    let is_filler = [0, BIT, u16::MAX].iter().any(|&filler| codes(records).all(|code| code == filler));
    if is_filler || codes(records).any(is_foreign) {
        return None;
    }
    let colour = |code: u16| match code {
        0 => Rgb::splat(GREY),
        _ => five_bits([code >> 10, code >> 5, code]),
    };
    Some(codes(records).map(colour).collect())
}

/// Names what is not read.
pub fn report(header: &[u8], records: &[[u8; RECORD]], path: &Path, remarks: &mut Vec<Warning>) {
    let mut warn = |what: &str, fallback: &str| {
        remarks.push(Warning::new(Location::file(path), what, fallback));
    };
    let colour = behind(header, COLOR);
    if colour.is_some_and(|[.., alpha]: [u8; 4]| !matches!(alpha, 0 | 255)) {
        warn("the opacity of COLOR= is not read", "the mesh is opaque");
    }
    // Bytes that are all equal are filled in by writers that have no material.
    if behind(header, MATERIAL).is_some_and(|bytes: [u8; 12]| bytes.iter().any(|byte| *byte != bytes[0])) {
        warn("MATERIAL= is not read", note(table("STL"), MATERIAL));
    }
    if colour.is_none() && codes(records).any(is_foreign) {
        remarks.push(Warning {
            severity: Severity::Note,
            ..Warning::new(
                Location::file(path),
                "the attributes of triangles are no colours",
                "they are left out",
            )
        });
    }
}

/// Returns the bytes behind a word of the header.
fn behind<const N: usize>(header: &[u8], word: &str) -> Option<[u8; N]> {
    let at = header.windows(word.len()).position(|part| part == word.as_bytes())?;
    header.get(at + word.len()..)?.first_chunk().copied()
}

/// Returns the attribute of each triangle.
fn codes(records: &[[u8; RECORD]]) -> impl Iterator<Item = u16> {
    records.iter().map(|record| u16::from_le_bytes([record[RECORD - 2], record[RECORD - 1]]))
}

/// True for an attribute that is no colour of VisCAM.
fn is_foreign(code: u16) -> bool {
    code != 0 && code & BIT == 0
}

fn five_bits(channels: [u16; 3]) -> Rgb {
    Rgb::from(channels.map(|channel| srgb_to_linear(f32::from(channel & 31) / 31.0)))
}

#[cfg(test)]
mod tests {
    use super::super::stl::tests::{binary, read};
    use super::*;
    use scene::AttributeValues;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// Returns the colours of the faces of a file with attributes, and the warnings.
    fn colours(header: &[u8], codes: &[u16]) -> (Vec<Rgb>, Vec<String>) {
        let file = binary(header, &codes.iter().map(|&code| (TRIANGLE, code)).collect::<Vec<_>>());
        let (mesh, said) = read(&file);
        let colours = match mesh.attributes.first().map(|attribute| &attribute.values) {
            Some(AttributeValues::Triangles(values)) => values.clone(),
            _ => Vec::new(),
        };
        assert_eq!(super::super::stl::has_colours(&file), !colours.is_empty());
        (colours, said)
    }

    #[test]
    fn faces_have_the_colours_of_both_kinds_of_writers() {
        // 28 of 31 and 2 of 31, by the standard's formula in f64.
        let (high, low) = (0.793811, 0.005371);
        let is = |found: Rgb, expected: [f32; 3]| (found - Rgb::from(expected)).length() < 1e-4;
        let (found, said) = colours(b"by a viewer", &[0xF042, 0x8B82, 0x885C, 0]);
        assert!(is(found[0], [high, low, low]) && is(found[1], [low, high, low]), "{found:?}");
        assert!(is(found[2], [low, low, high]) && is(found[3], [0.5; 3]), "{found:?}");
        assert_eq!(said, [""; 0]);
        let header = b"COLOR=\xFF\xFF\xFF\xFF,MATERIAL=\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF";
        let (found, said) = colours(header, &[0x085C, 0x0B82, 0x8000]);
        assert!(is(found[0], [high, low, low]) && is(found[1], [low, high, low]), "{found:?}");
        assert_eq!((found[2], said.len()), (Rgb::ONE, 0));
        for code in [0x8000, 0xFFFF, 0] {
            let (found, _) = colours(b"COLOR=\xE0\x10\x10\xFF", &[code; 2]);
            assert!(is(found[1], [0.745404, 0.005182, 0.005182]), "{found:?}");
        }
    }

    #[test]
    fn attributes_that_are_no_colours_paint_nothing() {
        for codes in [[0; 3], [0x8000; 3], [0xFFFF; 3]] {
            assert_eq!(colours(b"", &codes), (Vec::new(), Vec::new()));
        }
        for codes in [[1, 2, 3], [0x8001, 0x1234, 0], [7; 3]] {
            let (found, said) = colours(b"", &codes);
            assert!(found.is_empty() && said.len() == 1 && said[0].contains("are no colours"), "{said:?}");
        }
        let header = b"COLOR=\x01\x02\x03\x80MATERIAL=\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0A\x0B\x0C";
        let (_, said) = colours(header, &[0x8000]);
        assert!(said.len() == 2 && said[0].contains("opacity") && said[1].contains("MATERIAL="), "{said:?}");
    }
}
