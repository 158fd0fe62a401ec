//! `lightsplat` in packages: starts the variant of the program that suits the processor.
//!
//! Packages hold the program twice, compiled for x86-64-v3 and for x86-64-v4. This launcher is compiled for every
//! x86-64 processor. `execve` replaces it by a variant, which keeps the process, arguments, streams and signals. The
//! variants stand beside the folder of the launcher, wherever that is moved, or linked to.

#![forbid(unsafe_code)]

mod choice;

use choice::{choose, features};
use std::convert::Infallible;
use std::env;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Folders of the variants in the tarball and in the wheel, beside the folder of the launcher.
const FOLDERS: [&str; 2] = ["lib/lightsplat", "libexec/lightsplat"];

/// Variable that sets the largest instruction set used, for machines whose images must have equal bits.
const VARIABLE: &str = "LIGHTSPLAT_ISA";

fn main() -> ExitCode {
    let Err(what) = start();
    eprintln!("error: {what}");
    ExitCode::FAILURE
}

/// Replaces this program by a variant, or returns why it cannot.
fn start() -> Result<Infallible, String> {
    let limit = env::var_os(VARIABLE).map(|limit| limit.to_string_lossy().into_owned());
    let isa = choose(&features(), limit.as_deref())?;
    let own = env::current_exe().map_err(|error| format!("cannot find the program's folder: {error}"))?;
    let program = variant(&own, isa);
    let mut arguments = env::args_os();
    let mut command = Command::new(&program);
    if let Some(name) = arguments.next() {
        command.arg0(name);
    }
    let error = command.args(arguments).exec();
    Err(format!(
        "cannot start {}: {error}; keep the folders of the package together, or install it again",
        program.display()
    ))
}

/// Returns the path of a variant. `own` is the path of the launcher, without links.
fn variant(own: &Path, isa: &str) -> PathBuf {
    let prefix = own.parent().and_then(Path::parent).unwrap_or(Path::new(".."));
    let [tarball, wheel] = FOLDERS.map(|folder| prefix.join(folder).join(format!("lightsplat-{isa}")));
    if wheel.exists() { wheel } else { tarball }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn variants_stand_beside_the_folder_of_the_launcher() {
        let prefix = env::temp_dir().join(format!("lightsplat-launcher-{}", std::process::id()));
        let find = || variant(&prefix.join("bin/lightsplat"), "x86-64-v3");
        assert_eq!(find(), prefix.join("lib/lightsplat/lightsplat-x86-64-v3"));
        let wheel = prefix.join("libexec/lightsplat/lightsplat-x86-64-v3");
        fs::create_dir_all(wheel.parent().unwrap()).unwrap();
        fs::write(&wheel, "").unwrap();
        assert_eq!(find(), wheel);
        fs::remove_dir_all(&prefix).unwrap();
    }
}
