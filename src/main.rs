//! The `lightsplat` command.

use mimalloc::MiMalloc;
use std::process::ExitCode;

/// Allocator that gives memory back which it has no more use for: that of glibc keeps the tiles of a large picture.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    isa::is_checked();
    lightsplat::cli::run(std::env::args_os())
}
