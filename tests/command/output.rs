//! Files that a render leaves behind.

use super::{Finished, Sandbox, read};
use lightsplat::film::{ExrFile, Fact, read_exr};
use std::process::Command;

#[test]
fn a_render_writes_picture_preview_variance_and_where_it_comes_from() {
    let sandbox = Sandbox::new();
    let run = sandbox.render("a.exr", &["--seed", "3"]).expect(0);
    assert_eq!(run.stdout, "");
    assert!(run.stderr.contains("a.exr") && run.stderr.contains("a.png") && run.stderr.contains("EV"));
    assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
    let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
    let color = file.color().unwrap();
    assert_eq!((color.width, color.height), (24, 16));
    assert!(color.pixels.iter().any(|p| p.x > 0.0));
    assert_eq!(file.layers(), ["", "variance"]);
    let facts = file.metadata();
    assert_eq!((facts.text("method"), facts.text("partial")), (Some("path"), Some("false")));
    assert_eq!((facts.number("spp"), facts.number("seed")), (Some(4.0), Some(3.0)));
    assert_eq!(facts.text("version"), Some(env!("CARGO_PKG_VERSION")));
    assert_eq!(facts.text("scene_hash").map(str::len), Some(16));
    assert!(facts.number("render_seconds").unwrap() > 0.0 && facts.number("standard_error").unwrap() > 0.0);
    assert!(matches!(facts.get("settings"), Some(Fact::Text(json)) if json.contains("\"spp\":4")));
}

#[test]
fn the_settings_of_lightcuts_reach_the_method_and_the_file() {
    let sandbox = Sandbox::new();
    let options = [
        "--set",
        "epsilon=0.3",
        "--set",
        "max-cut=7",
        "--set",
        "vpls=300",
        "--set",
        "direct-vpls=256",
        "--set",
        "clamp=0",
    ];
    let shadows = ["--set", "share=off", "--set", "occluder-slots=256", "--set", "occluder-ways=2"];
    let coarse = [&["--method", "lightcuts"], &options[..], &shadows].concat();
    sandbox.render("a.exr", &coarse).expect(0);
    let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
    assert_eq!(file.metadata().text("method"), Some("lightcuts"));
    let settings: serde_json::Value =
        serde_json::from_str(file.metadata().text("settings").unwrap()).unwrap();
    let expected = serde_json::json!({
        "spp": 4, "seed": 0, "max_depth": null, "epsilon": 0.3, "max_cut": 7, "vpls": 300, "direct_vpls": 256,
        "clamp": 0, "compensation": "on", "share": "off",
        "occluder_cache": "auto", "occluder_slots": 256, "occluder_ways": 2,
    });
    assert_eq!(settings, expected);
    sandbox.render("b.exr", &[&coarse[..], &["--threads", "3"]].concat()).expect(0);
    assert_eq!(read_exr(&sandbox.path("b.exr")).unwrap(), file.color().unwrap());
    sandbox.render("c.exr", &[&coarse[..], &["--set", "occluder-cache=off"]].concat()).expect(0);
    assert_eq!(read_exr(&sandbox.path("c.exr")).unwrap(), file.color().unwrap());
    let refused = sandbox.render("d.exr", &["--method", "lightcuts", "--set", "occluder-ways=9"]).expect(2);
    assert!(refused.stderr.contains("from 1 to 8"), "{}", refused.stderr);
}

#[test]
fn a_crop_repeats_the_pixels_of_the_whole_picture_for_any_number_of_threads() {
    let sandbox = Sandbox::new();
    sandbox.render("whole.exr", &["--threads", "1"]).expect(0);
    sandbox.render("crop.exr", &["--threads", "3", "--crop", "5,3,7,9", "--no-png"]).expect(0);
    let whole = ExrFile::read(&sandbox.path("whole.exr")).unwrap().color().unwrap();
    let file = ExrFile::read(&sandbox.path("crop.exr")).unwrap();
    assert_eq!((file.window().film, file.window().offset), ([24, 16], [5, 3]));
    let crop = file.color().unwrap();
    for (i, pixel) in crop.pixels.iter().enumerate() {
        let (x, y) = (i % 7 + 5, i / 7 + 3);
        assert_eq!(*pixel, whole.pixels[y * 24 + x]);
    }
    assert!(!sandbox.path("crop.png").exists());
}

#[test]
fn extreme_resolutions_are_rendered() {
    let sandbox = Sandbox::new();
    for resolution in ["1x1", "1x70", "70x1", "16384x2"] {
        sandbox.run(&Sandbox::path_tracing("1", &["--resolution", resolution])).expect(0);
        let image = ExrFile::read(&sandbox.path("a.exr")).unwrap().color().unwrap();
        assert_eq!(format!("{}x{}", image.width, image.height), resolution);
    }
}

#[test]
fn statistics_are_the_only_data_on_stdout() {
    let sandbox = Sandbox::new();
    let json = sandbox.render("a.exr", &["--stats", "json"]).expect(0).stdout;
    let stats: serde_json::Value = serde_json::from_str(&json).unwrap();
    for stage in ["load", "build", "render", "write", "total"] {
        assert!(stats["times"][stage]["wall_seconds"].as_f64().unwrap() >= 0.0, "{stage}");
    }
    assert_eq!(stats["counters"]["Paths"]["total"], 24 * 16 * 4);
    assert_eq!(stats["run"]["complete"], true);
    let text = sandbox.render("a.exr", &["--stats", "text"]).expect(0).stdout;
    assert!(text.contains("Rays\n") && text.contains("total"), "{text}");
}

#[test]
fn messages_for_programs_are_one_object_a_line_from_start_to_end() {
    let sandbox = Sandbox::new();
    let stderr = sandbox.render("a.exr", &["--progress", "ndjson"]).expect(0).stderr;
    let events: Vec<serde_json::Value> = stderr.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert!(events.iter().all(|e| e["v"] == 1));
    let kinds: Vec<&str> = events.iter().map(|e| e["event"].as_str().unwrap()).collect();
    assert_eq!((kinds[0], kinds[kinds.len() - 1]), ("start", "end"));
    assert_eq!((&events[0]["command"], &events[events.len() - 1]["exit"]), (&"render".into(), &0.into()));
    let find =
        |kind: &str| &events[kinds.iter().rposition(|k| *k == kind).unwrap_or_else(|| panic!("{kind}"))];
    assert_eq!(find("stage")["stage"], "render");
    let last = find("progress");
    assert_eq!((&last["stage"], &last["done"]), (&"render".into(), &last["total"]));
    assert_eq!((last["fraction"].as_f64(), last["eta_seconds"].as_f64()), (Some(1.0), Some(0.0)));
    assert_eq!(find("wrote")["files"], serde_json::json!(["a.exr", "a.png"]));
    // An invalid scene is an error, and an end all the same.
    let stderr = sandbox.run(&["render", "none.xml", "-o", "b.exr", "--progress", "ndjson"]).expect(3).stderr;
    assert!(stderr.contains(r#""event":"error""#) && stderr.contains(r#""exit":3"#), "{stderr}");
}

#[test]
fn a_run_is_not_over_before_its_error_is_measured() {
    let sandbox = Sandbox::new();
    let more = ["--verify", "300", "--progress", "ndjson"];
    let stderr = sandbox.render("a.exr", &more).expect(0).stderr;
    let events = stderr.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
    let (stages, told): (Vec<_>, Vec<_>) =
        events.filter(|e| e["stage"].is_string()).partition(|e| e["event"] == "stage");
    let stages: Vec<&str> = stages.iter().map(|e| e["stage"].as_str().unwrap()).collect();
    assert_eq!(stages, ["render", "verify"]);
    let (last, before) = told.split_last().unwrap();
    assert_eq!((&last["fraction"], &last["eta_seconds"]), (&1.0.into(), &0.0.into()));
    assert!(before.iter().all(|e| e["fraction"].as_f64() < Some(1.0)), "{before:?}");
}

#[test]
fn equal_renders_are_equal_bytes_and_are_left_alone_where_they_are() {
    let sandbox = Sandbox::new();
    let files = || ["a.exr", "a.png"].map(|name| super::read(&sandbox.path(name)));
    sandbox.render("a.exr", &["--reproducible", "--threads", "1"]).expect(0);
    let first = files();
    sandbox.render("a.exr", &["--reproducible", "--threads", "2"]).expect(0);
    assert!(files() == first);
    let left = |more: &[&str]| {
        let stderr =
            sandbox.render("a.exr", &[&["--reproducible", "--resume"], more].concat()).expect(0).stderr;
        stderr.contains("already exists and is unchanged")
    };
    assert!(left(&[]));
    std::fs::remove_file(sandbox.path("a.png")).unwrap();
    assert!(!left(&[]) && left(&[]) && files() == first);
    assert!(!left(&["--seed", "1"]) && left(&["--seed", "1"]) && !left(&["--exposure", "1"]));
    let error =
        sandbox.run(&["render", "room.xml", "-o", "b.exr", "--reproducible", "--time", "1s"]).expect(2);
    assert!(error.stderr.contains("--time"), "{}", error.stderr);
}

#[test]
fn agents_are_told_percentage_status_and_failure() {
    let sandbox = Sandbox::new();
    let stderr = sandbox.render("a.exr", &["--progress", "openjd"]).expect(0).stderr;
    let told: Vec<f64> = stderr
        .lines()
        .filter_map(|l| l.strip_prefix("openjd_progress: "))
        .map(|p| p.parse().unwrap())
        .collect();
    let (last, before) = told.split_last().unwrap();
    assert!(*last == 100.0 && before.iter().all(|p| *p < 100.0), "{stderr}");
    assert!(stderr.contains("openjd_status: image 1 of 1: render") && stderr.contains("wrote a.exr"));
    let stderr = sandbox.run(&["render", "none.xml", "-o", "b.exr", "--progress", "openjd"]).expect(3).stderr;
    assert!(stderr.contains("openjd_fail: ") && stderr.contains("error: "), "{stderr}");
}

#[test]
fn unwritable_outputs_end_with_4_before_rendering() {
    let sandbox = Sandbox::new();
    std::fs::create_dir(sandbox.path("folder.exr")).unwrap();
    // A render that would take hours: the error must come before it begins.
    let long = ["render", "room.xml", "--method", "path", "--spp", "4000000000", "-o"];
    for output in ["none/none/a.exr", "folder.exr", "room.xml/a.exr"] {
        let stderr = sandbox.run(&[&long[..], &[output]].concat()).expect(4).stderr;
        assert!(stderr.contains(output), "{stderr}");
    }
    sandbox.run(&[&long[..], &["a.exr", "--png", "none/none/a.png"]].concat()).expect(4);
    assert!(!sandbox.path("a.exr").exists());
    assert!(sandbox.run(&[&long[..], &["a.exr/"]].concat()).expect(2).stderr.contains("without /"));
}

#[cfg(unix)]
#[test]
fn write_protected_pictures_are_refused_before_rendering_and_may_stay() {
    let sandbox = Sandbox::new();
    for name in ["a.exr", "a.png"] {
        sandbox.render("a.exr", &["--resume"]).expect(0);
        let mut permissions = std::fs::metadata(sandbox.path(name)).unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(sandbox.path(name), permissions).unwrap();
        let before = read(&sandbox.path(name));
        for more in [&[][..], &["--resume"]] {
            let stderr = sandbox.run(&Sandbox::path_tracing("4000000000", more)).expect(4).stderr;
            assert!(stderr.contains(name) && stderr.contains("write-protected"), "{stderr}");
        }
        assert!(read(&sandbox.path(name)) == before);
        assert!(
            sandbox
                .render("a.exr", &["--resume"])
                .expect(0)
                .stderr
                .contains("already exists and is unchanged")
        );
        std::fs::remove_file(sandbox.path(name)).unwrap();
    }
}

/// Runs the command under a limit of 4096 or 8192 bytes per file, with SIGXFSZ ignored or not.
fn limited(sandbox: &Sandbox, on_signal: &str) -> Finished {
    let script = format!("{on_signal} ulimit -c 0; ulimit -f 8; exec \"$0\" \"$@\"");
    let output = Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_lightsplat")])
        .args(["render", "room.xml", "-o", "a.exr", "--method", "path", "--spp", "2"])
        .current_dir(sandbox.folder.path())
        .output()
        .unwrap();
    Finished::from(output)
}

#[cfg(unix)]
#[test]
fn a_disk_that_fills_up_ends_with_4_and_leaves_the_old_files_whole() {
    let sandbox = Sandbox::new();
    sandbox.render("a.exr", &[]).expect(0);
    let before = (read(&sandbox.path("a.exr")), read(&sandbox.path("a.png")));
    for on_signal in ["trap '' XFSZ;", ""] {
        let stderr = limited(&sandbox, on_signal).expect(4).stderr;
        assert!(stderr.contains("a.exr: File too large") && stderr.contains("is unchanged"), "{stderr}");
        assert_eq!((read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))), before);
        assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
    }
}

#[test]
fn names_that_are_too_long_are_refused_before_the_render() {
    let sandbox = Sandbox::new();
    let of = |length: usize| "x".repeat(length - 4) + ".exr";
    let long = ["--method", "path", "--spp", "1000000000"];
    let refused =
        sandbox.run(&[&["render", "room.xml", "-o", &of(256)][..], &long].concat()).expect(4).stderr;
    assert!(refused.contains("too long"), "{refused}");
    sandbox.render(&of(255), &[]).expect(0);
    // The name of a partial image, which would stand beside the complete one, is longer.
    let again = sandbox.run(&[&["render", "room.xml", "-o", &of(255)][..], &long].concat()).expect(4).stderr;
    assert!(again.contains("partial.exr") && again.contains("too long"), "{again}");
}

/// All features, by the names of their channels.
const FEATURES: [&str; 16] = [
    "A",
    "albedo.B",
    "albedo.G",
    "albedo.R",
    "depth.Z",
    "geometricNormal.X",
    "geometricNormal.Y",
    "geometricNormal.Z",
    "materialId",
    "normal.X",
    "normal.Y",
    "normal.Z",
    "objectId",
    "position.X",
    "position.Y",
    "position.Z",
];

#[test]
fn features_are_written_by_every_method_and_agree_with_the_cameras_matrices() {
    let sandbox = Sandbox::new();
    let all = "alpha,albedo,depth,normal,geometric-normal,material,object,position";
    let methods: [(&str, &[&str]); 4] = [
        ("path", &[]),
        ("reconstruction", &["--set", "vpls=300"]),
        ("lightcuts", &["--set", "vpls=300"]),
        ("photon-cache", &["--set", "photons=1000", "--set", "gather-rays=64"]),
    ];
    let mut albedos = Vec::new();
    for (method, more) in methods {
        let options = [&["--method", method, "--no-png", "--aov", all], more].concat();
        sandbox.render("a.exr", &options).expect(0);
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        let channels = file.channels();
        assert!(FEATURES.iter().all(|name| channels.iter().any(|channel| channel == name)), "{channels:?}");
        let layer = |name: &str| file.layer(name).unwrap().pixels;
        let (position, depth, alpha) = (layer("position"), layer("depth.Z"), layer("A"));
        let camera = file.camera().unwrap();
        let product = |p: [f32; 3], matrix: &[f32; 16]| -> [f32; 4] {
            let p = [p[0], p[1], p[2], 1.0];
            std::array::from_fn(|column| (0..4).map(|row| p[row] * matrix[4 * row + column]).sum())
        };
        let mut floor = 0;
        for i in (0..24 * 16).filter(|&i| alpha[i].x == 1.0) {
            // The floor is seen squarely enough for the mean position to lie in the pixel.
            if layer("objectId")[i].x != 1.0 || layer("normal")[i].y < 0.999 {
                continue;
            }
            floor += 1;
            let [x, y, _, w] = product(position[i].to_array(), &camera.world_to_ndc);
            let (column, row) = ((x / w * 24.0) as usize, (y / w * 16.0) as usize);
            assert_eq!((column, row), (i % 24, i / 24), "{method}");
            let [_, _, z, _] = product(position[i].to_array(), &camera.world_to_camera);
            assert!((z / depth[i].x - 1.0).abs() < 0.1, "{z} {}", depth[i].x);
            assert!(position[i].y.abs() < 1e-4);
            let albedo = layer("albedo")[i];
            assert!((albedo.x - 0.6).abs() < 1e-4 && (albedo.z - 0.4).abs() < 1e-4, "{albedo}");
            assert_eq!(layer("materialId")[i].x, 1.0);
        }
        assert!(floor > 60, "{floor}");
        albedos.push(layer("albedo"));
        sandbox.run(&["compare", "a.exr", "a.exr"]).expect(0);
    }
    // All other methods look through the same eye samples.
    assert!(albedos[1] == albedos[2] && albedos[2] == albedos[3]);
}

#[test]
fn inspection_writes_its_layers_as_pictures_for_both_caches() {
    for (method, more) in [("cache", "vpls=1000"), ("photon-cache", "photons=1000")] {
        let sandbox = Sandbox::new();
        let options = ["--method", method, "--set", more, "--set=inspect=on", "--set", "passes=1"];
        let more: &[&str] = if method == "cache" { &[] } else { &["--set", "gather-rays=64"] };
        sandbox.render("a.exr", &[&options, more].concat()).expect(0);
        let files = sandbox.files();
        for layer in ["direct", "indirect", "records", "footprint", "gradient", "weights", "seams.1"] {
            assert!(files.contains(&format!("a.{layer}.png")), "{method}: {files:?}");
        }
        let layers = ExrFile::read(&sandbox.path("a.exr")).unwrap().channels();
        assert!(layers.iter().any(|name| name == "gradient.X"), "{layers:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn pictures_are_written_to_paths_of_any_bytes() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let sandbox = Sandbox::new();
    let folder = sandbox.folder.path().join(OsStr::from_bytes(b"\xff"));
    std::fs::create_dir(&folder).unwrap();
    let render = ["render", "room.xml", "--method", "path", "--spp", "1", "--resolution", "4x4"];
    for more in [["--stats", "json"], ["--progress", "ndjson"]] {
        let mut command = sandbox.command(&[&render[..], &more].concat());
        command.arg("-o").arg(folder.join(OsStr::from_bytes(b"a\xfe.exr")));
        Finished::from(command.output().unwrap()).expect(0);
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 2);
        std::fs::remove_dir_all(&folder).unwrap();
        std::fs::create_dir(&folder).unwrap();
    }
    let job = "[[picture]]\nscene = '../room.xml'\noutput = 'b.exr'\nmethod = 'path'\nspp = 1\nresolution = '4x4'\n";
    std::fs::write(folder.join("job.toml"), job).unwrap();
    let mut command = sandbox.command(&["batch", "--progress", "ndjson"]);
    Finished::from(command.arg(folder.join("job.toml")).output().unwrap()).expect(0);
    assert!(read_exr(&folder.join("b.exr")).is_ok());
}

#[test]
fn no_result_replaces_a_file_that_is_read_or_another_result() {
    let sandbox = Sandbox::new();
    let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/valid");
    std::fs::copy(corpus.join("tile.png"), sandbox.path("wood.png")).unwrap();
    std::fs::copy(corpus.join("sky.exr"), sandbox.path("sky.exr")).unwrap();
    let scene = "resolution = [4, 4]\ncamera = { origin = [0, 0, 5], target = [0, 0, 0] }\n\
        material = [{ name = 'm', kind = 'diffuse', reflectance = 'wood.png' }]\n\
        mesh = [{ shape = 'cube', material = 'm' }]\nenvironment = { file = 'sky.exr' }\n";
    std::fs::write(sandbox.path("own.toml"), scene).unwrap();
    let names = ["own.toml", "room.xml", "sky.exr", "wood.png"];
    let before = names.map(|name| read(&sandbox.path(name)));
    let refused = |arguments: &[&str]| {
        let stderr = sandbox.run(arguments).expect(2).stderr;
        assert!(stderr.contains("name another file"), "{stderr}");
        assert_eq!(sandbox.files(), names);
    };
    let render = ["render", "own.toml", "--method", "path", "--spp", "1"];
    // The default PNG is beside the picture.
    refused(&[&render[..], &["-o", "wood.exr"]].concat());
    refused(&[&render[..], &["-o", "./sky.exr", "--no-png"]].concat());
    refused(&["bench", "shadow", "own.toml", "--export-json", "own.toml"]);
    refused(&["bench", "shadow", "own.toml", "--export-json", "wood.png"]);
    refused(&["bench", "shadow", "own.toml", "--export-markdown", "a.csv", "--export-json", "./a.csv"]);
    let job = "[[picture]]\nscene = 'own.toml'\noutput = 'wood.exr'\nspp = 1\n";
    std::fs::write(sandbox.path("job.toml"), job).unwrap();
    sandbox.run(&["batch", "job.toml"]).expect(5);
    std::fs::remove_file(sandbox.path("job.toml")).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("a.exr", sandbox.path("x.png")).unwrap();
        let stderr =
            sandbox.run(&[&render[..], &["-o", "a.exr", "--png", "x.png"]].concat()).expect(2).stderr;
        assert!(stderr.contains("two results"), "{stderr}");
        std::fs::remove_file(sandbox.path("x.png")).unwrap();
    }
    sandbox.render("a.exr", &["--seed", "1"]).expect(0);
    sandbox.render("b.exr", &["--seed", "2"]).expect(0);
    let whole = read(&sandbox.path("a.exr"));
    sandbox.run(&["merge", "a.exr", "b.exr", "-o", "a.exr"]).expect(2);
    assert!(read(&sandbox.path("a.exr")) == whole);
    assert!(names.map(|name| read(&sandbox.path(name))) == before);
}
