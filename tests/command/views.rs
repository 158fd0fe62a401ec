//! Views of a list: names of files, films, exposure, what views share, resuming and kills, batches, wrong lists.

use super::walk::PATH;
use super::{Finished, Sandbox, read};
use lightsplat::film::ExrFile;
use std::fs;
use std::path::PathBuf;

/// Cameras around the floor and its lamp: a name, a position and a target each.
const VIEWS: [(&str, [f64; 3], [f64; 3]); 5] = [
    ("./train/r_0.png", [0.0, 3.0, 6.0], [0.0, 0.5, 0.0]),
    ("./train/r_1.png", [0.4, 3.0, 5.8], [0.0, 0.5, 0.0]),
    ("./test/r_0.png", [0.8, 3.0, 5.6], [0.0, 0.5, 0.0]),
    ("../up/r_3.png", [1.2, 3.0, 5.4], [0.0, 0.5, 0.0]),
    ("./train/r_0.png", [1.6, 3.0, 5.2], [0.0, 0.5, 0.0]),
];

/// Names of the images of the views.
pub(super) const NAMES: [&str; 5] = ["train/r_0", "train/r_1", "test/r_0", "up/r_3", "train/r_0_2"];

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// Returns the list of a NeRF data set with these views.
fn transforms(views: &[(&str, [f64; 3], [f64; 3])]) -> String {
    let frame = |(name, origin, target): &(&str, [f64; 3], [f64; 3])| {
        let back = unit([0, 1, 2].map(|i| origin[i] - target[i]));
        let right = unit(cross([0.0, 1.0, 0.0], back));
        let up = cross(back, right);
        let row = |i: usize| [right[i], up[i], back[i], origin[i]];
        serde_json::json!({ "file_path": name, "transform_matrix": [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]] })
    };
    let frames: Vec<serde_json::Value> = views.iter().map(frame).collect();
    let angle = 50f64.to_radians();
    serde_json::json!({ "camera_angle_x": angle, "w": 96, "h": 64, "frames": frames }).to_string()
}

pub(super) fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    fs::write(sandbox.path("path.toml"), PATH).unwrap();
    fs::write(sandbox.path("cameras.json"), transforms(&VIEWS)).unwrap();
    sandbox
}

fn arguments<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let base = ["views", "path.toml", "cameras.json", "-o", "out", "--no-denoise"];
    // Small cells have records on small images, too.
    let fast = [["--spp", "4"], ["--set", "vpls=2000"], ["--set", "least-cell=32"]];
    let own = fast.iter().filter(|option| !more.contains(&option[0])).flatten().copied();
    base.into_iter().chain(own).chain(more.iter().copied()).collect()
}

pub(super) fn views(sandbox: &Sandbox, more: &[&str]) -> Finished {
    sandbox.run(&arguments(more))
}

pub(super) fn exr(sandbox: &Sandbox, name: &str) -> ExrFile {
    ExrFile::read(&sandbox.path(&format!("out/{name}.exr"))).unwrap()
}

pub(super) fn colour(sandbox: &Sandbox, name: &str) -> lightsplat::film::Image {
    exr(sandbox, name).color().unwrap()
}

/// Returns all files below `out`, without those that kills leave.
pub(super) fn files(sandbox: &Sandbox) -> Vec<String> {
    let (mut folders, mut found) = (vec![sandbox.path("out")], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "exr" || e == "png" || e == "records") {
                let name = path.strip_prefix(sandbox.path("out")).unwrap();
                found.push(name.to_str().unwrap().to_owned());
            }
        }
    }
    found.sort();
    found
}

fn bytes(sandbox: &Sandbox) -> Vec<(String, Vec<u8>)> {
    files(sandbox)
        .into_iter()
        .map(|name| {
            let bytes = read(&sandbox.path(&format!("out/{name}")));
            (name, bytes)
        })
        .collect()
}

pub(super) fn clear(sandbox: &Sandbox) {
    fs::remove_dir_all(sandbox.path("out")).unwrap();
}

#[test]
fn views_are_images_of_their_cameras_named_after_the_files_of_the_list() {
    let sandbox = sandbox();
    let done = views(&sandbox, &["--stats", "json", "--aov", "depth"]).expect(0);
    let mut expected: Vec<String> =
        NAMES.iter().flat_map(|name| [format!("{name}.exr"), format!("{name}.png")]).collect();
    expected.sort();
    assert_eq!(files(&sandbox), expected);
    assert!(done.stderr.contains("5 views rendered"), "{}", done.stderr);
    assert!(done.stderr.contains("\"../up/r_3.png\" leads out of the output folder; the image is up/r_3"));
    let exposure = exr(&sandbox, NAMES[0]).metadata().number("png_exposure");
    for (number, name) in (1..).zip(NAMES) {
        let metadata = exr(&sandbox, name).metadata();
        assert_eq!((metadata.number("frame"), metadata.text("view")), (Some(f64::from(number)), Some(name)));
        assert!(exposure.is_some() && metadata.number("png_exposure") == exposure);
        assert!(exr(&sandbox, name).layer("depth.Z").is_ok());
    }
    // Records of a view light the next one.
    let stats: Vec<serde_json::Value> =
        done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let new = |i: usize| stats[i]["counters"]["Walk"]["new records"].as_u64().unwrap();
    assert!(stats.len() == 5 && new(0) > 3 * new(4), "{} {}", new(0), new(4));
    assert!(stats[0]["counters"]["VPLs"].is_object() && stats[1]["counters"]["VPLs"].is_null());
    // The camera is that of the scene in the same place.
    sandbox.run(&["render", "path.toml", "-o", "b.exr", "--spp", "1", "--set", "vpls=100"]).expect(0);
    let still = ExrFile::read(&sandbox.path("b.exr")).unwrap();
    let [a, b] = [exr(&sandbox, NAMES[0]).camera().unwrap(), still.camera().unwrap()];
    assert!(a.world_to_ndc.iter().zip(&b.world_to_ndc).all(|(a, b)| (a - b).abs() < 1e-5), "{a:?} {b:?}");
}

#[test]
fn lists_in_toml_have_films_of_their_own_and_views_may_be_exposed_each() {
    let sandbox = sandbox();
    let camera = |name: &str, height: f64, more: &str| {
        format!("[[camera]]\nname = \"{name}\"\norigin = [0, {height}, 6]\ntarget = [0, 0.5, 0]\n{more}\n")
    };
    let list = [camera("a.1", 3.0, "resolution = [40, 20]"), camera("b", 0.2, "fov = 20")].concat();
    fs::write(sandbox.path("list.toml"), list).unwrap();
    let run = |more: &[&str]| {
        let base = ["views", "path.toml", "list.toml", "-o", "out", "--method", "path", "--spp", "1"];
        sandbox.run(&[&base, more].concat())
    };
    run(&["--exposure-per-view"]).expect(0);
    assert_eq!(files(&sandbox), ["a.1.exr", "a.1.png", "b.exr", "b.png"]);
    let size = |name| {
        let image = colour(&sandbox, name);
        [image.width, image.height]
    };
    assert_eq!([size("a.1"), size("b")], [[40, 20], [96, 64]]);
    let exposure = |name| exr(&sandbox, name).metadata().number("png_exposure").unwrap();
    assert!((exposure("a.1") - exposure("b")).abs() > 0.1);
    run(&["--resolution", "50%"]).expect(0);
    assert_eq!([size("a.1"), size("b")], [[20, 10], [48, 32]]);
    assert_eq!(exposure("a.1"), exposure("b"));
    assert!(run(&["--exposure-per-view", "--exposure", "1"]).expect(2).stderr.contains("--exposure"));
}

#[test]
fn reproducible_views_do_not_depend_on_the_views_before_them() {
    let sandbox = sandbox();
    for light in [&[][..], &["--env", "sky"]] {
        views(&sandbox, &[&["--reproducible"], light].concat()).expect(0);
        let whole = bytes(&sandbox);
        assert!(whole.len() == 10);
        clear(&sandbox);
        for only in ["5", "2-3"] {
            views(&sandbox, &[&["--reproducible", "--only", only], light].concat()).expect(0);
        }
        let some = bytes(&sandbox);
        assert!(some.len() == 6 && some.iter().all(|file| whole.contains(file)), "{light:?}");
        clear(&sandbox);
    }
}

#[test]
fn the_order_of_views_changes_their_noise_and_not_their_mean() {
    let sandbox = sandbox();
    let means = |views_in_order: &[(&str, [f64; 3], [f64; 3])]| {
        fs::write(sandbox.path("cameras.json"), transforms(views_in_order)).unwrap();
        views(&sandbox, &["--no-png", "--spp", "64", "--set", "vpls=20000"]).expect(0);
        ["train/r_0", "test/r_0", "up/r_3"].map(|name| colour(&sandbox, name))
    };
    let mut order = VIEWS[..4].to_vec();
    let forwards = means(&order);
    order.reverse();
    let backwards = means(&order);
    for (a, b) in forwards.iter().zip(&backwards) {
        let [a_mean, b_mean] = [a, b].map(|image| {
            image.pixels.iter().map(|p| f64::from(p.y)).sum::<f64>() / image.pixels.len() as f64
        });
        assert!(a != b && (a_mean / b_mean - 1.0).abs() < 0.01, "{a_mean} {b_mean}");
    }
}

#[test]
fn views_at_a_time_have_the_bits_of_views_one_after_the_other() {
    let sandbox = sandbox();
    let few = ["--set", "vpls=2000"];
    for more in [
        &["--method", "path"][..],
        &[&few[..], &["--reproducible"]].concat(),
        &[&few[..], &["--chunk", "2"]].concat(),
    ] {
        let run = |jobs: &str| {
            let base = ["views", "path.toml", "cameras.json", "-o", "out", "--no-denoise", "--spp", "4"];
            let done = sandbox.run(&[&base, &["--threads", "2", "-j", jobs][..], more].concat()).expect(0);
            assert!(done.stderr.contains("5 views rendered"), "{}", done.stderr);
            let images =
                NAMES.map(|name| (colour(&sandbox, name), read(&sandbox.path(&format!("out/{name}.png")))));
            clear(&sandbox);
            images
        };
        assert!(run("1") == run("2"), "{more:?}");
    }
}

#[test]
fn views_do_not_depend_on_threads() {
    let sandbox = sandbox();
    let colours = |threads| {
        views(&sandbox, &["--threads", threads, "--no-png", "--only", "1-3"]).expect(0);
        [0, 2].map(|i| colour(&sandbox, NAMES[i]))
    };
    let one = colours("1");
    assert!(one == colours("2") && one == colours("4"));
}

#[test]
fn resumed_views_are_those_of_an_undisturbed_run() {
    let sandbox = sandbox();
    let colours = || NAMES.map(|name| colour(&sandbox, name));
    let records = || sandbox.path("out/train/r_0.records");
    views(&sandbox, &[]).expect(0);
    assert!(!records().exists());
    let whole = colours();
    for (spoil, repeated) in [("", ""), ("absent", " (2 rendered again"), ("damaged", " (2 rendered again")] {
        clear(&sandbox);
        views(&sandbox, &["--only", "1-2"]).expect(0);
        match spoil {
            "absent" => fs::remove_file(records()).unwrap(),
            "damaged" => fs::write(records(), "torn").unwrap(),
            _ => assert!(records().exists()),
        }
        let stderr = views(&sandbox, &["--resume"]).expect(0).stderr;
        assert!(stderr.contains(&format!("3 views rendered, 2 existed already{repeated}")), "{stderr}");
        assert!(colours() == whole && !records().exists(), "{spoil}");
    }
    let stderr = views(&sandbox, &["--resume"]).expect(0).stderr;
    assert!(stderr.contains("0 views rendered, 5 existed already"), "{stderr}");
    // Another camera of the list changes exposure and shared lights.
    let moved = transforms(&VIEWS).replace("5.2", "5.25");
    fs::write(sandbox.path("cameras.json"), moved).unwrap();
    let stderr = views(&sandbox, &["--resume"]).expect(0).stderr;
    assert!(stderr.contains("5 views rendered"), "{stderr}");
}

#[test]
fn chunks_have_the_same_views_in_whichever_runs_and_order() {
    let sandbox = sandbox();
    views(&sandbox, &["--chunk", "2"]).expect(0);
    let whole = NAMES.map(|name| colour(&sandbox, name));
    clear(&sandbox);
    for only in ["5", "3-4", "1-2"] {
        views(&sandbox, &["--chunk", "2", "--only", only]).expect(0);
    }
    assert!(NAMES.map(|name| colour(&sandbox, name)) == whole);
    assert!(files(&sandbox).iter().all(|name| !name.ends_with(".records")));
}

#[cfg(unix)]
mod signals {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    /// Starts slow views, sends the signal as view 3 begins; returns the exit code.
    fn stopped(sandbox: &Sandbox, signal: &str) -> Option<i32> {
        let mut child = sandbox
            .command(&arguments(&["--progress", "ndjson", "--spp", "120"]))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
        let mut events = lines.by_ref().map(|line| serde_json::from_str::<serde_json::Value>(&line).unwrap());
        assert!(events.any(|e| e["event"] == "frame" && e["state"] == "start" && e["frame"] == 3));
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        lines.for_each(drop);
        child.wait().unwrap().code()
    }

    #[test]
    fn whatever_stops_views_leaves_whole_ones_and_resuming_does_the_rest() {
        let sandbox = sandbox();
        views(&sandbox, &["--spp", "120"]).expect(0);
        let whole = NAMES.map(|name| colour(&sandbox, name));
        for (signal, code) in [("-KILL", None), ("-INT", Some(75))] {
            clear(&sandbox);
            assert_eq!(stopped(&sandbox, signal), code, "{signal}");
            let there = files(&sandbox);
            assert!(
                (4..10).contains(&there.iter().filter(|name| !name.ends_with(".records")).count()),
                "{there:?}"
            );
            let kept = read(&sandbox.path("out/train/r_0.exr"));
            views(&sandbox, &["--resume", "--spp", "120"]).expect(0);
            assert!(files(&sandbox).len() == 10 && read(&sandbox.path("out/train/r_0.exr")) == kept);
            assert!(NAMES.map(|name| colour(&sandbox, name)) == whole, "{signal}");
        }
    }

    /// Kills: a few, or as many as LIGHTSPLAT_KILLS says.
    #[test]
    fn kills_at_random_moments_leave_whole_files_and_the_views_of_an_undisturbed_run() {
        let kills: u32 = std::env::var("LIGHTSPLAT_KILLS").map_or(4, |kills| kills.parse().unwrap());
        let sandbox = sandbox();
        let begun = std::time::Instant::now();
        views(&sandbox, &["--resume"]).expect(0);
        let span = begun.elapsed();
        let whole = NAMES.map(|name| colour(&sandbox, name));
        clear(&sandbox);
        let (mut random, mut killed) = (1u64, 0);
        while killed < kills {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let mut child = sandbox.command(&arguments(&["--resume"])).stderr(Stdio::null()).spawn().unwrap();
            std::thread::sleep(span.mul_f64((random >> 40) as f64 / f64::from(1 << 24)));
            child.kill().unwrap();
            let was_killed = child.wait().unwrap().code().is_none();
            killed += u32::from(was_killed);
            for (name, expected) in NAMES.iter().zip(&whole) {
                let path = sandbox.path(&format!("out/{name}.exr"));
                assert!(
                    !path.exists() || ExrFile::read(&path).unwrap().color().unwrap() == *expected,
                    "{name}"
                );
            }
            if !was_killed || killed == kills {
                views(&sandbox, &["--resume"]).expect(0);
                assert!(NAMES.map(|name| colour(&sandbox, name)) == whole, "after {killed} kills");
                clear(&sandbox);
            }
        }
    }
}

#[test]
fn batches_list_chunks_of_views_and_render_any_of_them() {
    let sandbox = sandbox();
    let job = "options = { method = 'path', spp = 1 }\n[[picture]]\nscene = 'path.toml'\noutput = 'out'\nviews = 'cameras.json'\n\
        chunk = 2\n[[picture]]\nscene = 'path.toml'\noutput = 'still.exr'\n";
    fs::write(sandbox.path("job.toml"), job).unwrap();
    let list = sandbox.run(&["batch", "job.toml", "--list"]).expect(0).stdout;
    let lines: Vec<&str> = list.lines().collect();
    assert!(
        lines.len() == 4 && lines[2] == "3\tpath.toml\tout\tviews 5-5" && !lines[3].contains("views"),
        "{list}"
    );
    let planned = sandbox.run(&["batch", "job.toml", "--dry-run"]).expect(0);
    assert!(planned.stdout.contains("file\tout/train/r_0_2.png\n") && planned.stdout.contains("96x64"));
    assert!(!sandbox.path("out").exists());
    sandbox.run(&["batch", "job.toml", "--only", "2"]).expect(0);
    assert_eq!(files(&sandbox), ["test/r_0.exr", "test/r_0.png", "up/r_3.exr", "up/r_3.png"]);
    let done = sandbox.run(&["batch", "job.toml", "--resume"]).expect(0).stderr;
    assert!(
        done.contains("0 views rendered, 2 existed already") && sandbox.path("still.exr").exists(),
        "{done}"
    );
    assert_eq!(files(&sandbox).len(), 10);
    // Two entries may share a folder, and no file.
    let twice = job.replace("output = 'still.exr'", "output = 'out'\nviews = 'cameras.json'\nonly = '4'");
    fs::write(sandbox.path("job.toml"), twice).unwrap();
    assert!(sandbox.run(&["batch", "job.toml"]).expect(2).stderr.contains("same file"));
    for (views, expected) in
        [("'absent.json'", "cannot read"), ("3", "`views` cannot be 3"), ("'path.toml'", "write [[camera]]")]
    {
        let job = format!("[[picture]]\nscene = 'path.toml'\noutput = 'o'\nviews = {views}\nchunk = 2\n");
        fs::write(sandbox.path("job.toml"), job).unwrap();
        let failed = sandbox.run(&["batch", "job.toml"]);
        assert!(failed.code != Some(0) && failed.stderr.contains(expected), "{views}: {}", failed.stderr);
    }
}

#[test]
fn a_wrong_camera_is_left_out_and_the_other_views_keep_their_numbers() {
    let sandbox = sandbox();
    let mut list: serde_json::Value = serde_json::from_str(&transforms(&VIEWS)).unwrap();
    list["frames"][1]["transform_matrix"][0][3] = "BAD".into();
    fs::write(sandbox.path("cameras.json"), list.to_string().replace("\"BAD\"", "-Infinity")).unwrap();
    let run = |more: &[&str]| {
        let base = ["views", "path.toml", "cameras.json", "-o", "out", "--method", "path", "--spp", "1"];
        sandbox.run(&[&base, more].concat())
    };
    let stderr = run(&[]).expect(0).stderr;
    assert!(
        stderr.contains("frame 2 (\"./train/r_1.png\"): the transform_matrix holds -Infinity"),
        "{stderr}"
    );
    assert!(stderr.contains("4 views rendered") && files(&sandbox).len() == 8, "{stderr}");
    assert_eq!(exr(&sandbox, "test/r_0").metadata().number("frame"), Some(3.0));
    clear(&sandbox);
    run(&["--only", "2-3"]).expect(0);
    assert_eq!(files(&sandbox), ["test/r_0.exr", "test/r_0.png"]);
    clear(&sandbox);
    assert!(run(&["--strict"]).expect(3).stderr.contains("frame 2"));
    assert!(run(&["--only", "6"]).expect(2).stderr.contains("no view 6"));
}

#[test]
fn wrong_lists_and_options_are_errors_and_nothing_is_written() {
    let sandbox = sandbox();
    let error = |more: &[&str], code| views(&sandbox, more).expect(code).stderr;
    let beyond = error(&["--only", "4-6"], 2);
    assert!(beyond.contains("no view 6") && beyond.contains("cameras.json has 5 cameras"), "{beyond}");
    assert!(error(&["--only", "0"], 2).contains("count from 1"));
    assert!(error(&["--chunk", "0"], 2).contains("1 or more"));
    assert!(error(&["--crop", "90,0,10,10"], 2).contains("view 1: --crop must lie within"));
    let lensed = transforms(&VIEWS).replacen('{', "{ \"k1\": 0.1,", 1);
    fs::write(sandbox.path("cameras.json"), lensed).unwrap();
    assert!(error(&["--strict"], 3).contains("`k1` is not supported"));
    assert!(error(&["--only", "1", "--dry-run"], 0).contains("the image has no distortion"));
    fs::write(sandbox.path("cameras.json"), "{ \"frames\": [{}] }").unwrap();
    assert!(error(&[], 3).contains("frame 1: there is no valid transform_matrix"));
    let absent = sandbox.run(&["views", "path.toml", "none.json", "-o", "out"]).expect(3).stderr;
    assert!(absent.contains("cannot read none.json"), "{absent}");
    fs::write(sandbox.path("cameras.json"), transforms(&VIEWS)).unwrap();
    let nowhere =
        sandbox.run(&["views", "path.toml", "cameras.json", "-o", "none/none/out"]).expect(4).stderr;
    assert!(nowhere.contains("does not exist"), "{nowhere}");
    let left: Vec<PathBuf> = files(&sandbox).into_iter().map(PathBuf::from).collect();
    assert!(left.is_empty(), "{left:?}");
}
