//! Tests of files, materials and texture coordinates that are not there, in all formats.

use crate::{LoadOptions, Loaded, Severity, load};
use base::math::Rgb;
use scene::Share;
use serde_json::json;
use std::fs;

const HEAD: &str = "resolution = [8, 4]\ncamera = { origin = [0, 0, 5], target = [0, 0, 0] }\n\
    environment = { radiance = 1 }\n";
const SENSOR: &str = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>";
const QUAD: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Loads the scene `name` with files beside it, among them the image `tile.png`.
fn load_with(name: &str, text: &str, files: &[(&str, &str)], strict: bool) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    let tile = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/scenes/valid/tile.png");
    fs::copy(tile, folder.path().join("tile.png")).unwrap();
    let grey = image::RgbImage::from_pixel(3, 3, image::Rgb([90, 90, 90]));
    grey.save(folder.path().join("grey.png")).unwrap();
    for (name, text) in files.iter().chain(&[(name, text)]) {
        fs::write(folder.path().join(name), text).unwrap();
    }
    load(&folder.path().join(name), &LoadOptions { strict, ..LoadOptions::default() })
        .map_err(|e| e.to_string())
}

fn said(loaded: &Loaded) -> Vec<String> {
    let of_weight = loaded.warnings.iter().filter(|warning| warning.severity == Severity::Warning);
    of_weight.map(|warning| warning.to_string()).collect()
}

/// A glTF model of one triangle under a sky, with a texture `image` and with or without texture coordinates.
fn gltf(image: &str, has_uvs: bool) -> String {
    let data = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let mut attributes = json!({ "POSITION": 0 });
    if has_uvs {
        attributes["TEXCOORD_0"] = json!(1);
    }
    let accessor = |kind| json!({ "bufferView": 0, "componentType": 5126, "type": kind, "count": 3 });
    json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "buffers": [{ "byteLength": 36, "uri": data }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [accessor("VEC3"), accessor("VEC2")],
        "images": [{ "uri": image }], "textures": [{ "source": 0 }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "meshes": [{ "name": "kite", "primitives": [{ "attributes": attributes, "material": 0 }] }],
    })
    .to_string()
}

#[test]
fn a_texture_that_cannot_be_read_is_a_warning_and_grey_in_all_formats() {
    let toml = |image: &str| {
        format!(
            "{HEAD}material = [{{ name = \"m\", kind = \"diffuse\", reflectance = \"{image}\", opacity = \"{image}\", \
             normal_map = \"{image}\" }}]\nmesh = [{{ shape = \"rectangle\", material = \"m\" }}]\n"
        )
    };
    let xml = |image: &str| {
        format!(
            "{SENSOR}<shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">\
             <string name=\"filename\" value=\"{image}\"/></texture></bsdf></shape></scene>"
        )
    };
    let in_toml = |image: &str| format!("{HEAD}mesh = [{{ file = \"{image}.gltf\" }}]\n");
    let obj = format!("mtllib m.mtl\nvt 0 0\nusemtl m\n{}", QUAD.replace("f 1 2 3 4", "f 1/1 2/1 3/1 4/1"));
    for image in ["none.png", "bad.png"] {
        let mtl = format!("newmtl m\nmap_Kd -s 2 2 {image}\n");
        let model = gltf(image, true);
        let model_name = format!("{image}.gltf");
        let files = [("bad.png", "no image"), ("m.mtl", &*mtl), ("a.obj", &*obj), (&*model_name, &*model)];
        let of_obj = format!("{HEAD}mesh = [{{ file = \"a.obj\" }}]\n");
        for (name, text) in
            [("s.toml", toml(image)), ("s.xml", xml(image)), ("t.toml", in_toml(image)), ("u.toml", of_obj)]
        {
            let loaded = load_with(name, &text, &files, false).unwrap_or_else(|e| panic!("{name}: {e}"));
            let warnings = said(&loaded);
            assert!(!warnings.is_empty(), "{name}");
            for warning in &warnings {
                assert!(
                    warning.contains(image) && warning.contains("a grey of 0.5 is used instead"),
                    "{warning}"
                );
            }
            assert_eq!(loaded.scene.textures[0].texels.get(0, 0), Rgb::splat(0.5), "{name}");
            let strict = load_with(name, &text, &files, true).unwrap_err();
            assert!(strict.contains(image) && strict.contains("strict"), "{strict}");
        }
        let masked = load_with("s.toml", &toml(image), &files, false).unwrap().scene;
        assert_eq!((masked.materials[0].opacity, masked.materials[0].relief), (None, None));
        let faded = toml(image).replace("opacity = \"", "opacity = { scale = 0.5, file = \"").replacen(
            "\", normal",
            "\" }, normal",
            1,
        );
        let faded = load_with("s.toml", &faded, &files, false).unwrap().scene;
        assert_eq!(faded.materials[0].opacity, Some(Share::Constant(0.5)));
    }
}

#[test]
fn a_mesh_or_an_environment_that_is_not_there_is_an_error() {
    for (text, named) in [
        (format!("{HEAD}mesh = [{{ file = \"none.obj\" }}]\n"), "none.obj"),
        (HEAD.replace("radiance = 1", "file = \"none.exr\""), "none.exr"),
        (HEAD.replace("radiance = 1", "file = \"a.obj\""), "a.obj"),
    ] {
        let message = load_with("s.toml", &text, &[("a.obj", QUAD)], false).unwrap_err();
        assert!(message.contains(named), "{message}");
    }
}

#[test]
fn materials_and_libraries_that_are_not_there_are_named_once_a_mesh() {
    let obj = "mtllib walls.mtl none.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl brick\nf 1 2 3\n\
        usemtl Brick.001\nf 1 3 4\nusemtl never\nusemtl dark oak\nf 1 2 4\nusemtl Brick.001\nf 2 3 4\n";
    let files = [("a.obj", obj), ("walls.mtl", "newmtl brick\nKd 0.6 0.15 0.1\n"), ("b.obj", QUAD)];
    let text = format!("{HEAD}mesh = [{{ file = \"a.obj\" }}]\n");
    let loaded = load_with("s.toml", &text, &files, false).unwrap();
    let [library, materials] = &said(&loaded)[..] else { panic!("{:?}", loaded.warnings) };
    assert!(library.contains("a.obj:1: there is no material library \"none.mtl\""), "{library}");
    assert!(
        materials.contains("s.toml:4:") && materials.contains("\"Brick.001\", \"dark oak\";"),
        "{materials}"
    );
    assert!(load_with("s.toml", &text, &files, true).unwrap_err().contains("none.mtl"));
    let bare = load_with("s.toml", &text.replace("a.obj", "b.obj"), &files, false).unwrap();
    assert!(said(&bare)[0].contains("neither the mesh nor its file has a material"), "{:?}", bare.warnings);
    let chosen = "mesh = [{ file = \"a.obj\", material = \"m\" }]\n\
        material = [{ name = \"m\", kind = \"mirror\" }]\n";
    assert!(load_with("s.toml", &format!("{HEAD}{chosen}"), &files, true).is_ok());
}

#[test]
fn libraries_are_found_by_all_names_and_the_first_definition_counts() {
    let obj = format!(
        "mtllib walls.mtl dark oak.mtl # both\nmtllib \\\n last.mtl\nusemtl oak\n{QUAD}usemtl b\nf 1 2 3\n"
    );
    let files = [
        ("a.obj", &*obj),
        ("walls.mtl", "newmtl other\nKd 1 0 0\n"),
        ("dark oak.mtl", "newmtl oak # wood\r\nKd 0.25 \\\r\n 0.5 0.75\r\nillum 1\r\n"),
        ("last.mtl", "newmtl oak\nKd 1 1 1\nnewmtl\tb\nKd 0\t0 1\n"),
    ];
    let text = format!("{HEAD}mesh = [{{ file = \"a.obj\" }}]\n");
    let loaded = load_with("s.toml", &text, &files, false).unwrap();
    let [again] = &said(&loaded)[..] else { panic!("{:?}", loaded.warnings) };
    let [place, other] = ["last.mtl:1: the material \"oak\" is also defined in ", "dark oak.mtl:1; that"];
    assert!(again.contains(place) && again.contains(other), "{again}");
    let scene = loaded.scene;
    let colours: Vec<_> =
        scene.meshes.iter().map(|m| scene.materials[m.material.0 as usize].diffuse).collect();
    assert_eq!(colours, [Rgb::new(0.25, 0.5, 0.75).into(), Rgb::Z.into()]);
    assert_eq!(scene.sources.len(), 5);
}

#[test]
fn materials_that_are_defined_again_are_named_unless_they_are_equal() {
    let obj = format!("mtllib m.mtl\nusemtl oak\n{QUAD}");
    let text = format!("{HEAD}mesh = [{{ file = \"a.obj\" }}]\n");
    let said = |library: &str| -> Vec<String> {
        said(&load_with("s.toml", &text, &[("a.obj", &*obj), ("m.mtl", library)], false).unwrap())
    };
    let [again] = &said("newmtl oak\nKd 1 0 0\nillum 1\n\nnewmtl oak # again\nKd 0 0 1\n")[..] else {
        panic!()
    };
    assert!(again.contains("m.mtl:1: the material \"oak\" is also defined in "), "{again}");
    assert!(again.contains("m.mtl:5; that definition is used instead"), "{again}");
    for sound in [
        "newmtl oak\nKd 1 0 0\nillum 1\nnewmtl oak\nKd 1 0 0\nillum 1\n",
        "newmtl oak\nKd 1 0 0\nnewmtl oak #2\nKd 0 1 0\nnewmtl oak #3\nKd 0 1 0\nnewmtl elm\nKd 0 0 1\n",
    ] {
        assert!(said(sound).len() < 2, "{:?}", said(sound));
    }
}

#[test]
fn textures_without_coordinates_are_named_once_a_mesh() {
    let toml = |material: &str, meshes: &str| {
        format!(
            "{HEAD}material = [{{ name = \"m\", {material} }}, {{ name = \"d\", kind = \"mirror\" }}]\nmesh = [{meshes}]\n"
        )
    };
    let colour = "kind = \"diffuse\", reflectance = \"tile.png\"";
    let rough = "kind = \"conductor\", preset = \"Au\", alpha = \"tile.png\"";
    let relief = "kind = \"mirror\", bump_map = \"tile.png\"";
    let grey = "kind = \"diffuse\", reflectance = \"grey.png\"";
    let ply = "{ file = \"a.ply\", material = \"m\" }";
    let shapes = ["rectangle", "cube", "disk", "sphere", "cylinder"]
        .map(|shape| format!("{{ shape = \"{shape}\", material = \"m\" }}"));
    let partly = format!("vt 0.5 0.5\nmtllib m.mtl\nusemtl m\n{QUAD}f 1/1 2/1 3/1\n");
    let whole = format!("vt 0.5 0.5\nmtllib m.mtl\nusemtl m\n{}", QUAD.replace("f 1 2 3 4", "f 1/1 2/1 3/1"));
    let mtl = "newmtl m\nmap_Kd tile.png\nillum 1\n";
    let (bare, mapped) = (gltf("tile.png", false), gltf("tile.png", true));
    let files = [
        ("a.ply", PLY),
        ("a.obj", QUAD),
        ("partly.obj", &*partly),
        ("whole.obj", &*whole),
        ("m.mtl", mtl),
        ("bare.gltf", &*bare),
        ("mapped.gltf", &*mapped),
    ];
    for (text, named) in [
        (toml(colour, ply), "\"a\""),
        (toml(rough, ply), "\"a\""),
        (toml(relief, ply), "\"a\""),
        (toml(colour, "{ file = \"a.obj\", material = \"m\" }"), "\"a\""),
        (toml(colour, "{ file = \"a.ply\", material = \"d\", emission = \"tile.png\" }"), "\"a\""),
        (toml(colour, "{ file = \"partly.obj\" }"), "\"partly:m\""),
        (toml(colour, "{ file = \"bare.gltf\" }"), "\"node 0\""),
        (toml(colour, "{ file = \"whole.obj\" }"), ""),
        (toml(colour, "{ file = \"mapped.gltf\" }"), ""),
        (toml(colour, "{ file = \"a.ply\", material = \"d\" }"), ""),
        (toml(colour, &shapes.join(", ")), ""),
        (toml(grey, ply), ""),
    ] {
        let loaded = load_with("s.toml", &text, &files, false).unwrap_or_else(|e| panic!("{text}: {e}"));
        let warnings = said(&loaded);
        let is_named =
            warnings.iter().filter(|w| w.contains("lack texture coordinates") && w.contains(named)).count();
        assert_eq!(
            (is_named, warnings.len()),
            (usize::from(!named.is_empty()), is_named),
            "{text}: {warnings:?}"
        );
        let strict = load_with("s.toml", &text, &files, true);
        assert_eq!(strict.is_err(), is_named > 0, "{text}");
    }
    // Mitsuba's own coordinates stand in, so the picture is the one described.
    let xml = format!(
        "{SENSOR}<shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/><bsdf type=\"diffuse\">\
         <texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"tile.png\"/></texture>\
         </bsdf></shape></scene>"
    );
    let notes = load_with("s.xml", &xml, &files, true).unwrap().warnings;
    assert!(notes.iter().any(|note| note.what.contains("lack texture coordinates")), "{notes:?}");
    let cube = xml.replace("\"ply\"", "\"cube\"").replace("<string name=\"filename\" value=\"a.ply\"/>", "");
    let notes = load_with("s.xml", &cube, &files, true).unwrap().warnings;
    assert!(!notes.iter().any(|note| note.what.contains("lack texture coordinates")), "{notes:?}");
}
