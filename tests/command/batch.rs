//! Batches: pictures and walks of several scenes in one call, what fails, and going on after a stop.

use super::{Finished, Sandbox, read, walk};
use lightsplat::film::ExrFile;
use std::fs;

const JOBS: &str = r#"
options = { method = "path", spp = 4, resolution = "24x16" }

[[picture]]
scene = "room.xml"
output = "out/room.exr"

[[picture]]
scene = "path.toml"
output = "out/walk.##.exr"
frames = "1-2"

[[picture]]
scene = "broken.xml"
output = "out/broken.exr"

[[picture]]
scene = "room.xml"
output = "out/crop.exr"
crop = [4, 2, 8, 8]
png = "out/preview.png"

[[picture]]
scene = "room.xml"
output = "nowhere/deep/a.exr"
"#;

fn sandbox(jobs: &str) -> Sandbox {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path("out")).unwrap();
    fs::write(sandbox.path("broken.xml"), "<scene").unwrap();
    fs::write(sandbox.path("path.toml"), walk::PATH).unwrap();
    fs::write(sandbox.path("jobs.toml"), jobs).unwrap();
    sandbox
}

fn batch(sandbox: &Sandbox, more: &[&str]) -> Finished {
    sandbox.run(&[&["batch", "jobs.toml"], more].concat())
}

#[test]
fn what_fails_does_not_stop_the_others_and_the_exit_code_says_so() {
    let sandbox = sandbox(JOBS);
    let stderr = batch(&sandbox, &["--progress", "ndjson"]).expect(5).stderr;
    let events: Vec<serde_json::Value> =
        stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |kind: &str| events.iter().filter(|e| e["event"] == kind).cloned().collect::<Vec<_>>();
    let errors: Vec<String> = of("error").iter().map(|e| e["text"].to_string()).collect();
    assert!(errors.len() == 3, "{errors:?}");
    // The unwritable file is known before anything is rendered.
    assert!(
        errors[0].contains("nowhere") && errors[1].contains("broken.xml") && errors[2].contains("2 of 5")
    );
    let place = |kind: &str| events.iter().position(|e| e["event"] == kind).unwrap();
    assert!(place("error") < place("picture"));
    let fractions: Vec<f64> = of("progress").iter().map(|e| e["fraction"].as_f64().unwrap()).collect();
    assert!(fractions.is_sorted() && fractions.last() > Some(&0.5), "{fractions:?}");
    let summary = &of("summary")[1];
    assert_eq!((&summary["done"], &summary["failed"]), (&3.into(), &2.into()));
    assert_eq!(events.last().unwrap()["exit"], 5);
    let mut files: Vec<_> =
        fs::read_dir(sandbox.path("out")).unwrap().map(|e| e.unwrap().file_name()).collect();
    files.sort();
    let walk = ["walk.01.exr", "walk.01.png", "walk.02.exr", "walk.02.png"];
    assert_eq!(files, [&["crop.exr", "preview.png", "room.exr", "room.png"], &walk[..]].concat());
    let crop = ExrFile::read(&sandbox.path("out/crop.exr")).unwrap().window();
    assert_eq!((crop.offset, crop.width), ([4, 2], 8));
    // `render` gives an equal image.
    sandbox.render("alone.exr", &[]).expect(0);
    let color = |name: &str| ExrFile::read(&sandbox.path(name)).unwrap().color().unwrap();
    assert_eq!(color("out/room.exr"), color("alone.exr"));
    // Entries at a time are equal, too.
    fs::rename(sandbox.path("out"), sandbox.path("before")).unwrap();
    fs::create_dir(sandbox.path("out")).unwrap();
    batch(&sandbox, &["-j", "3", "--threads", "2"]).expect(5);
    for name in ["room", "crop", "walk.01", "walk.02"] {
        assert_eq!(color(&format!("out/{name}.exr")), color(&format!("before/{name}.exr")), "{name}");
    }
}

#[test]
fn scenes_are_read_once_and_resuming_renders_what_lacks() {
    let jobs = "options = { method = 'path', spp = 1, camera = '3' }\n".to_owned()
        + &["a", "b", "c"]
            .map(|n| format!("[[picture]]\nscene = 'room.xml'\noutput = 'out/{n}.exr'\n"))
            .concat();
    // Reading warns of what is not supported, once for each time that it is done.
    let sandbox = sandbox(&jobs.replace(", camera = '3'", ""));
    let scene = super::ROOM.replace("type=\"diffuse\"", "type=\"roughdielectric\"");
    fs::write(sandbox.path("room.xml"), scene).unwrap();
    let stderr = batch(&sandbox, &[]).expect(0).stderr;
    assert_eq!(
        stderr.matches("\"reflectance\" of bsdf \"roughdielectric\" is not supported").count(),
        1,
        "{stderr}"
    );
    assert!(stderr.contains("3 of 3 images, walks and views done"), "{stderr}");
    let kept = ["a", "c"].map(|n| read(&sandbox.path(&format!("out/{n}.exr"))));
    fs::remove_file(sandbox.path("out/b.exr")).unwrap();
    let stderr = batch(&sandbox, &["--resume"]).expect(0).stderr;
    assert_eq!(stderr.matches("already exists and is unchanged").count(), 2, "{stderr}");
    assert!(["a", "c"].map(|n| read(&sandbox.path(&format!("out/{n}.exr")))) == kept);
    assert!(sandbox.path("out/b.exr").exists());
    // A camera that is not there.
    fs::write(sandbox.path("jobs.toml"), jobs).unwrap();
    assert!(batch(&sandbox, &[]).expect(5).stderr.contains("0 of 3 images"));
}

#[test]
fn wrong_job_files_are_errors_before_anything_is_rendered() {
    for (jobs, code, part) in [
        ("[[picture]]\nscene = 'room.xml'", 3, "output"),
        ("picture = 3", 3, "line 1"),
        (&format!("{JOBS}spq = 3"), 2, "--spq"),
        (&format!("{JOBS}progress = 'none'"), 2, "lightsplat batch --progress"),
    ] {
        let sandbox = sandbox(jobs);
        let stderr = batch(&sandbox, &[]).expect(code).stderr;
        assert!(stderr.contains(part) && stderr.contains("jobs.toml"), "{stderr}");
        assert_eq!(fs::read_dir(sandbox.path("out")).unwrap().count(), 0);
    }
    // A lone one that fails has no others; its options are found wrong with the line in the file.
    let lone = sandbox("[[picture]]\nscene = 'room.xml'\noutput = 'a.exr'\nmethod = 'path'\nvpls = 9\n");
    let stderr = batch(&lone, &[]).expect(5).stderr;
    assert!(
        stderr.contains("jobs.toml, line 3: a.exr: --set vpls") && !stderr.contains("others"),
        "{stderr}"
    );
    let sandbox = Sandbox::new();
    assert!(batch(&sandbox, &[]).expect(3).stderr.contains("cannot read jobs.toml"));
}

#[test]
fn two_entries_that_would_write_one_file_are_refused_with_their_lines() {
    let head = "options = { method = 'path', spp = 1, resolution = '8x8' }\n";
    let entry = |output: &str, frames: &str| {
        let scene = if output.contains('#') { "path.toml" } else { "room.xml" };
        format!("[[picture]]\nscene = '{scene}'\noutput = '{output}'\n{frames}\n")
    };
    let jobs = |entries: [(&str, &str); 2]| {
        head.to_owned() + &entries.map(|(output, frames)| entry(output, frames)).concat()
    };
    for entries in [
        [("a.exr", ""), ("out/../a.exr", "")],
        [("w.##.exr", "frames = '1-3'"), ("w.##.exr", "frames = '3-4'")],
        [("w.##.exr", "frames = '4'"), ("w.##.exr", "")],
        [("w.##.exr", "frames = '1'"), ("w.01.exr", "")],
    ] {
        let sandbox = sandbox(&jobs(entries));
        let stderr = batch(&sandbox, &[]).expect(2).stderr;
        assert!(stderr.contains("line 4") && stderr.contains("line 8"), "{stderr}");
    }
    let apart = [("w.##.exr", "frames = '1'"), ("w.##.exr", "frames = '2'")];
    batch(&sandbox(&jobs(apart)), &[]).expect(0);
}

#[test]
fn entries_are_listed_and_chosen_by_their_numbers() {
    let sandbox = sandbox(JOBS);
    let listed = batch(&sandbox, &["--list"]).expect(0).stdout;
    let lines: Vec<&str> = listed.lines().collect();
    assert_eq!(lines.len(), 5);
    assert_eq!(lines[3], "4\troom.xml\tout/crop.exr");
    batch(&sandbox, &["--only", "4"]).expect(0);
    let mut files: Vec<_> =
        fs::read_dir(sandbox.path("out")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["crop.exr", "preview.png"]);
    let stderr = batch(&sandbox, &["--only", "2,6"]).expect(2).stderr;
    assert!(stderr.contains("no entry 6") && stderr.contains("have 5"), "{stderr}");
}
