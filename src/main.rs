//! The `lightsplat` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    lightsplat::cli::run(std::env::args_os())
}
