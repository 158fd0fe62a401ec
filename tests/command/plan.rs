//! `render --time` and `--error`: the goal, the plan and the result as reported; and pictures that can be
//! repeated.

use super::{Sandbox, read};
use lightsplat::film::ExrFile;

/// Renders with `--resolution` and the like, without the settings that plans choose.
fn render(sandbox: &Sandbox, name: &str, more: &[&str]) -> super::Finished {
    sandbox.run(&[&["render", "room.xml", "-o", name, "--resolution", "24x16", "--no-png"], more].concat())
}

fn plan(run: &super::Finished) -> serde_json::Value {
    let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    report["run"]["plan"].clone()
}

#[test]
fn a_time_is_planned_told_and_repeated_by_its_settings() {
    let sandbox = Sandbox::new();
    for method in ["reconstruction", "cache", "lightcuts", "path"] {
        let options = ["--method", method, "--time", "300ms", "--seed", "3", "--stats", "json"];
        let run = render(&sandbox, "a.exr", &options).expect(0);
        let plan = plan(&run);
        assert_eq!(plan["asked_seconds"], 0.3);
        for key in ["planned_seconds", "got_seconds"] {
            assert!(plan[key].as_f64().unwrap() > 0.0, "{key} {plan}");
        }
        let settings = plan["options"].as_str().unwrap();
        assert!(run.stderr.contains(settings), "{}", run.stderr);
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        assert_eq!(file.metadata().text("plan_options"), Some(settings));
        assert!(file.metadata().number("plan_got_seconds_before_writing").unwrap() > 0.0);

        let mut again = vec!["--method", method, "--seed", "3"];
        again.extend(settings.split(' '));
        render(&sandbox, "b.exr", &again).expect(0);
        let b = ExrFile::read(&sandbox.path("b.exr")).unwrap();
        let images = [file, b].map(|file| file.color().unwrap());
        assert_eq!(images[0].pixels, images[1].pixels, "{settings}");
    }
}

#[test]
fn an_error_is_met_and_the_same_for_any_number_of_threads() {
    let sandbox = Sandbox::new();
    let wanted = ["--error", "20%", "--verify", "100", "--set", "verify-samples=1024", "--stats", "json"];
    let files = ["1", "3"].map(|threads| {
        let run = render(&sandbox, "a.exr", &[&wanted[..], &["--threads", threads]].concat()).expect(0);
        let plan = plan(&run);
        assert_eq!((&plan["asked_error"], &plan["met"]), (&0.2.into(), &true.into()), "{plan}");
        assert!(plan["got_error"]["high"].as_f64().unwrap() <= 0.2, "{plan}");
        assert!(run.stderr.contains("error, measured by path tracing"), "{}", run.stderr);
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        assert!(file.metadata().number("verified_rms_high").unwrap() <= 0.2);
        assert_eq!(file.metadata().number("plan_got_error"), plan["got_error"]["value"].as_f64());
        (file.color().unwrap(), plan)
    });
    assert_eq!((&files[0].0.pixels, &files[0].1), (&files[1].0.pixels, &files[1].1));
}

#[test]
fn an_error_out_of_reach_is_not_claimed_and_typed_settings_are_held() {
    let sandbox = Sandbox::new();
    let held = ["--set", "vpls=20", "--set", "epsilon=0.5", "--set", "max-cut=3", "--set", "patches=16"];
    let wanted = ["--error", "0.001%", "--verify", "50", "--set", "verify-samples=64", "--stats", "json"];
    let run = render(&sandbox, "a.exr", &[&held[..], &wanted].concat()).expect(0);
    let plan = plan(&run);
    assert_eq!(plan["met"], false);
    assert!(run.stderr.contains("may be above 0.001 %"), "{}", run.stderr);
    for pair in held.chunks(2) {
        assert!(plan["options"].as_str().unwrap().contains(&pair.join(" ")), "{plan}");
    }
    assert!(read(&sandbox.path("a.exr")).len() > 1000);
}

#[test]
fn qualities_are_settings_from_rough_to_fine_and_typed_ones_are_held() {
    let sandbox = Sandbox::new();
    let settings = |options: &[&str]| {
        let run = render(&sandbox, "a.exr", &[options, &["--stats", "json"]].concat()).expect(0);
        let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        (report["run"]["method"].clone(), report["run"]["settings"].clone())
    };
    let names = ["draft", "preview", "final", "reference"];
    let found = names.map(|name| settings(&["--quality", name, "--set", "vpls=500"]));
    for (method, settings) in &found {
        assert_eq!((method, &settings["vpls"]), (&"cache".into(), &500.into()));
    }
    let of = |key: &str| [0, 1, 2, 3].map(|k| found[k].1[key].as_f64().unwrap());
    assert!(of("epsilon").is_sorted_by(|a, b| a > b), "{:?}", of("epsilon"));
    assert!(of("spp").is_sorted() && of("spp")[0] < of("spp")[3], "{:?}", of("spp"));
    let (method, by_paths) = settings(&["--quality", "draft", "--method", "path"]);
    assert!(method == "path" && by_paths["spp"].as_f64() < Some(64.0), "{by_paths}");
}

#[test]
fn without_time_the_cheapest_picture_is_taken_and_the_reason_is_told() {
    let sandbox = Sandbox::new();
    let stderr = render(&sandbox, "a.exr", &["--time", "1ms"]).expect(0).stderr;
    assert!(stderr.contains("neither method meets the time") || stderr.contains("not denoised"), "{stderr}");
    assert!(!stderr.contains("about 0.0 times"), "{stderr}");
}

#[test]
fn wishes_that_make_no_sense_are_refused() {
    let sandbox = Sandbox::new();
    for wrong in [
        &["--time", "soon"][..],
        &["--time", "0s"],
        &["--error", "2"],
        &["--time", "2s", "--error", "2%"],
        &["--time", "2s", "--method", "photon-cache"],
        &["--quality", "best"],
        &["--quality", "draft", "--time", "2s"],
        &["--quality", "draft", "--method", "photon-cache"],
    ] {
        render(&sandbox, "a.exr", wrong).expect(2);
    }
    assert_eq!(sandbox.files(), ["room.xml"]);
}

#[test]
fn an_open_method_is_chosen_and_the_reasons_told_and_kept() {
    let sandbox = Sandbox::new();
    let open = render(&sandbox, "a.exr", &["--stats", "json"]).expect(0);
    let facts = plan(&open);
    let Some(chosen) = facts["chosen"].as_str() else {
        assert!(open.stderr.contains("not denoised"), "{}", open.stderr);
        return;
    };
    assert!(open.stderr.contains(&format!("Method: {chosen} ")));
    for key in ["paths_a_sample", "rays_ratio", "other_work"] {
        assert!(facts[key].as_f64().unwrap() > 0.0, "{key} {facts}");
    }
    let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
    assert_eq!(file.metadata().text("plan_chosen"), Some(chosen));
    assert_eq!(file.metadata().text("method"), Some(chosen));
    let report: serde_json::Value = serde_json::from_str(&open.stdout).unwrap();
    let rays = &report["counters"]["Plan"]["rays of the pilot"];
    assert_eq!(*rays, facts["pilot_rays"]);
    // A method that is named, or settings that paths lack or that say how good the picture is to be.
    for closed in [&["--method", "cache"][..], &["--spp", "4"], &["--set", "vpls=500"]] {
        let run = render(&sandbox, "b.exr", &[closed, &["--stats", "json"]].concat()).expect(0);
        assert!(plan(&run).is_null() && !run.stderr.contains("Method:"), "{closed:?}");
        let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(report["run"]["method"], "cache");
    }
}
