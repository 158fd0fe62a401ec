//! Tests of colours of vertices.

use super::model::{COMPONENT_U16, Model};
use super::{load_bytes, material};
use base::math::Rgb;
use scene::{AttributeTexture, Mesh, Parameter, Reflectance, Scene, TextureId};
use serde_json::json;

const COMPONENT_U8: u32 = 5121;

/// Colours of the corners of the square, as fractions.
const COLOURS: [[f32; 4]; 4] =
    [[1.0, 0.2, 0.0, 1.0], [0.0, 1.0, 0.4, 0.6], [0.6, 0.0, 0.8, 0.0], [0.4, 0.6, 1.0, 0.2]];

/// Returns a square of a material whose vertices have the colours of an accessor, which `add` adds.
fn coloured(source: serde_json::Value, add: impl FnOnce(&mut Model) -> usize) -> Model {
    let mut model = Model::new();
    let source = model.push("materials", source);
    let mesh = model.square(Some(source));
    let colours = add(&mut model);
    model.json["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] = json!(colours);
    model.node(json!({ "mesh": mesh }));
    model
}

fn normalized<T: Copy>(
    model: &mut Model,
    component: u32,
    values: &[T],
    bytes: impl Fn(T) -> Vec<u8>,
) -> usize {
    let bytes: Vec<u8> = values.iter().flat_map(|value| bytes(*value)).collect();
    let at = model.accessor(&bytes, component, "VEC4", 4);
    model.json["accessors"][at]["normalized"] = json!(true);
    at
}

fn attribute(scene: &Scene, texture: TextureId) -> AttributeTexture {
    *scene.textures.attribute(texture).expect("an attribute")
}

/// Returns the values that a mesh has for a texture.
fn values<'a>(scene: &Scene, mesh: &'a Mesh, texture: TextureId) -> &'a [Rgb] {
    let id = attribute(scene, texture).attribute;
    mesh.attributes.iter().find(|attribute| attribute.id == id).expect("the attribute").values.all()
}

#[test]
fn colours_of_vertices_multiply_the_base_colour_whatever_their_type() {
    let source = || json!({ "name": "m", "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 1, 1] } });
    let flat: Vec<f32> = COLOURS.iter().flatten().copied().collect();
    for model in [
        coloured(source(), |m| normalized(m, COMPONENT_U8, &flat, |v| vec![(v * 255.0) as u8])),
        coloured(source(), |m| {
            normalized(m, COMPONENT_U16, &flat, |v| ((v * 65535.0) as u16).to_le_bytes().to_vec())
        }),
        coloured(source(), |m| m.floats(&COLOURS)),
        coloured(source(), |m| m.floats(&COLOURS.map(|[r, g, b, _]| [r, g, b]))),
    ] {
        let loaded = load_bytes("m.glb", &model.glb()).unwrap();
        assert!(loaded.warnings.iter().all(|w| !w.what.contains("colours")), "{:?}", loaded.warnings);
        let base = &material(&loaded, "m").principled.as_ref().unwrap().base_color;
        let Reflectance::Textured { texture, scale } = *base else { panic!("{base:?}") };
        assert_eq!((scale, attribute(&loaded.scene, texture).image), (Rgb::new(0.5, 0.25, 1.0), None));
        let found = values(&loaded.scene, &loaded.scene.meshes[0], texture);
        let near = |(found, [r, g, b, _]): (&Rgb, [f32; 4])| found.distance(Rgb::new(r, g, b)) < 1e-5;
        assert!(found.len() == 4 && found.iter().zip(COLOURS).all(near), "{found:?}");
        // An opaque material has no use for their opacity.
        assert_eq!((material(&loaded, "m").opacity, loaded.scene.meshes[0].attributes.len()), (None, 1));
    }
}

#[test]
fn primitives_with_and_without_colours_share_no_material() {
    let mut model = coloured(json!({ "name": "m" }), |m| m.floats(&COLOURS));
    let plain = model.square(Some(0));
    model.node(json!({ "mesh": plain }));
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    let [coloured, plain] = &loaded.scene.meshes[..] else { panic!() };
    assert!(coloured.material != plain.material && plain.attributes.is_empty());
    let plain = &loaded.scene.materials[plain.material.0 as usize];
    assert_eq!(plain.principled.as_ref().unwrap().base_color, Reflectance::Constant(Rgb::ONE));
}

#[test]
fn blended_materials_are_as_opaque_as_texture_and_vertices_say() {
    let mut model = Model::new();
    let texture = model.texture([[255, 255, 255, 128]; 4], json!({}));
    let base = json!({ "baseColorTexture": { "index": texture }, "baseColorFactor": [1, 1, 1, 0.5] });
    model.push("materials", json!({ "name": "m", "alphaMode": "BLEND", "pbrMetallicRoughness": base }));
    let mesh = model.square(Some(0));
    let colours = model.floats(&COLOURS);
    model.json["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] = json!(colours);
    model.node(json!({ "mesh": mesh }));
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    let Some(Parameter::Textured { texture, scale }) = material(&loaded, "m").opacity else { panic!() };
    let image = attribute(&loaded.scene, texture).image.expect("an image");
    let alpha = loaded.scene.textures.by_id(image).unwrap().texels.get(0, 0).x;
    assert!((alpha - 128.0 / 255.0).abs() < 1e-6 && scale == 0.5);
    let found = values(&loaded.scene, &loaded.scene.meshes[0], texture);
    assert!(found.iter().zip(COLOURS).all(|(found, [.., alpha])| *found == Rgb::splat(alpha)), "{found:?}");
}

#[test]
fn modes_that_gltf_does_not_define_are_named() {
    let mut model = Model::new();
    let texture = model.texture([[255, 255, 255, 128]; 4], json!({ "wrapS": 1, "magFilter": 2 }));
    let base = json!({ "baseColorTexture": { "index": texture } });
    model.push("materials", json!({ "name": "m", "alphaMode": "MSAK", "pbrMetallicRoughness": base }));
    let mesh = model.square(Some(0));
    model.node(json!({ "mesh": mesh }));
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    for what in ["an alphaMode", "a wrap mode", "a magFilter"] {
        assert!(loaded.warnings.iter().any(|warning| warning.what.contains(what)), "{:?}", loaded.warnings);
    }
}

#[test]
fn masks_cut_the_product_of_factor_texture_and_vertices() {
    let mut model = Model::new();
    let texture = model.texture([[255, 255, 255, 128]; 4], json!({}));
    let base = json!({ "baseColorTexture": { "index": texture }, "baseColorFactor": [1, 1, 1, 0.5] });
    model.push(
        "materials",
        json!({ "name": "m", "alphaMode": "MASK", "alphaCutoff": 0.1, "pbrMetallicRoughness": base }),
    );
    let mesh = model.square(Some(0));
    let colours = model.floats(&COLOURS);
    model.json["meshes"][mesh]["primitives"][0]["attributes"]["COLOR_0"] = json!(colours);
    model.node(json!({ "mesh": mesh }));
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    assert!(loaded.warnings.iter().all(|w| w.severity == crate::Severity::Note), "{:?}", loaded.warnings);
    let Some(Parameter::Textured { texture, scale }) = material(&loaded, "m").opacity else { panic!() };
    let of = |alpha: f32| {
        let found = loaded.scene.textures.lookup(texture, glam::Vec2::splat(0.5), |_| Rgb::splat(alpha));
        (found * scale).x
    };
    // 0.5 by the factor and 128 / 255 by the image: 0.1 is reached from an alpha of 0.3984 on.
    assert_eq!([1.0, 0.6, 0.4, 0.39, 0.2, 0.0].map(of), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let found = values(&loaded.scene, &loaded.scene.meshes[0], texture);
    assert!(found.iter().zip(COLOURS).all(|(found, [.., alpha])| *found == Rgb::splat(alpha)), "{found:?}");
    // Without an image, and with a factor that no vertex can lift to the cutoff.
    for (factor, expected) in [(0.5, [1.0, 0.0]), (0.0, [0.0, 0.0])] {
        model.json["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorFactor": [1, 1, 1, factor] });
        let loaded = load_bytes("m.glb", &model.glb()).unwrap();
        let opacity = material(&loaded, "m").opacity.expect("a mask");
        let textures = &loaded.scene.textures;
        let of =
            |alpha: f32| opacity.value(|id| textures.lookup(id, glam::Vec2::ZERO, |_| Rgb::splat(alpha)).x);
        assert_eq!([0.25, 0.15].map(of), expected, "{factor}");
    }
}

#[test]
fn unlit_materials_shine_in_the_colours_of_their_vertices() {
    let source = json!({
        "name": "m", "extensions": { "KHR_materials_unlit": {} },
        "pbrMetallicRoughness": { "baseColorFactor": [0.5, 1, 1, 1] },
    });
    let mut model = coloured(source, |m| m.floats(&COLOURS));
    model.uses("KHR_materials_unlit");
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    let mesh = &loaded.scene.meshes[0];
    let emission = mesh.emission.expect("emission");
    assert_eq!(emission.radiance, Rgb::new(0.5, 1.0, 1.0));
    let found = values(&loaded.scene, mesh, emission.texture.expect("a texture"));
    assert_eq!(found[1], Rgb::new(0.0, 1.0, 0.4));
}

#[test]
fn colours_of_other_numbers_of_vertices_or_of_other_types_are_errors() {
    let mut few = coloured(json!({}), |m| m.floats(&COLOURS[..3]));
    let message = load_bytes("m.glb", &few.glb()).unwrap_err().to_string();
    assert!(message.contains("4 vertices and 3 colours"), "{message}");
    few = coloured(json!({}), |m| m.floats(&[[0.0f32, 1.0]; 4]));
    let message = load_bytes("m.glb", &few.glb()).unwrap_err().to_string();
    assert!(message.contains("the wrong type"), "{message}");
}
