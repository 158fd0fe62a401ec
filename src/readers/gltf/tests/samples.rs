//! Sample models for every feature.

use super::model::Model;
use super::packed;
use serde_json::{Value, json};

const WHITE: [u8; 4] = [255; 4];
const CLEAR: [u8; 4] = [255, 255, 255, 0];

/// Returns every model with its name and the unsupported features that it asks for.
pub fn all() -> Vec<(&'static str, Model, &'static [&'static str])> {
    vec![
        ("instances", instances(), &[]),
        ("instancing", instancing(), &[]),
        ("textures", textures(), &["different wrap modes"]),
        ("emission", emission(), &[]),
        ("lights", lights(), &[]),
        ("camera", camera(), &[]),
        ("alpha", alpha(), &[]),
        ("glass", glass(), &["sheets that transmit in part"]),
        ("layers", layers(), &["a quarter", "sheen", "coloured reflection"]),
        ("unlit", unlit(), &["unlit"]),
        ("topology", topology(), &["points and lines"]),
        ("skin", arm(), &[]),
        ("draco", packed::draco(&packed::hex(packed::EDGEBREAKER)), &[]),
        ("draco in order", packed::draco(&packed::hex(packed::SEQUENTIAL)), &[]),
        ("meshopt", packed::meshopt("EXT_meshopt_compression"), &[]),
        ("face", face(), &[]),
        (
            "unmodelled",
            unmodelled(),
            &["a skin whose mesh", "KHR_materials_iridescence", "EXT_x", "several sets"],
        ),
    ]
}

/// Returns two instances of a mesh below a rotated node, and one scaled by a matrix.
fn instances() -> Model {
    let mut model = Model::new();
    let material = json!({
        "name": "brass", "pbrMetallicRoughness": {
            "baseColorFactor": [0.9, 0.7, 0.3, 1], "metallicFactor": 1, "roughnessFactor": 0.4,
        },
    });
    let material = model.push("materials", material);
    let mesh = model.square(Some(material));
    let left = model.push("nodes", json!({ "mesh": mesh, "name": "left", "translation": [-3, 0, 0] }));
    let right = model.push(
        "nodes",
        json!({ "mesh": mesh, "name": "right", "translation": [3, 0, 0], "scale": [1, 2, 1] }),
    );
    let half = std::f32::consts::FRAC_1_SQRT_2;
    model.node(json!({ "name": "pair", "children": [left, right], "rotation": [0, half, 0, half] }));
    let matrix = json!([2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 10, 0, 1]);
    model.node(json!({ "mesh": mesh, "name": "big", "matrix": matrix }));
    model
}

/// Returns a mesh with two instances by the extension.
fn instancing() -> Model {
    let mut model = Model::new();
    let mesh = model.square(None);
    let translations = model.floats(&[[-2.0, 0.0, 0.0], [2.0, 1.0, -1.0]]);
    let rotations = model.floats(&[[0.0, 0.6, 0.0, 0.8], [0.0, 0.0, 0.0, 1.0]]);
    let scales = model.floats(&[[1.0, 2.0, 1.0], [-1.0, 1.0, 1.0]]);
    let attributes = json!({ "TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales });
    model.push("extensionsUsed", json!("EXT_mesh_gpu_instancing"));
    let extensions = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    model.node(json!({ "mesh": mesh, "name": "row", "extensions": extensions }));
    model
}

fn textures() -> Model {
    let mut model = Model::new();
    let texels = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], WHITE];
    let nearest = json!({ "magFilter": 9728, "wrapS": 33071, "wrapT": 10497 });
    let colour = model.texture(texels, nearest);
    let surface = model.texture([[0, 128, 255, 255]; 4], json!({ "wrapS": 33648, "wrapT": 33648 }));
    let transform = json!({ "offset": [0.25, 0.5], "rotation": 0.5, "scale": [2, 3] });
    let relief = model.texture([[128, 128, 255, 255]; 4], json!({}));
    let relief = json!({ "index": relief, "scale": 0.5 });
    model.shown(json!({ "name": "tiles", "normalTexture": relief, "pbrMetallicRoughness": {
        "baseColorTexture": { "index": colour, "extensions": { "KHR_texture_transform": transform } },
        "metallicRoughnessTexture": { "index": surface }, "metallicFactor": 0.5, "roughnessFactor": 0.8,
    } }));
    model.uses("KHR_texture_transform");
    model
}

fn emission() -> Model {
    let mut model = Model::new();
    let texture = model.texture([WHITE, WHITE, [0, 0, 0, 255], WHITE], json!({}));
    model.shown(json!({
        "name": "screen", "emissiveFactor": [1, 0.5, 0.25], "emissiveTexture": { "index": texture },
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 12 } },
    }));
    model.uses("KHR_materials_emissive_strength");
    model
}

fn lights() -> Model {
    let mut model = Model::new();
    model.json["asset"]["generator"] = json!("Khronos glTF Blender I/O v4.3.47");
    let light = |kind: &str, more: Value| {
        let mut light = json!({ "type": kind, "color": [1, 0.5, 0.25], "intensity": 683 });
        light.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        light
    };
    model.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        light("point", json!({ "range": 5 })), light("directional", json!({})),
        light("spot", json!({ "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.5 } })),
    ] } });
    for number in 0..3 {
        let reference = json!({ "KHR_lights_punctual": { "light": number } });
        model.node(json!({ "translation": [0, 4, number], "extensions": reference }));
    }
    let mesh = model.square(None);
    model.node(json!({ "mesh": mesh }));
    model.uses("KHR_lights_punctual");
    model
}

/// Returns a camera that one animation moves with each interpolation, and rotates. Another animation moves it, too, and
/// a square.
fn camera() -> Model {
    let mut model = Model::new();
    let lens =
        json!({ "type": "perspective", "perspective": { "yfov": 1.0, "aspectRatio": 2.0, "znear": 0.1 } });
    let camera = model.push("cameras", lens);
    let eye = model.push("nodes", json!({ "camera": camera, "name": "Camera", "translation": [0, 0, 5] }));
    let dolly = model.node(json!({ "name": "dolly", "children": [eye] }));
    let mesh = model.square(None);
    let square = model.node(json!({ "mesh": mesh, "name": "square" }));
    let times = model.floats(&[[0.5], [1.5], [2.5]]);
    let line = model.floats(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 8.0, 0.0]]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = model.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, half, 0.0, half], [0.0, 1.0, 0.0, 0.0]]);
    let still = [0.0; 3];
    let spline = model.floats(&[
        still,
        [0.0, 0.0, 5.0],
        [0.0, 0.0, 2.0],
        still,
        [0.0, 0.0, 6.0],
        still,
        still,
        [0.0, 0.0, 6.0],
        still,
    ]);
    let channel = |sampler: usize, node: usize, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    model.push("animations", json!({
        "name": "walk",
        "samplers": [
            { "input": times, "output": line }, { "input": times, "output": turns, "interpolation": "STEP" },
            { "input": times, "output": spline, "interpolation": "CUBICSPLINE" },
        ],
        "channels": [channel(0, dolly, "translation"), channel(1, dolly, "rotation"), channel(2, eye, "translation")],
    }));
    model.push(
        "animations",
        json!({
            "name": "other", "samplers": [{ "input": times, "output": line }],
            "channels": [channel(0, dolly, "translation"), channel(0, square, "translation")],
        }),
    );
    model
}

fn alpha() -> Model {
    let mut model = Model::new();
    let texels = [WHITE, CLEAR, [255, 255, 255, 100], WHITE];
    let texture = model.texture(texels, json!({}));
    let nearest = model.texture(texels, json!({ "magFilter": 9728 }));
    let pbr = |alpha: f32, texture: Option<usize>| match texture {
        Some(texture) => {
            json!({ "baseColorFactor": [1, 1, 1, alpha], "baseColorTexture": { "index": texture } })
        }
        None => json!({ "baseColorFactor": [1, 1, 1, alpha] }),
    };
    for (mode, alpha, texture) in [
        ("MASK", 0.5, Some(texture)),
        ("BLEND", 0.25, None),
        ("BLEND", 0.5, Some(texture)),
        ("OPAQUE", 0.5, None),
        ("MASK", 0.4, None),
        ("MASK", 0.5, Some(nearest)),
    ] {
        model.shown(
            json!({ "alphaMode": mode, "alphaCutoff": 0.45, "pbrMetallicRoughness": pbr(alpha, texture) }),
        );
    }
    model
}

fn glass() -> Model {
    let mut model = Model::new();
    let pbr = |roughness: f32| json!({ "roughnessFactor": roughness, "metallicFactor": 0 });
    let all = json!({ "transmissionFactor": 1 });
    let volume = json!({ "thicknessFactor": 2, "attenuationDistance": 1, "attenuationColor": [0.5, 1, 0.5] });
    model.shown(json!({ "name": "pane", "pbrMetallicRoughness": pbr(0.0), "extensions": { "KHR_materials_transmission": all } }));
    model.shown(json!({ "name": "solid", "pbrMetallicRoughness": pbr(0.0), "extensions": {
        "KHR_materials_transmission": all, "KHR_materials_volume": volume, "KHR_materials_ior": { "ior": 1.8 },
    } }));
    model.shown(json!({ "name": "frosted", "pbrMetallicRoughness": pbr(0.5), "extensions": {
        "KHR_materials_transmission": all, "KHR_materials_volume": { "thicknessFactor": 1 },
    } }));
    model.shown(json!({ "name": "veil", "pbrMetallicRoughness": pbr(0.0), "extensions": {
        "KHR_materials_transmission": { "transmissionFactor": 0.3 },
    } }));
    for extension in ["transmission", "volume", "ior"] {
        model.uses(&format!("KHR_materials_{extension}"));
    }
    model
}

fn layers() -> Model {
    let mut model = Model::new();
    let texture = model.texture([[255, 0, 0, 255]; 4], json!({}));
    model.shown(json!({ "name": "car", "extensions": { "KHR_materials_clearcoat": {
        "clearcoatFactor": 0.75, "clearcoatTexture": { "index": texture }, "clearcoatRoughnessFactor": 0.1,
    } } }));
    model.shown(json!({ "name": "velvet", "extensions": {
        "KHR_materials_sheen": { "sheenColorFactor": [0.5, 0.25, 0], "sheenRoughnessFactor": 0.4 },
    } }));
    model.shown(json!({ "name": "dull", "extensions": {
        "KHR_materials_specular": { "specularFactor": 0.25, "specularColorFactor": [1, 0.9, 0.8] },
    } }));
    let brushed = |roughness: f32, strength: f32| {
        json!({
            "name": format!("brushed {roughness}"),
            "pbrMetallicRoughness": { "metallicFactor": 1, "roughnessFactor": roughness },
            "extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": strength, "anisotropyRotation": 0.5 } },
        })
    };
    model.shown(brushed(0.5, 0.6));
    model.shown(brushed(0.1, 1.0));
    for extension in ["clearcoat", "sheen", "specular", "anisotropy"] {
        model.uses(&format!("KHR_materials_{extension}"));
    }
    model
}

fn unlit() -> Model {
    let mut model = Model::new();
    model.shown(json!({
        "name": "sign", "doubleSided": true, "pbrMetallicRoughness": { "baseColorFactor": [0.2, 0.4, 0.8, 1] },
        "extensions": { "KHR_materials_unlit": {} },
    }));
    let label = model.shown(json!({
        "name": "label", "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.25, 0.25] },
        "extensions": { "KHR_materials_unlit": {} },
    }));
    model.json["nodes"][label]["translation"] = json!([0, 0, 1]);
    model.uses("KHR_materials_unlit");
    model
}

/// Returns strips, fans, points, quantised and sparse positions.
fn topology() -> Model {
    let mut model = Model::new();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
    let positions = model.floats(&corners);
    let short: Vec<u8> = [[0i16, 0, 0, 0], [32767, 0, 0, 0], [0, 32767, 0, 0]]
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let quantised = model.accessor(&short, 5122, "VEC3", 3);
    let view = model.json["accessors"][quantised]["bufferView"].as_u64().unwrap() as usize;
    model.json["bufferViews"][view]["byteStride"] = json!(8);
    model.json["accessors"][quantised]["normalized"] = json!(true);
    let at = model.view(&[0, 2]);
    let values = model.view(
        &[[0f32, 0.0, 7.0], [0.0, 1.0, 7.0]]
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes())
            .collect::<Vec<u8>>(),
    );
    let base = model.json["accessors"][positions].clone();
    let sparse = model.push("accessors", base);
    model.json["accessors"][sparse]["sparse"] = json!({
        "count": 2, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values },
    });
    let list = model.indices(&[0, 1, 2]);
    let primitive =
        |positions: usize, mode: u32| json!({ "attributes": { "POSITION": positions }, "mode": mode });
    let mut listed = primitive(sparse, 4);
    listed["indices"] = json!(list);
    let primitives = json!([
        primitive(positions, 5),
        primitive(positions, 6),
        primitive(positions, 0),
        primitive(quantised, 4),
        listed
    ]);
    let mesh = model.push("meshes", json!({ "primitives": primitives }));
    model.node(json!({ "mesh": mesh }));
    model.uses("KHR_mesh_quantization");
    model
}

fn unmodelled() -> Model {
    let mut model = Model::new();
    let texture = model.texture([WHITE; 4], json!({}));
    let node = model.shown(json!({
        "name": "all", "occlusionTexture": { "index": texture },
        "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } },
        "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": texture, "texCoord": 1 },
        "extensions": { "KHR_materials_iridescence": { "iridescenceFactor": 1 }, "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyTexture": { "index": texture } } },
    }));
    let moved = model.floats(&[[0.0, 0.0, 1.0]; 4]);
    model.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": moved }]);
    model.push("skins", json!({ "joints": [node] }));
    model.json["nodes"][node]["skin"] = json!(0);
    for extension in ["KHR_materials_iridescence", "EXT_x"] {
        model.uses(extension);
    }
    model
}

const IDENTITY: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

/// Returns the matrix of a translation, by columns.
fn shifted(x: f32, y: f32, z: f32) -> [f32; 16] {
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
