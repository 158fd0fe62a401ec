//! Faults, colours and names of OBJ files.

use super::RawMesh;
use super::obj::read;
use crate::error::Warning;
use crate::selection::PartSelection;
use base::math::Rgb;
use std::path::Path;

/// Returns the mesh of a unit square with more lines behind it, and the remarks.
fn square_and(more: &str) -> (RawMesh, Vec<String>) {
    let text = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n{more}");
    let mut remarks = Vec::new();
    let mesh = read(text.as_bytes(), Path::new("t.obj"), &PartSelection::default(), &mut remarks);
    (mesh.unwrap(), remarks.iter().map(Warning::to_string).collect())
}

#[test]
fn faces_that_cannot_be_used_are_left_out_and_named_once() {
    for (more, said) in [
        ("f 1 2\nf 3\nf\n", "t.obj:6: faces of less than three corners: 3, here the first"),
        ("f 1 2 9\nf 0 1 2\nf 1 2 -9", "t.obj:6: faces with a vertex that does not exist: 3, "),
        ("v nan 0 0\nf 1 2 5\nf 1 2 5", "t.obj:7: faces with a position that is no finite number: 2, "),
        ("v -nan(ind) 0 1.#INF\nf 5 2 1 # 5", "t.obj:7: faces with a position that is no finite number: 1, "),
    ] {
        let (mesh, remarks) = square_and(more);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]], "{more}");
        assert!(remarks.len() == 1 && remarks[0].starts_with(said), "{remarks:?}");
    }
    for unused in ["v -nan(ind) 0 0\n", "vn 1.#QNAN 0 0\n", "vt nan\n"] {
        assert_eq!(square_and(unused).1, [""; 0], "{unused}");
    }
}

#[test]
fn values_of_corners_that_cannot_be_used_are_named_and_the_face_stays() {
    for (more, said) in [
        (
            "f 1/1 2 3\nf 1//7 2 3",
            "t.obj:6: corners with a texture coordinate or normal that does not exist: 2",
        ),
        ("vn -1.#IND 0 0\nf 1//1 2 3", "t.obj:7: corners with a normal that is no finite number: 1, "),
        (
            "vt 0 0\nvt 1.#QNAN 0\nf 1/1 2/2 3/1",
            "t.obj:8: corners with texture coordinates that are no finite",
        ),
    ] {
        let (mesh, remarks) = square_and(more);
        assert!(mesh.triangles.len() >= 3, "{more}");
        assert!(remarks.len() == 1 && remarks[0].starts_with(said), "{remarks:?}");
    }
}

#[test]
fn colours_of_whole_numbers_above_1_go_up_to_255() {
    let colours = |codes: [&str; 3]| {
        let lines = codes.map(|code| format!("v 0 0 0 {code}\n")).concat();
        let (mesh, remarks) = square_and(&format!("{lines}f 5 6 7\n"));
        (mesh.attributes[0].values.all()[4..].to_vec(), remarks)
    };
    let (bytes, remarks) = colours(["51 102 204", "0 0 1", "255 255 255"]);
    assert!((bytes[0] - Rgb::new(0.0331, 0.1329, 0.6038)).length() < 1e-3, "{bytes:?}");
    assert_eq!(bytes[2], Rgb::ONE);
    assert!(remarks.len() == 1 && remarks[0].starts_with("t.obj:6: the colours"), "{remarks:?}");
    let (fractions, remarks) = colours(["1 0 1", "0 0 0", "0.5 1 1"]);
    assert!(fractions[0] == Rgb::new(1.0, 0.0, 1.0) && remarks.is_empty(), "{fractions:?}");
    let (odd, remarks) = colours(["nan 0 0", "1 1 1", "0 0 0"]);
    assert!(
        odd[0] == Rgb::ONE && remarks[0].contains("with a colour that is no finite"),
        "{odd:?} {remarks:?}"
    );
}

#[test]
fn objects_whose_names_hold_marks_are_chosen() {
    let text =
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\no Lamp #1 # left\nf 1 2 3\no Lamp #2\nf 3 2 1\nf 3 2 1\no \xBA\xEC\n\
        f 1 2 3\nf 1 2 3\nf 1 2 3\ng a b #c\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 2 3\n";
    for (name, count) in
        [("Lamp #1", 1), ("Lamp #2", 2), ("Lamp #1 # left", 1), ("红", 7), ("a b #c", 4), ("b", 4)]
    {
        let selection = PartSelection { only: vec![name.to_owned()], except: vec![] };
        let mesh = read(text, Path::new("t.obj"), &selection, &mut Vec::new()).unwrap();
        assert_eq!(mesh.triangles.len(), count, "{name}");
    }
}
