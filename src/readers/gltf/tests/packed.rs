//! Models with compressed primitives and buffer views.

use super::model::Model;
use serde_json::json;

/// A square of 3 by 3 vertices whose middle stands up, with normals and texture coordinates: the encoder of Draco 1.5 at
/// level 7 (edgebreaker), by the Python package DracoPy 2.2.
pub const EDGEBREAKER: &str = "445241434f02020101000000090802080200037fda07ff0111ff028840ff02884003000000010000ff0000010309
    0201000001010903000100010009030002020000003f0000003f000000000000003f00000000000000000000003f000000000000803f0000003f
    0000803f000000000000803f0000803f0000003f0000803f000000000000803f00000000000000000000803f00000000000000000000803f0000
    0000000000000000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f000000000000000000008
    03f00000000000000000000803f00000000000000000000803f010101000f03390e2fc93103de759dffffffffffffff00c0ff0f00fcff00000000
    00fcff000000f0ff03000000fe7f000000f8ff0100000000ff3f0000000000000000000000000000000000400e";
/// The same without a change of order, at level 0 (sequential).
pub const SEQUENTIAL: &str = "445241434f020201000000080901000104000403010205010504030407030706040508040807010303090201000109
    030001000903000200000200000000000000000000003f000000000000803f00000000000000000000003f0000003f0000003f0000803f000000
    3f000000000000803f0000003f0000803f0000803f0000803f00000000000000000000803f00000000000000000000803f0000000000000000
    0000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f000000000000
    00000000803f00000000000000000000803f000101000f031d072fe5380304e085f8ff010000c0ff0700000001e0ff0700fe7f00e0fff7ff0180
    ff5f00f0ff0180ff1f000000fc7f0000000000000000ff3f0000000000000000000000000000000000400e";

/// Returns bytes from hexadecimal digits and space.
pub fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let byte = |pair: &[u8; 2]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    digits.as_chunks::<2>().0.iter().map(byte).collect()
}

/// Returns a model of a compressed stream.
pub fn draco(stream: &[u8]) -> Model {
    let mut model = Model::new();
    let view = model.view(stream);
    let accessor = |model: &mut Model, component: u32, kind: &str, count: usize| {
        model.push("accessors", json!({ "componentType": component, "type": kind, "count": count }))
    };
    let positions = accessor(&mut model, 5126, "VEC3", 9);
    let normals = accessor(&mut model, 5126, "VEC3", 9);
    let uvs = accessor(&mut model, 5126, "VEC2", 9);
    let indices = accessor(&mut model, 5123, "SCALAR", 24);
    let compressed =
        json!({ "bufferView": view, "attributes": { "POSITION": 2, "NORMAL": 1, "TEXCOORD_0": 0 } });
    let mesh = model.push(
        "meshes",
        json!({ "primitives": [{
        "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs }, "indices": indices,
        "extensions": { "KHR_draco_mesh_compression": compressed },
    }] }),
    );
    model.node(json!({ "mesh": mesh }));
    model.push("extensionsRequired", json!("KHR_draco_mesh_compression"));
    model.uses("KHR_draco_mesh_compression");
    model
}

/// Returns a model of one triangle whose corners and indices `extension` compresses: buffer views 2 and 3.
pub fn meshopt(extension: &str) -> Model {
    let mut model = Model::new();
    // Shorts: (1, 2, 3), (3, 2, 3) and (1, 5, 3).
    let corners = model
        .view(&hex("a0020430000000000000000200600000000000000000000000000000000000000000000000000000
        0000000000000000000100020003000000"));
    let sequence = model.view(&hex("d1 00 04 04 00000000"));
    for (view, stride, mode) in [(corners, 8, "ATTRIBUTES"), (sequence, 2, "INDICES")] {
        let mut statements = model.json["bufferViews"][view].clone();
        statements["byteStride"] = json!(stride);
        statements["count"] = json!(3);
        statements["mode"] = json!(mode);
        let mut parent =
            json!({ "buffer": 0, "byteLength": 3 * stride, "extensions": { extension: statements } });
        if stride == 8 {
            parent["byteStride"] = json!(stride);
        }
        model.push("bufferViews", parent);
    }
    let accessor = |view: usize, component: u32, kind: &str| json!({ "bufferView": view, "componentType": component, "type": kind, "count": 3 });
    let positions = model.push("accessors", accessor(2, 5122, "VEC3"));
    let indices = model.push("accessors", accessor(3, 5123, "SCALAR"));
    let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
    let mesh = model.push("meshes", json!({ "primitives": [primitive] }));
    model.node(json!({ "mesh": mesh }));
    model.uses(extension);
    model
}
