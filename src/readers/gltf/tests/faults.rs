//! Models with numbers and images that are wrong: the rest is read, and a warning names what is left out.

use super::model::Model;
use super::{load_bytes, load_with};
use crate::{LoadOptions, Loaded, Severity};
use image::codecs::jpeg::JpegEncoder;
use serde_json::json;

/// Loads a model; returns it with its warnings, which are errors under `strict`.
fn loaded(model: &Model) -> (Loaded, Vec<String>) {
    let glb = model.glb();
    let loaded = load_bytes("m.glb", &glb).unwrap();
    let of_weight = loaded.warnings.iter().filter(|warning| warning.severity == Severity::Warning);
    let said: Vec<String> = of_weight.map(ToString::to_string).collect();
    let strict = LoadOptions { strict: true, ..LoadOptions::default() };
    assert_eq!(load_with("m.glb", &[("m.glb", &glb)], &strict).is_err(), !said.is_empty(), "{said:?}");
    (loaded, said)
}

/// A square with other numbers: attribute, position of a number in the binary chunk, and the number.
fn square(attribute: &str, at: usize, number: [u8; 4]) -> Model {
    let mut model = Model::new();
    let base = json!({ "baseColorFactor": [0.5, 0.5, 0.5, 1] });
    model.shown(json!({ "name": "m", "pbrMetallicRoughness": base }));
    let primitive = &model.json["meshes"][0]["primitives"][0];
    let accessor = primitive.get(attribute).unwrap_or(&primitive["attributes"][attribute]);
    let view = model.json["accessors"][accessor.as_u64().unwrap() as usize]["bufferView"].as_u64().unwrap();
    let start = model.json["bufferViews"][view as usize]["byteOffset"].as_u64().unwrap() as usize;
    model.binary[start + at..start + at + 4].copy_from_slice(&number);
    model
}

#[test]
fn bad_numbers_of_meshes_are_named_and_the_rest_is_read() {
    let (nan, infinity) = (f32::NAN.to_le_bytes(), f32::INFINITY.to_le_bytes());
    // The fourth vertex belongs to one of the two triangles.
    for (attribute, at, number, triangles, what) in [
        ("POSITION", 36, nan, 1, "triangles with a position that is no finite number: 1"),
        ("POSITION", 40, infinity, 1, "triangles with a position that is no finite number: 1"),
        ("POSITION", 36, 1e30f32.to_le_bytes(), 1, "triangles beyond 1e18: 1"),
        ("indices", 8, [2, 0, 77, 0], 1, "triangles with a vertex that does not exist: 1"),
        ("NORMAL", 40, nan, 2, "normals that are no finite numbers: 1"),
        ("TEXCOORD_0", 0, nan, 2, "texture coordinates that are no finite numbers: 1"),
    ] {
        let (loaded, said) = loaded(&square(attribute, at, number));
        let [said] = &said[..] else { panic!("{attribute}: {said:?}") };
        assert!(said.contains("m.glb: ") && said.contains(what) && said.contains("\"node 0\""), "{said}");
        assert_eq!(loaded.scene.meshes[0].triangles.len(), triangles, "{attribute}");
    }
    let (_, said) = loaded(&square("NORMAL", 36, 0f32.to_le_bytes()));
    assert_eq!(said, [""; 0]);
}

#[test]
fn corners_beyond_the_last_triangle_are_named() {
    let mut model = Model::new();
    let mesh = model.square(None);
    model.node(json!({ "mesh": mesh }));
    let indices = model.json["meshes"][0]["primitives"][0]["indices"].as_u64().unwrap() as usize;
    model.json["accessors"][indices]["count"] = json!(5);
    let (loaded, said) = loaded(&model);
    assert!(said[0].contains("the last triangle lacks corners: "), "{said:?}");
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
}

#[test]
fn empty_lists_of_instances_and_wrong_places_are_named() {
    let model = |places: &[[f32; 3]], count: usize| {
        let mut model = Model::new();
        let mesh = model.square(None);
        let places = model.floats(places);
        model.json["accessors"][places]["count"] = json!(count);
        let attributes = json!({ "attributes": { "TRANSLATION": places } });
        model.node(json!({ "mesh": mesh, "extensions": { "EXT_mesh_gpu_instancing": attributes } }));
        model.node(json!({ "mesh": mesh, "translation": [0, 5, 0] }));
        model.uses("EXT_mesh_gpu_instancing");
        model
    };
    for (model, meshes, what) in [
        (model(&[[0.0; 3]], 0), 1, "a list of instances is empty"),
        (model(&[[0.0; 3], [f32::NAN; 3]], 2), 2, "transforms of instances are not finite"),
    ] {
        let (loaded, said) = loaded(&model);
        assert!(said.len() == 1 && said[0].contains(what) && said[0].contains("of node 0"), "{said:?}");
        assert_eq!(loaded.scene.meshes.len(), meshes, "{what}");
    }
}

/// A model whose one image has these bytes, and is stated to be a PNG image.
fn textured(bytes: &[u8]) -> Model {
    let mut model = Model::new();
    let texture = model.texture([[255; 4]; 4], json!({}));
    let view = model.view(bytes);
    model.json["images"][0]["bufferView"] = json!(view);
    let base = json!({ "baseColorTexture": { "index": texture } });
    model.shown(json!({ "name": "m", "pbrMetallicRoughness": base }));
    model
}

fn jpeg() -> Vec<u8> {
    let mut jpeg = Vec::new();
    let noise = |x: u32, y: u32| (x * x * 7919 + y * y * 104_729 + x * y * 31) as u8;
    let image = image::RgbImage::from_fn(64, 64, |x, y| image::Rgb([noise(x, y), noise(y, x), 128]));
    JpegEncoder::new(&mut jpeg).encode_image(&image).unwrap();
    jpeg
}

#[test]
fn images_inside_that_are_cut_or_something_else_are_named() {
    let jpeg = jpeg();
    let (plain, said) = loaded(&textured(&jpeg));
    assert_eq!(said, [""; 0]);
    let note = &plain.warnings.iter().map(ToString::to_string).find(|said| said.contains("stated")).unwrap();
    assert!(note.contains("stated to be image/png, and its bytes are a JPEG image"), "{note}");
    let (_, said) = loaded(&textured(&jpeg[..3 * jpeg.len() / 4]));
    assert!(said.len() == 1 && said[0].contains("the JPEG image image 0 ends too early"), "{said:?}");
    for (bytes, what) in [
        (&b"version https://git-lfs.github.com/spec/v1\n"[..], "image 0 is a pointer of Git LFS; "),
        (b"<!DOCTYPE html><html></html>", "image 0 is an HTML page; "),
        (b"II*\0\x08\0\0\0\0\0\0\0", "image 0 is a TIFF image; "),
    ] {
        let (_, said) = loaded(&textured(bytes));
        assert!(said.len() == 1 && said[0].contains(what), "{said:?}");
    }
    let mut model = textured(&jpeg);
    model.json["images"][0]["mimeType"] = json!("image/jpg");
    assert!(!loaded(&model).0.warnings.iter().any(|warning| warning.what.contains("stated")));
}
