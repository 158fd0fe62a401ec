//! Merging: weights, variances and headers, and pictures that cannot be merged.

use super::{Finished, Sandbox};
use lightsplat::film::{ExrFile, Image};

fn merge(sandbox: &Sandbox, inputs: &[&str]) -> Finished {
    sandbox.run(&[&["merge"], inputs, &["-o", "m.exr"]].concat())
}

fn file(sandbox: &Sandbox, name: &str) -> ExrFile {
    ExrFile::read(&sandbox.path(name)).unwrap()
}

fn render(sandbox: &Sandbox, name: &str, seed: &str, spp: &str, more: &[&str]) {
    let base = ["render", "room.xml", "-o", name, "--resolution", "24x16", "--seed", seed, "--spp", spp];
    sandbox.run(&[&base, more].concat()).expect(0);
}

/// Checks that each channel of `c` is `weights[0]` of `a` and `weights[1]` of `b`.
fn assert_mean(c: &Image, a: &Image, b: &Image, weights: [f32; 2]) {
    for ((c, a), b) in c.pixels.iter().zip(&a.pixels).zip(&b.pixels) {
        let mean = *a * weights[0] + *b * weights[1];
        assert!((mean - *c).abs().max_element() <= 1e-5 * mean.abs().max_element(), "{c} for {mean}");
    }
}

#[test]
fn pictures_count_as_much_as_they_have_samples_and_merged_ones_can_be_merged_again() {
    let sandbox = Sandbox::new();
    let path = ["--method", "path", "--aov", "depth,object"];
    for (name, seed, spp) in [("a.exr", "1", "16"), ("b.exr", "2", "48"), ("c.exr", "3", "64")] {
        render(&sandbox, name, seed, spp, &path);
    }
    let stderr = merge(&sandbox, &["a.exr", "b.exr"]).expect(0).stderr;
    assert!(stderr.contains("merged from 2 images") && sandbox.path("m.png").exists(), "{stderr}");
    let [a, b, m] = ["a.exr", "b.exr", "m.exr"].map(|name| file(&sandbox, name));
    let color = |file: &ExrFile| file.color().unwrap();
    assert_mean(&color(&m), &color(&a), &color(&b), [0.25, 0.75]);
    let variance = |file: &ExrFile| file.layer("variance").unwrap();
    assert_mean(&variance(&m), &variance(&a), &variance(&b), [0.0625, 0.5625]);
    assert_eq!(m.layer("objectId").unwrap(), a.layer("objectId").unwrap());
    assert_eq!((m.channels(), m.camera(), m.window()), (a.channels(), a.camera(), a.window()));
    let facts = m.metadata();
    assert_eq!((facts.number("spp"), facts.text("seed")), (Some(64.0), Some("1,2")));
    assert!(facts.number("standard_error") < b.metadata().number("standard_error"));
    assert_eq!((facts.text("job"), facts.get("render_seconds")), (None, None));
    std::fs::rename(sandbox.path("m.exr"), sandbox.path("ab.exr")).unwrap();
    merge(&sandbox, &["ab.exr", "c.exr"]).expect(0);
    let [c, all] = ["c.exr", "m.exr"].map(|name| file(&sandbox, name));
    assert_mean(&color(&all), &color(&m), &color(&c), [0.5, 0.5]);
    assert_eq!(all.metadata().text("seed"), Some("1,2,3"));
    // The merged picture is as good as one of as many samples: by the z-test of `compare`, and by its own statement.
    render(&sandbox, "whole.exr", "9", "128", &path);
    let error = |file: &ExrFile| file.metadata().number("standard_error").unwrap();
    let ratio = error(&all) / error(&file(&sandbox, "whole.exr"));
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
    assert!(merge(&sandbox, &["ab.exr", "b.exr"]).expect(3).stderr.contains("also has seed 2"));
}

#[test]
fn pixels_that_are_no_numbers_are_named_and_mended() {
    let sandbox = Sandbox::new();
    for (name, seed) in [("a.exr", "1"), ("b.exr", "2")] {
        render(&sandbox, name, seed, "4", &["--method", "path"]);
    }
    let mut a = file(&sandbox, "a.exr");
    let mut color = a.color().unwrap();
    (color.pixels[24 + 5].x, color.pixels[30].y) = (f32::NAN, f32::NAN);
    a.replace_color(&color, None).unwrap();
    a.write(&sandbox.path("a.exr")).unwrap();
    let warning =
        "warning: a.exr: 2 pixels are NaN or infinite, the first in column 5, row 1; NaN counts as 0";
    let merged = merge(&sandbox, &["b.exr", "a.exr"]).expect(0).stderr;
    assert!(merged.contains(warning), "{merged}");
    assert!(file(&sandbox, "m.exr").color().unwrap().pixels.iter().all(|pixel| pixel.is_finite()));
    let compared = sandbox.run(&["compare", "a.exr", "b.exr"]).expect(0);
    assert!(compared.stderr.contains(warning) && !compared.stdout.contains("NaN"), "{}", compared.stderr);
}

#[test]
fn pictures_are_merged_with_those_alone_that_are_sharpened_as_they_are() {
    let sandbox = Sandbox::new();
    let scene = super::ROOM.replace("rfilter type=\"box\"", "rfilter type=\"mitchell\"");
    std::fs::write(sandbox.path("room.xml"), scene).unwrap();
    for (name, seed) in [("a.exr", "1"), ("b.exr", "2")] {
        render(&sandbox, name, seed, "4", &["--method", "path"]);
    }
    merge(&sandbox, &["a.exr", "b.exr"]).expect(0);
    let [a, mut b, m] = ["a.exr", "b.exr", "m.exr"].map(|name| file(&sandbox, name));
    assert_mean(&m.color().unwrap(), &a.color().unwrap(), &b.color().unwrap(), [0.5, 0.5]);
    b.remove_fact("sharpened");
    b.write(&sandbox.path("b.exr")).unwrap();
    assert!(merge(&sandbox, &["a.exr", "b.exr"]).expect(3).stderr.contains("sharpening"));
}

#[test]
fn pictures_that_do_not_belong_together_are_refused_with_the_reason() {
    let sandbox = Sandbox::new();
    let path = ["--method", "path"];
    render(&sandbox, "a.exr", "1", "1", &path);
    let cases: [(&str, &[&str]); 5] = [
        ("also has seed 1", &["--method", "path", "--seed", "1"]),
        ("setting, besides", &["--method", "path", "--seed", "2", "--max-depth", "2"]),
        ("size or crop", &["--method", "path", "--seed", "2", "--crop", "0,0,4,4"]),
        ("method", &["--seed", "2", "--set", "vpls=100", "--no-denoise"]),
        ("scene", &["--method", "path", "--seed", "2"]),
    ];
    for (reason, more) in cases {
        if reason == "scene" {
            let scene = super::ROOM.replace("0.6, 0.5, 0.4", "0.6, 0.5, 0.3");
            std::fs::write(sandbox.path("room.xml"), scene).unwrap();
        }
        let base = ["render", "room.xml", "-o", "b.exr", "--resolution", "24x16", "--spp", "1"];
        sandbox.run(&[&base, more].concat()).expect(0);
        let stderr = merge(&sandbox, &["a.exr", "b.exr"]).expect(3).stderr;
        assert!(stderr.contains(reason) && stderr.contains("b.exr"), "{reason}: {stderr}");
    }
    assert!(merge(&sandbox, &["a.exr"]).expect(2).stderr.contains("2"));
    assert!(merge(&sandbox, &["a.exr", "none.exr"]).expect(3).stderr.contains("none.exr"));
    assert!(!sandbox.path("m.exr").exists());
}

#[test]
fn of_denoised_pictures_the_noisy_ones_are_merged_if_they_were_kept() {
    let sandbox = Sandbox::new();
    let path = |name, seed, more: &[&str]| {
        render(&sandbox, name, seed, "4", &[&["--method", "path", "--denoise"], more].concat());
    };
    path("a.exr", "1", &["--set=keep-noisy=on"]);
    if file(&sandbox, "a.exr").metadata().text("denoised") == Some("false") {
        return; // The library is not there.
    }
    path("b.exr", "2", &["--set=keep-noisy=on"]);
    merge(&sandbox, &["a.exr", "b.exr"]).expect(0);
    let [a, b, m] = ["a.exr", "b.exr", "m.exr"].map(|name| file(&sandbox, name));
    let noisy = |file: &ExrFile| file.layer("noisy").unwrap();
    assert_mean(&m.color().unwrap(), &noisy(&a), &noisy(&b), [0.5, 0.5]);
    assert!(
        m.layer("noisy").is_err() && m.layer("variance").is_ok() && m.metadata().get("denoised").is_none()
    );
    path("b.exr", "2", &[]);
    assert!(merge(&sandbox, &["a.exr", "b.exr"]).expect(3).stderr.contains("--set keep-noisy=on"));
}
