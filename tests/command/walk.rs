//! Walks: frames whole, left out or done anew, kills in the middle, wrong ranges.

use super::{Finished, Sandbox, read};
use lightsplat::film::ExrFile;
use std::fs;

/// A floor under a lamp, and a path of six frames past it.
pub(super) const PATH: &str = r#"
resolution = [96, 64]
[camera]
origin = [0, 3, 6]
target = [0, 0.5, 0]
fov = 50
[camera.path]
keys = [
    { frame = 1, origin = [0, 3, 6], target = [0, 0.5, 0] },
    { frame = 6, origin = [1, 3, 5], target = [0, 0.5, 0] },
]
[[material]]
name = "grey"
kind = "diffuse"
reflectance = [0.6, 0.5, 0.4]
[[mesh]]
shape = "rectangle"
material = "grey"
transform = [{ rotate = { axis = [1, 0, 0], angle = -90 } }, { scale = 3 }]
[[mesh]]
shape = "rectangle"
material = "grey"
emission = [5, 5, 5]
transform = [{ rotate = { axis = [1, 0, 0], angle = 90 } }, { translate = [0, 2, 0] }]
"#;

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::with("path.toml", PATH);
    fs::create_dir(sandbox.path("f")).unwrap();
    sandbox
}

fn arguments<'a>(frames: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let base = ["walk", "path.toml", "-o", "f/a.##.exr", "--set", "vpls=2000", "--no-denoise"];
    [&base, &["--frames", frames][..], more].concat()
}

/// Renders frames fast.
fn walk(sandbox: &Sandbox, frames: &str, more: &[&str]) -> Finished {
    sandbox.run(&arguments(frames, &[more, &["--spp", "4"]].concat()))
}

/// Names of the files of the frames, without their records and leftovers of kills.
fn frames(sandbox: &Sandbox) -> Vec<String> {
    let entries = fs::read_dir(sandbox.path("f")).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> =
        names.filter(|name| name.ends_with(".exr") || name.ends_with(".png")).collect();
    names.sort();
    names
}

#[test]
fn frames_are_whole_pictures_of_one_exposure_each_by_its_own_camera() {
    let sandbox = sandbox();
    let done = walk(&sandbox, "1-3,6", &["--stats", "json", "--aov", "depth"]).expect(0);
    let names = ["01", "02", "03", "06"].map(|n| [format!("a.{n}.exr"), format!("a.{n}.png")]).concat();
    assert_eq!(frames(&sandbox), names);
    assert!(done.stderr.contains("4 frames rendered"), "{}", done.stderr);
    let files = [1, 2, 3, 6].map(|n| (n, ExrFile::read(&sandbox.path(&format!("f/a.{n:02}.exr"))).unwrap()));
    for (number, file) in &files {
        let metadata = file.metadata();
        assert_eq!(
            (metadata.number("frame"), metadata.text("partial")),
            (Some(f64::from(*number)), Some("false"))
        );
        assert_eq!(metadata.number("png_exposure"), files[0].1.metadata().number("png_exposure"));
        assert!(file.camera() != files[0].1.camera() || *number == 1);
    }
    let stats: Vec<serde_json::Value> =
        done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(stats.iter().map(|s| s["frame"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2, 3, 6]);
    let count = |stats: &serde_json::Value, name| stats["counters"]["Walk"][name].as_u64().unwrap();
    assert!(count(&stats[0], "new records") > 4 * count(&stats[3], "new records"));
    assert!(count(&stats[3], "records kept") >= count(&stats[0], "new records"));
    // The exposure typed is the exposure taken, and the same frame alone by `render` has the same camera.
    walk(&sandbox, "1", &["--exposure", "-1.5"]).expect(0);
    let file = ExrFile::read(&sandbox.path("f/a.01.exr")).unwrap();
    assert_eq!(file.metadata().number("png_exposure"), Some(-1.5));
    sandbox
        .run(&["render", "path.toml", "-o", "b.exr", "--frame", "6", "--spp", "1", "--set", "vpls=100"])
        .expect(0);
    assert_eq!(ExrFile::read(&sandbox.path("b.exr")).unwrap().camera(), files[3].1.camera());
}

#[test]
fn single_frames_stand_in_the_place_for_the_number_with_all_their_files() {
    let sandbox = sandbox();
    let render = |more: &[&str]| {
        let base =
            ["render", "path.toml", "-o", "f/s.###.exr", "--method", "path", "--spp", "1", "--no-denoise"];
        sandbox.run(&[&base, more].concat())
    };
    render(&["--frame", "6"]).expect(0);
    assert_eq!(frames(&sandbox), ["s.006.exr", "s.006.png"]);
    let again = render(&["--frame", "6", "--resume"]).expect(0).stderr;
    assert!(again.contains("s.006.exr already exists"), "{again}");
    render(&["--frame", "2", "--png", "f/shown.%02d.png"]).expect(0);
    assert_eq!(frames(&sandbox), ["s.002.exr", "s.006.exr", "s.006.png", "shown.02.png"]);
    // A walk renders the same files, and a name with a place needs a number.
    sandbox
        .run(&["walk", "path.toml", "-o", "f/s.###.exr", "--frames", "6", "--spp", "1", "--set", "vpls=99"])
        .expect(0);
    assert_eq!(frames(&sandbox).len(), 4);
    let refused = render(&[]).expect(2).stderr;
    assert!(refused.contains("--frame N"), "{refused}");
    let job =
        "[[picture]]\nscene = 'path.toml'\noutput = 'f/b.##.exr'\nframe = 1\nmethod = 'path'\nspp = 1\n";
    fs::write(sandbox.path("job.toml"), [job, &job.replace("frame = 1", "frame = 3")].concat()).unwrap();
    sandbox.run(&["batch", "job.toml"]).expect(0);
    assert_eq!(frames(&sandbox)[..4], ["b.01.exr", "b.01.png", "b.03.exr", "b.03.png"]);
    fs::write(sandbox.path("job.toml"), job.repeat(2)).unwrap();
    assert!(sandbox.run(&["batch", "job.toml"]).expect(2).stderr.contains("same file"));
}

#[test]
fn stages_are_told_once_a_frame_and_the_fraction_ends_at_one() {
    let sandbox = sandbox();
    let stderr = walk(&sandbox, "1-3", &["--progress", "ndjson"]).expect(0).stderr;
    let events: Vec<serde_json::Value> =
        stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |kind: &str| events.iter().filter(|e| e["event"] == kind).cloned().collect::<Vec<_>>();
    let mut stages: Vec<String> =
        of("stage").iter().map(|e| format!("{} {}", e["frame"], e["stage"])).collect();
    let count = stages.len();
    stages.sort();
    stages.dedup();
    assert!(count > 6 && stages.len() == count, "{stages:?}");
    let fractions: Vec<f64> = of("progress").iter().map(|e| e["fraction"].as_f64().unwrap()).collect();
    let (last, before) = fractions.split_last().unwrap();
    assert!(*last == 1.0 && before.iter().all(|f| *f < 1.0) && before.is_sorted(), "{fractions:?}");
}

#[test]
fn resuming_leaves_whole_frames_alone_and_does_others_anew() {
    let sandbox = sandbox();
    walk(&sandbox, "1-5", &[]).expect(0);
    let file = |name: &str| sandbox.path(&format!("f/{name}"));
    let whole = read(&file("a.03.exr"));
    fs::write(file("a.02.exr"), &whole[..whole.len() / 2]).unwrap();
    fs::write(file("a.03.exr"), read(&file("a.01.exr"))).unwrap();
    fs::write(file("a.04.png"), "torn").unwrap();
    let kept = read(&file("a.05.exr"));
    let stderr = walk(&sandbox, "1-6", &["--resume"]).expect(0).stderr;
    assert!(stderr.contains("4 frames rendered, 2 existed already (1 rendered again"), "{stderr}");
    assert_eq!(read(&file("a.05.exr")), kept);
    for (number, name) in (1..=6).map(|n| (f64::from(n), format!("a.{n:02}.exr"))) {
        assert_eq!(ExrFile::read(&file(&name)).unwrap().metadata().number("frame"), Some(number));
    }
    let stderr = walk(&sandbox, "1-6", &["--resume"]).expect(0).stderr;
    assert!(stderr.contains("0 frames rendered, 6 existed already"), "{stderr}");
    // Other settings, or another scene, make other frames.
    let stderr = walk(&sandbox, "1-2", &["--resume", "--seed", "7"]).expect(0).stderr;
    assert!(stderr.contains("2 frames rendered"), "{stderr}");
    fs::write(sandbox.path("path.toml"), PATH.replace("[5, 5, 5]", "[6, 5, 5]")).unwrap();
    let stderr = walk(&sandbox, "3", &["--resume"]).expect(0).stderr;
    assert!(stderr.contains("1 frames rendered"), "{stderr}");
}

#[test]
fn an_open_method_is_chosen_once_for_the_whole_path() {
    let sandbox = sandbox();
    let open = |frames: &str, more: &[&str]| {
        let base = ["walk", "path.toml", "-o", "f/a.##.exr", "--resolution", "48x32", "--frames", frames];
        sandbox.run(&[&base, more].concat()).expect(0).stderr
    };
    let chosen = |stderr: &str| -> Vec<String> {
        stderr.lines().filter(|line| line.starts_with("Method: ")).map(str::to_owned).collect()
    };
    let first = open("1-3", &[]);
    let choice = chosen(&first);
    if first.contains("not denoised") {
        return eprintln!("skipped: no denoiser");
    }
    assert!(choice.len() == 1, "{first}");
    let image = |n: u32| ExrFile::read(&sandbox.path(&format!("f/a.{n:02}.exr"))).unwrap().color().unwrap();
    let whole = image(3);
    let resumed = open("1-4", &["--resume"]);
    assert!(chosen(&resumed) == choice && resumed.contains("1 frames rendered, 3 existed"), "{resumed}");
    fs::remove_file(sandbox.path("f/a.03.exr")).unwrap();
    assert!(chosen(&open("1-4", &["--resume"])) == choice && image(3) == whole);
}

#[test]
fn frames_do_not_depend_on_threads() {
    let sandbox = sandbox();
    let colours = |threads| {
        walk(&sandbox, "1-3", &["--threads", threads, "--no-png"]).expect(0);
        ["f/a.01.exr", "f/a.03.exr"].map(|name| ExrFile::read(&sandbox.path(name)).unwrap().color().unwrap())
    };
    assert_eq!(colours("1"), colours("3"));
}

#[test]
fn wrong_names_ranges_and_scenes_are_errors_and_nothing_is_written() {
    let sandbox = sandbox();
    let error = |frames: &str, more: &[&str], code| walk(&sandbox, frames, more).expect(code).stderr;
    assert!(error("0-4", &[], 2).contains("count from 1"));
    assert!(error("4-2", &[], 2).contains("contains no frame"));
    assert!(error("a", &[], 2).contains("1-100x5"));
    let beyond = error("5-7", &[], 2);
    assert!(beyond.contains("no frame 7") && beyond.contains("has 6"), "{beyond}");
    assert!(error("1", &["--set", "memory-limit=much"], 2).contains("512M"));
    assert!(error("1", &["--set", "memory-limit=-1M"], 2).contains("512M"));
    for chunk in ["0", "-1", "x"] {
        assert!(error("1", &["--chunk", chunk], 2).contains("expected a whole number, 1 or more"));
    }
    assert!(error("1", &["--set", "q-scale=-1"], 2).contains("from 0.01 to 1000"));
    assert!(error("1", &["--set", "denoise-quality=fast"], 2).contains("needs --denoise"));
    assert!(error("1", &["--camera", "2"], 2).contains("no camera \"2\""));
    sandbox.run(&["info", "path.toml", "--camera", "1"]).expect(0);
    assert!(error("1", &["--time", "3s"], 2).contains("--time"));
    let named = |name: &str| sandbox.run(&["walk", "path.toml", "-o", name, "--frames", "1"]);
    assert!(named("f/a.exr").expect(2).stderr.contains("####"));
    assert!(named("none/none/a.#.exr").expect(4).stderr.contains("does not exist"));
    let pathless = sandbox.run(&["walk", "room.xml", "-o", "f/a.#.exr"]).expect(2).stderr;
    assert!(pathless.contains("no camera path") && pathless.contains("[camera.path]"), "{pathless}");
    assert_eq!(frames(&sandbox), [""; 0]);
}

/// Bytes of all files in the folder of the frames, by name.
fn bytes(sandbox: &Sandbox) -> Vec<(String, Vec<u8>)> {
    frames(sandbox)
        .into_iter()
        .map(|name| (name.clone(), read(&sandbox.path(&format!("f/{name}")))))
        .collect()
}

#[test]
fn a_resumed_walk_has_the_bytes_of_an_undisturbed_one_whatever_is_there() {
    let sandbox = sandbox();
    let records = || sandbox.path("f/a.01.records").exists();
    walk(&sandbox, "1-6", &["--reproducible"]).expect(0);
    let whole = bytes(&sandbox);
    assert!(whole.len() == 12 && !records());
    let empty = || {
        fs::remove_dir_all(sandbox.path("f")).unwrap();
        fs::create_dir(sandbox.path("f")).unwrap();
    };
    let resume = || walk(&sandbox, "1-6", &["--reproducible", "--resume"]).expect(0).stderr;
    // Frames by a former run, with its records, without them, and with damaged ones.
    for (spoil, repeated) in [("", ""), ("absent", " (3 rendered again"), ("damaged", " (3 rendered again")] {
        empty();
        walk(&sandbox, "1-3", &["--reproducible"]).expect(0);
        assert!(records() && bytes(&sandbox) == whole[..6]);
        match spoil {
            "absent" => fs::remove_file(sandbox.path("f/a.01.records")).unwrap(),
            "damaged" => fs::write(sandbox.path("f/a.01.records"), "torn").unwrap(),
            _ => {}
        }
        let stderr = resume();
        assert!(stderr.contains(&format!("3 frames rendered, 3 existed already{repeated}")), "{stderr}");
        assert!(bytes(&sandbox) == whole && !records(), "{spoil}");
    }
    // Frames of a walk that began elsewhere are others.
    empty();
    walk(&sandbox, "3-6", &["--reproducible"]).expect(0);
    assert!(bytes(&sandbox)[0] != whole[4]);
    let stderr = resume();
    assert!(stderr.contains("6 frames rendered") && bytes(&sandbox) == whole, "{stderr}");
}

#[test]
fn chunks_have_the_same_bytes_in_whichever_runs_and_order() {
    let sandbox = sandbox();
    let chunks = |frames: &str| walk(&sandbox, frames, &["--chunk", "2", "--reproducible"]).expect(0);
    chunks("1-6");
    let whole = bytes(&sandbox);
    walk(&sandbox, "1-6", &["--reproducible"]).expect(0);
    assert!(bytes(&sandbox)[..4] == whole[..4] && bytes(&sandbox)[4] != whole[4]);
    fs::remove_dir_all(sandbox.path("f")).unwrap();
    fs::create_dir(sandbox.path("f")).unwrap();
    for frames in ["5-6", "1-2", "3-4"] {
        chunks(frames);
    }
    assert!(bytes(&sandbox) == whole);
    // Other methods have nothing that lives on.
    let paths = |frames: &str, more: &[&str]| {
        let common = ["--method", "path", "--reproducible", "--spp", "1", "--frames", frames];
        sandbox.run(&[&["walk", "path.toml", "-o", "f/a.##.exr"], &common[..], more].concat()).expect(0)
    };
    paths("1-6", &[]);
    let whole = bytes(&sandbox);
    paths("3", &["--seed", "1"]);
    let stderr = paths("1-6", &["--resume"]).stderr;
    assert!(stderr.contains("1 frames rendered, 5 existed already,") && bytes(&sandbox) == whole, "{stderr}");
}

#[cfg(unix)]
mod signals {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    /// Starts a walk of slow frames, sends the signal as frame 3 begins; returns the exit code.
    fn stopped(sandbox: &Sandbox, signal: &str) -> Option<i32> {
        let mut child = sandbox
            .command(&arguments("1-6", &["--progress", "ndjson", "--spp", "120"]))
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
    fn whatever_stops_a_walk_leaves_whole_frames_and_resuming_does_the_rest() {
        for (signal, code) in [("-KILL", None), ("-INT", Some(75)), ("-TERM", Some(75))] {
            let sandbox = sandbox();
            assert_eq!(stopped(&sandbox, signal), code, "{signal}");
            let there = frames(&sandbox);
            assert!(there.len() >= 4 && there.len() < 12, "{there:?}");
            for name in there.iter().filter(|name| name.ends_with(".exr")) {
                let file = ExrFile::read(&sandbox.path(&format!("f/{name}"))).unwrap();
                assert_eq!(file.metadata().text("partial"), Some("false"));
            }
            let kept = read(&sandbox.path("f/a.01.exr"));
            sandbox.run(&arguments("1-6", &["--resume", "--spp", "120"])).expect(0);
            assert_eq!(frames(&sandbox).len(), 12);
            assert_eq!(read(&sandbox.path("f/a.01.exr")), kept);
        }
    }

    /// On a disk in memory, which needs a namespace in which this user may mount one.
    #[test]
    fn a_disk_that_fills_up_leaves_whole_frames_and_resuming_does_the_rest() {
        let sandbox = sandbox();
        walk(&sandbox, "1-6", &["--reproducible"]).expect(0);
        let whole = bytes(&sandbox);
        fs::remove_dir_all(sandbox.path("f")).unwrap();
        fs::create_dir(sandbox.path("f")).unwrap();
        let kilobytes = whole.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() / 1024;
        // All that was written leaves the disk before its namespace ends.
        let script = format!(
            "mkdir disk && mount -t tmpfs -o size={}k none disk || exit 99; cd disk; mkdir f; cp ../path.toml .
            \"$0\" \"$@\"; code=$?; cp f/* ../f; exit $code",
            kilobytes * 2 / 3
        );
        let output = Command::new("unshare")
            .args(["--user", "--map-root-user", "--mount", "sh", "-c", &script])
            .arg(env!("CARGO_BIN_EXE_lightsplat"))
            .args(arguments("1-6", &["--reproducible", "--spp", "4"]))
            .current_dir(sandbox.folder.path())
            .output();
        let Ok(run) = output.map(Finished::from) else { return eprintln!("skipped: no unshare") };
        if run.code == Some(99) || run.stderr.starts_with("unshare:") {
            return eprintln!("skipped: no disk in memory for this user: {}", run.stderr);
        }
        let stderr = run.expect(4).stderr;
        assert!(
            stderr.contains("No space left") && stderr.contains("an existing file is unchanged"),
            "{stderr}"
        );
        let there = bytes(&sandbox);
        assert!(there.len() >= 5 && there.len() < 12, "{:?}", frames(&sandbox));
        assert!(there.iter().all(|file| whole.contains(file)));
        walk(&sandbox, "1-6", &["--reproducible", "--resume"]).expect(0);
        assert!(bytes(&sandbox) == whole);
    }

    /// Kills: a few, or as many as LIGHTSPLAT_KILLS says.
    #[test]
    fn kills_at_random_moments_leave_whole_files_and_the_bytes_of_an_undisturbed_walk() {
        let kills: u32 = std::env::var("LIGHTSPLAT_KILLS").map_or(6, |kills| kills.parse().unwrap());
        let sandbox = sandbox();
        let arguments = arguments("1-6", &["--chunk", "4", "--spp", "4", "--reproducible", "--resume"]);
        let begun = std::time::Instant::now();
        sandbox.run(&arguments).expect(0);
        let span = begun.elapsed();
        let whole = bytes(&sandbox);
        let mut random = 1u64;
        let mut killed = 0;
        while killed < kills {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let mut child = sandbox.command(&arguments).stderr(Stdio::null()).spawn().unwrap();
            std::thread::sleep(span.mul_f64((random >> 40) as f64 / f64::from(1 << 24)));
            child.kill().unwrap();
            let was_killed = child.wait().unwrap().code().is_none();
            killed += u32::from(was_killed);
            for (name, bytes) in bytes(&sandbox) {
                let same = whole.iter().find(|(known, _)| *known == name);
                assert!(same.is_some_and(|(_, whole)| *whole == bytes), "{name} after {killed} kills");
            }
            if !was_killed || killed == kills {
                sandbox.run(&arguments).expect(0);
                assert!(bytes(&sandbox) == whole, "after {killed} kills");
                fs::remove_dir_all(sandbox.path("f")).unwrap();
                fs::create_dir(sandbox.path("f")).unwrap();
            }
        }
    }
}
