//! Studies render missing pictures, store them, and write the same results in two formats.

use super::bench::assert_names_machine;
use super::{Finished, Sandbox};
use serde_json::Value;
use std::fs;
use std::path::Path;

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

/// Returns the messages that say that a picture was rendered.
fn rendered(stderr: &str) -> Vec<&str> {
    stderr.lines().filter(|line| line.ends_with(" s")).collect()
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Returns a report without its paragraph on the machine, whose load changes from run to run.
fn without_machine(report: &str) -> &str {
    report.split_once("## Machine and settings").unwrap().0
}

/// The table of some scenes, first of them `path.toml`, in a sandbox.
fn table(sandbox: &Sandbox, scenes: &[&str], reference_spp: &str) -> Finished {
    // The room with a path as long as the walk of the table. Its light is direct, but photons would take seconds.
    let path = super::walk::PATH.replace("frame = 6", "frame = 24");
    fs::write(sandbox.path("path.toml"), format!("max_depth = 2\n{path}")).unwrap();
    let common = ["--scenes", SCENES, "-o", "study", "--resolution", "32x32", "--threads", "2"];
    let reference = ["--reference-spp", reference_spp];
    sandbox.run(&[&["bench", "table1"], scenes, &common[..], &reference].concat()).expect(0)
}

/// Asserts that the table has a row for each method, and that a second run renders nothing.
fn assert_table_covers_all_methods(sandbox: &Sandbox, names: &[&str]) {
    let run = || table(sandbox, names, "8");
    let first = run();
    let table = json(&sandbox.path("study/table1.json"));
    let scenes = table["scenes"].as_array().unwrap();
    assert_eq!(scenes.len(), names.len());
    let mut pictures = 0;
    for scene in scenes {
        assert_eq!(scene["reference"]["spp"], 8);
        assert!(scene["reference"]["standard_error"].as_f64().unwrap() > 0.0);
        let rows = scene["rows"].as_array().unwrap();
        assert_eq!(rows[0]["label"], "default");
        let labels =
            ["reconstruction", "cache, anisotropic", "cache, isotropic", "photon-cache", "lightcuts"];
        for label in [&["default"], &labels[..]].concat() {
            let row = rows.iter().find(|row| row["label"] == label).unwrap();
            assert!(row["total"].as_f64().unwrap() > 0.0 && row["main"] == true, "{row}");
            // Few paths and few samples, but the same scene: of the same brightness.
            let brightness = row["against_reference"]["brightness"].as_f64().unwrap();
            assert!((0.7..1.3).contains(&brightness), "{row}");
            let flip = row["against_lightcuts"]["flip"].as_f64();
            assert_eq!(flip.is_none(), ["default", "lightcuts"].contains(&label), "{row}");
            assert!(flip.is_none_or(|flip| flip < 0.1), "{row}");
            // An estimate of the whole pixel has no aliasing that an error of light could leave out.
            assert_eq!(row["light"] == row["against_reference"], label == "default", "{row}");
            // Without a denoiser there are no paths to compare with.
            let against_paths = &row["versus"][2];
            assert!(against_paths["at_equal_flip"].is_object() || against_paths.is_null(), "{row}");
        }
        let walk = rows.iter().find(|row| row["paper"] == "LWalk2");
        assert_eq!(walk.is_some(), scene["scene"] == scenes[0]["scene"]);
        if let Some(walk) = walk {
            let of = |what: &str| [walk, &rows[0]].map(|row| row[what].as_f64().unwrap());
            assert!(of("light_pass")[0] < 0.5 * of("light_pass")[1], "{walk}");
            let brightness = walk["against_reference"]["brightness"].as_f64().unwrap();
            assert!((0.7..1.3).contains(&brightness), "{walk}");
        }
        // Includes the two references.
        pictures += rows.len() + 2;
    }
    assert_eq!(rendered(&first.stderr).len(), pictures, "{}", first.stderr);
    assert_eq!(fs::read_to_string(sandbox.path("study/table1.md")).unwrap(), first.stdout);
    assert_names_machine(&table["facts"], &[&first.stdout]);
    // The plot comes first, and the table that fits the page before the complete one.
    let place = |what: &str| first.stdout.find(what).unwrap_or_else(|| panic!("{what}: {}", first.stdout));
    let order = ["](table1.svg)", "| paper's |", "<details>"].map(place);
    assert!(order.is_sorted(), "{order:?}");

    let again = run();
    assert_eq!(rendered(&again.stderr), [""; 0]);
    assert_eq!(without_machine(&again.stdout), without_machine(&first.stdout));
}

#[test]
fn the_table_covers_all_methods_and_renders_nothing_twice() {
    assert_table_covers_all_methods(&Sandbox::new(), &["path.toml"]);
}

#[test]
#[ignore = "a study: two scenes, lost images and longer references"]
fn the_table_renders_what_was_lost_and_adds_to_references() {
    let (sandbox, names) = (Sandbox::new(), ["path.toml", "knot"]);
    assert_table_covers_all_methods(&sandbox, &names);
    // Lost pictures are rendered again, and references grow by the missing rounds.
    let folder = sandbox.path("study/pictures");
    let lost = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let lost = lost.filter(|path| path.to_str().unwrap().contains("knot--photon-cache"));
    lost.for_each(|path| fs::remove_file(path).unwrap());
    let more = table(&sandbox, &names, "16");
    let lines = rendered(&more.stderr);
    let count = |what: &str| lines.iter().filter(|line| line.contains(what)).count();
    assert_eq!((count("reference"), count("photon-cache"), lines.len()), (4, 4, 8), "{lines:?}");
    assert_eq!(json(&sandbox.path("study/table1.json"))["scenes"][1]["reference"]["spp"], 16);
}

#[test]
fn the_trade_sweeps_knobs_and_draws_the_front() {
    let sandbox = Sandbox::new();
    let knobs = ["--knob", "epsilon", "--knob", "spp"];
    // The room has no indirect light.
    let base = [&["bench", "trade", "cornell", "--scenes", SCENES, "-o", "study"][..], &knobs].concat();
    let size = ["--resolution", "48x32", "--reference-spp", "16", "--threads", "2"];
    let run = || sandbox.run(&[&base[..], &size].concat()).expect(0);
    let first = run();
    let trade = json(&sandbox.path("study/trade.json"));
    let scene = &trade["scenes"][0];
    let points = scene["points"].as_array().unwrap();
    let sweeps = scene["sweeps"].as_array().unwrap();
    assert_eq!(sweeps.iter().map(|s| s["knob"].as_str().unwrap()).collect::<Vec<_>>(), ["spp", "epsilon"]);
    for sweep in sweeps {
        let levels = sweep["levels"].as_array().unwrap();
        assert!(levels.len() > 2, "{sweep}");
        for level in levels {
            let point = &points[level[1].as_u64().unwrap() as usize];
            assert!(point["label"].as_str().unwrap().ends_with(level[0].as_str().unwrap()), "{point}");
            let other_samples = sweep["knob"] == "spp" && level[0] != "16";
            assert_eq!(point["limit"].is_null(), other_samples, "{point}");
            assert!(point["light"].is_number() && point["whole_pixels"] == true, "{point}");
        }
    }
    let sorted = |sort: &str| points.iter().filter(|point| point["sort"] == sort).count();
    let sorts = ["default", "quality", "other"].map(sorted);
    assert_eq!(sorts, [1, 4, 3]);
    let svg = fs::read_to_string(sandbox.path("study/cornell-fronts.svg")).unwrap();
    assert!(
        svg.matches("class=\"head\"").count() == 3
            && svg.contains(">one knob turned<")
            && svg.contains(">front<")
    );

    let again = run();
    assert_eq!(rendered(&again.stderr), [""; 0]);
    assert_eq!(without_machine(&again.stdout), without_machine(&first.stdout));
    assert!(sandbox.run(&[&base[..], &["--knob", "luck"]].concat()).expect(2).stderr.contains("patch"));
}

#[test]
fn the_race_tells_times_within_those_of_its_pictures() {
    // Few edges, since virtual lights take a second in each image.
    let sandbox = Sandbox::with("direct.xml", &super::ROOM.replace("value=\"4\"", "value=\"2\""));
    let base = ["bench", "race", "direct.xml", "-o", "study", "--resolution", "24x16", "--threads", "2"];
    let run = || sandbox.run(&[&base[..], &["--reference-spp", "16"]].concat()).expect(0);
    let first = run();
    let race = json(&sandbox.path("study/race.json"));
    let scene = &race["scenes"][0];
    let points = scene["points"].as_array().unwrap();
    let denoises = points.iter().any(|point| point["is_path"] == true);
    let times = scene["times"].as_array().unwrap();
    assert_eq!(times.len(), 5);
    for times in times {
        for (method, is_path) in [("default", false), ("path", true)] {
            let of_method = points.iter().filter(|point| point["is_path"] == is_path);
            let seconds: Vec<f64> = of_method.map(|point| point["seconds"].as_f64().unwrap()).collect();
            assert_eq!(times[method].is_null(), is_path && !denoises, "{times}");
            if let Some(time) = times[method]["value"].as_f64() {
                let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
                let most = seconds.iter().copied().fold(0.0, f64::max);
                assert!((0.999 * least..=1.001 * most).contains(&time), "{times} {seconds:?}");
            }
        }
    }
    let heads = ["PSNR 35", "PSNR 40", "PSNR 45", "FLIP 0.08", "FLIP 0.05"];
    assert!(heads.iter().all(|head| first.stdout.contains(&format!(" {head} |"))), "{}", first.stdout);
    let again = run();
    assert_eq!(rendered(&again.stderr), [""; 0]);
    let tables =
        |report: &str| report.split_once(" PSNR 35 |").map(|(_, rest)| without_machine(rest).to_owned());
    assert_eq!(tables(&again.stdout), tables(&first.stdout));
    assert_chart_shows_others(&sandbox, &base);
}

/// Asserts that a race whose images are stored draws the figures of another program beside them, and names wrong files.
fn assert_chart_shows_others(sandbox: &Sandbox, base: &[&str]) {
    let line = r#"{"name": "Other <1>", "scene": "elsewhere", "seconds": 2, "flip": 0.04, "note": "Measured alone."}"#;
    fs::write(sandbox.path("others.jsonl"), line).unwrap();
    let with = |file: &str| sandbox.run(&[base, &["--reference-spp", "16", "--with", file]].concat());
    let run = with("others.jsonl").expect(0);
    assert_eq!(rendered(&run.stderr), [""; 0]);
    let svg = fs::read_to_string(sandbox.path("study/race.svg")).unwrap();
    let chart = roxmltree::Document::parse(&svg).unwrap();
    let holds =
        |text: &str| chart.descendants().any(|node| node.text().is_some_and(|found| found.contains(text)));
    for text in ["Other <1>", "lightsplat, cache", "elsewhere: FLIP", "processor seconds", "Measured alone."]
    {
        assert!(holds(text), "{text}: {svg}");
    }
    assert!(svg.contains("prefers-color-scheme:dark"), "{svg}");
    assert_eq!(json(&sandbox.path("study/race.json"))["others"][0]["flip"], 0.04);
    fs::write(sandbox.path("wrong.jsonl"), line.replace("flip", "flop")).unwrap();
    assert!(with("wrong.jsonl").expect(3).stderr.contains("wrong.jsonl:1: "));
    assert!(with("missing.jsonl").expect(3).stderr.contains("missing.jsonl"));
    let growth = sandbox.run(&["bench", "growth", "cornell", "--with", "others.jsonl"]);
    assert!(growth.expect(2).stderr.contains("bench race"));
}

#[test]
fn what_has_no_effect_or_is_not_there_is_refused() {
    let sandbox = Sandbox::new();
    assert!(
        sandbox.run(&["bench", "table1", "--export-json", "a.json"]).expect(2).stderr.contains("--output")
    );
    assert!(
        sandbox
            .run(&["bench", "shadow", "room.xml", "--reference-spp", "8"])
            .expect(2)
            .stderr
            .contains("Studies")
    );
    assert!(sandbox.run(&["bench", "table1", "nowhere"]).expect(3).stderr.contains("scenes/nowhere.toml"));
    sandbox.run(&["bench", "table1", "-o", "room.xml/below"]).expect(4);
}
