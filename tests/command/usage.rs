//! Wrong command lines end with 2, wrong scenes with 3, before any work is done.

use super::Sandbox;
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn help_and_version_are_data_and_no_error() {
    let sandbox = Sandbox::new();
    let help = sandbox.run(&["--help"]).expect(0);
    for command in ["render", "info", "compare"] {
        assert!(help.stdout.contains(command), "{}", help.stdout);
        assert!(sandbox.run(&[command, "--help"]).expect(0).stdout.contains("Usage"));
    }
    assert!(sandbox.run(&["--version"]).expect(0).stdout.contains(env!("CARGO_PKG_VERSION")));
    assert!(help.stderr.is_empty());
}

#[test]
fn empty_variables_count_as_none() {
    let sandbox = Sandbox::new();
    let render =
        ["render", "room.xml", "-o", "a.exr", "--method", "path", "--spp", "1", "--resolution", "8x8"];
    let run = |threads: &str| {
        let mut command = sandbox.command(&render);
        command.env("LIGHTSPLAT_THREADS", threads).env("LIGHTSPLAT_PROGRESS", "");
        super::Finished::from(command.output().unwrap())
    };
    run("").expect(0);
    assert!(run("many").expect(2).stderr.contains("many"));
}

#[cfg(target_os = "linux")]
#[test]
fn help_that_cannot_be_printed_ends_with_4() {
    let sandbox = Sandbox::new();
    for arguments in [&["--help"][..], &["--version"], &["info", "room.xml"]] {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let status = sandbox.command(arguments).stdout(full).stderr(std::process::Stdio::null()).status();
        assert_eq!(status.unwrap().code(), Some(4), "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_that_is_moved_with_its_libraries_takes_these() {
    let sandbox = Sandbox::new();
    // Asked so, the loader lists what it loads: "name => path (address)".
    let libraries = |program: &Path| {
        let mut command = Command::new(program);
        let output =
            command.env_remove("LD_LIBRARY_PATH").env("LD_TRACE_LOADED_OBJECTS", "1").output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let paths = text.lines().filter_map(|line| line.split_once("=> ")?.1.split(' ').next());
        let of_embree = |path: &&str| ["/libembree", "/libtbb"].iter().any(|name| path.contains(name));
        paths.filter(of_embree).map(PathBuf::from).collect::<Vec<_>>()
    };
    let here = libraries(Path::new(env!("CARGO_BIN_EXE_lightsplat")));
    assert!(!here.is_empty());
    for library in &here {
        std::fs::copy(library, sandbox.path(library.file_name().unwrap().to_str().unwrap())).unwrap();
    }
    let moved = sandbox.path("lightsplat");
    std::fs::copy(env!("CARGO_BIN_EXE_lightsplat"), &moved).unwrap();
    let folder = sandbox.folder.path().canonicalize().unwrap();
    let there = libraries(&moved);
    assert_eq!(there.len(), here.len());
    assert!(there.iter().all(|library| library.parent() == Some(&folder)), "{there:?}");
    let run = Command::new(&moved).env_remove("LD_LIBRARY_PATH").arg("--version").output().unwrap();
    assert!(run.status.success());
}

#[cfg(target_os = "linux")]
#[test]
fn devices_and_pipes_are_refused_at_once() {
    let sandbox = Sandbox::new();
    let place = |name: &str, text: &str| std::fs::write(sandbox.path(name), text).unwrap();
    for name in ["zero.toml", "zero.xml", "zero.glb", "zero.obj", "zero.png", "zero.mtl"] {
        std::os::unix::fs::symlink("/dev/zero", sandbox.path(name)).unwrap();
    }
    assert!(std::process::Command::new("mkfifo").arg(sandbox.path("pipe.toml")).status().unwrap().success());
    place(
        "mesh.toml",
        "material = [{ name = 'm', kind = 'mirror' }]\nmesh = [{ file = 'zero.obj', material = 'm' }]",
    );
    place("texture.toml", "material = [{ name = 'm', kind = 'diffuse', reflectance = 'zero.png' }]");
    place("library.obj", "mtllib zero.mtl\nusemtl m\n");
    place("library.toml", "mesh = [{ file = 'library.obj' }]");
    for name in ["zero.toml", "zero.xml", "zero.glb", "pipe.toml", "mesh.toml"] {
        let stderr = sandbox.run(&["info", name]).expect(3).stderr;
        assert!(stderr.contains("not a regular file"), "{name}: {stderr}");
    }
    // Grey stands in for a texture and for the materials of a library.
    for (name, refusal) in [("texture.toml", "not a regular file"), ("library.toml", "no material library")] {
        sandbox.run(&["info", name]).expect(0);
        let stderr = sandbox.run(&["info", "--strict", name]).expect(3).stderr;
        assert!(stderr.contains(refusal), "{name}: {stderr}");
    }
    std::fs::rename(sandbox.path("pipe.toml"), sandbox.path("pipe.exr")).unwrap();
    let compared = sandbox.run(&["compare", "pipe.exr", "pipe.exr"]).expect(3);
    assert!(compared.stderr.contains("not a regular file"), "{}", compared.stderr);
    assert!(sandbox.run(&["batch", "zero.toml"]).expect(3).stderr.contains("not a regular file"));
}

#[test]
fn errors_of_the_system_are_told_once() {
    let sandbox = Sandbox::new();
    for arguments in
        [&["info", "none.toml"][..], &["compare", "none.exr", "none.exr"], &["batch", "none.toml"]]
    {
        let stderr = sandbox.run(arguments).expect(3).stderr;
        assert_eq!(stderr.matches("No such file").count(), 1, "{stderr}");
        assert_eq!(stderr.matches(arguments[1]).count(), 1, "{stderr}");
    }
}

#[test]
fn wrong_command_lines_end_with_2_and_say_what_is_wrong() {
    let sandbox = Sandbox::new();
    let render = |more: &[&str]| sandbox.render("a.exr", more).expect(2).stderr;
    assert!(!sandbox.run(&[]).expect(2).stderr.is_empty());
    sandbox.run(&["paint"]).expect(2);
    sandbox.run(&["render"]).expect(2);
    render(&["--method", "guess"]);
    render(&["--threads", "0"]);
    render(&["--max-depth", "0"]);
    render(&["--exposure", "bright"]);
    render(&["--crop", "1,2,3"]);
    for (option, value, expected) in [
        ("--spp", "0", "expected at least 1"),
        ("--spp", "-3", "expected at least 1"),
        ("--seed", "4294967296", "from 0 to 4294967295"),
        ("--seed", "-1", "from 0 to 4294967295"),
        ("--threads", "-1", "1..=4096"),
        ("--verify", "-1", "16.."),
        ("--time", "-1s", "like 10s"),
        ("--error", "-2%", "like 2%"),
        ("--frame", "-1", "1 or more"),
        ("--resolution", "65537x1", "from 1 to 65536"),
        ("--camera", "bob", "chooses among 1"),
        ("--set", "denoise-quality=fast", "needs --denoise"),
    ] {
        let typed = ["render", "room.xml", "-o", "a.exr", "--method", "path", option, value];
        let stderr = sandbox.run(&typed).expect(2).stderr;
        assert!(stderr.contains(expected), "{option} {value}: {stderr}");
    }
    assert!(render(&["--set", "vpls=9"]).contains("lightcuts"));
    render(&["--method", "lightcuts", "--set", "epsilon=2"]);
    assert!(render(&["--method", "cache", "--set", "photons=9"]).contains("photon-cache"));
    assert!(render(&["--method", "photon-cache", "--set", "vpls=9"]).contains("no such setting"));
    assert!(render(&["--set", "probe-rays=9"]).contains("--method cache, photon-cache"));
    let by_cuts = ["--method", "cache", "--set", "direct=cuts", "--set", "indirect=cuts"];
    assert!(render(&by_cuts).contains("--method reconstruction"));
    for wrong in [
        ["--set", "nearest=1"],
        ["--set", "gather-rays=3"],
        ["--set", "sample-rays=0"],
        ["--set", "photons=-5"],
        ["--set", "reach=5,2"],
    ] {
        render(&["--method", "photon-cache", wrong[0], wrong[1]]);
    }
    for option in ["--set=mu", "--set=series-alpha", "--set=series-error"] {
        for wrong in ["nan", "inf", "-1"] {
            render(&["--method", "cache", &format!("{option}={wrong}")]);
        }
    }
    assert!(render(&["--aov", "albedo,normals"]).contains("geometric-normal"));
    render(&["--no-png", "--png", "b.png"]);
    assert!(render(&["--crop", "20,0,5,5"]).contains("24x16"));
    assert!(render(&["--frame", "1"]).contains("no camera path"));
    assert!(render(&["--png", "b.jpg"]).contains(".png"));
    assert!(sandbox.render("a.tiff", &[]).expect(2).stderr.contains(".exr"));
    assert_eq!(sandbox.files(), ["room.xml"]);
}

#[cfg(target_os = "linux")]
#[test]
fn more_eye_samples_than_memory_holds_are_refused_with_a_remedy() {
    let sandbox = Sandbox::new();
    let arguments = ["render", "room.xml", "-o", "a.exr", "--spp", "4000000000"];
    let stderr = sandbox.run(&arguments).expect(2).stderr;
    for remedy in ["GiB", "--spp", "--crop", "--method lightcuts"] {
        assert!(stderr.contains(remedy), "{stderr}");
    }
    assert_eq!(sandbox.files(), ["room.xml"]);
}

#[test]
fn scenes_that_are_missing_unknown_or_broken_end_with_3_and_name_the_file() {
    let sandbox = Sandbox::new();
    std::fs::write(sandbox.path("broken.xml"), "<scene version=\"3.0.0\">\n<shape").unwrap();
    std::fs::write(sandbox.path("scene.usd"), "").unwrap();
    for name in ["missing.xml", "missing.toml", "broken.xml", "scene.usd"] {
        for arguments in [&["render", name, "-o", "a.exr"][..], &["info", name]] {
            let stderr = sandbox.run(arguments).expect(3).stderr;
            assert!(stderr.contains(name), "{stderr}");
        }
    }
    assert!(!sandbox.path("a.exr").exists());
}

#[test]
fn a_black_picture_is_warned_of_and_an_error_under_strict() {
    let sandbox = Sandbox::new();
    // The lamp shines away from all that is seen.
    let text = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"rectangle\">\
        <emitter type=\"area\"/><transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/><translate y=\"9\"/>\
        </transform></shape></scene>";
    std::fs::write(sandbox.path("black.xml"), text).unwrap();
    let arguments = ["render", "black.xml", "-o", "a.exr", "--spp", "1", "--resolution", "4x4"];
    let warned = sandbox.run(&arguments).expect(0);
    assert!(warned.stderr.contains("warning: the image is black"), "{}", warned.stderr);
    assert!(warned.stderr.contains("the emitter \"rectangle"), "{}", warned.stderr);
    let strict = sandbox.run(&[&arguments[..], &["--strict"]].concat()).expect(1);
    assert!(strict.stderr.contains("error: a.exr: the image is black"), "{}", strict.stderr);
    let dark = text.replace("<emitter type=\"area\"/>", "");
    std::fs::write(sandbox.path("black.xml"), dark).unwrap();
    let warned = sandbox.run(&arguments).expect(0);
    assert!(warned.stderr.contains("no light that is supported"), "{}", warned.stderr);
    sandbox.run(&[&arguments[..], &["--strict"]].concat()).expect(3);
}

#[test]
fn strict_turns_a_warning_into_an_error() {
    let sandbox = Sandbox::new();
    let text = super::ROOM.replace("type=\"diffuse\"", "type=\"velvetish\"");
    std::fs::write(sandbox.path("odd.xml"), text).unwrap();
    let arguments = ["render", "odd.xml", "-o", "a.exr", "--spp", "1", "--resolution", "4x4"];
    let lenient = sandbox.run(&arguments).expect(0);
    assert!(
        lenient.stderr.contains("velvetish") && lenient.stderr.contains("odd.xml:"),
        "{}",
        lenient.stderr
    );
    std::fs::remove_file(sandbox.path("a.exr")).unwrap();
    let strict = sandbox.run(&[&arguments[..], &["--strict"]].concat()).expect(3);
    assert!(strict.stderr.contains("velvetish"), "{}", strict.stderr);
    assert!(!sandbox.path("a.exr").exists());
}

#[test]
fn info_tells_what_a_scene_holds_as_text_and_json() {
    let sandbox = Sandbox::new();
    assert!(sandbox.run(&["info", "room.xml"]).expect(0).stdout.contains("triangles"));
    let json = sandbox.run(&["info", "room.xml", "--json"]).expect(0).stdout;
    let facts: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(facts["triangles"], 4);
    assert_eq!(facts["resolution"], serde_json::json!([96, 64]));
    assert_eq!((&facts["materials"], &facts["cameras"]), (&2.into(), &serde_json::json!([""])));
    assert_eq!(facts["lights"][0]["kind"], "area");
    assert_eq!(facts["box"], serde_json::json!({ "min": [-3.0, 0.0, -3.0], "max": [3.0, 2.0, 3.0] }));
    assert_eq!((&facts["frame_range"], &facts["not_supported"]), (&().into(), &serde_json::json!([])));
}
