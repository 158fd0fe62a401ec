//! Memory is reckoned before it is spent.

use crate::all_methods::all;
use lightsplat::film::Window;

/// Runs the program in `folder` with so many KiB of address space, or without a limit; returns its exit code and
/// what it says.
#[cfg(target_os = "linux")]
fn run(folder: &std::path::Path, kibibytes: Option<u32>, arguments: &str) -> (Option<i32>, String) {
    let limit = kibibytes.map_or(String::new(), |most| format!("ulimit -v {most}; "));
    let line = format!("{limit}exec {} {arguments}", env!("CARGO_BIN_EXE_lightsplat"));
    let run =
        std::process::Command::new("sh").args(["-c", &line]).current_dir(folder).output().expect("a shell");
    (run.status.code(), String::from_utf8_lossy(&run.stderr).into_owned())
}

#[test]
fn every_method_reckons_with_pixels_samples_lights_and_photons() {
    let small = Window::whole([100, 100]);
    for (name, method) in all() {
        let expected = |key: &str, value: &str, window: &Window| {
            let mut method = method;
            let known = method.set(key, value).expect("a value");
            known.then(|| method.expected_bytes(window))
        };
        assert!(method.expected_bytes(&Window::whole([32_768, 32_768])) > 60 << 30, "{name}");
        for (key, value) in [("vpls", "1000000000"), ("direct_vpls", "1000000000"), ("photons", "1000000000")]
        {
            assert!(expected(key, value, &small).is_none_or(|bytes| bytes > 100 << 30), "{name} {key}");
        }
        let samples = expected("spp", "1000000", &small).expect("every method has samples");
        let keeps = !["path", "lightcuts", "drawn"].contains(&name);
        assert!(samples > 100 << 30 || !keeps, "{name} {samples}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn too_much_for_the_limit_of_the_shell_is_refused_before_anything_is_rendered() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("room.toml"), crate::all_methods::room(1.0)).expect("a scene");
    for wanted in ["--vpls 100000000", "--direct-vpls 100000000", "--method photon-cache --photons 100000000"]
        .into_iter()
        .chain(["--method path --resolution 16384x8192", "--method lightcuts --resolution 16384x8192"])
    {
        let arguments = format!("render room.toml -o a.exr --threads 1 {wanted}");
        let (code, stderr) = run(folder.path(), Some(3_000_000), &arguments);
        assert_eq!(code, Some(2), "{wanted}: {stderr}");
        assert!(stderr.contains("GiB") && stderr.contains("--crop"), "{stderr}");
    }
    assert!(!folder.path().join("a.exr").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn copies_of_meshes_are_counted_before_they_are_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let group = "<shape type=\"sphere\"/>".repeat(100);
    let instances = "<shape type=\"instance\"><ref id=\"g\"/></shape>".repeat(1000);
    let own = format!("<shape type=\"shapegroup\" id=\"g\">{group}</shape>{instances}");
    let mut ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 50000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
            .to_owned();
    ply += &"3 0 1 2\n".repeat(50_000);
    std::fs::write(folder.path().join("a.ply"), ply).expect("a mesh");
    let of_file = "<shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/></shape>".repeat(1000);
    for (name, shapes) in [("instances", own), ("files", of_file)] {
        let text = format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{shapes}</scene>");
        std::fs::write(folder.path().join("a.xml"), text).expect("a scene");
        let (code, stderr) = run(folder.path(), Some(600_000), "info a.xml");
        assert_eq!(code, Some(3), "{name}: {stderr}");
        assert!(
            stderr.contains("a.xml") && stderr.contains("triangles that there is memory for"),
            "{stderr}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_mesh_too_long_for_the_memory_there_is_is_not_begun() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(path("a.obj"), corners.to_owned() + &"# nothing\n".repeat(20_000_000)).expect("a mesh");
    std::fs::write(path("a.toml"), "[[mesh]]\nfile = \"a.obj\"\n").expect("a scene");
    let (code, stderr) = run(folder.path(), Some(700_000), "info a.toml");
    assert_eq!(code, Some(3), "{stderr}");
    assert!(stderr.contains("a.obj: reading it takes about 572 MiB of memory, and "), "{stderr}");
    assert_eq!(run(folder.path(), None, "info a.toml").0, Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn pictures_too_large_for_the_memory_there_is_are_not_decoded() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    // Of one colour: a small file.
    image::GrayImage::new(16_000, 16_000).save(path("a.png")).expect("a picture");
    let texture = "[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = { file = \"a.png\" }\n\
        [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\n";
    std::fs::write(path("texture.toml"), texture).expect("a scene");
    std::fs::write(path("sky.toml"), "[environment]\nfile = \"a.png\"\n").expect("a scene");
    for scene in ["texture.toml", "sky.toml"] {
        let (code, stderr) = run(folder.path(), Some(2_000_000), &format!("info {scene}"));
        assert_eq!(code, Some(3), "{scene}: {stderr}");
        assert!(stderr.contains("a.png: its 16000 x 16000 pixels take about 2929 MiB of memory"), "{stderr}");
    }
}
