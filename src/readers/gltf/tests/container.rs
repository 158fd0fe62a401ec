//! Tests of the chunks of binary files, and of versions.

use super::load_bytes;
use super::model::Model;
use serde_json::json;

/// Kind and content of a chunk.
type Chunk = ([u8; 4], Vec<u8>);

/// Returns the model of a square, and its chunks.
fn square() -> (Model, Vec<Chunk>) {
    let mut model = Model::new();
    let mesh = model.square(None);
    model.node(json!({ "mesh": mesh }));
    let glb = model.glb();
    let mut chunks = Vec::new();
    let mut at = 12;
    while at < glb.len() {
        let length = u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
        chunks.push((glb[at + 4..at + 8].try_into().unwrap(), glb[at + 8..at + 8 + length].to_vec()));
        at += 8 + length;
    }
    (model, chunks)
}

fn glb(chunks: &[Chunk]) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, content) in chunks {
        body.extend((content.len() as u32).to_le_bytes());
        body.extend(kind);
        body.extend(content);
    }
    [&b"glTF\x02\0\0\0"[..], &(12 + body.len() as u32).to_le_bytes(), &body].concat()
}

#[test]
fn padding_by_zeros_or_spaces_and_further_chunks_load() {
    let (_, chunks) = square();
    let same = |chunks: &[Chunk]| {
        let loaded = load_bytes("m.glb", &glb(chunks)).unwrap();
        assert_eq!((loaded.scene.meshes.len(), loaded.scene.meshes[0].triangles.len()), (1, 2));
    };
    same(&chunks);
    for padding in [&b"\0\0\0\0"[..], b"    ", b"  \0\0", b"\n\0\0\0"] {
        let mut padded = chunks.clone();
        padded[0].1.extend(padding);
        padded[1].1.extend([0; 4]);
        same(&padded);
    }
    let other = (*b"XTRA", vec![1, 2, 3, 4]);
    same(&[chunks[0].clone(), chunks[1].clone(), other.clone()]);
    same(&[chunks[0].clone(), other.clone(), chunks[1].clone()]);
    let message = |chunks: &[Chunk]| load_bytes("m.glb", &glb(chunks)).unwrap_err().to_string();
    assert!(message(&[other, chunks[0].clone()]).contains("the first chunk is not JSON"));
    let mut cut = glb(&chunks);
    cut.truncate(cut.len() - 8);
    assert!(load_bytes("m.glb", &cut).unwrap_err().to_string().contains("ends within a chunk"));
}

#[test]
fn byte_order_marks_are_passed_and_other_versions_are_told_in_words() {
    let (model, _) = square();
    let says = |bytes: &[u8], parts: [&str; 2]| {
        let message = load_bytes("m.gltf", bytes).unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    };
    let text = model.json.to_string();
    let message = |bytes: &[u8]| load_bytes("m.gltf", bytes).unwrap_err().to_string();
    let plain = message(text.as_bytes());
    let file = |message: &str| message.split_once("m.gltf").map(|(_, rest)| rest.to_owned());
    assert_eq!(file(&message(&[b"\xEF\xBB\xBF", text.as_bytes()].concat())), file(&plain));
    says(br#"{"asset": {"version": "1.0"}, "meshes": {"m": {}}}"#, ["glTF 1.0", "convert it to glTF 2.0"]);
    says(br#"{"nodes": {"n": {}}}"#, ["glTF 1.0", "convert it"]);
    says(br#"{"asset": {"version": "1.1"}}"#, ["glTF 1.1", "convert it"]);
    says(br#"{"asset": {"version": "3.0"}}"#, ["glTF 3.0", "export it as glTF 2.0"]);
    says(br#"{"asset": {"version": "2.2", "minVersion": "2.1"}}"#, ["glTF 2.1", "export it"]);
    says(b"glTF\x01\0\0\0\x20\0\0\0", ["version 1", "convert it to glTF 2.0"]);
}
