//! Tests of files as exporters write them: units by the exporter, one clock of all animations, scales of 0, JSON and
//! URIs beside the letter of the standard, and glass without a thickness.

use super::{Model, load_beside, load_bytes, load_with, material, near};
use crate::{LoadOptions, Loaded, Severity};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::Vec3;
use scene::{DeltaLight, Lobe, Reflectance};
use serde_json::{Value, json};

fn load_glb(model: &Model) -> Loaded {
    load_bytes("m.glb", &model.glb()).unwrap()
}

fn options() -> LoadOptions {
    LoadOptions { strict: true, ..LoadOptions::default() }
}

/// Returns a square, and a lamp of a kind at z = 2.
fn lamp(generator: &str, kind: &str, intensity: f64, node: Value) -> Model {
    let mut model = Model::new();
    let mesh = model.square(None);
    model.node(json!({ "mesh": mesh }));
    model.json["asset"]["generator"] = json!(generator);
    let mut light = json!({ "type": kind, "intensity": intensity });
    if kind == "spot" {
        light["spot"] = json!({ "outerConeAngle": 0.7 });
    }
    model.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    let mut own = json!({ "name": "Lamp", "translation": [0, 0, 2],
        "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    own.as_object_mut().unwrap().extend(node.as_object().unwrap().clone());
    model.node(own);
    model.uses("KHR_lights_punctual");
    model
}

/// Returns the position of the light, its direction, and its intensity or irradiance.
fn light(loaded: &Loaded) -> (Vec3, Vec3, f32) {
    let centre = loaded.scene.centre.as_vec3();
    match loaded.scene.lights[0] {
        DeltaLight::Point { position, intensity } => (position + centre, Vec3::ZERO, intensity.x),
        DeltaLight::Spot { position, direction, intensity, .. } => {
            (position + centre, direction, intensity.x)
        }
        DeltaLight::Directional { direction, irradiance } => (Vec3::ZERO, direction, irradiance.x),
        DeltaLight::Projector { .. } => panic!("glTF has no projectors"),
    }
}

#[test]
fn lamps_have_the_units_of_their_exporter() {
    let [old, new] = ["Khronos glTF Blender I/O v3.3.27", "Khronos glTF Blender I/O v4.2.60"];
    let watts = 100.0 / (4.0 * std::f32::consts::PI);
    let is_said = |loaded: &Loaded| loaded.warnings.iter().any(|w| w.fallback.contains("--lumens-per-watt"));
    for (generator, kind, written, expected, says) in [
        (old, "point", 100.0, watts, false),
        (old, "spot", 100.0, watts, false),
        (old, "directional", 3.0, 3.0, false),
        ("Khronos Blender glTF 2.0 exporter", "directional", 3.0, 3.0, false),
        (new, "point", 5435.141306588225, watts, true),
        (new, "directional", 2049.0, 3.0, true),
        ("something else", "directional", 3.0, 3.0, true),
    ] {
        let model = lamp(generator, kind, written, json!({}));
        let loaded = load_with("m.glb", &[("m.glb", &model.glb())], &options()).unwrap();
        let power = light(&loaded).2;
        assert!((power / expected - 1.0).abs() < 1e-5, "{generator} {kind}: {power} {expected}");
        assert_eq!(is_said(&loaded), says, "{generator}: {:?}", loaded.warnings);
        let given = LoadOptions { lumens_per_watt: Some(2.0), ..options() };
        let given = load_with("m.glb", &[("m.glb", &model.glb())], &given).unwrap();
        assert_eq!(light(&given).2, written as f32 / 2.0);
        assert!(!is_said(&given) && given.hash != loaded.hash);
    }
    let scene = LoadOptions { lumens_per_watt: Some(2.0), ..LoadOptions::default() };
    let message = load_with("s.toml", &[("s.toml", b"")], &scene).unwrap_err().to_string();
    assert!(message.contains("--lumens-per-watt is for glTF models"), "{message}");
}

/// Returns a square and a camera that channels move from x = 0 at their first key to 2 at their last one, at 2 s.
fn moved(first_of_camera: f32, first_of_square: f32, apart: bool) -> Model {
    let mut model = Model::new();
    let mesh = model.square(None);
    let lens = json!({ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } });
    let camera = model.push("cameras", lens);
    model.node(json!({ "mesh": mesh, "name": "square" }));
    model.node(json!({ "camera": camera, "name": "eye" }));
    let line = model.floats(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    let action = |model: &mut Model, node: usize, first: f32| {
        let times = model.floats(&[[first], [2.0]]);
        json!({ "samplers": [{ "input": times, "output": line }],
            "channels": [{ "sampler": 0, "target": { "node": node, "path": "translation" } }] })
    };
    let (eye, square) = (action(&mut model, 1, first_of_camera), action(&mut model, 0, first_of_square));
    model.json["animations"] = json!([eye, square]);
    if !apart {
        let mut whole = model.json["animations"][0].clone();
        whole["samplers"] = json!([whole["samplers"][0], square["samplers"][0]]);
        whole["channels"] = json!([whole["channels"][0], square["channels"][0]]);
        whole["channels"][1]["sampler"] = json!(1);
        model.json["animations"] = json!([whole]);
    }
    model
}

#[test]
fn all_animations_have_one_clock() {
    for apart in [false, true] {
        for (camera, square) in [(1.0, 0.0), (0.0, 1.0), (1.0 / 24.0, 0.0), (1.0, 1.0)] {
            let model = moved(camera, square, apart);
            let at = |frame| {
                let options = LoadOptions { frame, ..options() };
                load_with("m.glb", &[("m.glb", &model.glb())], &options).unwrap()
            };
            let rest = at(None);
            let said = |w: &crate::Warning| w.what == "there is an animation of 49 frames";
            assert!(rest.warnings.iter().any(said), "{:?}", rest.warnings);
            assert_eq!((rest.animation_frames, rest.cameras.path.len()), (49, 49));
            for frame in [1, 2, 13, 25, 37, 49] {
                let loaded = at(Some(frame));
                assert!(!loaded.warnings.iter().any(said) && loaded.moves);
                let time = (frame as f32 - 1.0) / 24.0;
                let place = |first: f32| 2.0 * ((time - first) / (2.0 - first)).clamp(0.0, 1.0);
                let centre = loaded.scene.centre.as_vec3();
                let eye = loaded.cameras.path[frame - 1].origin + centre;
                let middle = super::bounds(&loaded, 0)[0] + Vec3::new(1.0, 1.0, 0.0);
                assert!(near(eye, [place(camera), 0.0, 0.0]), "{apart} {camera} {square} {frame}: {eye}");
                assert!(
                    near(middle, [place(square), 0.0, 0.0]),
                    "{apart} {camera} {square} {frame}: {middle}"
                );
            }
        }
    }
    // An animation of what another one moves does not play.
    let mut model = moved(0.0, 0.0, true);
    model.json["animations"][1]["channels"][0]["target"]["node"] = json!(1);
    model.json["animations"][1]["name"] = json!("second");
    let loaded = load_glb(&model);
    assert!(loaded.warnings.iter().any(|w| w.what == "an animation moves what another one moves: second"));
    // A damaged animation is named if nobody asks for it, and is an error otherwise.
    model.json["animations"][0]["samplers"][0]["input"] = json!(99);
    let loaded = load_glb(&model);
    assert!(loaded.warnings.iter().any(|w| w.what.contains("the animation is damaged: ")));
    let asked = LoadOptions { frame: Some(1), ..LoadOptions::default() };
    assert!(load_with("m.glb", &[("m.glb", &model.glb())], &asked).is_err());
}

#[test]
fn scales_of_0_hide_meshes_and_neither_lamps_nor_cameras() {
    let turned =
        json!({ "rotation": [0, std::f32::consts::FRAC_1_SQRT_2, 0, std::f32::consts::FRAC_1_SQRT_2] });
    for kind in ["point", "spot", "directional"] {
        for scale in [[0, 0, 0], [0, 1, 1], [1, 1, 0]] {
            let mut hidden = turned.clone();
            hidden["scale"] = json!(scale);
            let [shown, hidden] = [turned.clone(), hidden].map(|node| {
                let model = lamp("", kind, 4.0, node);
                let loaded = load_with("m.glb", &[("m.glb", &model.glb())], &options()).unwrap();
                light(&loaded)
            });
            assert!(
                hidden.0.distance(shown.0) < 1e-5 && hidden.1.distance(shown.1) < 1e-6,
                "{kind} {scale:?}"
            );
            assert_eq!(hidden.2, shown.2);
        }
    }
    // The parent of a sun, and the placement of the model, have no scale.
    let mut model = lamp("", "directional", 3.0, json!({}));
    model.node(json!({ "children": [1], "scale": [0, 0, 0] }));
    model.json["scenes"][0]["nodes"] = json!([0, 2]);
    assert_eq!(light(&load_glb(&model)).1, Vec3::NEG_Z);
    let scene = "[[mesh]]\nfile = \"m.glb\"\ntransform = [{ scale = 0 }]\n[[mesh]]\nfile = \"m.glb\"\n";
    let loaded = load_beside("s.toml", &[("m.glb", &model.glb()), ("s.toml", scene.as_bytes())]).unwrap();
    assert_eq!((light(&loaded).1, loaded.scene.meshes.len()), (Vec3::NEG_Z, 1));
}

#[test]
fn a_camera_with_a_scale_of_0_is_used_if_there_is_no_other() {
    let camera = |good: bool, wanted: Option<&str>| {
        let mut model = Model::new();
        let mesh = model.square(None);
        model.node(json!({ "mesh": mesh }));
        let lens = json!({ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } });
        let camera = model.push("cameras", lens);
        let bad = model.push("nodes", json!({ "camera": camera, "name": "bad" }));
        model.node(json!({ "children": [bad], "scale": [0, 0, 0], "translation": [0, 0, 7] }));
        if good {
            model.node(json!({ "camera": camera, "name": "good", "translation": [0, 0, 5] }));
        }
        let options = LoadOptions { camera: wanted.map(str::to_owned), ..options() };
        let loaded = load_with("m.glb", &[("m.glb", &model.glb())], &options).unwrap();
        assert!(
            loaded
                .warnings
                .iter()
                .any(|w| w.what.contains("scale of 0") || w.fallback.contains("scale of 0"))
                != (wanted == Some("good"))
        );
        assert_eq!(loaded.cameras.still.forward, Vec3::NEG_Z);
        (loaded.cameras.still.origin + loaded.scene.centre.as_vec3()).z
    };
    assert_eq!(camera(true, None), 5.0);
    assert_eq!(camera(true, Some("good")), 5.0);
    assert_eq!(camera(true, Some("bad")), 7.0);
    assert_eq!(camera(false, None), 7.0);
}

/// Returns a textured square in one text file, whose buffer is a data URI.
fn text(model: &Model) -> Value {
    let mut json = model.json.clone();
    let encoded = STANDARD.encode(&model.binary);
    let uri = format!("data:application/octet-stream;base64,{encoded}");
    json["buffers"] = json!([{ "byteLength": model.binary.len(), "uri": uri }]);
    json
}

#[test]
fn numbers_and_absent_members_are_read_as_exporters_write_them() {
    let mut model = Model::new();
    model.shown(json!({ "name": "m", "pbrMetallicRoughness": { "baseColorFactor": [0.6, 0.3, 0.1, 1] } }));
    let plain = text(&model);
    let changes: [fn(&mut Value); 7] = [
        |file| file["accessors"][0]["componentType"] = json!(5126.0),
        |file| file["accessors"][0]["count"] = json!(4.0),
        |file| file["bufferViews"][1]["byteOffset"] = json!(48.0),
        |file| {
            file["scene"] = json!(0.0);
            file["nodes"][0]["mesh"] = json!(0.0);
            file["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(0.0);
        },
        |file| {
            file["nodes"][0]["skin"] = json!(-1);
            file["nodes"][0]["camera"] = json!(-1.0);
            file["materials"][0]["normalTexture"] = json!({ "index": -1 });
        },
        |file| {
            file["nodes"][0]["name"] = Value::Null;
            file["nodes"][0]["extras"] = Value::Null;
            file["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = Value::Null;
            file["animations"] = Value::Null;
        },
        |file| {
            file["nodes"][0]["children"] = json!([]);
            for list in ["animations", "skins", "cameras", "images"] {
                file[list] = json!([]);
            }
        },
    ];
    let load = |file: &Value| {
        let bytes = file.to_string();
        load_with("m.gltf", &[("m.gltf", bytes.as_bytes())], &options())
    };
    let expected = load(&plain).unwrap();
    for (i, change) in changes.iter().enumerate() {
        let mut file = plain.clone();
        change(&mut file);
        let loaded = load(&file).unwrap_or_else(|error| panic!("{i}: {error}"));
        let [found, plain] = [&loaded, &expected].map(|loaded| &loaded.scene.meshes[0].positions);
        assert!(found.iter().eq(plain.iter()), "{i}");
        assert_eq!(material(&loaded, "m"), material(&expected, "m"), "{i}");
    }
    // Errors keep their line.
    let wrong = "{ \"asset\": { \"version\": \"2.0\" },\n\"accessors\": [{\n\"count\": 4.5 }] }";
    let message = load_beside("m.gltf", &[("m.gltf", wrong.as_bytes())]).unwrap_err().to_string();
    assert!(message.contains("m.gltf:3: "), "{message}");
    // A repaired file would lose one of two values of a key in silence.
    let twice = "{ \"asset\": { \"version\": \"2.0\" }, \"scene\": 0.0,\n\"nodes\": [{ \"mesh\": 0,\n\"mesh\": 1 }] }";
    let message = load_beside("m.gltf", &[("m.gltf", twice.as_bytes())]).unwrap_err().to_string();
    assert!(message.contains("m.gltf:3: ") && message.contains("the key \"mesh\" is twice"), "{message}");
}

#[test]
fn one_bad_picture_leaves_the_rest() {
    let mut model = Model::new();
    let texture = model.texture([[255; 4]; 4], json!({}));
    let base = json!({ "baseColorFactor": [0.5, 0.25, 0.125, 1], "baseColorTexture": { "index": texture } });
    model.shown(json!({ "name": "m", "pbrMetallicRoughness": base }));
    let changes: [fn(&mut Value); 4] = [
        |file| file["images"][0] = json!({ "uri": "data:image/png;base64,i!" }),
        |file| file["images"][0] = json!({ "bufferView": 77, "mimeType": "image/png" }),
        |file| file["images"][0] = json!({}),
        |file| file["textures"][0]["source"] = json!(5),
    ];
    for (i, change) in changes.iter().enumerate() {
        let mut file = text(&model);
        change(&mut file);
        let loaded = load_beside("m.gltf", &[("m.gltf", file.to_string().as_bytes())]).unwrap();
        let is_named = |w: &crate::Warning| {
            w.severity == Severity::Warning
                && w.what.contains("a texture cannot be read: ")
                && w.what.ends_with(": m")
        };
        assert!(loaded.warnings.iter().any(is_named), "{i}: {:?}", loaded.warnings);
        let colour = super::principled(&loaded, "m").base_color;
        assert_eq!(colour, Reflectance::Constant(Vec3::new(0.5, 0.25, 0.125)), "{i}");
    }
}

#[test]
fn nodes_at_map_coordinates_meet() {
    let matrix = |x: f64| json!({ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1] });
    let steps = |x: f64| json!({ "translation": [x, 0, 0] });
    for place in [&matrix as &dyn Fn(f64) -> Value, &steps] {
        let mut model = Model::new();
        let mesh = model.square(None);
        for x in [4_512_344.2, 4_512_346.3] {
            let mut node = place(x);
            node["mesh"] = json!(mesh);
            model.node(node);
        }
        let loaded = load_glb(&model);
        let across = |i: usize| loaded.scene.meshes[i].positions.iter().map(|p| p.x);
        let gap = across(1).fold(f32::INFINITY, f32::min) - across(0).fold(f32::NEG_INFINITY, f32::max);
        assert!((gap - 0.1).abs() < 1e-5, "{gap}");
    }
}

/// Returns a tetrahedron of glass, whose triangles share no vertices, without a stated thickness.
fn glass(generator: &str, faces: usize) -> Model {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f32]];
    let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mut model = Model::new();
    model.json["asset"]["generator"] = json!(generator);
    let positions: Vec<[f32; 3]> = triangles[..faces].iter().flatten().map(|i| corners[*i]).collect();
    let positions = model.floats(&positions);
    let clear = json!({ "KHR_materials_transmission": { "transmissionFactor": 1 } });
    let base = json!({ "roughnessFactor": 0, "metallicFactor": 0 });
    let material = model
        .push("materials", json!({ "name": "glass", "pbrMetallicRoughness": base, "extensions": clear }));
    let primitive = json!({ "attributes": { "POSITION": positions }, "material": material });
    let mesh = model.push("meshes", json!({ "primitives": [primitive] }));
    model.node(json!({ "mesh": mesh }));
    model.uses("KHR_materials_transmission");
    model
}

#[test]
fn closed_glass_by_blender_is_solid() {
    let blender = "Khronos glTF Blender I/O v4.2.60";
    let thin = LoadOptions { thin_glass: true, ..options() };
    for (generator, faces, options, is_thin, note) in [
        (blender, 4, options(), false, "--thin-glass"),
        (blender, 4, thin, true, ""),
        (blender, 3, options(), true, "thicknessFactor"),
        ("something else", 4, options(), true, "thicknessFactor"),
    ] {
        let model = glass(generator, faces);
        let loaded = load_with("m.glb", &[("m.glb", &model.glb())], &options).unwrap();
        let lobe = &material(&loaded, "glass").lobes[0];
        assert!(
            matches!(lobe, Lobe::Dielectric { thin, .. } if *thin == is_thin),
            "{generator} {faces}: {lobe:?}"
        );
        let said: Vec<_> = loaded.warnings.iter().filter(|w| w.what.contains("glass")).collect();
        match note {
            "" => assert!(said.is_empty(), "{said:?}"),
            note => assert!(said.len() == 1 && said[0].fallback.contains(note), "{said:?}"),
        }
    }
    // A volume of thickness 0 says that the wall is thin.
    let mut model = glass(blender, 4);
    model.json["materials"][0]["extensions"]["KHR_materials_volume"] = json!({ "thicknessFactor": 0 });
    model.uses("KHR_materials_volume");
    assert!(matches!(material(&load_glb(&model), "glass").lobes[0], Lobe::Dielectric { thin: true, .. }));
    let scene = "[[mesh]]\nfile = \"m.glb\"\nthin_glass = true\n[environment]\nradiance = 1\n";
    let files = [("m.glb", &glass(blender, 4).glb()[..]), ("s.toml", scene.as_bytes())];
    let loaded = load_beside("s.toml", &files).unwrap();
    assert!(matches!(material(&loaded, "glass").lobes[0], Lobe::Dielectric { thin: true, .. }));
}

#[test]
fn empty_nodes_that_may_be_lamps_are_named() {
    let mut model = lamp("", "point", 4.0, json!({}));
    for name in ["Area.001", "Empty"] {
        model.node(json!({ "name": name }));
    }
    let loaded = load_with("m.glb", &[("m.glb", &model.glb())], &options()).unwrap();
    let said: Vec<_> = loaded.warnings.iter().filter(|w| w.what.contains("may be a lamp")).collect();
    assert!(said.len() == 1 && said[0].what.ends_with(": Area.001"), "{said:?}");
}
