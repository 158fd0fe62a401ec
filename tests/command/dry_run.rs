//! `--dry-run`: what would be written, the errors of a real run, and no trace on the disk.

use super::{Sandbox, walk};
use std::fs;

/// Runs a command with `--dry-run`, which must change nothing, and returns its standard output.
#[track_caller]
fn dry(sandbox: &Sandbox, arguments: &[&str]) -> String {
    let before = sandbox.files();
    let finished = sandbox.run(&[arguments, &["--dry-run"]].concat()).expect(0);
    assert_eq!(sandbox.files(), before);
    finished.stdout
}

#[test]
fn dry_runs_name_files_resolution_method_and_memory() {
    let sandbox = Sandbox::with("path.toml", walk::PATH);
    let still =
        ["render", "room.xml", "-o", "new/a.exr", "--crop", "4,2,8,6", "--method", "path", "--spp", "7"];
    let text = dry(&sandbox, &still);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[..3], ["file\tnew/a.exr", "file\tnew/a.png", "resolution\t96x64, of which 8x6 at 4,2"]);
    assert_eq!(lines[3], "method\tpath, 7 samples per pixel");
    assert!(lines[4].starts_with("memory\tabout 0.00 GiB for the image") && lines.len() == 5, "{text}");
    assert!(dry(&sandbox, &["render", "room.xml"]).starts_with("file\troom.exr\nfile\troom.png\n"));
    let text = dry(&sandbox, &["walk", "path.toml", "-o", "f.##.exr", "--frames", "2..3", "--no-png"]);
    assert!(text.starts_with("file\tf.02.exr\nfile\tf.03.exr\nresolution\t"), "{text}");
    let events = sandbox.run(&["render", "room.xml", "--dry-run", "--progress", "ndjson"]).expect(0).stderr;
    let events: Vec<serde_json::Value> =
        events.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let event = events.iter().find(|event| event["event"] == "dry_run").unwrap();
    assert_eq!(event["files"], serde_json::json!(["room.exr", "room.png"]));
    assert!(event["memory_bytes"]["image"].as_u64() > Some(0));
}

#[test]
fn dry_runs_have_the_errors_of_real_runs() {
    let sandbox = Sandbox::with("path.toml", walk::PATH);
    fs::write(sandbox.path("broken.xml"), "<scene").unwrap();
    let cases: [(&[&str], i32); 7] = [
        (&["render", "room.xml", "-o", "a.exr", "--crop", "95,0,2,2"], 2),
        (&["render", "path.toml", "-o", "a.exr", "--frame", "999"], 2),
        (&["render", "broken.xml", "-o", "a.exr"], 3),
        (&["render", "none.xml", "-o", "a.exr"], 3),
        (&["render", "room.xml", "-o", "no/such/a.exr"], 4),
        (&["render", "room.xml", "-o", "a.exr", "--resolution", "16384x65536", "--spp", "4096"], 2),
        (&["walk", "room.xml", "-o", "f.##.exr"], 2),
    ];
    for (arguments, code) in cases {
        let [dry, real] =
            [&["--dry-run"][..], &[]].map(|more| sandbox.run(&[arguments, more].concat()).expect(code));
        let last =
            |text: &str| text.lines().last().unwrap_or_default().split("and ").next().unwrap().to_owned();
        assert_eq!(last(&dry.stderr), last(&real.stderr), "{arguments:?}");
        assert_eq!(dry.stdout, "");
    }
    assert_eq!(sandbox.files(), ["broken.xml", "path.toml", "room.xml"]);
}

#[test]
fn dry_batches_report_every_entry_and_what_fails() {
    let sandbox = Sandbox::new();
    let jobs = "options = { method = 'path' }\n[[picture]]\nscene = 'room.xml'\noutput = 'a.exr'\n[[picture]]\n\
                scene = 'room.xml'\noutput = 'b.exr'\nresolution = '8x4'\n";
    fs::write(sandbox.path("jobs.toml"), jobs).unwrap();
    let text = dry(&sandbox, &["batch", "jobs.toml"]);
    assert!(text.contains("file\ta.exr\n") && text.contains("file\tb.png\nresolution\t8x4\n"), "{text}");
    fs::write(sandbox.path("jobs.toml"), format!("{jobs}crop = [0, 0, 9, 9]\n")).unwrap();
    let failed = sandbox.run(&["batch", "jobs.toml", "--dry-run"]).expect(5);
    assert!(failed.stderr.contains("b.exr") && failed.stderr.contains("1 of 2"), "{}", failed.stderr);
    assert_eq!(sandbox.files(), ["jobs.toml", "room.xml"]);
}
