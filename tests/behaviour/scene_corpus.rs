//! The corpus of small scenes: the valid ones load, the invalid ones fail with a file, a remedy and no panic,
//! and so do valid ones after cutting and corrupting.

use lightsplat::scene::formats::{LoadOptions, Loaded, load};
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

/// Asserts the properties that every other stage relies on.
fn assert_sound(Loaded { scene, cameras, .. }: &Loaded) {
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        assert!(mesh.normals.is_empty() || mesh.normals.len() == count);
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3));
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == count);
        assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
        assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < count));
        assert!((mesh.material.0 as usize) < scene.materials.len());
    }
    for texture in &scene.textures {
        assert_eq!(texture.texels.len(), texture.width * texture.height);
        assert!(
            texture.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0 && t.max_element() <= 1.0)
        );
    }
    assert!(scene.centre.is_finite() && cameras.still.origin.is_finite());
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

/// A random generator good enough to pick bytes with.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % n.max(1)
    }
}

/// Loads every valid scene with one of the files cut or corrupted.
#[test]
fn damaged_files_never_panic() {
    let files = corpus("valid");
    let mut random = Lcg(7);
    let (mut survived, mut failed) = (0, 0);
    for victim in &files {
        let original = fs::read(victim).unwrap();
        for round in 0..40 {
            let mut bytes = original.clone();
            match round % 4 {
                0 => bytes.truncate(random.below(original.len())),
                1 => (0..=random.below(4)).for_each(|_| {
                    let at = random.below(bytes.len());
                    bytes[at] = random.below(256) as u8;
                }),
                2 => {
                    // A run of bytes moves somewhere else.
                    let (a, b) = (random.below(bytes.len()), random.below(bytes.len()));
                    let run: Vec<u8> = bytes[a.min(b)..a.max(b)].iter().take(64).copied().collect();
                    let at = random.below(bytes.len());
                    bytes.splice(at..at, run);
                }
                _ => {
                    // Digits become other digits: numbers and indices out of range.
                    for _ in 0..3 {
                        let digits: Vec<usize> =
                            (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
                        if !digits.is_empty() {
                            bytes[digits[random.below(digits.len())]] = b"0123456789-e."[random.below(13)];
                        }
                    }
                }
            }
            let folder = tempfile::tempdir().unwrap();
            for file in &files {
                let name = file.file_name().unwrap();
                let contents = if file == victim { bytes.clone() } else { fs::read(file).unwrap() };
                fs::write(folder.path().join(name), contents).unwrap();
            }
            let scenes = ["everything.toml", "everything.xml", "old.xml", "void.toml"];
            let own = victim.file_name().unwrap().to_str().unwrap();
            let is_own = scenes.contains(&own);
            for scene in scenes.iter().filter(|s| !is_own || **s == own) {
                match load(&folder.path().join(scene), &LoadOptions::default()) {
                    Ok(loaded) => {
                        assert_sound(&loaded);
                        survived += 1;
                    }
                    Err(error) => {
                        assert!(error.to_string().len() > 10);
                        failed += 1;
                    }
                }
            }
        }
    }
    assert!(survived > 100 && failed > 100, "{survived} {failed}: the damage is one-sided");
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
