//! Reader of PLY meshes, ASCII and binary of either byte order.
//!
//! Vertices have optional normals and texture coordinates. Faces have any number of corners; `polygon` triangulates
//! them. Colours and other attributes of both are those that `ply_attributes` finds. Other elements and properties are
//! named (see `ply_statements`), and so are faces that cannot be used.
//!
//! Reasons against `ply-rs-bw` 4.0.1:
//! - Reading ends at bytes that are not UTF-8, at blank lines, and at ASCII elements over several lines.
//! - Each face is a list of its own in memory.
//! - Messages have three lines.

use super::faults::Faults;
use super::ply_contents::PlyContents;
use super::ply_header::{Format, header, line_end};
use super::ply_values::{Ascii, Binary, PlyValues};
use super::{RawMesh, ply_statements};
use crate::error::{Location, SceneError, Warning};
use std::path::Path;

/// Reads the PLY file `bytes`; `path` is for messages. Names in `remarks` what is not read.
pub fn read(bytes: &[u8], path: &Path, remarks: &mut Vec<Warning>) -> Result<RawMesh, SceneError> {
    let (header, body) =
        header(bytes).map_err(|(line, what)| SceneError::mesh(Location::line(path, line), what))?;
    remarks.extend(ply_statements::unread(&bytes[..bytes.len() - body.len()], path));
    let mut values: Box<dyn PlyValues> = match header.format {
        Format::Ascii => Box::new(Ascii { rest: body, line: header.lines, line_end: line_end(bytes) }),
        Format::LittleEndian => Box::new(Binary { rest: body, big_endian: false }),
        Format::BigEndian => Box::new(Binary { rest: body, big_endian: true }),
    };
    let mut contents =
        PlyContents { mesh: RawMesh::default(), faults: Faults::default(), has_odd: false, path };
    match contents.read(&header, values.as_mut(), remarks) {
        Ok(()) => {
            let behind = values.rest().trim_ascii().len();
            if behind > 0 {
                let what = format!("{behind} bytes follow the last element");
                let fallback = "they are left out; repair or re-export the mesh";
                remarks.push(Warning::new(contents.place(values.as_ref()), what, fallback));
            }
            contents.faults.report(remarks);
            Ok(contents.mesh)
        }
        Err(what) => Err(SceneError::mesh(contents.place(values.as_ref()), what)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use glam::{DVec3, Vec2};

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
    fn data_behind_the_last_element_is_named() {
        let said = |bytes: &[u8]| -> Vec<String> {
            let mut remarks = Vec::new();
            super::read(bytes, Path::new("t.ply"), &mut remarks).unwrap();
            remarks.iter().map(Warning::to_string).filter(|said| said.contains("follow")).collect()
        };
        let (text, binary) = (ascii(), binary(true));
        for whole in [text.as_bytes(), &binary] {
            assert_eq!((said(whole), said(&[whole, b"\n \n"].concat())), (vec![], vec![]));
            assert!(said(&[whole, b"\nmore"].concat())[0].contains("4 bytes follow the last element"));
        }
        let fewer = text.replace("element face 1", "element face 0");
        assert!(said(fewer.as_bytes())[0].contains("bytes follow the last element; they are left out"));
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
    }

    #[test]
    fn faces_that_cannot_be_used_are_left_out_and_named_once() {
        let with = |faces: &str| {
            let count = 1 + faces.lines().count();
            let text = ascii().replace("face 1", &format!("face {count}")) + faces;
            let mut remarks = Vec::new();
            let mesh = super::read(text.as_bytes(), Path::new("t.ply"), &mut remarks).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]], "{faces}");
            remarks
                .iter()
                .map(Warning::to_string)
                .filter(|said| !said.contains("not read"))
                .collect::<Vec<_>>()
        };
        for index in ["2147483648", "4294967295", "4294967298", "-1", "9", "nan", "0.5"] {
            let said = with(&format!("0 3 0 1 {index}\n0 4 0 1 2 {index}\n"));
            assert!(said.len() == 1 && said[0].contains("a vertex that does not exist: 2, here"), "{said:?}");
            assert!(said[0].starts_with("t.ply:22:"), "{said:?}");
        }
        let said = with("0 2 0 1\n0 1 0\n0 0\n");
        assert!(said.len() == 1 && said[0].contains("less than three corners: 3, here"), "{said:?}");
    }

    #[test]
    fn numbers_that_are_none_cost_only_the_faces_that_use_them() {
        for nan in ["nan", "-nan(ind)", "1.#QNAN", "inf"] {
            let text =
                ascii().replace("1 1 0 1 1\n", &format!("{nan} 1 0 1 1\n")).replace("face 1", "face 2");
            let mut remarks = Vec::new();
            let mesh =
                super::read((text + "0 3 0 1 3\n").as_bytes(), Path::new("t.ply"), &mut remarks).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 3]]);
            let said = remarks.last().unwrap().to_string();
            assert!(
                said.starts_with("t.ply:21: faces with a position that is no finite number: 1"),
                "{said}"
            );
        }
    }

    #[test]
    fn names_in_capitals_and_lines_of_old_macintoshes_are_read() {
        let text = ascii().replace("float x", "float X").replace("float y", "float Y");
        for text in [text.replace("double z", "double Z"), ascii().replace('\n', "\r")] {
            let mut remarks = Vec::new();
            let mesh = super::read(text.as_bytes(), Path::new("t.ply"), &mut remarks).unwrap();
            assert_eq!((mesh.triangles.len(), mesh.positions[2]), (2, DVec3::new(1.0, 1.0, 0.0)));
            assert_eq!(remarks.len(), 2, "{remarks:?}");
        }
    }

    #[test]
    fn colours_of_whole_numbers_above_1_go_up_to_255() {
        for kind in ["float", "int", "ushort", "double", "uchar"] {
            let colours = ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat();
            let text = format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                {colours}element face 1\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0 51 102 204\n1 0 0 0 0 0\n0 1 0 255 255 255\n3 0 1 2\n"
            );
            let mut remarks = Vec::new();
            let mesh = super::read(text.as_bytes(), Path::new("t.ply"), &mut remarks).unwrap();
            let values = mesh.attributes[0].values.all();
            assert!((values[0] - Rgb::new(0.0331, 0.1329, 0.6038)).length() < 1e-3, "{kind} {values:?}");
            assert_eq!(values[2], Rgb::ONE, "{kind}");
            assert_eq!(remarks.len(), usize::from(kind != "uchar"), "{remarks:?}");
        }
    }
}
