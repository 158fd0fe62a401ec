//! Turntables, PNG files alone, movies, lenses, clay and parts of scenes, masks, and smaller files.

use super::dataset::OBJ;
use super::{Finished, Sandbox, read};
use lightsplat::film::ExrFile;
use std::fs;

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::with("chair.obj", OBJ);
    fs::create_dir(sandbox.path("f")).unwrap();
    sandbox
}

const FAST: [&str; 7] = ["--method", "path", "--spp", "2", "--no-denoise", "-r", "24x16"];

fn turn(sandbox: &Sandbox, more: &[&str]) -> Finished {
    let base = ["walk", "chair.obj", "--turntable", "3"];
    sandbox.run(&[&base, &FAST[..], more].concat())
}

#[test]
fn turntables_may_be_png_files_alone() {
    let sandbox = sandbox();
    let stderr = turn(&sandbox, &["-o", "f/t.#.png", "--elevation", "10", "--aov", "depth"]).expect(0).stderr;
    assert!(stderr.contains("--aov depth is not written"), "{stderr}");
    let mut files: Vec<_> =
        fs::read_dir(sandbox.path("f")).unwrap().map(|file| file.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["t.1.png", "t.2.png", "t.3.png"]);
    assert!(read(&sandbox.path("f/t.1.png")) != read(&sandbox.path("f/t.2.png")));
    let refused = turn(&sandbox, &["-o", "f/t.#.png", "--resume"]).expect(2).stderr;
    assert!(refused.contains("--resume needs OpenEXR files"), "{refused}");
    let without = sandbox.run(&["walk", "chair.obj", "-o", "f/t.#.png"]).expect(2).stderr;
    assert!(without.contains("--turntable"), "{without}");
}

#[cfg(unix)]
#[test]
fn movies_are_of_all_frames_and_need_ffmpeg() {
    use std::os::unix::fs::PermissionsExt;
    let sandbox = sandbox();
    let run = |path: &str| {
        let frames = ["walk", "chair.obj", "--turntable", "3", "-o", "f/t.#.png", "--movie", "a.mp4"];
        let output = sandbox.command(&[&frames, &FAST[..]].concat()).env("PATH", path).output();
        Finished::from(output.unwrap())
    };
    let stderr = run("/nowhere").expect(2).stderr;
    assert!(stderr.contains("--movie needs ffmpeg") && !sandbox.path("f/t.1.png").exists(), "{stderr}");
    fs::create_dir(sandbox.path("bin")).unwrap();
    let ffmpeg = sandbox.path("bin/ffmpeg");
    let script = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nfor last; do :; done\nexec cat >\"$last\"\n";
    fs::write(&ffmpeg, script).unwrap();
    fs::set_permissions(&ffmpeg, fs::Permissions::from_mode(0o755)).unwrap();
    run(&format!("{}:{}", sandbox.path("bin").display(), std::env::var("PATH").unwrap())).expect(0);
    let frames = [1, 2, 3].map(|frame| read(&sandbox.path(&format!("f/t.{frame}.png"))));
    assert!(read(&sandbox.path("a.mp4")) == frames.concat());
}

#[test]
fn lenses_clay_and_names_change_the_image() {
    let sandbox = Sandbox::new();
    let image = |more: &[&str]| {
        sandbox.render("a.exr", more).expect(0);
        ExrFile::read(&sandbox.path("a.exr")).unwrap().color().unwrap()
    };
    let plain = image(&[]);
    assert!(image(&["--set", "clay=on"]) != plain && image(&["--set", "aperture=0.5"]) != plain);
    let far = image(&["--set", "aperture=0.5", "--set", "focus=100"]);
    assert!(far != image(&["--set", "aperture=0.5", "--set", "focus=1"]));
    let wrong = |more: &[&str], code| sandbox.render("a.exr", more).expect(code).stderr;
    assert!(wrong(&["--set", "focus=1"], 2).contains("aperture"));
    assert!(wrong(&["--set", "hide=table"], 3).contains("no mesh or material \"table\""));
}

#[test]
fn masks_ids_halves_and_depths_are_written() {
    let sandbox = Sandbox::new();
    sandbox.render("full.exr", &["--aov", "depth"]).expect(0);
    let layers =
        ["--aov", "crypto-object,crypto-material,object", "--set", "half=on", "--set", "depth-png=100"];
    sandbox.render("a.exr", &layers).expect(0);
    let [full, half] = ["full.exr", "a.exr"].map(|name| ExrFile::read(&sandbox.path(name)).unwrap());
    let channels = half.channels();
    for name in ["CryptoObject00.R", "CryptoObject02.A", "CryptoMaterial01.G", "objectId"] {
        assert!(channels.iter().any(|channel| channel == name), "{channels:?}");
    }
    let has_variance = |file: &ExrFile| file.channels().iter().any(|channel| channel.contains("variance"));
    assert!(has_variance(&full) && !has_variance(&half));
    let bytes = read(&sandbox.path("a.exr"));
    let has = |text: &str| bytes.windows(text.len()).any(|window| window == text.as_bytes());
    assert!(has("cryptomatte/3ae39a5/manifest") && has("cryptomatte/be359d6/conversion"));
    let colours = [&full, &half].map(|file| file.color().unwrap().pixels);
    assert!(colours[0] != colours[1]);
    for (full, half) in colours[0].iter().zip(&colours[1]) {
        assert!((*full - *half).abs().max_element() <= 1e-3 * full.max_element(), "{full} {half}");
    }
    let ids: serde_json::Value = serde_json::from_slice(&read(&sandbox.path("a.ids.json"))).unwrap();
    assert_eq!(ids["objects"].as_array().unwrap().len(), 2);
    let depth = full.layer("depth.Z").unwrap().pixels;
    let numbers = image::open(sandbox.path("a.depth.png")).unwrap().into_luma16().into_raw();
    for (depth, number) in depth.iter().zip(numbers) {
        let expected = if depth.x < 1e10 { (100.0 * depth.x).round() } else { 0.0 };
        assert!((f32::from(number) - expected).abs() < 0.6, "{depth} {number}");
    }
}
