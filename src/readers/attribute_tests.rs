//! Tests of attributes of meshes in files of all formats but glTF.

use crate::{LoadOptions, Loaded, load};
use base::math::Rgb;
use glam::Vec3;
use scene::{AttributeValues, Mesh, Parameter, Reflectance, Requirements};
use std::fs;

/// A camera, light, and the material `m` of the mesh's colour.
const HEAD: &str = "resolution = [8, 8]\ncamera = { origin = [0, 0, 5], target = [0, 0, 0], fov = 60 }\n\
    environment = { radiance = 1.0 }\n\
    material = [{ name = \"m\", kind = \"diffuse\", reflectance = { attribute = \"color\" } }]\n";

/// Loads `text` as the scene `name`, with a file beside it, as strictly as may be.
fn load_beside(name: &str, text: &str, file: (&str, &[u8])) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(file.0), file.1).unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    load(&path, &LoadOptions { strict: true, ..LoadOptions::default() }).map_err(|e| e.to_string())
}

fn of_file(mesh: &str, file: (&str, &[u8])) -> Result<Loaded, String> {
    load_beside("s.toml", &format!("{HEAD}mesh = [{{ file = \"{}\", {mesh} }}]\n", file.0), file)
}

fn vertices(mesh: &Mesh) -> &[Rgb] {
    match &mesh.attributes[..] {
        [attribute] if matches!(attribute.values, AttributeValues::Vertices(_)) => attribute.values.all(),
        other => panic!("{other:?}"),
    }
}

fn assert_near(found: &[Rgb], expected: &[[f32; 3]]) {
    let near = |(found, expected): (&Rgb, &[f32; 3])| found.distance(Rgb::from(*expected)) < 2e-6;
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(near), "{found:?} {expected:?}");
}

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    VERTEX\nelement face 2\nproperty list uchar int vertex_indices\nFACE\nend_header\n";

/// Returns a square of four vertices and two faces, of three and of four corners.
fn ply(vertex: &str, face: &str, vertices: [&str; 4], faces: [&str; 2]) -> Vec<u8> {
    let mut text = HEADER.replace("VERTEX", vertex).replace("FACE", face);
    for (at, rest) in ["0 0 0", "1 0 0", "1 1 0", "0 1 0"].iter().zip(vertices) {
        text += &format!("{at} {rest}\n");
    }
    text += &format!("3 0 1 2 {}\n4 1 2 3 0 {}\n", faces[0], faces[1]);
    text.into_bytes()
}

fn properties(kind: &str, names: &str) -> String {
    let lines: Vec<String> = names.split(' ').map(|name| format!("property {kind} {name}")).collect();
    lines.join("\n")
}

/// Returns the square with colours of vertices in sRGB and linear colours of faces.
fn coloured_ply() -> Vec<u8> {
    let (bytes, floats) = (properties("uchar", "red green blue alpha"), properties("float", "r g b"));
    let vertices = ["255 0 0 255", "0 188 0 51", "0 0 255 0", "255 255 255 255"];
    ply(&bytes, &floats, vertices, ["0.1 0.2 0.3", "0.4 0.5 0.6"])
}

/// Linear colours of the vertices of [`coloured_ply`]: 188 of 255 is 0.502886.
const COLOURS: [[f32; 3]; 4] = [[1.0, 0.0, 0.0], [0.0, 0.502886, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];

#[test]
fn ply_has_colours_of_vertices_and_of_faces() {
    let file = ("a.ply", &coloured_ply()[..]);
    let loaded = of_file("material = \"m\"", file).unwrap();
    assert_near(vertices(&loaded.scene.meshes[0]), &COLOURS);
    // A face of four corners is two triangles.
    let of_faces = HEAD.replace("\"color\"", "\"face_color\"");
    let text = format!("{of_faces}mesh = [{{ file = \"a.ply\", material = \"m\" }}]\n");
    let loaded = load_beside("s.toml", &text, file).unwrap();
    let [attribute] = &loaded.scene.meshes[0].attributes[..] else { panic!() };
    assert!(matches!(attribute.values, AttributeValues::Triangles(_)));
    assert_near(attribute.values.all(), &[[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.4, 0.5, 0.6]]);
    let alpha = HEAD.replace("\"color\"", "\"alpha\", scale = 0.5");
    let text = format!("{alpha}mesh = [{{ file = \"a.ply\", material = \"m\" }}]\n");
    let loaded = load_beside("s.toml", &text, file).unwrap();
    assert_near(vertices(&loaded.scene.meshes[0]), &[[1.0; 3], [0.2; 3], [0.0; 3], [1.0; 3]]);
    let Reflectance::Textured { texture, scale } = loaded.scene.materials[0].diffuse else { panic!() };
    assert!(loaded.scene.textures.attribute(texture).is_some() && scale == Rgb::splat(0.5));
}

#[test]
fn colours_show_where_a_ply_or_obj_file_has_no_material() {
    let shown = |name: &str, bytes: &[u8]| {
        let text = HEAD.replace("{ attribute = \"color\" }", "0.25");
        load_beside("s.toml", &format!("{text}mesh = [{{ file = \"{name}\" }}]\n"), (name, bytes))
    };
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 1 1 0 0 0 1 0.5\nv 0 1 0\nf 1 2 3 4\n";
    // 0.5 in sRGB is 0.214041. A vertex without a colour is white.
    let of_obj = [[1.0, 0.0, 0.0], [0.0, 0.214041, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
    let ply = coloured_ply();
    for (name, bytes, colours) in [("a.ply", &ply[..], COLOURS), ("a.obj", obj.as_bytes(), of_obj)] {
        let loaded = shown(name, bytes).unwrap();
        let mesh = &loaded.scene.meshes[0];
        assert_near(vertices(mesh), &colours);
        let material = &loaded.scene.materials[mesh.material.0 as usize];
        assert!(
            material.two_sided && matches!(material.diffuse, Reflectance::Textured { scale: Rgb::ONE, .. })
        );
    }
    let plain = ply_without_colours();
    assert!(shown("a.ply", &plain).unwrap_err().contains("no material"));
    let error = shown("a.obj", b"v 0 0 0 1\nv 1 0 0 1\nv 1 1 0 1\nf 1 2 3\n").unwrap_err();
    assert!(error.contains("has a material"), "{error}");
}

fn ply_without_colours() -> Vec<u8> {
    ply("comment", "comment", [""; 4], [""; 2])
}

#[test]
fn colours_of_obj_belong_to_positions_and_follow_them_into_groups() {
    let text = "v 0 0 0 1 1 1\nv 1 0 0 0 0 0\nv 1 1 0 1 0 0\nv 0 1 0 0 1 0\nvt 0 0\nvt 1 1\n\
        f 1/1 2/1 3/1\nusemtl x\nf 1/2 3/2 4/1\n";
    let error = of_file("", ("a.obj", text.as_bytes())).unwrap_err();
    assert!(error.contains("\"x\"; the colours of the vertices are used instead"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.obj"), text).unwrap();
    fs::write(folder.path().join("s.toml"), format!("{HEAD}mesh = [{{ file = \"a.obj\" }}]\n")).unwrap();
    let loaded = load(&folder.path().join("s.toml"), &LoadOptions::default()).unwrap();
    let [first, second] = &loaded.scene.meshes[..] else { panic!() };
    assert_near(vertices(first), &[[1.0; 3], [0.0; 3], [1.0, 0.0, 0.0]]);
    assert_near(vertices(second), &[[1.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn serialized_meshes_have_colours() {
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write;
    // Single precision and colours; three vertices, one triangle.
    let mut block = [0x1008u32.to_le_bytes().to_vec(), b"leaf\0".to_vec()].concat();
    block.extend([3u64, 1].iter().flat_map(|n| n.to_le_bytes()));
    let numbers =
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.25, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.75];
    block.extend(numbers.iter().flat_map(|n| n.to_le_bytes()));
    block.extend([0u32, 1, 2].iter().flat_map(|n| n.to_le_bytes()));
    let mut encoder = ZlibEncoder::new([0x1C, 4, 4, 0].to_vec(), Compression::default());
    encoder.write_all(&block).unwrap();
    let mut file = encoder.finish().unwrap();
    file.extend([0u64.to_le_bytes().to_vec(), 1u32.to_le_bytes().to_vec()].concat());
    let loaded = of_file("material = \"m\"", ("a.serialized", &file)).unwrap();
    assert_near(vertices(&loaded.scene.meshes[0]), &[[0.5, 0.25, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.75]]);
}

#[test]
fn mitsuba_textures_look_attributes_up_by_name() {
    let floats = properties("float", "color_0 color_1 color_2");
    let weights = properties("float", "weight_0");
    let vertices = ["0.1 0.2 0.3", "0.4 0.5 0.6", "0.7 0.8 0.9", "1 0 0"];
    let file = ply(&floats, &weights, vertices, ["0.25", "0.75"]);
    let xml = |name: &str| {
        format!(
            "<scene version=\"3.0.0\"><emitter type=\"constant\"/><sensor type=\"perspective\"/>\
            <shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/>\
            <bsdf type=\"diffuse\"><texture type=\"mesh_attribute\" name=\"reflectance\">\
            <string name=\"name\" value=\"{name}\"/><float name=\"scale\" value=\"0.5\"/></texture></bsdf>\
            <emitter type=\"area\"><texture type=\"mesh_attribute\" name=\"radiance\">\
            <string name=\"name\" value=\"face_weight\"/></texture></emitter></shape></scene>"
        )
    };
    let loaded = load_beside("s.xml", &xml("vertex_color"), ("a.ply", &file)).unwrap();
    let mesh = &loaded.scene.meshes[0];
    let [weight, colour] = &mesh.attributes[..] else { panic!("{:?}", mesh.attributes) };
    assert_near(colour.values.all(), &[[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9], [1.0, 0.0, 0.0]]);
    assert_near(weight.values.all(), &[[0.25; 3], [0.75; 3], [0.75; 3]]);
    // Attributes alone do not need texture coordinates, for which vertices would be doubled.
    assert_eq!((mesh.positions.len(), mesh.uvs.len()), (4, 0));
    let Reflectance::Textured { texture, scale } = loaded.scene.materials[0].diffuse else { panic!() };
    assert_eq!(loaded.scene.textures.attribute(texture).map(|found| found.attribute), Some(colour.id));
    assert_eq!(scale, Rgb::splat(0.5));
    let emitted = mesh.emission.and_then(|emission| loaded.scene.textures.attribute(emission.texture?));
    assert_eq!(emitted.map(|found| found.attribute), Some(weight.id));
    for (name, message) in [
        ("color", "starts with vertex_"),
        ("vertex_colour", "no attribute \"vertex_colour\", but vertex_color"),
    ] {
        let error = load_beside("s.xml", &xml(name), ("a.ply", &file)).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn attributes_of_divided_and_dropped_triangles_stay_with_them() {
    let floats = properties("float", "r g b");
    let ball = "{ shape = \"sphere\", material = \"n\" }";
    for (scale, divides) in [(1e2, false), (1e6, true)] {
        let of_vertices = ["0 0 0", "1 0 0.5", "1 1 1", "0 1 0.5"];
        // The second face loses the triangle without area between its last two corners.
        let file = String::from_utf8(ply(&floats, &floats, of_vertices, ["0 0 0", "0 0 1"])).unwrap();
        let file = file.replace("4 1 2 3 0 0 0 1\n", "4 0 2 3 3 0.5 0.5 0.5\n");
        for name in ["vertex_color", "face_color"] {
            let text = HEAD.replace(
                "\"color\" } }]",
                &format!("\"{name}\" }} }}, {{ name = \"n\", kind = \"diffuse\", reflectance = 0.5 }}]"),
            );
            let text = format!(
                "{text}mesh = [{ball}, {{ file = \"a.ply\", material = \"m\", transform = [\
                {{ translate = [-0.5, -0.5, -1.0] }}, {{ scale = [{scale:e}, {scale:e}, 2] }}] }}]\n"
            );
            let loaded = load_beside("s.toml", &text, ("a.ply", file.as_bytes())).unwrap();
            let mesh = &loaded.scene.meshes[1];
            assert_eq!(mesh.triangles.len() > 2, divides);
            let at = |p: Vec3| {
                let p = (p.as_dvec3() * loaded.scene.unit() + loaded.scene.centre) / scale + 0.5;
                Vec3::new(p.x as f32, p.y as f32, 0.5 * (p.x + p.y) as f32)
            };
            match &mesh.attributes[0].values {
                AttributeValues::Vertices(values) => {
                    assert_eq!(values.len(), mesh.positions.len());
                    for (position, value) in mesh.positions.iter().zip(values) {
                        assert!(at(*position).distance(*value) < 1e-5, "{position} {value}");
                    }
                }
                AttributeValues::Triangles(values) => {
                    assert_eq!(values.len(), mesh.triangles.len());
                    for (triangle, value) in mesh.triangles.iter().zip(values) {
                        let middle =
                            triangle.iter().map(|i| at(mesh.positions[*i as usize])).sum::<Vec3>() / 3.0;
                        let upper = if middle.y > middle.x { 0.5 } else { 0.0 };
                        assert_eq!(*value, Rgb::splat(upper), "{middle}");
                    }
                }
            }
        }
    }
}

#[test]
fn values_that_are_no_colours_are_repaired() {
    let floats = properties("float", "r g b");
    let file = ply(&floats, "comment", ["nan 0 0", "1 0 0", "0 0 0.5", "inf 1 1"], [""; 2]);
    let message = of_file("material = \"m\"", ("a.ply", &file)).unwrap_err();
    assert!(message.contains("a colour that is no finite number: 2, "), "{message}");
    let file = ply(&floats, "comment", ["0 0 0", "-1 0.5 0", "3 0 0.5", "1 1 1"], [""; 2]);
    let strict = of_file("material = \"m\"", ("a.ply", &file)).unwrap_err();
    assert!(strict.contains("1 values of the attribute \"color\""), "{strict}");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.ply"), &file).unwrap();
    let text = format!("{HEAD}mesh = [{{ file = \"a.ply\", material = \"m\" }}]\n");
    fs::write(folder.path().join("s.toml"), text).unwrap();
    let loaded = load(&folder.path().join("s.toml"), &LoadOptions::default()).unwrap();
    let expected = [[0.0; 3], [0.0, 0.5, 0.0], [1.0, 0.0, 0.5], [1.0; 3]];
    assert_near(vertices(&loaded.scene.meshes[0]), &expected);
    assert_eq!((loaded.repairs.bad_texels, loaded.repairs.clamped), (1, 1));
    // Light may exceed 1.
    let lamp = "material = \"m\", emission = { attribute = \"color\", scale = 2 }";
    let text = HEAD.replace("{ attribute = \"color\" }", "0.5");
    let text = format!("{text}mesh = [{{ file = \"a.ply\", {lamp} }}]\n");
    let file = ply(&floats, "comment", ["3 0 0", "0 0 0", "0 0 0", "0 0 0"], [""; 2]);
    let loaded = load_beside("s.toml", &text, ("a.ply", &file)).unwrap();
    assert_eq!(vertices(&loaded.scene.meshes[0])[0], Rgb::X * 3.0);
}

#[test]
fn attributes_count_where_something_looks_them_up() {
    let file = coloured_ply();
    let with = of_file("material = \"m\"", ("a.ply", &file)).unwrap();
    let text = HEAD.replace("{ attribute = \"color\" }", "0.5");
    let text = format!("{text}mesh = [{{ file = \"a.ply\", material = \"m\" }}]\n");
    let without = load_beside("s.toml", &text, ("a.ply", &file)).unwrap();
    let [with, without] = [&with, &without].map(|loaded| Requirements::new(&loaded.scene));
    assert_eq!((with.attributes, without.attributes), (1, 0));
    assert_eq!(with.memory.geometry - without.memory.geometry, 4 * 12);
    assert!(with.to_string().contains("mesh attributes  1") && !without.to_string().contains("attributes"));
    let missing = of_file("material = \"m\"", ("a.ply", &ply_without_colours())).unwrap_err();
    assert!(
        missing.contains("no attribute \"color\"") && missing.contains("white is used instead"),
        "{missing}"
    );
}

#[test]
fn an_attribute_is_multiplied_by_an_image_and_by_factors() {
    let text = HEAD.replace(
        "{ attribute = \"color\" }",
        "{ colour = { attribute = \"color\", image = \"tile.png\", scale = 0.5 }, scale = 0.25 }",
    );
    let text = format!("{text}mesh = [{{ shape = \"rectangle\", material = \"m\" }}]\n");
    let tile = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/scenes/valid/tile.png");
    let error = load_beside("s.toml", &text, ("tile.png", &fs::read(tile).unwrap())).unwrap_err();
    assert!(error.contains("the mesh \"rectangle\" has no attribute \"color\""), "{error}");
    let folder = tempfile::tempdir().unwrap();
    fs::copy(tile, folder.path().join("tile.png")).unwrap();
    fs::write(folder.path().join("s.toml"), &text).unwrap();
    let loaded = load(&folder.path().join("s.toml"), &LoadOptions::default()).unwrap();
    let Parameter::Textured { texture, scale } = loaded.scene.materials[0].diffuse else { panic!() };
    let image = loaded.scene.textures.attribute(texture).and_then(|found| found.image).unwrap();
    assert!(loaded.scene.textures.by_id(image).is_some() && scale == Rgb::splat(0.125));
}
