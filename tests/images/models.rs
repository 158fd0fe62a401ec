//! Models in glTF: mirrored nodes and skins, seen by a camera.

use crate::kit::*;
use crate::oracle::mean;
use glam::DVec3;
use lightsplat::method::path;
use serde_json::{Value, json};

/// Colour of the light of the square.
const COLOUR: [f32; 3] = [1.0, 0.5, 0.25];

/// Mean colour of the picture of a square from -1 to 1 that shines towards +z, without normals, whose vertices all have
/// the first joint. `nodes` are the nodes of the model. The film shows the square from -0.5 to 0.5 at z = 0.
fn seen(nodes: Value) -> DVec3 {
    let corners = [[-1.0f32, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    // A joint whose bound place is 10 to the left.
    let bound = [1.0f32, 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 10., 0., 0., 1.];
    let mut bytes: Vec<u8> = corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0u8, 1, 2, 0, 2, 3, 0, 0]);
    bytes.extend(bound.iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend([0u8; 16]);
    bytes.extend([255u8, 0, 0, 0].repeat(4));
    let accessor = |view: usize, component: u32, kind: &str, count: usize| json!({ "bufferView": view, "componentType": component, "type": kind, "count": count, "normalized": view == 4 });
    let view =
        |offset: usize, length: usize| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let attributes = json!({ "POSITION": 0, "JOINTS_0": 3, "WEIGHTS_0": 4 });
    let model = json!({
        "asset": { "version": "2.0" }, "nodes": nodes, "materials": [{ "emissiveFactor": COLOUR }],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 1, "material": 0 }] }],
        "skins": [{ "joints": [1], "inverseBindMatrices": 2 }],
        "accessors": [
            accessor(0, 5126, "VEC3", 4), accessor(1, 5121, "SCALAR", 6), accessor(2, 5126, "MAT4", 1),
            accessor(3, 5121, "VEC4", 4), accessor(4, 5121, "VEC4", 4),
        ],
        "bufferViews": [view(0, 48), view(48, 6), view(56, 64), view(120, 16), view(136, 16)],
        "buffers": [{ "byteLength": bytes.len(), "uri": "m.bin" }],
    });
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("a file");
    write("m.bin", &bytes);
    write("m.gltf", model.to_string().as_bytes());
    let scene = "resolution = [4, 4]\n[camera]\norigin = [0, 0, 5]\ntarget = [0, 0, 0]\nfilm_width = 1.0\n\
        [[mesh]]\nfile = \"m.gltf\"\n";
    write("scene.toml", scene.as_bytes());
    let world = world(load_scene(&folder.path().join("scene.toml"), None));
    mean(&image(&world, &path::Settings { spp: 1, ..Default::default() }))
}

fn assert_shines(nodes: Value, shines: bool) {
    let expected = if shines { DVec3::from(COLOUR.map(f64::from)) } else { DVec3::ZERO };
    let found = seen(nodes.clone());
    assert!((found - expected).length() < 1e-6, "{nodes}: {found}");
}

/// A node that mirrored turned a lamp without normals inside out: its picture was black.
#[test]
fn mirrored_lamps_shine_to_their_front() {
    for (scale, shines) in [([1, 1, 1], true), ([-1, 1, 1], true), ([1, -2, 1], true), ([-1, -1, 1], true)] {
        assert_shines(json!([{ "mesh": 0, "scale": scale }]), shines);
    }
    // Mirrored in z, the front is on the far side. Turned by half a turn, too.
    assert_shines(json!([{ "mesh": 0, "scale": [1, 1, -1] }]), false);
    assert_shines(json!([{ "mesh": 0, "rotation": [0, 1, 0, 0] }]), false);
}

/// The node of a skinned mesh placed it, not the joints: its picture was black.
#[test]
fn skinned_squares_stand_where_their_joints_are() {
    let nodes = |joint: Value| json!([{ "mesh": 0, "skin": 0, "translation": [50, 0, 0] }, joint]);
    assert_shines(nodes(json!({ "translation": [-10, 0, 0] })), true);
    assert_shines(nodes(json!({ "translation": [10, 0, 0], "scale": [-1, 1, 1] })), true);
    assert_shines(nodes(json!({})), false);
}
