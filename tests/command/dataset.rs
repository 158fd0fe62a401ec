//! Data sets: cameras and lights by seeds, what is left out, resuming, job files.

use super::{Finished, Sandbox};
use serde_json::Value;
use std::fs;

/// A tetrahedron.
pub(super) const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::with("chair.obj", OBJ);
    fs::create_dir(sandbox.path("more")).unwrap();
    fs::write(sandbox.path("more/Chair.obj"), OBJ.replace("v 1", "v 2")).unwrap();
    fs::write(sandbox.path("broken.glb"), "no model").unwrap();
    sandbox
}

fn dataset(sandbox: &Sandbox, more: &[&str]) -> Finished {
    let base = ["dataset", "chair.obj", "broken.glb", "more/Chair.obj", "-o", "out", "--views", "4"];
    let fast = ["--size", "16", "--method", "path", "--spp", "2", "--no-denoise", "--threads", "2"];
    sandbox.run(&[&base, &fast[..], more].concat())
}

fn json(sandbox: &Sandbox, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(sandbox.path(name)).unwrap()).unwrap()
}

#[test]
fn models_are_rendered_in_random_light_and_broken_ones_are_left_out() {
    let sandbox = sandbox();
    let light = ["--light", "0.5", "sky,0,60", "--aov", "object", "--set", "half=on"];
    let done = dataset(&sandbox, &light).expect(5);
    assert!(
        done.stderr.contains("1 of 3 models cannot be read and are left out: broken.glb"),
        "{}",
        done.stderr
    );
    for folder in ["chair", "Chair_2"] {
        let files: Vec<String> = (1..=4)
            .flat_map(|view| ["exr", "png"].map(|kind| format!("out/{folder}/{view:04}.{kind}")))
            .collect();
        assert!(files.iter().all(|file| sandbox.path(file).exists()), "{files:?}");
        let list = json(&sandbox, &format!("out/{folder}/transforms.json"));
        assert_eq!((list["w"].as_u64(), list["frames"].as_array().unwrap().len()), (Some(16), 4));
        assert_eq!(json(&sandbox, &format!("out/{folder}/ids.json"))["objects"][0]["id"], 1);
    }
    let metadata = json(&sandbox, "out/metadata.json");
    assert_eq!(metadata["left_out"], serde_json::json!(["broken.glb"]));
    let lights = metadata["models"][0]["lights"].as_array().unwrap();
    assert!(lights.iter().all(|light| ["0.5,0.5,0.5", "sky,0,60"].contains(&light.as_str().unwrap())));
    let list = json(&sandbox, "out/chair/transforms.json");
    let lit: Vec<&Value> = list["frames"].as_array().unwrap().iter().map(|frame| &frame["light"]).collect();
    assert!(lit == lights.iter().collect::<Vec<_>>(), "{list}");
    let jobs = fs::read_to_string(sandbox.path("out/jobs.toml")).unwrap();
    assert!(jobs.contains("half = true") && jobs.contains("aov = \"object\""), "{jobs}");
    // The job file gives the same images again.
    let first = fs::read(sandbox.path("out/chair/0001.png")).unwrap();
    fs::remove_file(sandbox.path("out/chair/0001.exr")).unwrap();
    let resumed = dataset(&sandbox, &[&light[..], &["--resume"]].concat()).expect(5);
    assert!(resumed.stderr.contains("1 views rendered"), "{}", resumed.stderr);
    fs::remove_file(sandbox.path("out/chair/0001.exr")).unwrap();
    sandbox.run(&["batch", "out/jobs.toml", "--resume"]).expect(0);
    assert!(first == fs::read(sandbox.path("out/chair/0001.png")).unwrap());
}

#[test]
fn cameras_depend_on_the_seed_and_the_model_alone() {
    let sandbox = sandbox();
    let cameras = |more: &[&str]| {
        dataset(&sandbox, &[&["--plan"], more].concat()).expect(5);
        assert!(!sandbox.path("out/chair/0001.exr").exists());
        ["chair", "Chair_2"].map(|folder| json(&sandbox, &format!("out/{folder}/transforms.json")))
    };
    let [first, second] = cameras(&[]);
    assert!(first["frames"][0] != second["frames"][0]);
    assert_eq!(cameras(&[]), [first.clone(), second]);
    assert!(cameras(&["--seed", "1"])[0] != first);
    let base = ["dataset", "chair.obj", "-o", "alone", "--views", "4", "--plan", "--size", "16"];
    sandbox.run(&base).expect(0);
    assert_eq!(json(&sandbox, "alone/chair/transforms.json"), first);
    for option in [&["--look-from", "1,2,3"][..], &["--dry-run"]] {
        assert!(dataset(&sandbox, option).expect(2).stderr.contains(option[0]), "{option:?}");
    }
}
