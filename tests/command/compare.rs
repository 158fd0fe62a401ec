//! The command `compare`.

use super::Sandbox;
use lightsplat::film::{Film, Image, write_exr};
use lightsplat::math::Rgb;

fn picture(sandbox: &Sandbox, name: &str, size: [u32; 2], value: impl Fn(usize) -> f32) {
    let mut image = Image::new(size[0], size[1]);
    image.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = Rgb::splat(value(i)));
    write_exr(&sandbox.path(name), &Film::new(image)).unwrap();
}

fn json(sandbox: &Sandbox, arguments: &[&str]) -> serde_json::Value {
    let run = sandbox.run(&[&["compare", "--json"], arguments].concat()).expect(0);
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn the_measures_are_printed_as_text_and_json() {
    let sandbox = Sandbox::new();
    picture(&sandbox, "a.exr", [8, 4], |i| 1.1 * (1 + i) as f32);
    picture(&sandbox, "b.exr", [8, 4], |i| (1 + i) as f32);
    let measures = json(&sandbox, &["a.exr", "b.exr"]);
    assert!((measures["mean_ratio"][1].as_f64().unwrap() - 1.1).abs() < 1e-6);
    assert!(measures["flip"].as_f64().unwrap() > 0.0 && measures["z_test"].is_null());
    let text = sandbox.run(&["compare", "a.exr", "b.exr"]).expect(0).stdout;
    assert!(text.contains("relMSE") && text.contains("1.10000"), "{text}");
    let same = json(&sandbox, &["a.exr", "a.exr"]);
    assert_eq!((same["rel_mse"].as_f64(), same["flip"].as_f64()), (Some(0.0), Some(0.0)));
    assert!(same["psnr"].is_null());
}

#[test]
fn variances_come_from_files_or_from_the_pictures_own_layers() {
    let sandbox = Sandbox::new();
    for (name, seed) in [("a.exr", "1"), ("b.exr", "2")] {
        let arguments = [
            "render",
            "room.xml",
            "-o",
            name,
            "--method",
            "path",
            "--spp",
            "64",
            "--resolution",
            "24x16",
            "--seed",
            seed,
        ];
        sandbox.run(&arguments).expect(0);
    }
    let own = json(&sandbox, &["a.exr", "b.exr"]);
    assert!(own["z_test"]["share_passed"].as_f64().unwrap() > 0.9, "{own}");
    assert!(own["reference_rel_mse"].as_f64().unwrap() > 0.0);
    // With variances that are far too small, the same two pictures disagree.
    picture(&sandbox, "tiny.exr", [24, 16], |_| 1e-12);
    let tiny = json(&sandbox, &["a.exr", "b.exr", "--variance-a", "tiny.exr", "--variance-b", "tiny.exr"]);
    assert_eq!(tiny["z_test"]["passed"], false, "{tiny}");
}

#[test]
fn the_heatmap_shows_both_pictures_and_the_error() {
    let sandbox = Sandbox::new();
    picture(&sandbox, "a.exr", [8, 6], |i| i as f32);
    picture(&sandbox, "b.exr", [8, 6], |_| 1.0);
    for of in ["flip", "relative"] {
        sandbox.run(&["compare", "a.exr", "b.exr", "--heatmap", "heat.png", "--heatmap-of", of]).expect(0);
        let heat = image::open(sandbox.path("heat.png")).unwrap();
        assert_eq!((heat.width(), heat.height()), (24, 6));
        std::fs::remove_file(sandbox.path("heat.png")).unwrap();
    }
    sandbox.run(&["compare", "a.exr", "b.exr", "--heatmap", "none/heat.png"]).expect(4);
}

#[test]
fn negative_variances_count_as_none_and_are_told() {
    let sandbox = Sandbox::new();
    picture(&sandbox, "a.exr", [8, 6], |i| 1.0 + i as f32);
    picture(&sandbox, "b.exr", [8, 6], |i| 1.1 + i as f32);
    picture(&sandbox, "v.exr", [8, 6], |i| if i % 2 == 0 { -1.0 } else { 1.0 });
    let arguments = ["compare", "a.exr", "b.exr", "--variance-a", "v.exr", "--variance-b", "v.exr"];
    let run = sandbox.run(&arguments).expect(0);
    assert!(
        run.stderr.contains("24 pixels in v.exr are negative") && !run.stdout.contains("NaN"),
        "{}",
        run.stdout
    );
}

#[test]
fn the_heatmap_replaces_no_picture_that_is_read() {
    let sandbox = Sandbox::new();
    picture(&sandbox, "a.exr", [8, 6], |_| 1.0);
    let before = super::read(&sandbox.path("a.exr"));
    assert!(
        sandbox.run(&["compare", "a.exr", "a.exr", "--heatmap", "a.exr"]).expect(2).stderr.contains(".png")
    );
    std::fs::copy(sandbox.path("a.exr"), sandbox.path("a.png")).unwrap();
    let run = sandbox.run(&["compare", "a.exr", "a.png", "--heatmap", "./a.png"]).expect(2);
    assert!(run.stderr.contains("would be lost"), "{}", run.stderr);
    assert!(super::read(&sandbox.path("a.exr")) == before && super::read(&sandbox.path("a.png")) == before);
}

#[test]
fn pictures_that_are_missing_broken_or_of_unlike_size_end_with_3() {
    let sandbox = Sandbox::new();
    picture(&sandbox, "a.exr", [8, 6], |_| 1.0);
    picture(&sandbox, "b.exr", [6, 8], |_| 1.0);
    let stderr = |test: &str| sandbox.run(&["compare", test, "a.exr"]).expect(3).stderr;
    assert!(stderr("b.exr").contains("6x8 and 8x6"));
    assert!(stderr("missing.exr").contains("missing.exr"));
    assert!(stderr("room.xml").contains("room.xml"));
    let variance = ["compare", "a.exr", "a.exr", "--variance-a", "b.exr"];
    assert!(sandbox.run(&variance).expect(3).stderr.contains("variance"));
}
