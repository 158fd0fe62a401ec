//! The corpus of small scenes: valid ones load, invalid ones fail with a file, a remedy and no panic. [`super::fuzz`]
//! tries damaged ones.

use super::sound::assert_sound;
use lightsplat::readers::{LoadOptions, Loaded, load};
use std::fs;
use std::path::{Path, PathBuf};

fn corpus(kind: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(kind);
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|f| f.unwrap().path()).collect();
    files.sort();
    files
}

fn is_scene(path: &Path) -> bool {
    let included = path.ends_with("materials.xml");
    !included && path.extension().is_some_and(|e| e == "toml" || e == "xml")
}

#[test]
fn valid_scenes_load_and_are_sound() {
    let scenes: Vec<PathBuf> = corpus("valid").into_iter().filter(|p| is_scene(p)).collect();
    assert!(scenes.len() >= 4);
    for path in scenes {
        let loaded = load(&path, &LoadOptions { strict: true, ..LoadOptions::default() })
            .unwrap_or_else(|e| panic!("{e}"));
        assert_sound(&loaded);
        assert!(
            loaded.repairs.is_clean() || loaded.repairs.turned > 0,
            "{}: {}",
            path.display(),
            loaded.repairs
        );
    }
}

#[test]
fn every_source_of_geometry_arrives_in_both_formats() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/valid");
    for (file, meshes, textures, lights, sources) in
        [("everything.toml", 11, 3, 3, 7), ("everything.xml", 11, 1, 3, 7), ("old.xml", 2, 0, 0, 2)]
    {
        let scene = load(&folder.join(file), &LoadOptions::default()).unwrap().scene;
        let counts = (scene.meshes.len(), scene.textures.len(), scene.lights.len(), scene.sources.len());
        assert_eq!(counts, (meshes, textures, lights, sources), "{file}");
        assert!(scene.environment.is_some());
    }
}

#[test]
fn invalid_scenes_fail_with_file_and_remedy() {
    let scenes: Vec<PathBuf> = corpus("invalid").into_iter().filter(|p| is_scene(p)).collect();
    assert!(scenes.len() >= 12);
    for path in scenes {
        let message = match load(&path, &LoadOptions::default()) {
            Ok(_) => panic!("{} loads", path.display()),
            Err(error) => error.to_string(),
        };
        assert!(message.contains("tests/scenes/") && message.contains("; "), "{message}");
    }
}

/// Loads a file with these bytes.
fn load_bytes(name: &str, bytes: &[u8]) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    load(&path, &LoadOptions::default()).map_err(|error| error.to_string())
}

#[test]
fn files_that_are_something_else_are_errors_that_say_what_they_are() {
    let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12\n";
    let page = b"<!DOCTYPE html>\n<html><body>404</body></html>\n";
    for name in ["glb", "gltf", "obj", "ply", "stl", "toml", "xml", "mtl", "exr", "png", "json", ""] {
        let name = format!("m.{name}");
        for (bytes, what) in [
            (&pointer[..], "a pointer of Git LFS; run `git lfs pull`"),
            (page, "an HTML page; download the file again"),
            (b"", "an empty file; download or export it again"),
        ] {
            let message = load_bytes(&name, bytes).unwrap_err();
            assert!(message.contains(&name) && message.contains(what), "{message}");
        }
        if !matches!(name.as_str(), "m.mtl" | "m.exr" | "m.png") {
            let message = load_bytes(&name, b"\x1F\x8B\x08\0\0\0\0\0").unwrap_err();
            assert!(message.contains("gzip; decompress it with gunzip"), "{message}");
        }
    }
    for name in ["m.obj", "m.stl", "m.toml", "m.vrm", "m"] {
        let message = load_bytes(name, b"glTF\x02\0\0\0\x0C\0\0\0").unwrap_err();
        assert!(message.contains("this is a binary glTF model; give it a name"), "{message}");
    }
}

#[test]
fn texts_of_other_encodings_are_read() {
    let scene = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\
        <shape type=\"rectangle\"/></scene>";
    let facet =
        "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    for (name, text) in [
        ("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("m.stl", facet),
        (
            "m.toml",
            "mesh = [{ shape = \"rectangle\", material = \"m\" }]\n\
            material = [{ name = \"m\", kind = \"diffuse\", reflectance = 0.5 }]\n",
        ),
        ("m.xml", scene),
    ] {
        let units: Vec<u16> = format!("\u{feff}{text}").encode_utf16().collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        let old = text.replace('\n', "\r").into_bytes();
        for bytes in [text.as_bytes().to_vec(), little.clone(), big, little[2..].to_vec(), old] {
            let loaded = load_bytes(name, &bytes).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(loaded.scene.meshes.len(), 1, "{name}");
        }
    }
    let latin = b"<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><!-- gr\xFCn -->".to_vec();
    let typed = b"<?xml version=\"1.0\"?><!DOCTYPE scene [<!ENTITY a \"b\">]>".to_vec();
    for head in [latin, typed] {
        assert!(load_bytes("m.xml", &[&head[..], scene.as_bytes()].concat()).is_ok());
    }
}

#[test]
fn names_do_not_act_on_a_terminal() {
    let text = "[[mesh]]\nshape = \"cube\"\nmaterial = \"\\u001b[2J\\nred\\u202e\"\n";
    let message = load_bytes("m.toml", text.as_bytes()).unwrap_err();
    assert!(message.contains(r"\u001b[2J\nred\u202e") && !message.contains(['\n', '\u{1b}']), "{message}");
}

/// Text that is well-formed and absurd.
#[test]
fn absurd_files_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let deep_xml = format!("<scene version=\"3.0.0\">{}", "<bsdf type=\"twosided\">".repeat(200_000));
    let deep_toml = format!("resolution = {}", "[".repeat(200_000));
    let wide_toml = format!("resolution = [{}]", "1,".repeat(200_000));
    let cases = [
        ("deep.xml", deep_xml),
        ("deep.toml", deep_toml),
        ("wide.toml", wide_toml),
        ("empty.xml", String::new()),
        ("other.json", "{}".into()),
    ];
    for (name, text) in cases {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let message = load(&path, &LoadOptions::default()).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
    }
    assert!(load(folder.path(), &LoadOptions::default()).is_err());
    assert!(load(Path::new(""), &LoadOptions::default()).is_err());
}
