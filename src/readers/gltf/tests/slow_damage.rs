//! Tests of damaged and absurd models. They end in an error or a sound scene, never in a panic, and use no more memory
//! than the file holds.

use super::model::{COMPONENT_F32, Model};
use super::{LoadOptions, load_bytes, load_with, samples};
use crate::lighting::Lighting;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// A generator of random bytes.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % n.max(1)
    }
}

/// Loads the file; returns true if it is a scene, and asserts that the scene is sound.
fn survives(bytes: &[u8]) -> bool {
    // The default sky takes longer than all else, and does not depend on the file.
    let lighting = Lighting { no_default: true, ..Lighting::default() };
    let options = LoadOptions { lighting, ..LoadOptions::default() };
    let Ok(loaded) = load_with("m.glb", &[("m.glb", bytes)], &options) else { return false };
    for mesh in &loaded.scene.meshes {
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3));
        assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
    }
    assert!(loaded.cameras.path.iter().chain([&loaded.cameras.still]).all(|c| c.origin.is_finite()));
    true
}

#[test]
fn cut_and_flipped_files_never_panic() {
    let mut random = Lcg(3);
    let (mut survived, mut failed) = (0, 0);
    for (_, model, _) in samples::all() {
        let whole = model.glb();
        for round in 0..120 {
            let mut bytes = whole.clone();
            let json = whole.len() - model.binary.len().next_multiple_of(4);
            match round % 4 {
                0 => bytes.truncate(random.below(whole.len())),
                1 => (0..=random.below(6)).for_each(|_| {
                    let at = random.below(bytes.len());
                    bytes[at] = random.below(256) as u8;
                }),
                2 => {
                    // Another digit gives types, counts, offsets and indices out of range.
                    let digits: Vec<usize> = (20..json).filter(|&i| bytes[i].is_ascii_digit()).collect();
                    bytes[digits[random.below(digits.len())]] = b"0123456789"[random.below(10)];
                }
                _ => {
                    let at = json + random.below(bytes.len() - json);
                    bytes[at] = random.below(256) as u8;
                }
            }
            match survives(&bytes) {
                true => survived += 1,
                false => failed += 1,
            }
        }
    }
    assert!(survived > 100 && failed > 100, "{survived} {failed}: the damage is one-sided");
}

/// Replaces every number of every model by absurd ones, one at a time.
///
/// Where a property is first met, all of them are tried, and elsewhere one of them in turn.
#[test]
fn absurd_numbers_never_panic() {
    let absurd = [json!(4_294_967_295u32), json!(1e39), json!(-1), json!(u64::MAX), json!(5125), Value::Null];
    let mut properties = BTreeSet::new();
    for (_, model, _) in samples::all() {
        let mut places = Vec::new();
        numbers(&model.json, &mut Vec::new(), &mut places);
        for (turn, place) in places.into_iter().enumerate() {
            let keys: Vec<String> = place.iter().filter_map(Member::key).collect();
            let values = match properties.insert(keys) {
                true => &absurd[..],
                false => &absurd[turn % absurd.len()..][..1],
            };
            for absurd in values {
                let mut json = model.json.clone();
                let at = place.iter().fold(&mut json, |at, step| match step {
                    Member::Key(key) => &mut at[key.as_str()],
                    Member::Index(index) => &mut at[*index],
                });
                *at = absurd.clone();
                survives(&Model { json, binary: model.binary.clone() }.glb());
            }
        }
    }
}

#[derive(Clone)]
enum Member {
    Key(String),
    Index(usize),
}

impl Member {
    fn key(&self) -> Option<String> {
        match self {
            Member::Key(key) => Some(key.clone()),
            Member::Index(_) => None,
        }
    }
}

fn numbers(value: &Value, way: &mut Vec<Member>, found: &mut Vec<Vec<Member>>) {
    match value {
        Value::Number(_) => found.push(way.clone()),
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                way.push(Member::Index(i));
                numbers(value, way, found);
                way.pop();
            }
        }
        Value::Object(object) => {
            for (key, value) in object {
                way.push(Member::Key(key.clone()));
                numbers(value, way, found);
                way.pop();
            }
        }
        _ => {}
    }
}

/// Loads a square after a change; returns the error.
fn error(change: impl Fn(&mut Model)) -> String {
    let mut model = Model::new();
    let mesh = model.square(None);
    model.node(json!({ "mesh": mesh }));
    change(&mut model);
    let message = load_bytes("m.glb", &model.glb()).map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("m.glb: ") && message.contains("; "), "{message}");
    message
}

#[test]
fn what_is_wrong_is_named_with_a_remedy() {
    let says = |message: String, part: &str| assert!(message.contains(part), "{message}");
    says(error(|m| m.json["accessors"][0]["componentType"] = json!(5125)), "the wrong type");
    says(error(|m| m.json["accessors"][0]["componentType"] = json!(7)), "unknown type");
    says(error(|m| m.json["accessors"][0]["type"] = json!("VEC2")), "the wrong type");
    says(error(|m| m.json["accessors"][3]["componentType"] = json!(COMPONENT_F32)), "the wrong type");
    says(error(|m| m.json["accessors"][0]["count"] = json!(1_000_000_000_000u64)), "do not fit");
    says(error(|m| m.json["accessors"][0]["byteOffset"] = json!(u64::MAX)), "do not fit");
    says(error(|m| m.json["accessors"][1]["count"] = json!(3)), "4 vertices and 3 normals");
    says(error(|m| m.json["bufferViews"][0]["byteLength"] = json!(1u64 << 40)), "beyond its buffer");
    says(error(|m| m.json["bufferViews"][0]["byteStride"] = json!(4)), "do not fit");
    says(
        error(|m| m.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99)),
        "accessor 99",
    );
    says(error(|m| m.json["meshes"][0]["primitives"][0]["material"] = json!(5)), "material 5");
    says(error(|m| m.json["meshes"][0]["primitives"][0]["mode"] = json!(9)), "mode is unknown");
    says(error(|m| m.json["nodes"][0]["children"] = json!([0])), "below itself");
    says(error(|m| m.json["nodes"][0]["mesh"] = json!(3)), "mesh 3");
    says(error(|m| m.json["scene"] = json!(4)), "scene 4");
    says(error(|m| m.json["asset"] = json!(4)), "syntax");
    let sparse =
        json!({ "bufferView": Value::Null, "componentType": 5126, "type": "VEC3", "count": 1u64 << 50 });
    says(error(|m| m.json["accessors"][0] = sparse.clone()), "than any real model");
    let twice = |m: &mut Model| {
        let child = m.push("nodes", json!({}));
        m.node(json!({ "children": [child, child] }));
    };
    says(error(twice), "two parents");
    let required = |m: &mut Model| {
        m.push("extensionsRequired", json!("KHR_texture_basisu"));
    };
    says(error(required), "export textures as PNG, JPEG or WebP");
    says(load_bytes("m.glb", b"glTF\x01\0\0\0\0\0\0\0").map(|_| ()).unwrap_err().to_string(), "version 1");
    says(load_bytes("m.gltf", b"{\n\"asset\": [\n}").map(|_| ()).unwrap_err().to_string(), "m.gltf:3");
}

/// A small file has many triangles: a hundred thousand instances of a mesh of ten thousand triangles. Instances that
/// emit are copies.
#[test]
fn copies_beyond_memory_are_an_error_and_instances_are_not() {
    let mut model = Model::new();
    let material = model.push("materials", json!({}));
    let mesh = model.square(Some(material));
    let corners: Vec<u16> = (0..30_000).map(|i| i % 4).collect();
    let indices = model.indices(&corners);
    model.json["meshes"][mesh]["primitives"][0]["indices"] = json!(indices);
    let nodes: Vec<Value> = (0..100_000).map(|_| json!({ "mesh": mesh })).collect();
    model.json["scenes"][0]["nodes"] = (0..nodes.len()).collect();
    model.json["nodes"] = Value::Array(nodes);
    let scene = load_bytes("m.glb", &model.glb()).unwrap().scene;
    assert_eq!((scene.triangle_count(), scene.groups[0].placements.len()), (10_000, 100_000));
    assert_eq!(scene.seen_triangle_count(), 1_000_000_000);
    model.json["materials"][material]["emissiveFactor"] = json!([1, 1, 1]);
    let message = load_bytes("m.glb", &model.glb()).map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("triangles that fit into memory"), "{message}");
}
