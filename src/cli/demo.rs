//! `lightsplat demo`: renders a built-in scene to the current folder, by the command that it prints.

use super::args::{Cli, Command};
use super::exit::Failure;
use super::{render, talk};

/// Command that the demo runs. Its first word is the program.
const COMMAND: [&str; 7] = ["lightsplat", "render", "kitchen", "-r", "640x360", "-o", "lightsplat-demo.exr"];

/// Runs the command.
pub fn run() -> Result<(), Failure> {
    let command = Cli::read(COMMAND).map_err(Failure::render)?.command;
    talk::line(&format!("demo: this runs `{}`", COMMAND.join(" ")));
    talk::line("demo: it writes lightsplat-demo.exr and lightsplat-demo.png to the current folder");
    match command {
        Command::Render(args) => render::run(*args),
        _ => Err(Failure::render(anyhow::anyhow!("the demo is no render"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::still_files::StillFiles;

    #[test]
    fn the_demo_renders_a_built_in_scene_to_the_files_that_it_names() {
        let Command::Render(args) = Cli::read(COMMAND).unwrap().command else { panic!("no render") };
        assert!(readers::is_built_in(&args.scene));
        let files = StillFiles::new(&args).unwrap();
        let names: Vec<_> = files.paths().map(|path| path.to_str().unwrap()).collect();
        assert_eq!(names, ["lightsplat-demo.exr", "lightsplat-demo.png"]);
    }
}
