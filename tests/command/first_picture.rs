//! First pictures: of files as exporters write them, with as few words as possible.

use super::{Finished, Sandbox};
use lightsplat::film::{ExrFile, Image, read_exr};
use std::fs;

/// A square on the ground, and a wall behind it.
const CORNER: &str = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv -1 2 -1\nv 1 2 -1\nf 1 2 3 4\nf 4 3 6 5\n";

/// A square of two triangles, as text of STL, standing on z.
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\nvertex 1 1 0\nendloop\nendfacet\n\
    facet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 1 0\nvertex -1 1 0\nendloop\nendfacet\nendsolid a\n";

/// A square that faces +z, of radiance `emissive`, as glTF with embedded data.
fn gltf(emissive: f32) -> String {
    let positions =
        [-1.0f32, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0];
    let bytes: Vec<u8> = positions.iter().flat_map(|number| number.to_le_bytes()).collect();
    use base64::Engine;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],
        "materials":[{{"emissiveFactor":[{emissive},{emissive},{emissive}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":72}}],
        "buffers":[{{"byteLength":72,"uri":"data:application/octet-stream;base64,{data}"}}]}}"#
    )
}

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    fs::write(sandbox.path("corner.obj"), CORNER).unwrap();
    fs::write(sandbox.path("plate.stl"), STL).unwrap();
    fs::write(sandbox.path("dark.gltf"), gltf(0.0)).unwrap();
    fs::write(sandbox.path("screen.gltf"), gltf(1.0)).unwrap();
    sandbox
}

/// Renders a file by few paths, with further words.
fn render(sandbox: &Sandbox, file: &str, more: &[&str]) -> Finished {
    sandbox
        .run(&[&["render", file, "--method", "path", "-s", "16", "--no-denoise", "-r", "32"], more].concat())
}

fn mean(image: &Image) -> f32 {
    image.pixels.iter().map(|pixel| pixel.y).sum::<f32>() / image.pixels.len() as f32
}

/// Returns the pixel of an image of 32 x 18 at its centre.
fn centre(image: &Image) -> f32 {
    image.pixels[9 * 32 + 16].y
}

#[test]
fn a_model_without_light_gets_a_sky_and_a_name_from_its_file() {
    let sandbox = sandbox();
    for (file, exr) in [("corner.obj", "corner.exr"), ("plate.stl", "plate.exr"), ("dark.gltf", "dark.exr")] {
        let stderr = render(&sandbox, file, &[]).expect(0).stderr;
        assert!(
            stderr.contains("the file has no light") && stderr.contains("--no-default-light"),
            "{stderr}"
        );
        assert!(stderr.contains(&format!("wrote {exr} and ")) && stderr.contains("(32x18, "), "{stderr}");
        let image = read_exr(&sandbox.path(exr)).unwrap();
        // Level ground has the irradiance π, so a diffuse surface of .5 to 1 has a radiance of that order.
        assert!((0.1..1.5).contains(&centre(&image)), "{file}: {}", centre(&image));
        assert!(image.pixels.iter().all(|pixel| pixel.min_element() > 0.0));
    }
    let dark = render(&sandbox, "dark.gltf", &["--no-default-light", "--strict"]).expect(3).stderr;
    assert!(dark.contains("no light that is supported") && dark.contains("--env sky"), "{dark}");
}

#[test]
fn what_glows_on_a_display_is_no_lamp_and_lamps_get_no_sky() {
    let sandbox = sandbox();
    assert!(render(&sandbox, "screen.gltf", &[]).expect(0).stderr.contains("the file has no light"));
    fs::write(sandbox.path("lamp.gltf"), gltf(1.0).replace("\"materials\":[{", LAMP)).unwrap();
    let stderr = render(&sandbox, "lamp.gltf", &[]).expect(0).stderr;
    assert!(!stderr.contains("the file has no light"), "{stderr}");
    // Scenes that state their light keep it.
    let stderr = render(&sandbox, "room.xml", &[]).expect(0).stderr;
    assert!(!stderr.contains("the file has no light"), "{stderr}");
}

/// An emissive strength of 20.
const LAMP: &str = r#""extensionsUsed":["KHR_materials_emissive_strength"],"materials":[{"extensions":
    {"KHR_materials_emissive_strength":{"emissiveStrength":20}},"#;

#[test]
fn environments_and_cameras_come_from_the_command_line() {
    let sandbox = sandbox();
    let picture = |more: &[&str]| {
        render(&sandbox, "corner.obj", &[more, &["-o", "a.exr"]].concat()).expect(0);
        read_exr(&sandbox.path("a.exr")).unwrap()
    };
    // The camera stands above, at a distance where the square covers all of the film, in an even light of 2.
    let above = ["--look-from", "0,9,0", "--look-at", "0,0,0", "--fov", "4"];
    let even = picture(&[&above[..], &["--env", "2", "--max-depth", "2"]].concat());
    // The wall hides a part of the sky behind the square, so less than .5 x 2 arrives.
    assert!((0.6..1.0).contains(&centre(&even)), "{}", centre(&even));
    let red = picture(&[&above[..], &["--env", "#ff0000"]].concat());
    assert!(red.pixels.iter().all(|pixel| pixel.y == 0.0 && pixel.x > 0.0));
    // A sun in front of the wall lights it; one behind it does not.
    let look = ["--azimuth", "0", "--elevation", "10"];
    let front = picture(&[&look[..], &["--env", "sky,0,20"]].concat());
    let back = picture(&[&look[..], &["--env", "sky,180,20"]].concat());
    assert!(centre(&front) > 2.0 * centre(&back), "{} {}", centre(&front), centre(&back));
    let turned = picture(&[&look[..], &["--env", "sky,0,20", "--env-rotate", "180"]].concat());
    assert!((mean(&turned) / mean(&back) - 1.0).abs() < 0.05);
    // A file that is no image is an error that names it.
    let stderr = render(&sandbox, "corner.obj", &["--env", "corner.obj"]).expect(3).stderr;
    assert!(stderr.contains("corner.obj"), "{stderr}");
}

#[test]
fn files_are_what_their_names_say() {
    let sandbox = sandbox();
    render(&sandbox, "corner.obj", &["-o", "new/only.png"]).expect(0);
    assert!(sandbox.path("new/only.png").exists() && !sandbox.path("new/only.exr").exists());
    let piped =
        sandbox.command(&["render", "corner.obj", "-s", "1", "-r", "16", "--method", "path", "-o", "-"]);
    let piped = { piped }.output().unwrap();
    assert!(piped.status.success() && piped.stdout.starts_with(b"\x89PNG"));
    let mut exr =
        sandbox.command(&["render", "corner.obj", "-s", "1", "-r", "16", "-o", "-", "--set", "format=exr"]);
    let exr = exr.output().unwrap();
    fs::write(sandbox.path("piped.exr"), exr.stdout).unwrap();
    assert_eq!(ExrFile::read(&sandbox.path("piped.exr")).unwrap().window().width, 16);
    let kept = render(&sandbox, "corner.obj", &["-o", "new/only.png", "--no-overwrite"]).expect(4).stderr;
    assert!(kept.contains("--no-overwrite keeps it"), "{kept}");
    for wrong in [&["-o", "a.jpg"][..], &["-o", "a.png", "--no-png"], &["-o", "a.png", "--resume"]] {
        render(&sandbox, "corner.obj", wrong).expect(2);
    }
    assert!(!sandbox.files().iter().any(|name| name.contains("jpg")));
}

#[test]
fn messages_are_as_many_as_asked_for() {
    let sandbox = sandbox();
    assert_eq!(render(&sandbox, "corner.obj", &["-q"]).expect(0).stderr, "");
    let stderr = render(&sandbox, "corner.obj", &["-v"]).expect(0).stderr;
    assert!(stderr.contains(" s: render"), "{stderr}");
    for (file, way_out) in
        [("a.blend", "Punctual Lights"), ("a.usdz", "Blender"), ("a.pbrt", "Mitsuba"), ("a.x", ".glb")]
    {
        let stderr = render(&sandbox, file, &[]).expect(3).stderr;
        assert!(stderr.contains(way_out), "{stderr}");
    }
}

#[test]
fn an_image_is_developed_again_with_another_exposure_and_view() {
    let sandbox = sandbox();
    render(&sandbox, "corner.obj", &["-o", "a.exr", "--exposure", "0"]).expect(0);
    let pixels = |name: &str| image::open(sandbox.path(name)).unwrap().into_rgb8().into_raw();
    let first = pixels("a.png");
    let developed = |more: &[&str]| {
        sandbox.run(&[&["develop", "a.exr", "-o", "b.png"], more].concat()).expect(0);
        pixels("b.png")
    };
    assert!(developed(&["--exposure", "0"]) == first);
    let sum = |pixels: &[u8]| pixels.iter().map(|&value| u64::from(value)).sum::<u64>();
    assert!(sum(&developed(&["--exposure", "-2"])) < sum(&first));
    for view in ["standard", "agx", "filmic"] {
        assert!(developed(&["--exposure", "0", "--view", view]) != first, "{view}");
    }
    let stderr = sandbox.run(&["develop", "a.exr", "-o", "b.exr"]).expect(2).stderr;
    assert!(stderr.contains(".png"), "{stderr}");
    let piped = sandbox.command(&["develop", "a.exr", "-o", "-", "--exposure", "0"]).output().unwrap().stdout;
    let (width, height) = image::image_dimensions(sandbox.path("a.png")).unwrap();
    let head = format!("P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\n");
    assert!(piped == [head.as_bytes(), &first].concat());
}

#[test]
fn the_version_names_libraries_and_instruction_sets() {
    let sandbox = sandbox();
    let said = sandbox.run(&["--version"]).expect(0).stdout;
    assert!(
        said.starts_with("lightsplat ") && said.contains("Embree: ") && said.contains("compiled for: "),
        "{said}"
    );
    assert_eq!(sandbox.run(&["-V"]).expect(0).stdout.lines().count(), 1);
    let bash = sandbox.run(&["generate", "bash"]).expect(0).stdout;
    assert!(bash.contains("--env-rotate"));
    fs::write(sandbox.path("completions"), bash).unwrap();
    let checked = std::process::Command::new("bash").arg("-n").arg(sandbox.path("completions")).status();
    assert!(checked.is_ok_and(|status| status.success()));
}

#[test]
fn built_in_scenes_render_by_name_and_files_come_first() {
    let sandbox = sandbox();
    render(&sandbox, "cornell", &["--reproducible"]).expect(0);
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cornell.toml");
    render(&sandbox, scene, &["--reproducible", "-o", "file.exr"]).expect(0);
    let bytes = |name: &str| fs::read(sandbox.path(name)).unwrap();
    assert!(bytes("cornell.exr") == bytes("file.exr") && bytes("cornell.png") == bytes("file.png"));
    assert!(sandbox.run(&["info", "kitchen"]).expect(0).stdout.contains("triangles"));
    fs::write(sandbox.path("knot"), "").unwrap();
    for (name, said) in [("knot", "an empty file"), ("no-such-scene", "or one of apartment, cornell")] {
        let stderr = sandbox.run(&["info", name]).expect(3).stderr;
        assert!(stderr.contains(said), "{stderr}");
    }
    fs::write(sandbox.path("jobs.toml"), "[[picture]]\nscene = 'cornell'\noutput = 'b.exr'\n").unwrap();
    assert!(sandbox.run(&["batch", "jobs.toml", "--list"]).expect(0).stdout.contains("cornell"));
}
