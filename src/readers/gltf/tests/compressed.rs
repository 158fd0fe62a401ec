//! Tests of compressed models: buffer views, primitives and textures.

use super::model::Model;
use super::packed;
use super::packed::{EDGEBREAKER, SEQUENTIAL, draco, hex};
use super::{load_bytes, principled};
use crate::Loaded;
use glam::Vec3;
use image::{ImageFormat, Rgba, RgbaImage};
use scene::Reflectance;
use serde_json::json;
use std::io::Cursor;

fn warnings(loaded: &Loaded) -> usize {
    loaded.warnings.iter().filter(|warning| !warning.what.contains("no light")).count()
}

#[test]
fn draco_primitives_have_their_vertices_and_triangles() {
    for stream in [EDGEBREAKER, SEQUENTIAL] {
        let loaded = load_bytes("m.glb", &draco(&hex(stream)).glb()).unwrap();
        assert_eq!(warnings(&loaded), 0, "{:?}", loaded.warnings);
        let (mesh, centre) = (&loaded.scene.meshes[0], loaded.scene.centre.as_vec3());
        assert_eq!((mesh.triangles.len(), mesh.positions.len()), (8, 9));
        for (position, uv) in mesh.positions.iter().zip(&mesh.uvs) {
            let at = *position + centre;
            // Positions are quantised to 14 bits. Texture coordinates, v upwards, are half the positions.
            let top = if at.truncate().distance(glam::Vec2::ONE) < 0.01 { 1.0 } else { 0.0 };
            assert!((at.z - top).abs() < 1e-3, "{at}");
            assert!(uv.distance(glam::Vec2::new(at.x / 2.0, 1.0 - at.y / 2.0)) < 1e-3, "{at} {uv}");
        }
        assert!(mesh.normals.iter().all(|normal| normal.distance(Vec3::Z) < 1e-3));
        let area: f32 = (0..8)
            .map(|t| {
                let [a, b, c] = mesh.corners(t);
                (b - a).cross(c - a).z / 2.0
            })
            .sum();
        assert!((area - 4.0).abs() < 1e-3, "{area}");
    }
}

#[test]
fn damaged_draco_primitives_are_errors() {
    let stream = hex(EDGEBREAKER);
    let error = |model: &Model| load_bytes("m.glb", &model.glb()).map(|_| ()).unwrap_err().to_string();
    for length in 0..stream.len() {
        let message = error(&draco(&stream[..length]));
        assert!(message.contains("mesh 0, primitive 0: its compressed form"), "{length}: {message}");
    }
    let changed = |change: &dyn Fn(&mut Model)| {
        let mut model = draco(&stream);
        change(&mut model);
        error(&model)
    };
    let says = |message: String, part: &str| assert!(message.contains(part), "{message}");
    says(changed(&|m| m.json["accessors"][0]["count"] = json!(8)), "9 vertices, and POSITION 8");
    says(changed(&|m| m.json["accessors"][2]["type"] = json!("VEC3")), "TEXCOORD_0 of another type");
    says(changed(&|m| m.json["accessors"][3]["componentType"] = json!(5126)), "indices of a wrong type");
    let extension = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    says(changed(&|m| *m.json.pointer_mut(extension).unwrap() = json!({})), "is not described");
    let unknown = |m: &mut Model| m.json.pointer_mut(extension).unwrap()["attributes"]["NORMAL"] = json!(7);
    says(changed(&unknown), "lacks NORMAL, attribute 7");
}

#[test]
fn compressed_buffer_views_stand_in_for_a_buffer_without_bytes() {
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let mut model = packed::meshopt(extension);
        let length = model.binary.len();
        let placeholder = json!({ "byteLength": 64, "extensions": { extension: { "fallback": true } } });
        model.json["buffers"] = json!([{ "byteLength": length }, placeholder]);
        model.push("extensionsRequired", json!(extension));
        let compressed = [2, 3];
        compressed.iter().for_each(|view| model.json["bufferViews"][view]["buffer"] = json!(1));
        let loaded = load_bytes("m.glb", &model.glb_as_is()).unwrap();
        assert_eq!(warnings(&loaded), 0, "{:?}", loaded.warnings);
        let (mesh, centre) = (&loaded.scene.meshes[0], loaded.scene.centre.as_vec3());
        let corners = mesh.triangles[0].map(|i| (mesh.positions[i as usize] + centre).to_array());
        assert_eq!(corners, [[1.0, 2.0, 3.0], [3.0, 2.0, 3.0], [1.0, 5.0, 3.0]]);
        model.json["bufferViews"][2]["extensions"][extension]["count"] = json!(4000);
        let message = load_bytes("m.glb", &model.glb_as_is()).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains("buffer view 2 has compressed bytes that end too early"), "{message}");
    }
}

#[test]
fn textures_may_be_webp() {
    let mut model = Model::new();
    let mut webp = Cursor::new(Vec::new());
    RgbaImage::from_pixel(2, 2, Rgba([255, 0, 0, 255])).write_to(&mut webp, ImageFormat::WebP).unwrap();
    let view = model.view(webp.get_ref());
    let image = model.push("images", json!({ "bufferView": view, "mimeType": "image/webp" }));
    let texture =
        model.push("textures", json!({ "extensions": { "EXT_texture_webp": { "source": image } } }));
    model.shown(
        json!({ "name": "red", "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }),
    );
    model.push("extensionsRequired", json!("EXT_texture_webp"));
    model.uses("EXT_texture_webp");
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    assert_eq!(warnings(&loaded), 0, "{:?}", loaded.warnings);
    let Reflectance::Textured { texture, .. } = principled(&loaded, "red").base_color else { panic!() };
    assert_eq!(loaded.scene.textures[texture.0 as usize].lookup(glam::Vec2::splat(0.5)), Vec3::X);
    // Without an image that is read, the texture is left out with a warning.
    model.json["textures"][0] = json!({ "extensions": { "KHR_texture_basisu": { "source": 0 } } });
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    assert!(loaded.warnings.iter().any(|w| w.what.contains("PNG, JPEG and WebP")), "{:?}", loaded.warnings);
    // An image beside the compressed one is used without a word.
    let png = model.texture([[0, 255, 0, 255]; 4], json!({}));
    model.json["textures"][0] = json!({ "source": model.json["textures"][png]["source"], "extensions": { "KHR_texture_basisu": { "source": 0 } } });
    assert_eq!(warnings(&load_bytes("m.glb", &model.glb()).unwrap()), 0);
}
