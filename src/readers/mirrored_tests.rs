//! Tests of transforms that mirror meshes, in all formats: the outside stays outside.

use crate::{LoadOptions, load};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use scene::Mesh;
use serde_json::json;
use std::fs;
use std::io::Write;

/// Corners of a tetrahedron, and its faces counter-clockwise from outside.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// Matrices of transforms row by row, and true if they mirror.
const TRANSFORMS: [([i32; 9], bool); 4] = [
    ([1, 0, 0, 0, 1, 0, 0, 0, 1], false),
    ([-1, 0, 0, 0, 1, 0, 0, 0, 1], true),
    ([-2, 0, 0, 0, -1, 0, 0, 0, -3], true),
    ([0, 1, 0, 1, 0, 0, 0, 0, -1], false),
];

/// Returns the signed volume of a closed mesh, above 0 if its front is outside.
fn volume(mesh: &Mesh) -> f32 {
    (0..mesh.triangles.len())
        .map(|t| {
            let [a, b, c] = mesh.corners(t);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

/// Returns the volumes of the meshes of the scene `name` with files beside it.
fn volumes(name: &str, text: &str) -> Vec<f32> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let list = |of: &dyn Fn(&[u32; 3]) -> String| FACES.iter().map(of).collect::<String>();
    let corners: String = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    write(
        "t.obj",
        (corners.clone() + &list(&|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1))).as_bytes(),
    );
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    let faces = list(&|[a, b, c]| format!("3 {a} {b} {c}\n"));
    write("t.ply", format!("{head}{}{faces}", corners.replace("v ", "")).as_bytes());
    let floats: Vec<u8> = CORNERS.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let indices: Vec<u8> = FACES.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
    let counts: Vec<u8> = [4u64, 4].iter().flat_map(|n| n.to_le_bytes()).collect();
    zlib.write_all(&[&0x1000u32.to_le_bytes()[..], b"t\0", &counts, &floats, &indices].concat()).unwrap();
    write("t.serialized", &[&[0x1C, 0x04, 4, 0][..], &zlib.finish().unwrap()].concat());
    write("t.bin", &[floats, indices].concat());
    write("m.gltf", gltf(&TRANSFORMS[0].0).as_bytes());
    write(name, text.as_bytes());
    let loaded =
        load(&folder.path().join(name), &LoadOptions::default()).unwrap_or_else(|e| panic!("{text}: {e}"));
    loaded.scene.meshes.iter().map(volume).collect()
}

/// Returns the glTF text of the tetrahedron below a node of a transform.
fn gltf(linear: &[i32; 9]) -> String {
    let [a, b, c, d, e, f, g, h, i] = linear;
    json!({
        "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "children": [1], "matrix": [a, d, g, 0, b, e, h, 0, c, f, i, 0, 0, 0, 0, 1] }, { "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4 },
            { "bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 12 },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 48 },
        ],
        "buffers": [{ "byteLength": 96, "uri": "t.bin" }],
    })
    .to_string()
}

fn rows([a, b, c, d, e, f, g, h, i]: &[i32; 9], separator: &str) -> String {
    [*a, *b, *c, 0, *d, *e, *f, 0, *g, *h, *i, 0, 0, 0, 0, 1].map(|v| v.to_string()).join(separator)
}

#[test]
fn meshes_without_normals_keep_their_outside_in_every_format() {
    const TOML: &str = "[camera]\norigin = [9, 9, 9]\ntarget = [0, 0, 0]\nfov = 40\n[environment]\nradiance = 1\n\
        [[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n";
    for (linear, _) in &TRANSFORMS {
        for file in ["t.obj", "t.ply", "t.serialized", "m.gltf"] {
            for flips in [false, true] {
                let text = format!(
                    "{TOML}[[mesh]]\nfile = \"{}\"\nmaterial = \"m\"\nflip_normals = {flips}\n\
                     transform = [{{ matrix = [{}] }}]\n",
                    file,
                    rows(linear, ", ")
                );
                let found = volumes("s.toml", &text);
                assert!((found[0] > 0.0) != flips && found.len() == 1, "{file} {linear:?} {flips} {found:?}");
            }
        }
        let found = volumes("m.gltf", &gltf(linear));
        assert!(found.len() == 1 && found[0] > 0.0, "glTF {linear:?} {found:?}");
    }
}

#[test]
fn shapes_of_mitsuba_keep_their_outside_but_for_spheres() {
    for (linear, mirrors) in &TRANSFORMS {
        let transform =
            format!("<transform name=\"to_world\"><matrix value=\"{}\"/></transform>", rows(linear, " "));
        let file = |kind: &str| format!("type=\"{kind}\"><string name=\"filename\" value=\"t.{kind}\"/>");
        let sphere = "type=\"sphere\">".to_owned();
        for (shape, is_sphere) in
            [(file("obj"), false), (file("ply"), false), (file("serialized"), false), (sphere, true)]
        {
            for (flips, flat) in [(false, false), (true, false), (false, true), (true, true)] {
                let options = format!(
                    "<boolean name=\"flip_normals\" value=\"{flips}\"/><boolean name=\"face_normals\" value=\"{flat}\"/>"
                );
                let text = format!(
                    "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\
                     <shape {shape}{options}{transform}</shape>\
                     <shape type=\"shapegroup\" id=\"g\"><shape {shape}{options}</shape></shape>\
                     <shape type=\"instance\"><ref id=\"g\"/>{transform}</shape></scene>"
                );
                let found = volumes("s.xml", &text);
                let expected = [flips != (is_sphere && *mirrors), flips];
                assert_eq!(found.len(), 2, "{shape}");
                for (volume, is_inside_out) in found.iter().zip(expected) {
                    assert!((*volume > 0.0) != is_inside_out, "{shape} {linear:?} {flips} {flat} {found:?}");
                }
            }
        }
    }
}
