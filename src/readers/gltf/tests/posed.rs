//! Models with skins and morph targets.

use super::model::Model;
use serde_json::json;

pub const IDENTITY: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

/// Returns the matrix of a translation, by columns.
pub fn shifted(x: f32, y: f32, z: f32) -> [f32; 16] {
    let mut matrix = IDENTITY;
    matrix[12..15].copy_from_slice(&[x, y, z]);
    matrix
}

/// Returns a square whose left edge follows one joint and whose right edge another, a node that shows it and joints.
///
/// The square is bound at x = 10. The joints are at x = 0 and at x = 5, the second turned by 90° about z.
pub fn arm() -> Model {
    let mut model = Model::new();
    let mesh = model.square(None);
    let joints = model.accessor(&[0, 1, 0, 0].repeat(4), 5121, "VEC4", 4);
    let weights: Vec<u8> =
        [[255, 0, 0, 0], [0, 255, 0, 0], [0, 255, 0, 0], [255, 0, 0, 0]].into_iter().flatten().collect();
    let weights = model.accessor(&weights, 5121, "VEC4", 4);
    model.json["accessors"][weights]["normalized"] = json!(true);
    model.attributes(mesh, &[("JOINTS_0", joints), ("WEIGHTS_0", weights)]);
    let bound = model.floats(&[shifted(0.0, 0.0, 0.0), shifted(-1.0, 0.0, 0.0)]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let left = model.node(json!({ "name": "left" }));
    let right =
        model.node(json!({ "name": "right", "translation": [5, 0, 0], "rotation": [0, 0, half, half] }));
    let skin = model.push("skins", json!({ "joints": [left, right], "inverseBindMatrices": bound }));
    // The node of the mesh has a transform of its own, which does not count.
    model.node(json!({ "mesh": mesh, "skin": skin, "translation": [0, 100, 0], "scale": [-3, 1, 1] }));
    model
}

/// Returns a square with two morph targets and animated weights.
pub fn face() -> Model {
    let mut model = Model::new();
    let mesh = model.square(None);
    let up = model.floats(&[[0.0, 0.0, 4.0]; 4]);
    let wide = model.floats(&[[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [-2.0, 0.0, 0.0]]);
    let tilt = model.floats(&[[1.0, 0.0, 0.0]; 4]);
    model.json["meshes"][mesh]["primitives"][0]["targets"] =
        json!([{ "POSITION": up, "NORMAL": tilt }, { "POSITION": wide }]);
    model.json["meshes"][mesh]["weights"] = json!([0.5, 0]);
    model.node(json!({ "mesh": mesh }));
    model.node(json!({ "mesh": mesh, "weights": [1, 1], "translation": [0, 10, 0] }));
    let times = model.floats(&[[0.0], [1.0]]);
    let line = model.floats(&[[0.0], [0.0], [1.0], [0.25]]);
    let spline: Vec<[f32; 1]> = [0., 0., 1., 0., 4., 0., 0., 0., 0., 1., 0., 0.].map(|v| [v]).to_vec();
    let spline = model.floats(&spline);
    let still = model.floats(&[[0.0, 10.0, 0.0], [0.0, 10.0, 2.0]]);
    let target = |node: usize, path: &str| json!({ "node": node, "path": path });
    model.push("animations", json!({
        "samplers": [
            { "input": times, "output": line }, { "input": times, "output": spline, "interpolation": "CUBICSPLINE" },
            { "input": times, "output": still },
        ],
        "channels": [
            { "sampler": 0, "target": target(0, "weights") }, { "sampler": 1, "target": target(1, "weights") },
            { "sampler": 2, "target": target(1, "translation") },
        ],
    }));
    model
}
