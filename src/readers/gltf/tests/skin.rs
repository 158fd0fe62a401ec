//! Tests of skins and morph targets.

use super::model::Model;
use super::samples::{all, arm, face};
use super::{bounds, load_beside, load_bytes};
use crate::{LoadOptions, Loaded, load};
use glam::Vec3;
use serde_json::{Value, json};

fn loaded(model: &Model) -> Loaded {
    load_bytes("m.glb", &model.glb()).unwrap()
}

/// Returns the model in its pose at `time`.
fn posed(model: &Model, time: f64) -> Result<Loaded, String> {
    let scene = format!("[[mesh]]\nfile = \"m.glb\"\ntime = {time}\n[environment]\nradiance = 1\n");
    load_beside("s.toml", &[("m.glb", &model.glb()), ("s.toml", scene.as_bytes())]).map_err(|e| e.to_string())
}

fn positions(loaded: &Loaded, mesh: usize) -> Vec<Vec3> {
    let centre = loaded.scene.centre.as_vec3();
    loaded.scene.meshes[mesh].positions.iter().map(|p| *p + centre).collect()
}

/// Returns the positions of the first mesh.
fn arrays(loaded: &Loaded) -> Vec<[f32; 3]> {
    positions(loaded, 0).into_iter().map(Into::into).collect()
}

fn assert_close(found: &[Vec3], expected: &[[f32; 3]]) {
    let close = found.iter().zip(expected).all(|(a, b)| a.distance(Vec3::from(*b)) < 1e-5);
    assert!(close && found.len() == expected.len(), "{found:?}");
}

/// Corners of the arm in its pose: (1, ±1) bound at -1 are (0, ±1), turned to (∓1, 0), at x = 5.
const BENT: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [6.0, 0.0, 0.0], [4.0, 0.0, 0.0], [-1.0, 1.0, 0.0]];

#[test]
fn joints_place_the_vertices_and_the_node_does_not() {
    let model = arm();
    assert_close(&positions(&loaded(&model), 0), &BENT);
    // All below a turned and mirrored node: the whole moves.
    let mut turned = model.json.clone();
    turned["scenes"][0]["nodes"] = json!([3]);
    turned["nodes"].as_array_mut().unwrap().push(json!({ "children": [0, 1, 2], "scale": [-1, 1, 1] }));
    let turned = Model { json: turned, binary: model.binary.clone() };
    let mirrored = loaded(&turned);
    assert_close(&positions(&mirrored, 0), &BENT.map(|[x, y, z]| [-x, y, z]));
    // Weights of shorts, of floats that do not sum up to 1, and in a second set, are the same.
    let mut model = arm();
    let shorts: Vec<u8> = [[65535u16, 0, 0, 0], [0, 65535, 0, 0], [0, 65535, 0, 0], [65535, 0, 0, 0]]
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let shorts = model.accessor(&shorts, 5123, "VEC4", 4);
    model.json["accessors"][shorts]["normalized"] = json!(true);
    model.attributes(0, &[("WEIGHTS_0", shorts)]);
    assert_close(&positions(&loaded(&model), 0), &BENT);
    let first = model.floats(&[[0.5, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.5, 0.0, 0.0, 0.0]]);
    let second = model.floats(&[[0.0; 4], [0.25; 4], [0.25; 4], [0.0; 4]]);
    let joints: Vec<u8> = [1u16; 16].iter().flat_map(|v| v.to_le_bytes()).collect();
    let joints = model.accessor(&joints, 5123, "VEC4", 4);
    model.attributes(0, &[("WEIGHTS_0", first), ("WEIGHTS_1", second), ("JOINTS_1", joints)]);
    assert_close(&positions(&loaded(&model), 0), &BENT);
}

#[test]
fn shares_of_joints_are_mixed_and_normals_follow() {
    let mut model = arm();
    let weights = model.floats(&[[0.25, 0.75, 0.0, 0.0]; 4]);
    let tilted = model.floats(&[[1.0, 0.0, 0.0]; 4]);
    model.attributes(0, &[("WEIGHTS_0", weights), ("NORMAL", tilted)]);
    let found = loaded(&model);
    // The corner (1, 1) is at (1, 1) by the first joint, and at (4, 0) by the second.
    assert!(positions(&found, 0)[2].distance(Vec3::new(3.25, 0.25, 0.0)) < 1e-5);
    // Both matrices are rotations: the mean of their matrices turns x to (0.25, 0.75).
    let expected = Vec3::new(0.25, 0.75, 0.0).normalize();
    assert!(
        found.scene.meshes[0].normals[0].distance(expected) < 1e-5,
        "{:?}",
        found.scene.meshes[0].normals
    );
    // Without normals, joints that mirror keep the front in front.
    let mut model = arm();
    model.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    let front = |model: &Model| {
        let [a, b, c] = loaded(model).scene.meshes[0].corners(0);
        (b - a).cross(c - a).z
    };
    let flat = front(&model);
    model.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    model.json["nodes"][1]["translation"] = json!([-5, 0, 0]);
    model.json["nodes"][1]["scale"] = json!([-1, 1, 1]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    model.json["nodes"][1]["rotation"] = json!([0, 0, -half, half]);
    assert!(flat * front(&model) > 0.0, "{flat}");
}

#[test]
fn morph_targets_stand_by_their_weights_and_move_with_time() {
    let model = face();
    let near = |a: Vec3, b: [f32; 3]| a.distance(Vec3::from(b)) < 1e-5;
    let rest = loaded(&model);
    assert!(bounds(&rest, 0).iter().zip([[-1.0, -1.0, 2.0], [1.0, 1.0, 2.0]]).all(|(a, b)| near(*a, b)));
    assert!(bounds(&rest, 1).iter().zip([[-3.0, 9.0, 4.0], [3.0, 11.0, 4.0]]).all(|(a, b)| near(*a, b)));
    assert!(near(rest.scene.meshes[0].normals[0], Vec3::new(0.5, 0.0, 1.0).normalize().to_array()));
    assert!(
        rest.warnings.iter().any(|warning| warning.what == "there is an animation of 25 frames"),
        "{:?}",
        rest.warnings
    );
    // At a quarter, the line gives weights of 0.25 and 0.0625.
    let quarter = posed(&model, 0.25).unwrap();
    assert!(quarter.warnings.is_empty(), "{:?}", quarter.warnings);
    assert!(
        bounds(&quarter, 0).iter().zip([[-1.125, -1.0, 1.0], [1.125, 1.0, 1.0]]).all(|(a, b)| near(*a, b))
    );
    // Hermite splines: one from 1, of slope 4 there, to 0; one from 0 to 1 that is level at both ends.
    let t = 0.25f32;
    let steep = 2.0 * t.powi(3) - 3.0 * t * t + 1.0 + 4.0 * (t.powi(3) - 2.0 * t * t + t);
    let level = 3.0 * t * t - 2.0 * t.powi(3);
    let low = [-1.0 - 2.0 * level, 9.0, 4.0 * steep + 0.5];
    assert!(near(bounds(&quarter, 1)[0], low), "{:?} {low:?}", bounds(&quarter, 1));
    let mut still = model.json.clone();
    still["animations"] = Value::Null;
    still.as_object_mut().unwrap().remove("animations");
    let message = posed(&Model { json: still, binary: model.binary.clone() }, 1.0).unwrap_err();
    assert!(message.contains("s.toml:1") && message.contains("leave time out"), "{message}");
}

#[test]
fn skins_and_targets_that_do_not_fit_are_errors() {
    let error = |mut model: Model, change: &dyn Fn(&mut Model)| {
        change(&mut model);
        load_bytes("m.glb", &model.glb()).unwrap_err().to_string()
    };
    let says = |message: String, part: &str| assert!(message.contains(part), "{message}");
    let first = |m: &mut Model, attribute: &str, value: Value| {
        m.json["meshes"][0]["primitives"][0]["attributes"][attribute] = value;
    };
    says(error(arm(), &|m| m.json["skins"][0]["joints"] = json!([0])), "a joint beyond the 1 of its skin");
    says(error(arm(), &|m| m.json["skins"][0]["joints"] = json!([0, 77])), "node 77 does not exist");
    says(error(arm(), &|m| m.json["scenes"][0]["nodes"] = json!([0, 2])), "node 1, is not in the scene");
    says(error(arm(), &|m| m.json["skins"][0]["joints"] = json!([0, 1, 0])), "3 joints and 2 matrices");
    says(error(arm(), &|m| m.json["nodes"][2]["skin"] = json!(3)), "skin 3");
    says(error(arm(), &|m| first(m, "JOINTS_0", json!(0))), "the wrong type");
    says(error(arm(), &|m| first(m, "WEIGHTS_0", json!(99))), "accessor 99");
    says(error(arm(), &|m| first(m, "WEIGHTS_1", json!(5))), "joints without weights");
    let few = |m: &mut Model| m.json["accessors"][4]["count"] = json!(3);
    says(error(arm(), &few), "3 joints and 4 weights");
    says(error(face(), &|m| m.json["accessors"][4]["count"] = json!(3)), "morph target 0 has 3");
}

#[test]
fn frames_of_an_animation_are_poses_of_models_without_a_scene_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    std::fs::write(&path, face().glb()).unwrap();
    let at = |frame| load(&path, &LoadOptions { frame, ..LoadOptions::default() }).unwrap();
    // The animation takes a second: frames 1 to 25, of which frame 7 is at a quarter.
    let (rest, first, seventh) = (at(None), at(Some(1)), at(Some(7)));
    assert_eq!((rest.cameras.path.len(), seventh.cameras.path.len()), (0, 25));
    assert_close(&positions(&seventh, 0), &arrays(&posed(&face(), 0.25).unwrap()));
    assert_close(&positions(&first, 0), &arrays(&posed(&face(), 0.0).unwrap()));
    assert!(rest.hash != first.hash && first.hash != seventh.hash);
    let fallbacks =
        |loaded: &Loaded| loaded.warnings.iter().any(|warning| warning.fallback.contains("--frame"));
    assert!(fallbacks(&rest) && !fallbacks(&seventh));
    assert!(first.moves && seventh.moves && !rest.moves);
    // A model without an animation has no frames.
    std::fs::write(&path, arm().glb()).unwrap();
    assert!(at(Some(7)).cameras.path.is_empty() && at(Some(7)).hash == at(None).hash);
}

#[test]
fn a_model_moves_if_a_mesh_a_light_or_a_joint_does() {
    let moves = |mut model: Model, node: usize, last: [f32; 3]| {
        let (times, places) = (model.floats(&[[0.0], [1.0]]), model.floats(&[[5.0, 0.0, 0.0], last]));
        model.json["animations"] = json!([{
            "samplers": [{ "input": times, "output": places }],
            "channels": [{ "sampler": 0, "target": { "node": node, "path": "translation" } }],
        }]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.glb");
        std::fs::write(&path, model.glb()).unwrap();
        let loaded = load(&path, &LoadOptions { frame: Some(3), ..LoadOptions::default() }).unwrap();
        assert_eq!(loaded.cameras.path.len(), 25);
        loaded.moves
    };
    let sample = |name: &str| all().into_iter().find(|(own, ..)| *own == name).unwrap().1;
    let away = [6.0, 0.0, 0.0];
    assert!(moves(arm(), 0, away) && moves(arm(), 1, away) && !moves(arm(), 1, [5.0, 0.0, 0.0]));
    assert!(moves(sample("lights"), 1, away));
    assert!(moves(sample("instances"), 0, away) && moves(sample("instances"), 2, away));
    // A camera and the node that carries it, and a square beside them.
    assert!(!moves(sample("camera"), 0, away) && !moves(sample("camera"), 1, away));
    assert!(moves(sample("camera"), 2, away));
}
