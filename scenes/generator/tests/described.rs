//! The generated scenes match their files: the parts named are the parts made, of the promised size and the
//! promised share of glossy surface, and made again they are the same.

use lightsplat_scenes::{Part, generate};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::LazyLock;

const SCENES: [&str; 6] = ["apartment", "hall", "kitchen", "knot", "nave", "plaza"];

/// A scene file and the parts that its generator makes, once for all tests.
struct Described {
    name: &'static str,
    parts: Vec<Part>,
    /// Material of every part.
    materials: BTreeMap<String, String>,
    /// Kind of every material.
    kinds: BTreeMap<String, String>,
}

static DESCRIBED: LazyLock<Vec<Described>> = LazyLock::new(|| SCENES.map(described).into());

fn described(name: &'static str) -> Described {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).with_extension("toml");
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
    let generator = table["generator"].as_str().unwrap_or_default();
    let parts = generate(generator).unwrap_or_else(|| panic!("{name}: no generator {generator}"));
    Described { name, parts, materials, kinds }
}

/// Surface area of all triangles of `part`.
fn area(part: &Part) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| part.positions[i as usize].as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    };
    part.triangles.iter().map(area).sum()
}

#[test]
fn a_file_names_exactly_the_parts_that_are_made_and_the_materials_that_it_uses() {
    for Described { name, parts, materials, kinds } in &*DESCRIBED {
        let made: BTreeSet<&String> = parts.iter().map(|p| &p.name).collect();
        assert_eq!(made.len(), parts.len(), "{name}: two parts of one name");
        assert_eq!(made, materials.keys().collect(), "{name}: parts made and parts named");
        let used: BTreeSet<&String> = materials.values().collect();
        assert_eq!(used, kinds.keys().collect(), "{name}: materials used and materials named");
    }
}

#[test]
fn scenes_are_as_large_and_as_glossy_as_promised() {
    // Triangles and relative tolerance; glossy share of the area and tolerance.
    let promised = [
        ("apartment", 72_000.0, 0.05, 0.62, 0.03),
        ("hall", 200_000.0, 0.05, 0.1, 0.02),
        ("kitchen", 72_000.0, 0.05, 0.28, 0.03),
        ("knot", 2936.0, 0.0, 0.43, 0.02),
        ("nave", 80_000.0, 0.05, 0.0, 0.0),
        ("plaza", 40_000.0, 0.2, 0.3, 0.3),
    ];
    for (scene, (name, count, tolerance, share, share_tolerance)) in DESCRIBED.iter().zip(promised) {
        assert_eq!(scene.name, name);
        let triangles: usize = scene.parts.iter().map(|p| p.triangles.len()).sum();
        assert!((triangles as f64 / count - 1.0).abs() <= tolerance, "{name}: {triangles} triangles");
        let (mut glossy, mut total) = (0.0, 0.0);
        for part in &scene.parts {
            total += area(part);
            let kind = &scene.kinds[&scene.materials[&part.name]];
            if ["glossy", "plastic", "roughplastic", "conductor"].contains(&kind.as_str()) {
                glossy += area(part);
            }
        }
        assert!((glossy / total - share).abs() <= share_tolerance, "{name}: glossy share {}", glossy / total);
    }
}

/// Coincident triangles would be hit in an arbitrary order.
#[test]
fn no_triangle_is_there_twice() {
    for Described { name, parts, .. } in &*DESCRIBED {
        let mut seen = BTreeSet::new();
        for part in parts {
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
fn generated_again_every_bit_is_the_same() {
    for Described { name, parts, .. } in &*DESCRIBED {
        for (a, b) in parts.iter().zip(generate(name).unwrap_or_default()) {
            assert_eq!(a.name, b.name);
            let bits = |part: &Part| -> Vec<u32> {
                let floats = part.positions.iter().chain(&part.normals).flat_map(|v| v.to_array());
                floats.chain(part.uvs.iter().flat_map(|v| v.to_array())).map(f32::to_bits).collect()
            };
            assert_eq!(bits(a), bits(&b), "{name}: {}", a.name);
            assert_eq!(a.triangles, b.triangles);
        }
    }
}

#[test]
fn generated_parts_are_sound() {
    for Described { name, parts, .. } in &*DESCRIBED {
        for part in parts {
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
