//! Memory is reckoned before it is spent, under the limits of a shell.
#![cfg(target_os = "linux")]

use super::{Finished, Sandbox};
use std::process::Command;

/// Runs the program with so many KiB of address space, or without a limit.
fn run(sandbox: &Sandbox, kibibytes: Option<u32>, arguments: &str) -> Finished {
    let limit = kibibytes.map_or(String::new(), |most| format!("ulimit -v {most}; "));
    let line = format!("{limit}exec {} {arguments}", env!("CARGO_BIN_EXE_lightsplat"));
    Finished::from(
        Command::new("sh").args(["-c", &line]).current_dir(sandbox.folder.path()).output().unwrap(),
    )
}

#[test]
fn too_much_for_the_limit_of_the_shell_is_refused_before_anything_is_rendered() {
    let sandbox = Sandbox::new();
    for wanted in [
        "--set vpls=100000000",
        "--set direct-vpls=100000000",
        "--method photon-cache --set photons=100000000",
    ]
    .into_iter()
    .chain(["--method path --resolution 16384x8192", "--method lightcuts --resolution 16384x8192"])
    {
        let arguments = format!("render room.xml -o a.exr --threads 1 {wanted}");
        let stderr = run(&sandbox, Some(3_000_000), &arguments).expect(2).stderr;
        assert!(stderr.contains("GiB") && stderr.contains("--crop"), "{stderr}");
    }
    assert_eq!(sandbox.files(), ["room.xml"]);
}

#[test]
fn copies_of_meshes_are_counted_before_they_are_made() {
    let sandbox = Sandbox::new();
    let emitter = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter>";
    let group = format!("<shape type=\"sphere\">{emitter}</shape>").repeat(10);
    let instances = "<shape type=\"instance\"><ref id=\"g\"/></shape>".repeat(1000);
    let own = format!("<shape type=\"shapegroup\" id=\"g\">{group}</shape>{instances}");
    let mut ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 50000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
            .to_owned();
    ply += &"3 0 1 2\n".repeat(50_000);
    std::fs::write(sandbox.path("a.ply"), ply).unwrap();
    let of_file = "<shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/></shape>".repeat(100);
    for (name, shapes) in [("instances", own), ("files", of_file)] {
        let text = format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{shapes}</scene>");
        std::fs::write(sandbox.path("a.xml"), text).unwrap();
        let stderr = run(&sandbox, Some(600_000), "info a.xml").expect(3).stderr;
        let names_both = stderr.contains("a.xml") && stderr.contains("triangles that fit into memory");
        assert!(names_both, "{name}: {stderr}");
    }
}

#[test]
fn a_mesh_too_long_for_the_memory_there_is_is_not_begun() {
    let sandbox = Sandbox::new();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(sandbox.path("a.obj"), corners.to_owned() + &"# nothing\n".repeat(20_000_000)).unwrap();
    std::fs::write(sandbox.path("a.toml"), "[[mesh]]\nfile = \"a.obj\"\n").unwrap();
    let stderr = run(&sandbox, Some(700_000), "info a.toml").expect(3).stderr;
    assert!(stderr.contains("a.obj: reading it takes about 572 MiB of memory, and "), "{stderr}");
    run(&sandbox, None, "info a.toml").expect(0);
}

#[test]
fn pictures_too_large_for_the_memory_there_is_are_not_decoded() {
    let sandbox = Sandbox::new();
    // A file of one colour is small.
    image::GrayImage::new(16_000, 16_000).save(sandbox.path("a.png")).unwrap();
    let texture = "[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = { file = \"a.png\" }\n\
        [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\n";
    std::fs::write(sandbox.path("texture.toml"), texture).unwrap();
    std::fs::write(sandbox.path("sky.toml"), "[environment]\nfile = \"a.png\"\n").unwrap();
    for scene in ["texture.toml", "sky.toml"] {
        let stderr = run(&sandbox, Some(2_000_000), &format!("info {scene}")).expect(3).stderr;
        assert!(stderr.contains("a.png: its 16000 x 16000 pixels take about 2929 MiB of memory"), "{stderr}");
    }
}
