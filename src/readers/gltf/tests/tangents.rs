//! Tests of the tangents of vertices.

use super::model::Model;
use super::{load_bytes, samples};
use glam::{Vec3, Vec4};
use serde_json::{Value, json};

/// Returns a square with a normal map and tangents along y, left-handed if `w` is -1.
fn mapped(w: f32) -> Model {
    let mut model = Model::new();
    let relief = model.texture([[128, 128, 255, 255]; 4], json!({}));
    model.shown(json!({ "name": "tiles", "normalTexture": { "index": relief } }));
    give_tangents(&mut model, w);
    model
}

fn give_tangents(model: &mut Model, w: f32) {
    let tangents = model.floats(&[[0.0, 1.0, 0.0, w]; 4]);
    model.attributes(0, &[("TANGENT", tangents)]);
}

fn tangents(model: &Model) -> Vec<Vec4> {
    load_bytes("m.glb", &model.glb()).unwrap().scene.meshes[0].tangents.clone()
}

fn assert_all(found: &[Vec4], expected: [f32; 4]) {
    let close = found.iter().all(|t| t.distance(expected.into()) < 1e-5);
    assert!(close && found.len() == 4, "{found:?} {expected:?}");
}

#[test]
fn tangents_follow_nodes_and_mirrors_swap_their_hand() {
    for w in [1.0, -1.0] {
        let mut model = mapped(w);
        assert_all(&tangents(&model), [0.0, 1.0, 0.0, w]);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        model.json["nodes"][0]["rotation"] = json!([half, 0, 0, half]);
        model.json["nodes"][0]["scale"] = json!([2, 5, 3]);
        assert_all(&tangents(&model), [0.0, 0.0, 1.0, w]);
        model.json["nodes"][0]["scale"] = json!([-2, 5, 3]);
        assert_all(&tangents(&model), [0.0, 0.0, 1.0, -w]);
        model.json["nodes"][0]["scale"] = json!([-2, -5, 3]);
        assert_all(&tangents(&model), [0.0, 0.0, -1.0, w]);
    }
}

#[test]
fn mirrored_models_are_mirror_images() {
    // The y axis of the texture's frame is the normal × the tangent × w. It is mirrored as everything else is.
    let y = |model: &Model| {
        let mesh = &load_bytes("m.glb", &model.glb()).unwrap().scene.meshes[0];
        let tangent = mesh.tangents[0];
        mesh.normals[0].cross(tangent.truncate()) * tangent.w
    };
    let mut model = mapped(1.0);
    let plain = y(&model);
    model.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    assert!(y(&model).distance(plain * Vec3::new(-1.0, 1.0, 1.0)) < 1e-6, "{plain}");
}

#[test]
fn tangents_follow_joints_and_morph_targets() {
    let mut model = samples::arm();
    let relief = model.texture([[128, 128, 255, 255]; 4], json!({}));
    let material = model.push("materials", json!({ "normalTexture": { "index": relief } }));
    model.json["meshes"][0]["primitives"][0]["material"] = json!(material);
    give_tangents(&mut model, 1.0);
    // The right edge follows a joint that is turned by 90° about z, and then mirrored in y.
    let found = tangents(&model);
    assert!(found[0].distance(Vec4::new(0.0, 1.0, 0.0, 1.0)) < 1e-5, "{found:?}");
    assert!(found[1].distance(Vec4::new(-1.0, 0.0, 0.0, 1.0)) < 1e-5, "{found:?}");
    model.json["nodes"][1]["scale"] = json!([1, -1, 1]);
    let found = tangents(&model);
    assert!(found[1].distance(Vec4::new(1.0, 0.0, 0.0, -1.0)) < 1e-5, "{found:?}");

    let mut model = mapped(-1.0);
    let turned = model.floats(&[[1.0, -1.0, 0.0]; 4]);
    model.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "TANGENT": turned }]);
    model.json["meshes"][0]["weights"] = json!([1]);
    assert_all(&tangents(&model), [1.0, 0.0, 0.0, -1.0]);
}

#[test]
fn tangents_are_read_where_a_material_knows_a_direction() {
    let mut model = mapped(1.0);
    model.json["materials"][0] = json!({});
    assert!(tangents(&model).is_empty());
    let brushed = json!({ "KHR_materials_anisotropy": { "anisotropyStrength": 0.5 } });
    model.json["materials"][0] =
        json!({ "extensions": brushed, "pbrMetallicRoughness": { "roughnessFactor": 0.4 } });
    assert_all(&tangents(&model), [0.0, 1.0, 0.0, 1.0]);
    let attributes = &mut model.json["meshes"][0]["primitives"][0]["attributes"];
    attributes.as_object_mut().unwrap().remove("NORMAL");
    assert!(tangents(&model).is_empty());
    let mut few = mapped(1.0);
    let last = few.json["accessors"].as_array().unwrap().len() - 1;
    few.json["accessors"][last]["count"] = json!(3);
    let message = load_bytes("m.glb", &few.glb()).unwrap_err().to_string();
    assert!(message.contains("4 vertices and 3 tangents"), "{message}");
    few.json["accessors"][last]["count"] = json!(4);
    few.json["accessors"][last]["componentType"] = Value::Null;
    assert!(load_bytes("m.glb", &few.glb()).is_err());
    // A tangent that is no number leaves the direction of u.
    let mut bad = mapped(1.0);
    let tangents = bad.floats(&[[f32::NAN, 1.0, 0.0, 1.0]; 4]);
    bad.attributes(0, &[("TANGENT", tangents)]);
    let loaded = load_bytes("m.glb", &bad.glb()).unwrap();
    assert!(loaded.scene.meshes[0].tangents.iter().all(|t| t.truncate() == Vec3::ZERO));
}
