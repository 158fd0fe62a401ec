//! Immediate end of the process, while threads of Embree may be running.

use std::ffi::c_int;

unsafe extern "C" {
    /// Ends the process without running exit handlers (POSIX).
    fn _exit(status: c_int) -> !;
}

/// Ends the process at once.
///
/// [`std::process::exit`] would let libraries free data that their threads still use, in a build or in denoising. This
/// sometimes corrupted the heap.
pub fn leave(code: u8) -> ! {
    // SAFETY: takes any status and has no other conditions; all memory stays as it is until the process is gone.
    unsafe { _exit(code.into()) }
}
