//! Benchmarks run on any scene and write the files asked for; no test depends on their figures.

use super::Sandbox;
use super::walk::PATH;
use std::fs;

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

#[test]
fn every_benchmark_runs_and_exports() {
    let sandbox = Sandbox::new();
    for name in ["shadow", "budget"] {
        let mut arguments = vec!["bench", name, "room.xml"];
        arguments.extend(["--repeats", "2", "--seconds", "0", "--threads", "2"]);
        arguments.extend(["--export-json", "a.json", "--export-markdown", "a.md"]);
        let stdout = sandbox.run(&arguments).expect(0).stdout;
        let read = |file: &str| std::fs::read_to_string(sandbox.path(file)).unwrap();
        let report: serde_json::Value = serde_json::from_str(&read("a.json")).unwrap();
        assert_eq!(report["benchmark"], name);
        assert_names_machine(&report["facts"], &[&stdout, &read("a.md")]);
        let rows = report["tables"].as_array().unwrap().iter().flat_map(|t| t["rows"].as_array().unwrap());
        let mut cases = 0;
        for row in rows {
            assert_eq!(row["samples"].as_array().unwrap().len(), 2);
            assert!(row["rate"]["median"].as_f64().unwrap() > 0.0, "{row}");
            cases += 1;
        }
        assert!(cases > 3, "{stdout}");
        let changed =
            report["tables"].as_array().unwrap().iter().find(|t| t["figures"][1] == "answers changed");
        assert_eq!(changed.is_some(), name == "shadow");
        for row in changed.into_iter().flat_map(|table| table["rows"].as_array().unwrap()) {
            assert_eq!(row["figures"][1], 0.0, "the cache changes no answer in the benchmark either");
        }
        assert!(read("a.md").starts_with(&format!("# {name}")) && read("a.md") == stdout);
    }
}

/// Asserts that a report's facts name machine and program, and that its texts hold them.
pub fn assert_names_machine(facts: &serde_json::Value, texts: &[&str]) {
    let facts = facts.as_array().unwrap();
    for name in
        ["version", "compiler", "compiled for", "Embree", "processor", "threads", "load at the start", "date"]
    {
        let fact = facts.iter().find(|fact| fact[0] == name).unwrap_or_else(|| panic!("{name}: {facts:?}"));
        let value = fact[1].as_str().unwrap();
        assert!(
            !value.is_empty() && texts.iter().all(|text| text.contains(value)),
            "{name} {value}: {texts:?}"
        );
    }
}

#[test]
fn scenes_are_asked_for_where_they_are_needed_and_nowhere_else() {
    let sandbox = Sandbox::new();
    assert!(sandbox.run(&["bench", "shadow"]).expect(2).stderr.contains("scene"));
    assert!(sandbox.run(&["bench", "shadow", "a.xml", "b.xml"]).expect(2).stderr.contains("one scene"));
    sandbox.run(&["bench", "luck"]).expect(2);
    assert!(sandbox.run(&["bench"]).expect(0).stdout.contains("shadow SCENE"));
    sandbox.run(&["bench", "shadow", "room.xml", "--repeats", "0"]).expect(2);
    sandbox.run(&["bench", "shadow", "room.xml", "--export-json", "missing/a.json"]).expect(4);
    assert!(sandbox.run(&["bench", "--help"]).expect(0).stdout.contains("shadow SCENE"));
}

#[test]
fn the_study_of_growth_tells_time_by_pixels_and_error_by_lamps() {
    // Scenes with indirect light take a second for virtual lights in each image.
    let sandbox = Sandbox::with("direct.toml", &format!("max_depth = 2\n{PATH}"));
    let common = ["bench", "growth", "direct.toml", "-o", "out", "--resolution", "16x16"];
    let found = sandbox.run(&[&common[..], &["--knob", "width"]].concat()).expect(2);
    assert!(found.stderr.contains("pixels, lamps, triangles"), "{}", found.stderr);
    let knobs = ["--knob", "pixels", "--knob", "lamps", "--knob", "threads", "--reference-spp", "256"];
    sandbox.run(&[&common[..], &knobs].concat()).expect(0);
    let read = |file: &str| fs::read_to_string(sandbox.path(file)).unwrap();
    assert!(read("out/growth.md").contains("## Lamps"));
    let json: serde_json::Value = serde_json::from_str(&read("out/growth.json")).unwrap();
    let values = |series: usize, key: &str| -> Vec<f64> {
        let points = json["series"][series]["points"].as_array().unwrap();
        points.iter().map(|point| point[key].as_f64().unwrap()).collect()
    };
    assert_eq!(values(0, "value"), [16.0, 64.0, 256.0, 1024.0, 4096.0]);
    assert_eq!(values(1, "value"), [10.0, 100.0, 1000.0, 10_000.0]);
    // Thousands of lamps in a film of 16x16 are seen by most pixels, whose errors exceed their means.
    let errors = values(1, "error");
    assert!(
        errors.iter().all(|error| *error > 0.0) && errors[..2].iter().all(|error| *error < 1.0),
        "{errors:?}"
    );
    assert_eq!([&json["threads"][0]["threads"], &json["threads"][0]["speed_up"]], [1.0, 1.0]);
    assert!(values(0, "whole").iter().zip(values(0, "eye_pass")).all(|(whole, part)| *whole > part));
}

#[test]
fn the_calibration_writes_the_prices_that_images_tell() {
    let sandbox = Sandbox::new();
    let scenes = ["cornell", "--scenes", SCENES, "-o", "out", "--resolution", "24x24", "--threads", "2"];
    // The finer levels take most of the time.
    let levels = ["--knob", "level 1", "--knob", "draft", "--reference-spp", "16"];
    sandbox.run(&[&["bench", "calibrate"], &scenes[..], &levels].concat()).expect(0);
    let read = |file: &str| fs::read_to_string(sandbox.path(file)).unwrap();
    let json: serde_json::Value = serde_json::from_str(&read("out/calibrate.json")).unwrap();
    let names: Vec<&str> =
        json["calibration"].as_array().unwrap().iter().filter_map(|p| p["name"].as_str()).collect();
    for name in ["ray", "counted_vpl", "sampled", "cached", "pilot", "indirect_rays"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let source = read("out/calibration.rs");
    assert!(source.contains("    // Factor ") && source.contains("\n    vpl_rays: 2.6,\n"), "{source}");
    assert_eq!(json["scenes"].as_array().unwrap().len(), 2);
}
