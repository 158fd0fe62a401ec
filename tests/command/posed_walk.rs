//! Walks through models that move: each frame shows the pose of its time.

use super::{Finished, Sandbox};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use lightsplat::film::{ExrFile, Image};
use serde_json::json;
use std::fs;

/// Width and height of the frames in pixels.
const SIZE: u32 = 24;
/// Half the width that the camera sees at the distance of the square.
const SEEN: f32 = 8.0;

/// Node that an animation moves to the right.
#[derive(Clone, Copy, PartialEq)]
enum Moved {
    Square = 0,
    Camera = 1,
}

/// A model of a bright square. A node is at x = 0, 4 and 8 in its three frames. A camera, if there is one, starts at
/// x = 4 and sees [`SEEN`] to both sides.
fn sandbox(moved: Moved, has_camera: bool) -> Sandbox {
    let corners = [[-1.0f32, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let (times, places) = ([0.0f32, 1.0 / 12.0], [[0.0f32, 0.0, 0.0], [8.0, 0.0, 0.0]]);
    let floats = [corners.as_flattened(), &times, places.as_flattened()].concat();
    let mut bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend([0u8, 1, 2, 0, 2, 3]);
    let view = |from: usize, length: usize| json!({ "buffer": 0, "byteOffset": from, "byteLength": length });
    let accessor = |view: usize, component: u32, kind: &str, count: usize| json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
    let mut nodes = vec![json!({ "mesh": 0 })];
    let mut model = json!({
        "asset": { "version": "2.0" }, "materials": [{ "emissiveFactor": [1, 1, 1] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 3, "material": 0 }] }],
        "animations": [{
            "samplers": [{ "input": 1, "output": 2 }],
            "channels": [{ "sampler": 0, "target": { "node": moved as usize, "path": "translation" } }],
        }],
        "accessors": [
            accessor(0, 5126, "VEC3", 4), accessor(1, 5126, "SCALAR", 2), accessor(2, 5126, "VEC3", 2),
            accessor(3, 5121, "SCALAR", 6),
        ],
        "bufferViews": [view(0, 48), view(48, 8), view(56, 24), view(80, 6)],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&bytes)) }],
    });
    if has_camera {
        let lens = json!({ "xmag": SEEN, "ymag": SEEN, "znear": 0.1, "zfar": 100 });
        model["cameras"] = json!([{ "type": "orthographic", "orthographic": lens }]);
        nodes.push(json!({ "camera": 0, "translation": [4, 0, 10] }));
        if moved == Moved::Camera {
            // The parent of the camera moves.
            nodes = vec![nodes[0].clone(), json!({ "children": [2] }), nodes[1].clone()];
        }
    }
    let roots: Vec<usize> = (0..nodes.len().min(2)).collect();
    model["scenes"] = json!([{ "nodes": roots }]);
    model["scene"] = json!(0);
    model["nodes"] = json!(nodes);
    let sandbox = Sandbox::new();
    fs::write(sandbox.path("m.gltf"), model.to_string()).unwrap();
    sandbox
}

/// Renders the model by paths, so that frames have the samples of stills.
fn run(sandbox: &Sandbox, command: &str, output: &str, more: &[&str]) -> Finished {
    let size = format!("{SIZE}x{SIZE}");
    let base = [command, "m.gltf", "-o", output, "--method", "path", "--spp", "16", "--resolution", &size];
    sandbox.run(&[&base[..], &["--no-default-light", "--no-denoise"], more].concat())
}

fn colours(sandbox: &Sandbox, name: &str) -> Image {
    ExrFile::read(&sandbox.path(name)).unwrap().color().unwrap()
}

/// Mean of an image, and the column of its light in units from the middle.
fn light(image: &Image) -> (f32, f32) {
    let sum: f32 = image.pixels.iter().map(|pixel| pixel.x).sum();
    let column = |i: usize| (i as u32 % SIZE) as f32 + 0.5;
    let moment: f32 = image.pixels.iter().enumerate().map(|(i, pixel)| pixel.x * column(i)).sum();
    (sum / (SIZE * SIZE) as f32, (moment / sum / SIZE as f32 - 0.5) * 2.0 * SEEN)
}

#[test]
fn each_frame_shows_the_pose_of_its_time_as_a_still_of_it_does() {
    let sandbox = sandbox(Moved::Square, true);
    let said = run(&sandbox, "walk", "a.#.exr", &[]).expect(0).stderr;
    assert!(said.contains("the model moves") && said.contains("3 frames rendered"), "{said}");
    // All commands say the same of the animation.
    assert!(!said.contains("pose at rest"), "{said}");
    let said = run(&sandbox, "render", "rest.exr", &["--strict"]).expect(0).stderr;
    assert!(said.contains("there is an animation of 3 frames; this is the pose at rest"), "{said}");
    let facts = sandbox.run(&["info", "m.gltf", "--strict", "--json"]).expect(0).stdout;
    assert!(facts.contains("\"frames\":3") && facts.contains("\"frame_range\":[1,3]"), "{facts}");
    for (frame, x) in [("1", -4.0), ("2", 0.0), ("3", 4.0)] {
        let image = colours(&sandbox, &format!("a.{frame}.exr"));
        let (mean, place) = light(&image);
        assert!(
            (mean * SEEN * SEEN - 1.0).abs() < 0.05 && (place - x).abs() < 0.1,
            "{frame}: {mean} {place}"
        );
        run(&sandbox, "render", "b.exr", &["--frame", frame]).expect(0);
        assert_eq!(colours(&sandbox, "b.exr"), image, "{frame}");
    }
    // A frame that lacks is rendered alone, and frames of the default method have no records.
    fs::remove_file(sandbox.path("a.2.exr")).unwrap();
    let said = run(&sandbox, "walk", "a.#.exr", &["--resume"]).expect(0).stderr;
    assert!(said.contains("1 frames rendered, 2 existed already"), "{said}");
    assert_eq!(light(&colours(&sandbox, "a.2.exr")).1.abs().round(), 0.0);
    let default = ["walk", "m.gltf", "-o", "c.#.exr", "--resolution", "24x24", "--spp", "16", "--no-denoise"];
    sandbox.run(&[&default[..], &["--no-default-light", "--set", "vpls=500"]].concat()).expect(0);
    let places = ["c.1.exr", "c.3.exr"].map(|name| light(&colours(&sandbox, name)).1);
    assert!((places[0] + 4.0).abs() < 0.2 && (places[1] - 4.0).abs() < 0.2, "{places:?}");
    assert!(sandbox.files().iter().all(|name| !name.ends_with(".records")));
}

#[test]
fn a_model_without_a_camera_leaves_the_view_of_its_first_frame() {
    let sandbox = sandbox(Moved::Square, false);
    run(&sandbox, "walk", "a.#.exr", &["--frames", "1,3"]).expect(0);
    let means = ["a.1.exr", "a.3.exr"].map(|name| light(&colours(&sandbox, name)).0);
    assert!(means[0] > 0.1 && means[1] == 0.0, "{means:?}");
}

#[test]
fn a_camera_that_moves_alone_sees_one_model() {
    let sandbox = sandbox(Moved::Camera, true);
    let said = run(&sandbox, "walk", "a.#.exr", &[]).expect(0).stderr;
    assert!(!said.contains("the model moves") && said.contains("3 frames rendered"), "{said}");
    let [first, second, third] = [1, 2, 3].map(|frame| light(&colours(&sandbox, &format!("a.{frame}.exr"))));
    // Half the square leaves the picture, and then all of it.
    assert!((first.1 + 4.0).abs() < 0.1 && (second.1 + 7.5).abs() < 0.2, "{first:?} {second:?}");
    assert!(
        (first.0 - 2.0 * second.0).abs() < 0.1 * first.0 && third.0 == 0.0,
        "{first:?} {second:?} {third:?}"
    );
}
