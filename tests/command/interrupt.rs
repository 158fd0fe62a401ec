//! Signals: the first one ends the render with a partial picture, which can go on; SIGKILL leaves the former file.
#![cfg(target_os = "linux")]

use super::random_interrupts::wait_for;
use super::{Sandbox, read};
use lightsplat::film::ExrFile;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::process::{Child, Command, Stdio};

/// O_NONBLOCK.
const NONBLOCK: i32 = 0o4000;

/// Starts a render that would take very long; returns once its first pixels are done.
fn begun(sandbox: &Sandbox) -> Child {
    begun_by(sandbox, &Sandbox::path_tracing("100000000", &[]))
}

/// Starts a render with any arguments; returns once its first pixels are done.
pub(super) fn begun_by(sandbox: &Sandbox, arguments: &[&str]) -> Child {
    let mut child = sandbox
        .command(&[arguments, &["--progress", "ndjson"]].concat())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let begun = lines.any(|line| {
        let event: serde_json::Value = serde_json::from_str(&line.unwrap()).unwrap();
        event["event"] == "progress" && event["done"].as_u64() > Some(0)
    });
    assert!(begun);
    // The pipe must be read on, or the child would find it closed.
    std::thread::spawn(move || lines.for_each(drop));
    child
}

pub(super) fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

#[test]
fn interrupted_renders_end_with_75_and_leave_a_picture_marked_as_partial() {
    for name in ["-INT", "-TERM"] {
        let sandbox = Sandbox::new();
        let mut child = begun(&sandbox);
        signal(&child, name);
        assert_eq!(child.wait().unwrap().code(), Some(75), "{name}");
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        assert_eq!(file.metadata().text("partial"), Some("true"));
        assert!(file.color().unwrap().pixels.iter().any(|p| p.x > 0.0));
        assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
    }
}

#[test]
fn signals_that_are_ignored_when_the_program_starts_stay_ignored() {
    for name in ["HUP", "INT", "TERM", "USR1"] {
        let sandbox = Sandbox::new();
        let mut command = Command::new("sh");
        command.args([
            "-c",
            &format!("trap '' {name}; exec \"$0\" \"$@\""),
            env!("CARGO_BIN_EXE_lightsplat"),
        ]);
        command.args(Sandbox::path_tracing("500", &["--resolution", "48x32", "--progress", "ndjson"]));
        command.current_dir(sandbox.folder.path()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
        assert!(lines.any(|line| line.contains(r#""event":"progress""#)));
        signal(&child, &format!("-{name}"));
        lines.for_each(drop);
        assert_eq!(child.wait().unwrap().code(), Some(0), "{name}");
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        assert_eq!(file.metadata().text("partial"), Some("false"));
        assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
    }
}

/// Interrupts a render; false if it ended before.
fn interrupted(sandbox: &Sandbox, arguments: &[&str]) -> bool {
    let mut child = begun_by(sandbox, arguments);
    signal(&child, "-INT");
    let code = child.wait().unwrap().code();
    assert!(matches!(code, Some(0 | 75)), "{code:?}");
    code == Some(75)
}

/// Interrupts a new render, and `times - 1` times more where it goes on; tries anew where it ends before.
fn interrupted_often(sandbox: &Sandbox, arguments: &[&str], times: u32) {
    let tried = (0..50).any(|_| {
        let _ = std::fs::remove_file(sandbox.path("a.exr"));
        (0..times).all(|_| interrupted(sandbox, arguments))
    });
    assert!(tried, "the render always ended before the signal");
}

#[test]
fn interrupted_paths_go_on_to_the_bytes_of_an_undisturbed_render() {
    let sandbox = Sandbox::new();
    let arguments = Sandbox::path_tracing("1000", &["--reproducible", "--resume", "--aov", "depth"]);
    sandbox.run(&arguments).expect(0);
    let files = || [read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))];
    let whole = files();
    for times in [1, 2] {
        interrupted_often(&sandbox, &arguments, times);
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        assert_eq!(file.metadata().text("partial"), Some("true"));
        assert!(file.numbers("samples").unwrap().pixels.iter().any(|n| *n > 0 && *n < 1000));
        assert_eq!(file.metadata().number("nonfinite"), Some(0.0));
    }
    let stderr = sandbox.run(&arguments).expect(0).stderr;
    assert!(stderr.contains("continuing with the samples") && files() == whole, "{stderr}");
    // Other settings make another picture.
    interrupted_often(&sandbox, &arguments, 1);
    let stderr = sandbox.run(&Sandbox::path_tracing("16", &["--resume", "--seed", "1"])).expect(0).stderr;
    assert!(!stderr.contains("continuing"), "{stderr}");
}

#[test]
fn interrupted_paths_are_merged_by_the_samples_of_each_pixel() {
    let sandbox = Sandbox::new();
    let mut child = begun(&sandbox);
    signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(75));
    let whole = |name, spp, seed| {
        let common = ["render", "room.xml", "--method", "path", "-o", name, "--spp", spp, "--seed", seed];
        sandbox.run(&common).expect(0);
        ExrFile::read(&sandbox.path(name)).unwrap()
    };
    let (a, b) = (ExrFile::read(&sandbox.path("a.exr")).unwrap(), whole("b.exr", "48", "5"));
    let merge = |inputs: [&str; 2]| {
        sandbox.run(&["merge", inputs[0], inputs[1], "-o", "m.exr"]).expect(0);
        ExrFile::read(&sandbox.path("m.exr")).unwrap()
    };
    let merged = merge(["a.exr", "b.exr"]);
    let samples = a.numbers("samples").unwrap().pixels;
    let images = [&a, &b, &merged].map(|file| file.color().unwrap().pixels);
    let variances = [&a, &b, &merged].map(|file| file.layer("variance").unwrap().pixels);
    for (i, n) in samples.iter().enumerate() {
        let share = *n as f32 / (*n + 48) as f32;
        for ([a, b, m], [of_a, of_b]) in [
            (images.each_ref().map(|image| image[i]), [share, 1.0 - share]),
            (variances.each_ref().map(|image| image[i]), [share * share, (1.0 - share) * (1.0 - share)]),
        ] {
            let expected = a * of_a + b * of_b;
            assert!(
                (m - expected).abs().max_element() <= 1e-5 * expected.max_element(),
                "{m} for {expected}"
            );
        }
    }
    assert_eq!(merged.metadata().text("partial"), Some("false"));
    let mean = samples.iter().map(|n| f64::from(*n)).sum::<f64>() / samples.len() as f64 + 48.0;
    assert!((merged.metadata().number("spp").unwrap() - mean).abs() < 1e-6 * mean);
    // The samples of a merged picture count on.
    std::fs::rename(sandbox.path("m.exr"), sandbox.path("ab.exr")).unwrap();
    whole("c.exr", "16", "6");
    let all = merge(["ab.exr", "c.exr"]);
    let counts = |file: &ExrFile| file.numbers("samples").map(|numbers| numbers.pixels);
    let expected = |more: u32| samples.iter().map(|n| n + more).collect::<Vec<_>>();
    let is_even = samples.iter().all(|n| *n == samples[0]);
    assert_eq!(counts(&merged), (!is_even).then(|| expected(48)));
    assert_eq!(counts(&all), (!is_even).then(|| expected(64)));
}

#[test]
fn a_part_of_a_picture_does_not_replace_a_whole_one() {
    let sandbox = Sandbox::new();
    sandbox.render("a.exr", &[]).expect(0);
    let before = (read(&sandbox.path("a.exr")), read(&sandbox.path("a.png")));
    for _ in 0..2 {
        let mut child = begun(&sandbox);
        signal(&child, "-INT");
        assert_eq!(child.wait().unwrap().code(), Some(75));
        assert!((read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))) == before);
        let file = ExrFile::read(&sandbox.path("a.partial.exr")).unwrap();
        assert_eq!(file.metadata().text("partial"), Some("true"));
        assert_eq!(sandbox.files(), ["a.exr", "a.partial.exr", "a.partial.png", "a.png", "room.xml"]);
    }
}

#[test]
fn a_part_beside_a_whole_picture_is_gone_on_from_and_goes_when_it_is_whole() {
    let sandbox = Sandbox::new();
    let arguments = Sandbox::path_tracing("1000", &["--resume"]);
    let is_interrupted = (0..50).any(|_| {
        sandbox.render("a.exr", &[]).expect(0);
        interrupted(&sandbox, &arguments)
    });
    assert!(is_interrupted && sandbox.path("a.partial.exr").exists());
    let stderr = sandbox.run(&arguments).expect(0).stderr;
    assert!(stderr.contains("continuing with the samples of a.partial.exr"), "{stderr}");
    assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
    assert_eq!(ExrFile::read(&sandbox.path("a.exr")).unwrap().metadata().number("spp"), Some(1000.0));
}

#[test]
fn plans_that_are_interrupted_say_so_and_write_nothing() {
    let sandbox = Sandbox::new();
    let arguments = ["render", "room.xml", "-o", "a.exr", "--error", "0.0001%", "--progress", "ndjson"];
    let mut child =
        sandbox.command(&arguments).args(["--method", "path"]).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains(r#""stage":"plan""#)));
    signal(&child, "-INT");
    assert!(lines.any(|line| line.contains("interrupted while planning; nothing is written")));
    lines.for_each(drop);
    assert_eq!(child.wait().unwrap().code(), Some(75));
    assert_eq!(sandbox.files(), ["room.xml"]);
}

#[test]
fn a_killed_render_leaves_the_old_files_whole() {
    let sandbox = Sandbox::new();
    sandbox.render("a.exr", &[]).expect(0);
    let before = (read(&sandbox.path("a.exr")), read(&sandbox.path("a.png")));
    let mut child = begun(&sandbox);
    signal(&child, "-KILL");
    assert_eq!(child.wait().unwrap().code(), None);
    assert_eq!((read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))), before);
}

/// Kills at random moments: a few, or as many as LIGHTSPLAT_KILLS says; half of them in the last tenth of a run, when
/// files are written.
#[test]
fn kills_at_random_moments_leave_the_old_files_or_the_new_ones_and_nothing_in_the_end() {
    let kills: u32 = std::env::var("LIGHTSPLAT_KILLS").map_or(6, |kills| kills.parse().unwrap());
    let sandbox = Sandbox::new();
    let render = |seed| {
        let more =
            ["--reproducible", "--resolution", "256x256", "--aov", "albedo,normal,position", "--seed", seed];
        Sandbox::path_tracing("2", &more).into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let bytes = || [read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))];
    let run = |arguments: &[String]| {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        sandbox.command(&arguments).stderr(Stdio::null()).spawn().unwrap()
    };
    let [old, new] = ["1", "2"].map(render);
    let begun = std::time::Instant::now();
    assert!(run(&new).wait().unwrap().success());
    let span = begun.elapsed();
    let after = bytes();
    assert!(run(&old).wait().unwrap().success());
    let before = bytes();
    assert!(before != after);
    let mut random = 1u64;
    let (mut killed, mut left) = (0, 0);
    while killed < kills {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let share = (random >> 40) as f64 / f64::from(1 << 24);
        let mut child = run(&new);
        std::thread::sleep(span.mul_f64(if killed % 2 == 0 { share } else { 0.9 + 0.1 * share }));
        child.kill().unwrap();
        killed += u32::from(child.wait().unwrap().code().is_none());
        for (i, bytes) in bytes().iter().enumerate() {
            assert!(*bytes == before[i] || *bytes == after[i], "{i} after {killed} kills");
        }
        left += sandbox.files().len() - 3;
        assert!(run(&old).wait().unwrap().success());
        assert!(bytes() == before);
        assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"], "after {killed} kills");
    }
    println!("{kills} kills left {left} temporary files");
}

#[test]
fn a_signal_while_a_scene_is_read_ends_the_run_at_once() {
    let sandbox = Sandbox::new();
    // Seconds to read and to build over.
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned() + &"f 1 2 3\n".repeat(4_000_000);
    std::fs::write(sandbox.path("a.obj"), mesh).unwrap();
    std::fs::write(sandbox.path("a.toml"), "[[mesh]]\nfile = \"a.obj\"\n").unwrap();
    for name in ["-INT", "-TERM"] {
        let mut command = sandbox.command(&["render", "a.toml", "-o", "b.exr", "--progress", "none"]);
        let child = command.stderr(Stdio::piped()).spawn().unwrap();
        wait_for(&child, 0.1);
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(75), "{name}: {stderr}");
        assert_eq!(stderr, "error: interrupted while reading the scene; nothing is written\n");
    }
    assert!(!sandbox.path("b.exr").exists());
}

#[test]
fn a_second_signal_ends_the_run_at_once() {
    let sandbox = Sandbox::new();
    // Nobody reads the statistics, and the pipe for them is full already.
    assert!(Command::new("mkfifo").arg(sandbox.path("full")).status().unwrap().success());
    let mut pipe =
        File::options().read(true).write(true).custom_flags(NONBLOCK).open(sandbox.path("full")).unwrap();
    while pipe.write(&[0; 4096]).is_ok() {}
    let stdout = File::options().write(true).open(sandbox.path("full")).unwrap();
    let arguments = Sandbox::path_tracing("1", &["--stats", "json", "--progress", "ndjson"]);
    let mut child = sandbox.command(&arguments).stdout(stdout).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains(r#""event":"wrote""#)));
    signal(&child, "-INT");
    assert!(lines.any(|line| line.contains("again to stop at once")));
    signal(&child, "-INT");
    assert!(lines.any(|line| line.contains(r#""event":"end","exit":130"#)));
    assert_eq!(child.wait().unwrap().code(), Some(130));
    drop(pipe);
    assert_eq!(sandbox.files(), ["a.exr", "a.png", "full", "room.xml"]);
}
