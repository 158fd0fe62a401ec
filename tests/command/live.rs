//! Previews: files that show what is rendered so far.
#![cfg(target_os = "linux")]

use super::interrupt::{begun_by, signal};
use super::{Sandbox, read};
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread;
use std::time::Duration;

/// Samples of a render that would take hours.
const ENDLESS: &str = "100000000";

fn start(sandbox: &Sandbox, arguments: &[&str]) -> Child {
    sandbox.command(arguments).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until a file exists while a run goes on.
fn wait_for(path: &Path, child: &mut Child) {
    while !path.exists() {
        assert_eq!(child.try_wait().unwrap(), None, "the run ended without {}", path.display());
        thread::sleep(Duration::from_millis(10));
    }
}

/// Stops a run; returns its messages.
fn stopped(child: Child) -> String {
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(75), "{stderr}");
    stderr
}

/// Returns the pixels of a PNG file of the room's size.
fn pixels(path: &Path) -> Vec<u8> {
    let image = image::open(path).unwrap().into_rgb8();
    assert_eq!(image.dimensions(), (96, 64));
    image.into_raw()
}

#[test]
fn previews_change_no_bit_and_the_last_one_is_the_image() {
    let sandbox = Sandbox::new();
    let base = Sandbox::path_tracing("64", &["--reproducible", "--exposure", "1"]);
    let files = || [read(&sandbox.path("a.exr")), read(&sandbox.path("a.png"))];
    sandbox.run(&base).expect(0);
    let plain = files();
    let stderr = sandbox
        .run(&[&base[..], &["--preview", "new/p.png", "--set", "every=10ms"]].concat())
        .expect(0)
        .stderr;
    assert!(files() == plain && read(&sandbox.path("new/p.png")) == plain[1], "{stderr}");
    assert!(!stderr.contains("warning"), "{stderr}");
}

#[test]
fn previews_are_whole_images_while_the_render_goes_on() {
    let sandbox = Sandbox::new();
    let preview = ["--preview", "p.png", "--set", "every=50ms", "--view", "agx"];
    let mut child = start(&sandbox, &Sandbox::path_tracing(ENDLESS, &preview));
    let file = sandbox.path("p.png");
    wait_for(&file, &mut child);
    let first = pixels(&file);
    assert!(first.iter().any(|value| *value > 100), "{first:?}");
    // A later one replaces it.
    while pixels(&file) == first {
        assert_eq!(child.try_wait().unwrap(), None);
        thread::sleep(Duration::from_millis(10));
    }
    stopped(child);
    assert_eq!(sandbox.files(), ["a.exr", "a.png", "p.png", "room.xml"]);
    assert_eq!(pixels(&file), pixels(&sandbox.path("a.png")));
}

#[test]
fn a_signal_asks_for_a_preview_beside_the_image() {
    let sandbox = Sandbox::new();
    let mut child = begun_by(&sandbox, &Sandbox::path_tracing(ENDLESS, &[]));
    let file = sandbox.path("a.preview.png");
    for _ in 0..2 {
        signal(&child, "-USR1");
        wait_for(&file, &mut child);
        assert!(pixels(&file).iter().any(|value| *value > 100));
        fs::remove_file(&file).unwrap();
    }
    stopped(child);
    assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
}

#[test]
fn a_preview_that_cannot_be_written_is_one_warning() {
    let sandbox = Sandbox::new();
    let preview = ["--preview", "live/p.png", "--set", "every=20ms"];
    let mut child = start(&sandbox, &Sandbox::path_tracing(ENDLESS, &preview));
    wait_for(&sandbox.path("live/p.png"), &mut child);
    // The run may write a file while the folder goes.
    while fs::remove_dir_all(sandbox.path("live")).is_err() {}
    thread::sleep(Duration::from_millis(500));
    let stderr = stopped(child);
    assert_eq!(stderr.matches("rendering goes on without this preview").count(), 1, "{stderr}");
    assert_eq!(sandbox.files(), ["a.exr", "a.png", "room.xml"]);
}

#[test]
fn wrong_previews_are_refused_before_rendering() {
    let sandbox = Sandbox::new();
    for (more, code, why) in [
        (&["--preview", "p.jpg"][..], 2, "must end in .png"),
        (&["--preview", "a.png"], 2, "two results"),
        (&["--preview", "no/such/p.png"], 4, "does not exist"),
        (&["--preview", "p.png", "--set", "every=0s"], 2, "a time like"),
        (&["--set", "every=1s"], 2, "--preview"),
        (&["--tev=14158"], 2, "host and port"),
    ] {
        let stderr = sandbox.render("a.exr", more).expect(code).stderr;
        assert!(stderr.contains(why), "{more:?}: {stderr}");
    }
    assert_eq!(sandbox.files(), ["room.xml"]);
}
