//! The end of the process while threads of Embree may be at work.

use std::ffi::c_int;

unsafe extern "C" {
    /// POSIX: ends the process without what libraries have registered to be done before.
    fn _exit(status: c_int) -> !;
}

/// Ends the process at once. By [`std::process::exit`] libraries would take apart what their threads, in the middle of
/// a build or of denoising, are working with: one run in a hundred then ended by a corrupted heap.
pub fn leave(code: u8) -> ! {
    // SAFETY: takes any status and has no other conditions; all memory stays as it is until the process is gone.
    unsafe { _exit(code.into()) }
}
