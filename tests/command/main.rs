//! The command as users and scripts call it: exit codes, files, streams, signals.

mod background;
mod batch;
mod bench;
mod blender;
mod compare;
mod dataset;
mod denoise;
mod dry_run;
mod first_picture;
mod interrupt;
mod live;
mod looks;
mod memory;
mod merge;
mod movie;
mod output;
mod plan;
mod posed_walk;
mod python;
#[cfg(target_os = "linux")]
mod random_interrupts;
mod sheet;
mod slow_studies;
#[cfg(target_os = "linux")]
mod slurm;
mod tev;
mod usage;
mod verify;
mod views;
mod views_choice;
mod walk;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The command, in a folder of its own.
struct Sandbox {
    folder: tempfile::TempDir,
}

impl Sandbox {
    fn new() -> Sandbox {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("room.xml"), ROOM).unwrap();
        Sandbox { folder }
    }

    /// A sandbox that has one more file.
    fn with(name: &str, text: &str) -> Sandbox {
        let sandbox = Sandbox::new();
        std::fs::write(sandbox.path(name), text).unwrap();
        sandbox
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lightsplat"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Finished {
        Finished::from(self.command(arguments).output().unwrap())
    }

    /// Renders the room to `name`, fast; by path tracing unless `more` names a method.
    fn render(&self, name: &str, more: &[&str]) -> Finished {
        let base = ["render", "room.xml", "-o", name, "--spp", "4", "--resolution", "24x16"];
        let method: &[&str] = if more.contains(&"--method") { &[] } else { &["--method", "path"] };
        self.run(&[&base, method, more].concat())
    }

    /// Arguments that trace the room's paths to `a.exr`.
    fn path_tracing<'a>(spp: &'a str, more: &[&'a str]) -> Vec<&'a str> {
        [&["render", "room.xml", "-o", "a.exr", "--method", "path", "--spp", spp], more].concat()
    }

    fn files(&self) -> Vec<String> {
        let mut names: Vec<_> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

struct Finished {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl From<Output> for Finished {
    fn from(output: Output) -> Finished {
        Finished {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Finished {
    /// Asserts the exit code, and shows the output if it is another.
    #[track_caller]
    fn expect(self, code: i32) -> Finished {
        assert_eq!(self.code, Some(code), "stdout: {}\nstderr: {}", self.stdout, self.stderr);
        self
    }
}

/// Options by which a method takes few lights or photons. Their default numbers take most of the time of small images.
fn few_lights(method: &str) -> &'static [&'static str] {
    match method {
        "path" => &[],
        "photon-cache" => &["--set", "photons=20000", "--set", "gather-rays=64"],
        _ => &["--set", "vpls=2000", "--set", "direct-vpls=256"],
    }
}

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// A grey square, lit by another above it.
const ROOM: &str = r#"<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="4"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="50"/>
    <transform name="to_world"><lookat origin="0, 3, 6" target="0, 0.5, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="96"/><integer name="height" value="64"/><rfilter type="box"/>
    </film>
  </sensor>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><scale value="3"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate y="2"/></transform>
    <emitter type="area"><rgb name="radiance" value="5, 5, 5"/></emitter>
  </shape>
</scene>
"#;
