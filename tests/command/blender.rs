//! The commands of `docs/blender.md`, on a file as Blender exports it: no light, and no camera unless it is ticked.

use super::Sandbox;
use image::Rgb;
use image::codecs::hdr::HdrEncoder;
use serde_json::{Value, json};
use std::fs;

/// Options of renders, so that they take little time.
const SMALL: [&str; 7] = ["-r", "32", "--spp", "1", "--set", "vpls=500", "--no-denoise"];

/// Frames of the camera's animation.
const FRAMES: usize = 13;

/// Returns the commands of the page: the lines of its blocks of code.
fn commands() -> Vec<String> {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/blender.md")).unwrap();
    let blocks = page.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let lines = blocks.flat_map(str::lines).map(|line| line.split(" #").next().unwrap_or_default().trim());
    lines.filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

/// Buffer of a file, with views and accessors of its parts.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an accessor of numbers; returns its index.
    fn add(&mut self, bytes: &[u8], mut accessor: Value) -> usize {
        accessor["bufferView"] = self.views.len().into();
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, width: usize, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let of = |fold: fn(f32, f32) -> f32| -> Vec<f32> {
            let column = |i: usize| numbers.iter().skip(i).step_by(width).copied().reduce(fold).unwrap();
            (0..width).map(column).collect()
        };
        let (min, max) = (of(f32::min), of(f32::max));
        let count = numbers.len() / width;
        self.add(
            &bytes,
            json!({ "componentType": 5126, "count": count, "type": kind, "min": min, "max": max }),
        )
    }
}

/// The cube of a new file of Blender, as its exporter writes it; with two cameras, of which the first is animated, if
/// they are ticked.
fn exported(cameras: bool) -> Vec<u8> {
    let (mut positions, mut normals, mut uvs, mut indices) = (vec![], vec![], vec![], vec![]);
    for face in 0..6u16 {
        let (axis, sign) = (usize::from(face / 2), if face % 2 == 0 { 1.0 } else { -1.0 });
        for corner in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0f32]] {
            let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
            (position[axis], normal[axis]) = (sign, sign);
            (position[(axis + 1) % 3], position[(axis + 2) % 3]) = (sign * corner[0], corner[1]);
            positions.extend(position);
            normals.extend(normal);
            uvs.extend(corner.map(|at| 0.5 + 0.5 * at));
        }
        indices.extend([0, 1, 2, 0, 2, 3].map(|i: u16| 4 * face + i));
    }
    let mut buffer = Buffer::default();
    let position = buffer.floats("VEC3", 3, &positions);
    let normal = buffer.floats("VEC3", 3, &normals);
    let uv = buffer.floats("VEC2", 2, &uvs);
    let corners: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    let indices =
        buffer.add(&corners, json!({ "componentType": 5123, "count": indices.len(), "type": "SCALAR" }));
    let attributes = json!({ "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv });
    let mut file = json!({
        "asset": { "generator": "Khronos glTF Blender I/O v4.5.47", "version": "2.0" },
        "scene": 0,
        "scenes": [{ "name": "Scene", "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "Cube" }],
        "meshes": [{
            "name": "Cube",
            "primitives": [{ "attributes": attributes, "indices": indices, "material": 0 }],
        }],
        "materials": [{
            "doubleSided": true,
            "name": "Material",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.800_000_011_920_929, 0.800_000_011_920_929, 0.800_000_011_920_929, 1],
                "metallicFactor": 0,
                "roughnessFactor": 0.5,
            },
        }],
    });
    if cameras {
        let lens =
            json!({ "aspectRatio": 1.777_777_777_777_777_7, "yfov": 0.399_596, "zfar": 100, "znear": 0.1 });
        let camera = |name: &str| json!({ "name": name, "perspective": lens, "type": "perspective" });
        file["cameras"] = json!([camera("Camera"), camera("Camera.001")]);
        file["scenes"][0]["nodes"] = json!([0, 1, 2]);
        let node = |camera: usize, name: &str, z: f32| json!({ "camera": camera, "name": name, "translation": [0, 0, z] });
        file["nodes"] = json!([file["nodes"][0], node(0, "Camera", 11.0), node(1, "Camera.001", 8.0)]);
        let times: Vec<f32> = (0..FRAMES).map(|frame| frame as f32 / 24.0).collect();
        let ways: Vec<f32> = (0..FRAMES).flat_map(|frame| [0.1 * frame as f32, 0.0, 11.0]).collect();
        let (input, output) = (buffer.floats("SCALAR", 1, &times), buffer.floats("VEC3", 3, &ways));
        file["animations"] = json!([{
            "name": "CameraAction",
            "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }],
            "samplers": [{ "input": input, "interpolation": "LINEAR", "output": output }],
        }]);
    }
    file["accessors"] = buffer.accessors.into();
    file["bufferViews"] = buffer.views.into();
    file["buffers"] = json!([{ "byteLength": buffer.bytes.len() }]);
    glb(&file, &buffer.bytes)
}

/// Returns a binary file of a description and its buffer.
fn glb(file: &Value, buffer: &[u8]) -> Vec<u8> {
    let mut text = file.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |number: usize| (number as u32).to_le_bytes();
    let head = [*b"glTF", word(2), word(28 + text.len() + buffer.len())].concat();
    [&head[..], &word(text.len()), b"JSON", &text, &word(buffer.len()), b"BIN\0", buffer].concat()
}

/// Returns a command without the option for the size of the image, and with those for little work.
fn small<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let size = arguments.iter().position(|argument| *argument == "-r");
    let is_size = |i: usize| size.is_some_and(|size| i == size || i == size + 1);
    let kept = arguments.iter().enumerate().filter(|(i, _)| !is_size(*i)).map(|(_, argument)| *argument);
    kept.chain(SMALL).collect()
}

#[test]
fn the_commands_of_the_page_work_on_files_as_blender_exports_them() {
    let sandbox = Sandbox::new();
    let sky: Vec<Rgb<f32>> = (0..32u8).map(|i| Rgb([1.0, 1.0, 4.0 - f32::from(i / 8)])).collect();
    let hdr = fs::File::create(sandbox.path("studio.hdr")).unwrap();
    HdrEncoder::new(hdr).encode(&sky, 8, 4).unwrap();
    let commands = commands();
    let mut verbs = Vec::new();
    for command in &commands {
        let words: Vec<&str> = command.split_whitespace().collect();
        let [program, verb, ..] = words[..] else { panic!("{command}") };
        assert_eq!(program, "lightsplat", "{command}");
        verbs.push(verb);
        let cameras = verb == "walk" || words.contains(&"-c") || words.contains(&"--frame");
        fs::write(sandbox.path("room.glb"), exported(cameras)).unwrap();
        if verb == "render" || verb == "walk" {
            // As it stands, then with less work.
            sandbox.run(&[&words[1..], &["--dry-run"]].concat()).expect(0);
            let said = sandbox.run(&small(&words[1..])).expect(0).stderr;
            let has_sky = said.contains("the file has no light");
            assert_eq!(has_sky, !words.contains(&"--env"), "{command}: {said}");
        } else {
            let finished = sandbox.run(&words[1..]).expect(0);
            assert!(
                verb != "info" || finished.stdout.contains("none; the whole scene is framed"),
                "{command}"
            );
        }
    }
    assert!(["info", "render", "develop", "walk"].iter().all(|verb| verbs.contains(verb)), "{verbs:?}");
    let image = image::open(sandbox.path("room.png")).unwrap().into_rgb8();
    assert!(image.width() == 32 && image.iter().any(|value| *value > 100));
    let last = format!("frames/f.{FRAMES:04}.exr");
    assert!(sandbox.path(&last).exists() && !sandbox.path("frames/f.0014.exr").exists());
    sandbox.run(&["info", "room.glb", "--json"]).expect(0);
}

#[test]
fn the_unit_of_lamps_is_an_option() {
    let mut buffer = Buffer::default();
    let corners = [-1.0, 0.0, -1.0, 1.0, 0.0, -1.0, 0.0, 0.0, 1.0];
    let position = buffer.floats("VEC3", 3, &corners);
    let lights = json!({ "lights": [{ "type": "point", "color": [1, 1, 1], "intensity": 54.4 }] });
    let file = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "mesh": 0 }, { "translation": [0, 2, 0], "extensions": { "KHR_lights_punctual": { "light": 0 } } }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": position } }] }],
        "extensionsUsed": ["KHR_lights_punctual"], "extensions": { "KHR_lights_punctual": lights },
        "buffers": [{ "byteLength": buffer.bytes.len() }],
        "bufferViews": buffer.views, "accessors": buffer.accessors,
    });
    let sandbox = Sandbox::new();
    fs::write(sandbox.path("m.glb"), glb(&file, &buffer.bytes)).unwrap();
    let light = |unit: &str| {
        let place = ["--look-from", "0,3,0.1", "--look-at", "0,0,0", "--env", "0", "--method", "path"];
        let base = ["render", "m.glb", "-o", "a.exr", "--lumens-per-watt", unit];
        sandbox.run(&[&base, &place[..], &SMALL[..2], &["--spp", "4", "--no-denoise"]].concat()).expect(0);
        lightsplat::film::read_exr(&sandbox.path("a.exr")).unwrap().luminance()
    };
    let (lumens, watts) = (light("683"), light("1"));
    assert!(lumens > 0.0 && (watts / lumens - 683.0).abs() < 0.1, "{watts} {lumens}");
}

#[test]
fn info_names_cameras_frames_and_materials_of_an_export() {
    let sandbox = Sandbox::new();
    fs::write(sandbox.path("room.glb"), exported(true)).unwrap();
    let facts = sandbox.run(&["info", "room.glb", "--json"]).expect(0).stdout;
    let facts: Value = serde_json::from_str(&facts).unwrap();
    assert_eq!(facts["cameras"], json!(["Camera", "Camera.001"]));
    assert_eq!(
        (&facts["frame_range"], &facts["material_names"]),
        (&json!([1, FRAMES]), &json!(["Material"]))
    );
    assert_eq!(facts["box"], json!({ "min": [-1.0, -1.0, -1.0], "max": [1.0, 1.0, 1.0] }));
    let text = sandbox.run(&["info", "room.glb"]).expect(0).stdout;
    for line in ["1 (Camera), 2 (Camera.001)", "1 to 13", "[-1.0,-1.0,-1.0] to [1.0,1.0,1.0]"] {
        assert!(text.contains(line), "{text}");
    }
}
