//! `render --denoise` and `denoise`: with the library, left out where it is missing, and without.

use super::{Finished, Sandbox, read};
use lightsplat::film::{ExrFile, Image};
use lightsplat::math::Rgb;

/// Renders the room with few paths.
fn noisy(sandbox: &Sandbox, name: &str, more: &[&str]) -> Finished {
    let base = ["render", "room.xml", "-o", name, "--method", "path", "--spp", "2"];
    sandbox.run(&[&base, more].concat())
}

/// Renders the room denoised; `None` where there is no library.
fn denoised(sandbox: &Sandbox, name: &str, more: &[&str]) -> Option<Finished> {
    let run = noisy(sandbox, name, &[&["--denoise"], more].concat()).expect(0);
    if run.stderr.contains("not denoised") {
        eprintln!("skipped: {}", run.stderr);
        return None;
    }
    Some(run)
}

fn file(sandbox: &Sandbox, name: &str) -> ExrFile {
    ExrFile::read(&sandbox.path(name)).unwrap()
}

fn color(sandbox: &Sandbox, name: &str) -> Image {
    file(sandbox, name).color().unwrap()
}

/// Runs a command with a folder in `OIDN_DIR` that is empty.
fn without_library(sandbox: &Sandbox, arguments: &[&str]) -> Finished {
    let folder = sandbox.path("empty");
    std::fs::create_dir_all(&folder).unwrap();
    Finished::from(sandbox.command(arguments).env("OIDN_DIR", &folder).output().unwrap())
}

/// Returns an OpenEXR file of 32-bit floats without compression, which may hold any values.
fn uncompressed(image: &Image) -> Vec<u8> {
    let window: Vec<u8> =
        [0, 0, image.width - 1, image.height - 1].iter().flat_map(|side| side.to_le_bytes()).collect();
    let mut channels = Vec::new();
    for name in [b"B\0", b"G\0", b"R\0"] {
        channels.extend_from_slice(name);
        channels.extend([2u32, 0, 1, 1].iter().flat_map(|word| word.to_le_bytes()));
    }
    channels.push(0);
    let mut file = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        file.extend_from_slice(format!("{name}\0{kind}\0").as_bytes());
        file.extend_from_slice(&(value.len() as u32).to_le_bytes());
        file.extend_from_slice(value);
    };
    attribute("channels", "chlist", &channels);
    attribute("compression", "compression", &[0]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    file.push(0);
    let (length, start) = (12 * image.width, file.len() + 8 * image.height as usize);
    for row in 0..image.height as usize {
        file.extend_from_slice(&((start + row * (8 + length as usize)) as u64).to_le_bytes());
    }
    for (row, pixels) in image.pixels.chunks(image.width as usize).enumerate() {
        file.extend_from_slice(&(row as u32).to_le_bytes());
        file.extend_from_slice(&length.to_le_bytes());
        for channel in [2, 1, 0] {
            file.extend(pixels.iter().flat_map(|pixel| pixel[channel].to_le_bytes()));
        }
    }
    file
}

#[test]
fn pixels_that_are_no_numbers_are_named_and_mended() {
    let sandbox = Sandbox::new();
    let mut image = Image::new(8, 4);
    image.pixels.fill(Rgb::splat(0.5));
    let mut write = |name: &str, bad: Option<f32>| {
        if let Some(bad) = bad {
            (image.pixels[11].y, image.pixels[13].x) = (bad, bad);
        }
        std::fs::write(sandbox.path(name), uncompressed(&image)).unwrap();
    };
    write("good.exr", None);
    write("inf.exr", Some(f32::INFINITY));
    write("nan.exr", Some(f32::NAN));
    let pixel = |name: &str| {
        let run =
            sandbox.run(&["develop", name, "-o", "a.png", "--exposure", "0", "--view", "standard"]).expect(0);
        (image::open(sandbox.path("a.png")).unwrap().to_rgb8().get_pixel(3, 1).0, run.stderr)
    };
    let (good, stderr) = pixel("good.exr");
    assert!(good[0] == good[1] && !stderr.contains("warning"), "{stderr}");
    for (name, green) in [("nan.exr", 0), ("inf.exr", 255)] {
        let (shown, stderr) = pixel(name);
        let warning = format!("warning: {name}: 2 pixels are NaN or infinite, the first in column 3, row 1");
        assert!(stderr.contains(&warning), "{stderr}");
        assert_eq!(shown, [good[0], green, good[2]]);
        let denoised = sandbox.run(&["denoise", name, "-o", "b.exr"]);
        assert!(denoised.stderr.contains(&warning), "{}", denoised.stderr);
        if denoised.code == Some(0) {
            assert!(color(&sandbox, "b.exr").pixels.iter().all(|pixel| pixel.is_finite()));
        }
    }
}

#[test]
fn a_missing_library_is_a_warning_with_its_remedy_and_a_noisy_picture_that_says_so() {
    let sandbox = Sandbox::new();
    sandbox.render("plain.exr", &[]).expect(0);
    let render = Sandbox::path_tracing(
        "4",
        &["--resolution", "24x16", "--denoise", "--set=keep-noisy=on", "--stats", "json"],
    );
    let run = without_library(&sandbox, &render).expect(0);
    for part in ["warning: the image is not denoised", "OIDN_DIR=", "make setup"] {
        assert!(run.stderr.contains(part), "{}", run.stderr);
    }
    let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert!(report["run"]["denoised"].is_null() && report["times"]["denoise"].is_null());
    let picture = file(&sandbox, "a.exr");
    assert_eq!(picture.metadata().text("denoised"), Some("false"));
    assert_eq!(picture.color().unwrap(), color(&sandbox, "plain.exr"));
    assert_eq!(picture.layers(), ["", "variance"]);

    let run = without_library(&sandbox, &["denoise", "a.exr", "-o", "b.exr"]).expect(1);
    assert!(run.stderr.contains("make setup"), "{}", run.stderr);
    assert!(!sandbox.path("b.exr").exists() && !sandbox.path("b.png").exists());
}

#[test]
fn a_denoised_picture_says_by_what_keeps_what_is_asked_and_is_nearer_to_the_truth() {
    let sandbox = Sandbox::new();
    let verify = ["--verify", "300", "--stats", "json", "--threads", "2"];
    let Some(run) = denoised(&sandbox, "a.exr", &[&verify[..], &["--set=keep-noisy=on"]].concat()) else {
        return;
    };
    let plain = noisy(&sandbox, "plain.exr", &verify).expect(0);
    let [report, plain] =
        [&run.stdout, &plain.stdout].map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap());
    let library = report["run"]["denoised"].as_str().unwrap();
    assert!(library.starts_with("Open Image Denoise 2."), "{library}");
    assert!(report["times"]["denoise"]["wall_seconds"].as_f64().unwrap() > 0.0);
    let rms =
        |report: &serde_json::Value| report["run"]["verified"]["relative_rms"]["value"].as_f64().unwrap();
    assert!(rms(&report) < 0.7 * rms(&plain), "{} {}", rms(&report), rms(&plain));

    let picture = file(&sandbox, "a.exr");
    assert_eq!(picture.metadata().text("denoised"), Some(library));
    assert_eq!(picture.layers(), ["", "noisy", "noisy.variance"]);
    // Paths of images to be denoised take other positions, and photons end them.
    let [kept, other] = [picture.layer("noisy").unwrap(), color(&sandbox, "plain.exr")];
    let ratio = kept.luminance() / other.luminance();
    assert!(kept != other && (ratio - 1.0).abs() < 0.1, "{ratio}");
    assert_eq!(picture.metadata().number("standard_error"), None);
    assert!(picture.metadata().number("noisy_standard_error").unwrap() > 0.0);
    for threads in ["1", "4"] {
        denoised(&sandbox, "b.exr", &["--threads", threads, "--no-png"]).unwrap();
        assert_eq!(color(&sandbox, "b.exr"), picture.color().unwrap());
    }
    let off = noisy(&sandbox, "c.exr", &["--denoise", "--no-denoise", "--stats", "json"]).expect(0);
    assert!(off.stdout.contains("\"denoised\":null"));
    assert!(noisy(&sandbox, "c.exr", &["--set=keep-noisy=on"]).expect(2).stderr.contains("--denoise"));
}

#[test]
fn a_file_is_denoised_as_its_render_would_be_and_keeps_all_else() {
    let sandbox = Sandbox::new();
    let aovs = ["--aov", "albedo,normal,depth,material,alpha", "--crop", "3,2,20,13"];
    noisy(&sandbox, "plain.exr", &aovs).expect(0);
    let before = read(&sandbox.path("plain.exr"));
    if denoised(&sandbox, "render.exr", &aovs).is_none() {
        return;
    }
    let run = sandbox.run(&["denoise", "plain.exr", "--keep-noisy"]).expect(0);
    assert!(run.stderr.contains("guided by albedo and normal"), "{}", run.stderr);
    assert!(sandbox.path("plain.denoised.png").exists() && read(&sandbox.path("plain.exr")) == before);
    let (plain, clean) = (file(&sandbox, "plain.exr"), file(&sandbox, "plain.denoised.exr"));
    assert_eq!(clean.color().unwrap(), color(&sandbox, "render.exr"));
    assert_eq!(clean.layer("noisy").unwrap(), plain.color().unwrap());
    assert_eq!(clean.layer("noisy.variance").unwrap(), plain.layer("variance").unwrap());
    for layer in ["albedo", "normal", "depth.Z", "materialId", "A"] {
        assert_eq!(clean.layer(layer).unwrap(), plain.layer(layer).unwrap(), "{layer}");
    }
    assert_eq!(clean.channels().len(), plain.channels().len() + 3);
    assert_eq!((clean.window(), clean.camera()), (plain.window(), plain.camera()));
    let (facts, kept) = (clean.metadata(), plain.metadata());
    for key in ["scene_hash", "settings", "render_seconds", "method"] {
        assert_eq!(facts.get(key), kept.get(key), "{key}");
    }
    assert!(facts.text("denoised").is_some_and(|library| library.starts_with("Open Image Denoise 2.")));

    let again = sandbox.run(&["denoise", "plain.denoised.exr"]).expect(3);
    assert!(again.stderr.contains("already denoised"), "{}", again.stderr);
    let onto = sandbox.run(&["denoise", "plain.exr", "-o", "./plain.exr"]).expect(2);
    assert!(onto.stderr.contains("another file") && read(&sandbox.path("plain.exr")) == before);
}

#[test]
fn quality_of_denoising_goes_with_the_work_or_is_as_asked() {
    let sandbox = Sandbox::new();
    let said = |name: &str| file(&sandbox, name).metadata().text("denoised").unwrap().to_owned();
    let Some(_) = denoised(&sandbox, "auto.exr", &[]) else { return };
    for quality in ["fast", "balanced", "high"] {
        denoised(&sandbox, &format!("{quality}.exr"), &["--set", &format!("denoise-quality={quality}")]);
    }
    assert!(
        said("fast.exr").ends_with(", fast quality") && said("balanced.exr").ends_with(", balanced quality")
    );
    assert!(!said("high.exr").contains("quality"), "{}", said("high.exr"));
    let [auto, fast, high] = ["auto.exr", "fast.exr", "high.exr"].map(|name| color(&sandbox, name));
    // Two paths in a room of few triangles are less work than the best network.
    assert_eq!((said("auto.exr"), &auto), (said("fast.exr"), &fast));
    assert_ne!(fast, high);

    // A single short path has no choice of a position, and no end by photons.
    let single = |name: &str, more: &[&str]| {
        let base = ["render", "room.xml", "-o", name, "--method", "path", "--spp", "1", "--max-depth", "4"];
        sandbox.run(&[&base, more].concat()).expect(0)
    };
    single("noisy.exr", &["--aov", "albedo,normal"]);
    single("clean.exr", &["--denoise", "--set", "denoise-quality=fast", "--set", "keep-noisy=on"]);
    assert_eq!(file(&sandbox, "clean.exr").layer("noisy").unwrap(), color(&sandbox, "noisy.exr"));
    // Layers are means over the image's samples. Guides come from a survey, with or without layers.
    single("layers.exr", &["--denoise", "--set", "denoise-quality=fast", "--aov", "albedo,normal"]);
    let layers = file(&sandbox, "layers.exr");
    assert_eq!(color(&sandbox, "layers.exr"), color(&sandbox, "clean.exr"));
    assert_eq!(layers.layer("albedo").unwrap(), file(&sandbox, "noisy.exr").layer("albedo").unwrap());
    sandbox.run(&["denoise", "noisy.exr", "-o", "later.exr", "--quality", "fast"]).expect(0);
    assert_ne!(color(&sandbox, "later.exr"), color(&sandbox, "clean.exr"));
}
