//! Benchmarks run on any scene and write the files asked for; no test depends on their figures.

use super::Sandbox;
use std::fs;

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

#[test]
fn every_benchmark_runs_and_exports() {
    let sandbox = Sandbox::new();
    let room = Some("room.xml");
    let of_scenes = ["shadow", "bounds", "budget"].map(|name| (name, room));
    for (name, scene) in of_scenes.into_iter().chain([("bsdf", None), ("hsh", None)]) {
        let mut arguments = vec!["bench", name];
        arguments.extend(scene);
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
fn the_cache_changes_no_answer_in_the_benchmark_either() {
    let sandbox = Sandbox::new();
    let arguments =
        ["bench", "shadow", "room.xml", "--repeats", "1", "--seconds", "0", "--export-json", "a.json"];
    sandbox.run(&arguments).expect(0);
    let text = std::fs::read_to_string(sandbox.path("a.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let tables = report["tables"].as_array().unwrap();
    let table = tables.iter().find(|t| t["figures"][1] == "answers changed").unwrap();
    assert!(table["rows"].as_array().unwrap().iter().all(|row| row["figures"][1] == 0.0));
}

#[test]
fn scenes_are_asked_for_where_they_are_needed_and_nowhere_else() {
    let sandbox = Sandbox::new();
    assert!(sandbox.run(&["bench", "shadow"]).expect(2).stderr.contains("scene"));
    assert!(sandbox.run(&["bench", "bsdf", "room.xml"]).expect(2).stderr.contains("scene"));
    sandbox.run(&["bench", "luck"]).expect(2);
    assert!(sandbox.run(&["bench"]).expect(0).stdout.contains("shadow SCENE"));
    sandbox.run(&["bench", "bsdf", "--repeats", "0"]).expect(2);
    sandbox.run(&["bench", "bsdf", "--export-json", "missing/a.json"]).expect(4);
    assert!(sandbox.run(&["bench", "--help"]).expect(0).stdout.contains("shadow SCENE"));
}

#[test]
fn the_study_of_growth_tells_time_by_pixels_and_error_by_lamps() {
    let sandbox = Sandbox::new();
    let common = ["bench", "growth", "cornell", "--scenes", SCENES, "-o", "out", "--resolution", "16x16"];
    let found = sandbox.run(&[&common[..], &["--knob", "width"]].concat()).expect(2);
    assert!(found.stderr.contains("pixels, lamps, triangles"), "{}", found.stderr);
    let knobs = ["--knob", "pixels", "--knob", "lamps", "--knob", "threads", "--reference-spp", "256"];
    sandbox.run(&[&common[..], &knobs].concat()).expect(0);
    let read = |file: &str| fs::read_to_string(sandbox.path(file)).unwrap();
    assert!(read("out/growth.md").contains("## Lamps") && read("out/Lamps-of-a-plaza.svg").contains("<svg"));
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
fn the_study_of_extremes_finds_the_same_error_at_any_brightness_of_the_light() {
    let sandbox = Sandbox::new();
    let common = ["bench", "extremes", "--repeats", "1", "--reference-spp", "8", "--resolution", "8x8"];
    let of = |more: &[&str]| sandbox.run(&[&common, more].concat());
    assert!(of(&["--knob", "luck"]).expect(2).stderr.contains("scale, offset, power"));
    assert!(of(&["room.xml"]).expect(2).stderr.contains("leave the scene out"));
    of(&["--knob", "power", "-o", "out"]).expect(0);
    let read = |file: &str| std::fs::read_to_string(sandbox.path(file)).unwrap();
    assert!(read("out/extremes.md").contains("## power") && read("out/power.svg").contains("<svg"));
    let json: serde_json::Value = serde_json::from_str(&read("out/extremes.json")).unwrap();
    let points = json["series"][0]["points"].as_array().unwrap();
    let middle = points.iter().find(|point| point["value"] == 1.0).unwrap();
    assert!(points.len() == 11 && middle["figures"].as_array().unwrap().len() >= 7);
    for point in points {
        let pairs = point["figures"].as_array().unwrap().iter().zip(middle["figures"].as_array().unwrap());
        for (figures, middle) in pairs {
            let [error, ordinary] = [figures, middle].map(|f| f["error"].as_f64().unwrap());
            assert!(error <= 1.1 * ordinary && figures["nonfinite"] == 0, "{point}");
        }
    }
}

#[test]
fn the_calibration_writes_the_prices_that_images_tell() {
    let sandbox = Sandbox::new();
    let scenes = ["cornell", "--scenes", SCENES, "-o", "out", "--resolution", "24x24", "--threads", "2"];
    sandbox.run(&[&["bench", "calibrate"], &scenes[..], &["--reference-spp", "16"]].concat()).expect(0);
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
