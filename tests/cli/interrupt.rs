//! Signals: the first one ends the render with a partial picture, SIGKILL leaves the former file.
#![cfg(unix)]

use super::{Sandbox, read};
use lightsplat::film::ExrFile;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// Starts a render that would take very long; returns once its first pixels are done.
fn begun(sandbox: &Sandbox) -> Child {
    let mut child = sandbox
        .command(&Sandbox::path_tracing("100000000", &["--progress", "ndjson"]))
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

fn signal(child: &Child, name: &str) {
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
fn a_killed_render_leaves_the_old_files_whole() {
    let sandbox = Sandbox::new();
    sandbox.render("a.exr", &[]).expect(0);
    let before = (read(&sandbox.path("a.exr")), read(&sandbox.path("a.png")));
    let mut child = begun(&sandbox);
    signal(&child, "-KILL");
    assert_eq!(child.wait().unwrap().code(), None);
    assert_eq!((read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))), before);
}

#[test]
fn a_second_signal_ends_the_run_at_once() {
    let sandbox = Sandbox::new();
    // Reading this scene never ends, and is not asked whether it should.
    assert!(Command::new("mkfifo").arg(sandbox.path("pipe.xml")).status().unwrap().success());
    let arguments = ["render", "pipe.xml", "-o", "a.exr", "--progress", "ndjson"];
    let mut child = sandbox.command(&arguments).stderr(Stdio::piped()).spawn().unwrap();
    let pipe = std::fs::File::options().write(true).open(sandbox.path("pipe.xml")).unwrap();
    signal(&child, "-INT");
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains("once more to stop at once")));
    signal(&child, "-INT");
    assert!(lines.any(|line| line.contains(r#""event":"end","exit":130"#)));
    assert_eq!(child.wait().unwrap().code(), Some(130));
    drop(pipe);
    assert_eq!(sandbox.files(), ["pipe.xml", "room.xml"]);
}
