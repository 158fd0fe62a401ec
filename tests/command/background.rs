//! Backgrounds: seen, hidden and transparent; exposure over automatic; layers of first hits.

use super::{Finished, Sandbox, few_lights, read};
use lightsplat::film::{ExrFile, Image};
use lightsplat::math::Rgb;
use std::fs;

/// A grey ball, a ball of glass, a card that is a quarter there, and a card that is not there, under a grey sky.
const SCENE: &str = r#"
resolution = [64, 48]
environment = { radiance = 1.0 }
[camera]
origin = [0, 0, 6]
target = [0, 0, 0]
fov = 50
[camera.path]
keys = [
    { frame = 1, origin = [0, 0, 6], target = [0, 0, 0] },
    { frame = 2, origin = [0, 0, 6.5], target = [0, 0, 0] },
]
[[material]]
name = "grey"
kind = "diffuse"
reflectance = 0.5
[[material]]
name = "glass"
kind = "glass"
[[material]]
name = "quarter"
kind = "diffuse"
reflectance = 0.5
opacity = 0.25
[[material]]
name = "nothing"
kind = "diffuse"
reflectance = 0.5
opacity = 0
[[mesh]]
shape = "sphere"
material = "grey"
transform = [{ scale = 0.8 }, { translate = [-1.2, 0.9, 0] }]
[[mesh]]
shape = "sphere"
material = "glass"
transform = [{ scale = 0.8 }, { translate = [1.2, 0.9, 0] }]
[[mesh]]
shape = "rectangle"
material = "quarter"
transform = [{ scale = 0.6 }, { translate = [-1.2, -1.2, 0] }]
[[mesh]]
shape = "rectangle"
material = "nothing"
transform = [{ scale = 0.6 }, { translate = [1.2, -1.2, 0] }]
"#;

/// Columns and rows of the middles of the four, and a corner.
const PLACES: [[u32; 2]; 5] = [[18, 13], [45, 13], [18, 37], [45, 37], [1, 1]];

fn render(sandbox: &Sandbox, output: &str, more: &[&str]) -> Finished {
    sandbox.run(&[&["render", "s.toml", "-o", output, "--spp", "4", "--exposure", "0"], more].concat())
}

fn file(sandbox: &Sandbox, name: &str) -> ExrFile {
    ExrFile::read(&sandbox.path(name)).unwrap()
}

fn at<T: Copy>(image: &Image<T>, [x, y]: [u32; 2]) -> T {
    image.pixels[(y * image.width + x) as usize]
}

#[test]
fn a_hidden_background_is_transparent_by_every_method() {
    let sandbox = Sandbox::with("s.toml", SCENE);
    for method in ["path", "cache", "lightcuts", "photon-cache", "reconstruction"] {
        for denoise in ["--denoise", "--no-denoise"] {
            let more = ["--background", "none", "--method", method, denoise, "--view", "standard"];
            render(&sandbox, "a.exr", &[&more[..], few_lights(method)].concat()).expect(0);
            let file = file(&sandbox, "a.exr");
            let (color, alpha) = (file.color().unwrap(), file.layer("A").unwrap());
            let [ball, glass, card, nothing, corner] =
                PLACES.map(|place| (at(&color, place), at(&alpha, place).x));
            for (color, alpha) in [nothing, corner] {
                assert_eq!((color, alpha), (Rgb::ZERO, 0.0), "{method} {denoise}");
            }
            assert!(ball.1 == 1.0 && ball.0.y > 0.1, "{method} {denoise}: {ball:?}");
            // The sky stays behind glass.
            assert!(glass.1 == 1.0 && glass.0.y > 0.5, "{method} {denoise}: {glass:?}");
            assert!((card.1 - 0.25).abs() < 0.02, "{method} {denoise}: {card:?}");
            for (color, alpha) in color.pixels.iter().zip(&alpha.pixels) {
                assert!(alpha.x > 0.0 || *color == Rgb::ZERO, "{method} {denoise}: {color}");
            }
            let png = image::open(sandbox.path("a.png")).unwrap();
            assert_eq!(png.color(), image::ColorType::Rgba8, "{method} {denoise}");
            let png = png.into_rgba8();
            let codes = PLACES.map(|[x, y]| png.get_pixel(x, y).0);
            assert_eq!((codes[3], codes[4]), ([0; 4], [0; 4]), "{method} {denoise}");
            assert_eq!([codes[0][3], codes[1][3]], [255; 2], "{method} {denoise}");
            assert!(codes[2][3].abs_diff(64) < 6, "{method} {denoise}: {:?}", codes[2]);
        }
    }
    // A grey card in a grey sky has radiance .5, also where only a quarter of it is there.
    let many = ["--background", "none", "--method", "path", "--spp", "256", "--view", "standard"];
    sandbox.run(&[&["render", "s.toml", "-o", "b.png", "--exposure", "0"], &many[..]].concat()).expect(0);
    let card = image::open(sandbox.path("b.png")).unwrap().into_rgba8().get_pixel(18, 37).0;
    assert!(card[1].abs_diff(188) < 12 && card[3].abs_diff(64) < 3, "{card:?}");
}

#[test]
fn other_commands_make_transparent_files_too() {
    let sandbox = Sandbox::with("s.toml", SCENE);
    let rgba = |name: &str| {
        let png = image::open(sandbox.path(name)).unwrap();
        assert_eq!(png.color(), image::ColorType::Rgba8, "{name}");
        assert_eq!(png.into_rgba8().get_pixel(1, 1).0, [0; 4], "{name}");
    };
    let fast = ["--background", "none", "--no-denoise", "--method", "path", "--spp", "2", "-r", "32"];
    sandbox.run(&[&["walk", "s.toml", "-o", "f.####.exr"], &fast[..]].concat()).expect(0);
    rgba("f.0001.png");
    let cameras = r#"{"camera_angle_x": 0.8, "w": 32, "h": 24, "frames": [{"file_path": "v",
        "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,6],[0,0,0,1]]}]}"#;
    fs::write(sandbox.path("c.json"), cameras).unwrap();
    sandbox.run(&[&["views", "s.toml", "c.json", "-o", "out"], &fast[..]].concat()).expect(0);
    rgba("out/v.png");
    let job =
        "[[picture]]\nscene = 's.toml'\noutput = 'b.exr'\nbackground = 'none'\nmethod = 'path'\nspp = 2\n";
    fs::write(sandbox.path("jobs.toml"), job).unwrap();
    sandbox.run(&["batch", "jobs.toml"]).expect(0);
    rgba("b.png");
    sandbox.run(&["develop", "b.exr", "-o", "d.png", "--view", "agx"]).expect(0);
    rgba("d.png");
    sandbox.run(&["sheet", "f.####.exr", "-o", "s.png", "--frames", "1-2"]).expect(0);
    let sheet = image::open(sandbox.path("s.png")).unwrap().into_rgb8();
    assert_eq!(sheet.get_pixel(6, 6).0, [32; 3]);
}

#[test]
fn the_denoiser_leaves_the_background_as_it_is() {
    let sandbox = Sandbox::with("s.toml", SCENE);
    for method in ["path", "cache", "lightcuts"] {
        for more in [&[][..], &["--aov", "normal"]] {
            let base = ["--denoise", "--method", method];
            let run = render(&sandbox, "a.exr", &[&base[..], more, few_lights(method)].concat()).expect(0);
            if run.stderr.contains("not denoised") {
                return;
            }
            let color = file(&sandbox, "a.exr").color().unwrap();
            for place in [PLACES[3], PLACES[4], [62, 1], [1, 46], [62, 46], [32, 24]] {
                assert!(
                    (at(&color, place) - 1.0).abs().max_element() < 1e-6,
                    "{method} {place:?}: {}",
                    at(&color, place)
                );
            }
        }
    }
}

#[test]
fn layers_that_a_png_cannot_hold_are_named() {
    let sandbox = Sandbox::with("s.toml", SCENE);
    let more = ["--method", "path", "--no-denoise", "-r", "8", "--aov", "alpha,depth"];
    let said = render(&sandbox, "x.png", &more).expect(0).stderr;
    assert!(
        said.contains("--aov alpha,depth is not written") && said.contains("--background none"),
        "{said}"
    );
    assert!(image::open(sandbox.path("x.png")).unwrap().color() == image::ColorType::Rgb8);
    render(&sandbox, "x.png", &[&more[..], &["--strict"]].concat()).expect(2);
    assert!(!render(&sandbox, "x.exr", &more).expect(0).stderr.contains("not written"));
}

#[test]
fn layers_of_first_hits_are_not_averaged() {
    let sandbox = Sandbox::with("s.toml", SCENE);
    let more = ["--method", "path", "--no-denoise", "--aov", "normal,depth,object,position,alpha"];
    let length = |file: &ExrFile| file.layer("normal").unwrap().map(|normal| normal.length());
    render(&sandbox, "mean.exr", &more).expect(0);
    let short = |length: &&f32| **length > 0.0 && (**length - 1.0).abs() > 1e-3;
    assert!(length(&file(&sandbox, "mean.exr")).pixels.iter().filter(short).count() > 20);
    render(&sandbox, "first.exr", &[&more[..], &["--set", "aov-mode=first"]].concat()).expect(0);
    let first = file(&sandbox, "first.exr");
    assert_eq!(first.metadata().text("aov_mode"), Some("first"));
    assert_eq!(length(&first).pixels.iter().filter(short).count(), 0);
    let ids = first.numbers("objectId").unwrap();
    // The ball of glass is what is hit, not what it shows. Of the card a quarter is there, so the ray passes it.
    assert_eq!(PLACES.map(|place| at(&ids, place)), [1, 2, 0, 0, 0]);
    let (depth, position) = (first.layer("depth.Z").unwrap(), first.layer("position").unwrap());
    for (place, id) in [(PLACES[0], 1), (PLACES[1], 2)] {
        let depth = at(&depth, place).x;
        assert!((at(&position, place).z - (6.0 - depth)).abs() < 1e-3 && depth < 6.0, "{id}: {depth}");
    }
    let alpha = first.layer("A").unwrap();
    assert!((at(&alpha, PLACES[2]).x - 0.25).abs() < 0.02, "alpha is a mean");
}

#[test]
fn exposure_over_automatic_counts_from_automatic_everywhere() {
    let sandbox = Sandbox::with("s.toml", SCENE);
    let fast = ["--no-denoise", "--method", "path", "--spp", "4", "-r", "16"];
    let stops = |name: &str| file(&sandbox, name).metadata().number("png_exposure").unwrap();
    let more = |words: &[&str], exposure: &str| {
        sandbox.run(&[words, &fast[..], &["--exposure", exposure]].concat()).expect(0)
    };
    let cameras = r#"{"camera_angle_x": 0.8, "w": 32, "h": 24, "frames": [{"file_path": "v",
        "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,6],[0,0,0,1]]}]}"#;
    fs::write(sandbox.path("c.json"), cameras).unwrap();
    for (words, exr) in [
        (&["render", "s.toml", "-o", "a.exr"][..], "a.exr"),
        (&["walk", "s.toml", "-o", "w.#.exr", "--frames", "1"], "w.1.exr"),
        (&["views", "s.toml", "c.json", "-o", "out"], "out/v.exr"),
    ] {
        let [auto, over, under, absolute] = ["auto", "auto+1", "auto-0.5", "+1"].map(|exposure| {
            more(words, exposure);
            stops(exr)
        });
        assert!(
            (over - auto - 1.0).abs() < 1e-5 && (auto - under - 0.5).abs() < 1e-5,
            "{exr}: {auto} {over} {under}"
        );
        assert_eq!(absolute, 1.0, "{exr}");
    }
    // An absolute exposure says what automatic exposure would be.
    let said = more(&["render", "s.toml", "-o", "a.exr"], "+1").stderr;
    assert!(said.contains("exposure +1.00 EV (auto is "), "{said}");
    let png = |exposure: &str| {
        let said = sandbox.run(&["develop", "a.exr", "-o", "d.png", "--exposure", exposure]).expect(0).stderr;
        (said, read(&sandbox.path("d.png")))
    };
    assert!(png("auto+1").1 != png("auto").1 && png("1").1 == png("+1").1);
    assert!(png("1").0.contains("auto is"));
    let refused = sandbox.run(&["develop", "a.exr", "--exposure", "auto1"]).expect(2).stderr;
    assert!(refused.contains("auto+1"), "{refused}");
}
