//! The corpus of small scenes: valid ones load, invalid ones fail with a file, a remedy and no panic. [`super::fuzz`]
//! tries damaged ones.

use super::sound::assert_sound;
use lightsplat::readers::{LoadOptions, load};
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
