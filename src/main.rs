//! The `lightsplat` command.

use mimalloc::MiMalloc;
use std::process::ExitCode;

/// Allocator that gives memory back which it has no more use for: that of glibc keeps the tiles of a large picture.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// Milliseconds for which the allocator keeps free memory.
const KEPT_FREE: u16 = 1000;

fn main() -> ExitCode {
    isa::is_checked();
    allocator::keep_for(KEPT_FREE);
    lightsplat::cli::run(std::env::args_os())
}
