//! The generated scenes are what their files say: the parts named are the parts made, of the promised size
//! and the promised share of glossy surface, and made again they are the same.

use lightsplat::scene::generate::{Part, generate};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const SCENES: [&str; 5] = ["apartment", "hall", "kitchen", "knot", "nave"];

struct Described {
    generator: String,
    /// Material of every part.
    materials: BTreeMap<String, String>,
    /// Kind of every material.
    kinds: BTreeMap<String, String>,
}

fn described(name: &str) -> Described {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let table: toml::Table = text.parse().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let text = |row: &toml::Value, key: &str| row.get(key).and_then(|v| v.as_str()).map(str::to_owned);
    let rows = |key: &str| table[key].as_array().cloned().unwrap_or_default();
    let mut materials = BTreeMap::new();
    for row in rows("mesh") {
        let Some(part) = text(&row, "part") else { continue };
        let material = text(&row, "material").unwrap_or_else(|| panic!("{name}: {part} has no material"));
        assert!(materials.insert(part.clone(), material).is_none(), "{name}: part {part} placed twice");
    }
    let kinds = rows("material")
        .iter()
        .map(|row| (text(row, "name").unwrap_or_default(), text(row, "kind").unwrap_or_default()))
        .collect();
    let generator = table["generator"].as_str().unwrap_or_default().to_owned();
    Described { generator, materials, kinds }
}

fn parts(scene: &Described) -> Vec<Part> {
    generate(&scene.generator).unwrap_or_else(|| panic!("no generator {}", scene.generator))
}

/// Checks the scene called `name` and returns its triangle count and its glossy share of area.
fn measured(name: &str) -> (usize, f64) {
    let scene = described(name);
    let parts = parts(&scene);
    let (mut glossy, mut total) = (0.0, 0.0);
    for part in &parts {
        let material = scene.materials.get(&part.name);
        let material = material.unwrap_or_else(|| panic!("{name}: part {} has no mesh row", part.name));
        let kind = scene.kinds.get(material).unwrap_or_else(|| panic!("{name}: no material {material}"));
        total += part.area();
        if ["glossy", "plastic", "roughplastic", "conductor"].contains(&kind.as_str()) {
            glossy += part.area();
        }
    }
    for named in scene.materials.keys() {
        assert!(parts.iter().any(|p| p.name == *named), "{name}: no part {named}");
    }
    for material in scene.kinds.keys() {
        assert!(scene.materials.values().any(|m| m == material), "{name}: material {material} is unused");
    }
    (parts.iter().map(|p| p.triangles.len()).sum(), glossy / total)
}

#[test]
fn knot_has_exactly_its_triangles_and_its_gloss() {
    let (triangles, glossy) = measured("knot");
    assert_eq!(triangles, 2936);
    assert!((glossy - 0.43).abs() < 0.02, "glossy share {glossy}");
}

#[test]
fn kitchen_is_as_large_and_as_glossy_as_promised() {
    let (triangles, glossy) = measured("kitchen");
    assert!((triangles as f64 / 72_000.0 - 1.0).abs() < 0.05, "{triangles} triangles");
    assert!((glossy - 0.28).abs() < 0.03, "glossy share {glossy}");
}

#[test]
fn nave_is_as_large_as_promised_and_all_diffuse() {
    let (triangles, glossy) = measured("nave");
    assert!((triangles as f64 / 80_000.0 - 1.0).abs() < 0.05, "{triangles} triangles");
    assert_eq!(glossy, 0.0);
}

#[test]
fn hall_is_as_large_and_as_glossy_as_promised() {
    let (triangles, glossy) = measured("hall");
    assert!((triangles as f64 / 200_000.0 - 1.0).abs() < 0.05, "{triangles} triangles");
    assert!((glossy - 0.1).abs() < 0.02, "glossy share {glossy}");
}

/// Coincident triangles would be hit in an order that nobody chose.
#[test]
fn no_triangle_is_there_twice() {
    for name in SCENES {
        let mut seen = BTreeSet::new();
        for part in parts(&described(name)) {
            for t in &part.triangles {
                // The smallest corner first but the winding kept: the faces of boxes that abut back to
                // back are never seen.
                let mut corners = t.map(|i| part.positions[i as usize].to_array().map(f32::to_bits));
                let smallest = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                corners.rotate_left(smallest);
                assert!(seen.insert(corners), "{name}: {} has {corners:?} twice", part.name);
            }
        }
    }
}

#[test]
fn apartment_is_as_large_and_as_glossy_as_promised() {
    let (triangles, glossy) = measured("apartment");
    assert!((triangles as f64 / 72_000.0 - 1.0).abs() < 0.05, "{triangles} triangles");
    assert!((glossy - 0.62).abs() < 0.03, "glossy share {glossy}");
}

#[test]
fn generated_again_every_bit_is_the_same() {
    for name in SCENES {
        let scene = described(name);
        for (a, b) in parts(&scene).iter().zip(&parts(&scene)) {
            assert_eq!(a.name, b.name);
            let bits = |part: &Part| -> Vec<u32> {
                let floats = part.positions.iter().chain(&part.normals).flat_map(|v| v.to_array());
                floats.chain(part.uvs.iter().flat_map(|v| v.to_array())).map(f32::to_bits).collect()
            };
            assert_eq!(bits(a), bits(b), "{name}: {}", a.name);
            assert_eq!(a.triangles, b.triangles);
        }
    }
}

#[test]
fn generated_parts_are_sound() {
    for name in SCENES {
        for part in parts(&described(name)) {
            let count = part.positions.len();
            assert!(part.normals.len() == count && part.uvs.len() == count, "{name}: {}", part.name);
            for (p, n) in part.positions.iter().zip(&part.normals) {
                assert!(p.is_finite() && (n.length() - 1.0).abs() < 1e-3, "{name}: {} {p} {n}", part.name);
            }
            for t in &part.triangles {
                let [a, b, c] = t.map(|i| part.positions[i as usize]);
                let area = 0.5 * (b - a).cross(c - a).length();
                assert!(area > 1e-10, "{name}: {} has a triangle without area at {a}", part.name);
            }
        }
    }
}
